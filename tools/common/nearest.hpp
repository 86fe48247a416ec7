// SPDX-License-Identifier: Apache-2.0
// Names the right word for a misspelt one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fdcg::tools {

// The first of `choices` with the fewest letters inserted, deleted or replaced; empty where there is no choice.
std::string nearest(std::string_view word, const std::vector<std::string>& choices);

// "; did you mean 'x'?", or nothing where no choice is near: at most a third of its letters, and one more, wrong.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& choices);

}  // namespace fdcg::tools
