// SPDX-License-Identifier: Apache-2.0
// fdcg-servo run --fast: simulated and recorded devices, on clocks of their own.
#pragma once

#include <string>
#include <vector>

#include "fdcg/device_tools.hpp"

namespace fdcg::servo {

struct FastRunArguments {
  double for_s = 0;  // of the devices' time; 0: until every recording has ended
  bool arm = false;
  bool says_text = true, says_json = false;  // at the end
};

// The exit code. `warnings` are told first.
int run_fast(dev::Scene scene, const std::vector<std::string>& warnings, const FastRunArguments& arguments);

}  // namespace fdcg::servo
