// SPDX-License-Identifier: Apache-2.0
// Messages that quote what a file holds.
#pragma once

#include <string>

namespace fdcg::tools {

// The text on one line that a person reads: control characters as '?', cut after a thousand bytes.
std::string one_line(std::string text);

}  // namespace fdcg::tools
