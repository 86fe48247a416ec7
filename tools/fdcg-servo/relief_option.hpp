// SPDX-License-Identifier: Apache-2.0
// Option --relief: heights that are felt and not in the mesh (fdcg/relief.h).
#pragma once

#include <optional>
#include <string>

#include "../common/options.hpp"
#include "fdcg/heights.h"

namespace fdcg::servo {

class ReliefOption {
 public:
  void declare(const tools::OptionGroup& group);
  [[nodiscard]] bool is_given() const { return waves_.has_value() || is_image_; }
  // Takes the heights of the graph's file, where the relief is its images. What is wrong with them; empty: nothing.
  [[nodiscard]] std::string open(const fdcg_graph& graph);
  // One tick of `contact` with the relief, which was given; where hip_m is not finite, without.
  void step(const fdcg_graph& graph, const fdcg_params& params, const double* hip_m, fdcg_contact* contact,
            fdcg_result* result);
  // The force of that tick before the heights turned it.
  [[nodiscard]] const double* flat_force_n() const { return flat_n_; }

 private:
  std::optional<fdcg_waves> waves_;
  bool is_image_ = false;
  fdcg_heights heights_{};
  fdcg_relief relief_{};
  fdcg_relief_state state_{};
  double flat_n_[3] = {};
};

}  // namespace fdcg::servo
