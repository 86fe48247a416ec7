// SPDX-License-Identifier: Apache-2.0
#include "words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fdcg::dev {
namespace {

constexpr std::size_t kLongestWord = 40;  // the comparison below takes time by the square

std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

// Never through the middle of a UTF-8 letter.
std::string cut(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xC0) == 0x80)
    --longest;
  return std::string(text.substr(0, longest)) + "...";
}

}  // namespace

bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7F';
}

std::string one_line(std::string text) {
  constexpr std::size_t kLongest = 1000;
  text = cut(text, kLongest);
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

std::string in_quotes(std::string_view word) {
  return "'" + cut(word, kLongestWord) + "'";
}

std::string shown_number(double number) {
  char text[64];
  const double size = std::fabs(number);
  const bool is_plain = size == 0 || (size >= 1e-4 && size < 1e10);
  const auto format = is_plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto end = std::to_chars(text, text + sizeof text, number, format).ptr;
  return std::string(text, end);
}

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words)
    list += (list.empty() ? "" : ", ") + word;
  return list;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& choices) {
  if (word.size() > kLongestWord) return "";
  std::string_view best;
  std::size_t fewest = kLongestWord;
  for (const std::string& choice : choices) {
    const std::size_t edits = edits_between(choice, word);
    if (edits >= fewest) continue;
    fewest = edits;
    best = choice;
  }
  return best.empty() || fewest > best.size() / 3 + 1 ? "" : "; did you mean '" + std::string(best) + "'?";
}

}  // namespace fdcg::dev
