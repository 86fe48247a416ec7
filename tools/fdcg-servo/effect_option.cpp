// SPDX-License-Identifier: Apache-2.0
#include "effect_option.hpp"

namespace fdcg::servo {

void EffectOption::declare(const tools::OptionGroup& group) {
  group.repeated(
      "--effect", "KIND,KEY=VALUE,...",
      [this](const std::string& text) {
        if (const std::string problem = effects_.add(text); !problem.empty())
          throw CLI::ValidationError("--effect", "'" + text + "': " + problem);
      },
      "A force on top of the contact's: magnet, viscosity, stick-slip, vibration, noise, tap, pulse or texture, with the keys "
      "that an object of a scene has for it; or that JSON itself. May be given again.");
}

}  // namespace fdcg::servo
