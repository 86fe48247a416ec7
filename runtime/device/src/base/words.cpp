// SPDX-License-Identifier: Apache-2.0
#include "base/words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

#include "shared/utf8.hpp"

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
  constexpr std::size_t kMostContinued = 3;
  std::size_t end = longest;
  while (end > 0 && longest - end < kMostContinued && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end;
  const bool splits_none = letter_bytes(text.substr(end)) == 0;
  return std::string(text.substr(0, splits_none ? longest : end)) + "...";
}

}  // namespace

bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7F';
}

std::string one_line(std::string text) {
  constexpr std::size_t kLongest = 1000;
  text = cut(text, kLongest);
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = std::string_view(text).substr(at);
    const std::size_t bytes = letter_bytes(rest);
    const bool is_high_control =
        bytes == 2 && rest[0] == '\xC2' && static_cast<unsigned char>(rest[1]) < 0xA0;  // U+0080 to U+009F
    line += bytes == 0 ? "\xEF\xBF\xBD" : is_control(rest[0]) || is_high_control ? "?" : rest.substr(0, bytes);
    at += bytes > 0 ? bytes : 1;
  }
  return line;
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
