// SPDX-License-Identifier: Apache-2.0
// Option --effect: forces on top of a contact's (fdcg/effect.h).
#pragma once

#include <string>

#include "../common/options.hpp"
#include "fdcg/device_tools.hpp"

namespace fdcg::servo {

class EffectOption {
 public:
  void declare(const tools::OptionGroup& group);
  [[nodiscard]] bool is_given() const { return !effects_.is_empty(); }
  [[nodiscard]] dev::GraphEffects& effects() { return effects_; }

 private:
  dev::GraphEffects effects_;
};

}  // namespace fdcg::servo
