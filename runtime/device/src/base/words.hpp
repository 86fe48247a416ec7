// SPDX-License-Identifier: Apache-2.0
// Small parts of messages that quote what a file holds. Not for the loop: all of it allocates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fdcg::dev {

bool is_control(char c);  // would break a line or hide text on a terminal
// On one line that a person reads: control characters as '?', bytes that are no UTF-8 as U+FFFD, cut after a thousand bytes.
std::string one_line(std::string text);
// 'word', cut after 40 bytes.
std::string in_quotes(std::string_view word);
// As short as reads back to the same number: "0.1", "1e-06".
std::string shown_number(double number);
// "a, b, c".
std::string listed(const std::vector<std::string>& words);
// "; did you mean 'x'?" with the word that takes the fewest letters inserted, deleted or replaced; nothing where more than a
// third of its letters, and one more, are wrong.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& choices);

}  // namespace fdcg::dev
