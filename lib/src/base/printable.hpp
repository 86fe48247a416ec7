// SPDX-License-Identifier: Apache-2.0
// Text of any bytes (paths, names from mesh files) for formats that demand UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fdcg::bake {

inline constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

// The code point that starts at `at` and its length in bytes; length 0 where no well-formed one starts there (Unicode 15,
// table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF).
struct CodePoint {
  char32_t value = 0;
  std::size_t bytes = 0;
};
[[nodiscard]] CodePoint code_point_at(std::string_view text, std::size_t at);

// Every byte that begins no well-formed code point becomes U+FFFD. At most `max_bytes` of the text, then "...".
[[nodiscard]] std::string valid_utf8(std::string_view text, std::size_t max_bytes = std::string_view::npos);

// The same with control characters as '?': what a mesh file holds must not steer a terminal.
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_bytes = std::string_view::npos);

}  // namespace fdcg::bake
