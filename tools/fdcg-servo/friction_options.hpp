// SPDX-License-Identifier: Apache-2.0
// Options of the friction curve and of materials (fdcg_friction_flag): each that is given switches its part on.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "../common/options.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::servo {

class FrictionOptions {
 public:
  void declare(const tools::OptionGroup& group, fdcg_params& params);
  // With the graph open: materials by their names, and whether it can be shaded. Must outlive the params. Empty, or what the
  // graph has not.
  std::string apply(const fdcg_graph& graph, fdcg_params& params);

 private:
  bool has_shading_ = false;
  std::vector<std::pair<std::string, fdcg_material>> named_;
  std::vector<fdcg_material> table_;
};

// As they stand on the command line.
inline constexpr const char* kFrictionOptions[] = {"--stribeck", "--viscous", "--presliding",
                                                   "--lag",      "--shading", "--material"};

}  // namespace fdcg::servo
