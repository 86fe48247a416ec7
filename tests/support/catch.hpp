// SPDX-License-Identifier: Apache-2.0
// Catch2, version 2 or 3, by the names that both have.
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
namespace Catch::Matchers {
inline auto ContainsSubstring(const std::string& words) {
  return Contains(words);
}
}  // namespace Catch::Matchers
#endif
