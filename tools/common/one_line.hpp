// SPDX-License-Identifier: Apache-2.0
// Messages that quote what a file holds.
#pragma once

#include <string>
#include <string_view>

namespace fdcg::tools {

// The text on one line that a person reads: control characters as '?', bytes that are no UTF-8 as U+FFFD, cut after so many
// bytes of it, never in the middle of a letter.
std::string one_line(std::string_view text, std::size_t longest = 1000);

}  // namespace fdcg::tools
