// SPDX-License-Identifier: Apache-2.0
#include "one_line.hpp"

namespace fdcg::tools {
namespace {

// Bytes of the well-formed UTF-8 letter that the text begins with; 0: with none (Unicode 15, table 3-7).
std::size_t letter_bytes(std::string_view text) {
  const auto byte = [text](std::size_t i) -> unsigned { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  const unsigned lead = byte(0), second = byte(1);
  if (lead < 0x80) return 1;
  const std::size_t bytes = lead >= 0xC2 && lead < 0xE0   ? 2
                            : lead >= 0xE0 && lead < 0xF0 ? 3
                            : lead >= 0xF0 && lead < 0xF5 ? 4
                                                          : 0;
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;  // overlong; surrogates
  if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;  // overlong; beyond U+10FFFF
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  return bytes;
}

bool is_control(std::string_view letter) {
  const auto first = static_cast<unsigned char>(letter[0]);
  if (letter.size() == 2) return first == 0xC2 && static_cast<unsigned char>(letter[1]) < 0xA0;  // U+0080 to U+009F
  return first < ' ' || first == 0x7F;
}

}  // namespace

std::string one_line(std::string_view text, std::size_t longest) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t known = letter_bytes(text.substr(at)), bytes = known > 0 ? known : 1;
    if (at + bytes > longest) return line + "...";
    const std::string_view letter = text.substr(at, bytes);
    line += known == 0 ? "\xEF\xBF\xBD" : is_control(letter) ? "?" : letter;
    at += bytes;
  }
  return line;
}

}  // namespace fdcg::tools
