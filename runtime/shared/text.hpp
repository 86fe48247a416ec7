// SPDX-License-Identifier: Apache-2.0
// Text of any bytes (paths, what a file holds) for messages and for formats that demand UTF-8. Not for the step: it allocates.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fdcg {

inline constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

// The code point that starts at `at` and its length in bytes; length 0 where no well-formed one starts there (Unicode 15,
// table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF).
struct CodePoint {
  char32_t value = 0;
  std::size_t bytes = 0;
};
[[nodiscard]] inline CodePoint code_point_at(std::string_view text, std::size_t at) {
  const auto byte_at = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned lead = byte_at(at);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead < 0xC2 || lead > 0xF4 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;  // of the second byte
  unsigned most = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  char32_t value = bytes == 0 ? 0 : lead & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    const unsigned next = byte_at(at + i);
    if (next < least || next > most) return {};
    value = (value << 6) | (next & 0x3Fu);
    least = 0x80, most = 0xBF;
  }
  return {value, bytes};
}

// Every byte that begins no well-formed code point becomes U+FFFD, every control character `control` where one is given. At
// most `max_bytes` of the text, never in the middle of a code point, then "...".
[[nodiscard]] inline std::string valid_utf8(std::string_view text, std::size_t max_bytes = std::string_view::npos,
                                            std::string_view control = {}) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint point = code_point_at(text, at);
    const std::size_t bytes = std::max<std::size_t>(point.bytes, 1);
    if (at + bytes > max_bytes) return out + "...";
    const bool is_control = point.value < 0x20 || (point.value >= 0x7F && point.value < 0xA0);
    out += point.bytes == 0 ? kReplacement : is_control && !control.empty() ? control : text.substr(at, bytes);
    at += bytes;
  }
  return out;
}

// The same with control characters as '?': what a file holds must not break a line or steer a terminal.
[[nodiscard]] inline std::string printable(std::string_view text, std::size_t max_bytes = std::string_view::npos) {
  return valid_utf8(text, max_bytes, "?");
}

// For a message that quotes what a file holds.
[[nodiscard]] inline std::string one_line(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  return printable(text, kLongest);
}

inline constexpr std::size_t kLongestWord = 40;  // edit_distance takes time by the square

// 'word', cut after 40 bytes.
[[nodiscard]] inline std::string in_quotes(std::string_view word) {
  return "'" + printable(word, kLongestWord) + "'";
}

// As short as reads back to the same number: "0.1", "1e-06".
[[nodiscard]] inline std::string shown_number(double number) {
  char text[64];
  const double size = std::fabs(number);
  const bool is_plain = size == 0 || (size >= 1e-4 && size < 1e10);
  const auto format = is_plain ? std::chars_format::fixed : std::chars_format::scientific;
  return {text, std::to_chars(text, text + sizeof text, number, format).ptr};
}

// "a, b, c".
[[nodiscard]] inline std::string listed(const std::vector<std::string>& words, const char* separator = ", ") {
  std::string list;
  for (const std::string& word : words)
    list += (list.empty() ? "" : separator) + word;
  return list;
}

// Letters inserted, deleted or replaced (Levenshtein).
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
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

// The first of `choices` with the fewest edits; empty where there is no choice, or where the word is too long to be a slip.
[[nodiscard]] inline std::string nearest(std::string_view word, const std::vector<std::string>& choices) {
  if (choices.empty() || word.size() > kLongestWord) return "";
  return *std::min_element(choices.begin(), choices.end(), [word](const std::string& a, const std::string& b) {
    return edit_distance(a, word) < edit_distance(b, word);
  });
}

// "; did you mean 'x'?", or nothing where no choice is near: at most a third of its letters, and one more, wrong.
[[nodiscard]] inline std::string did_you_mean(std::string_view word, const std::vector<std::string>& choices) {
  const std::string best = nearest(word, choices);
  if (best.empty() || edit_distance(best, word) > best.size() / 3 + 1) return "";
  return "; did you mean '" + best + "'?";
}

}  // namespace fdcg
