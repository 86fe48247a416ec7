// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace fdcg::bake {

// Frees an array that has served: `values = {}` keeps its memory.
template <class Value>
void release(std::vector<Value>& values) {
  std::vector<Value>().swap(values);
}

}  // namespace fdcg::bake
