// SPDX-License-Identifier: Apache-2.0
#include "one_line.hpp"

#include "shared/utf8.hpp"

namespace fdcg::tools {
namespace {

bool is_control(std::string_view letter) {
  const auto first = static_cast<unsigned char>(letter[0]);
  if (letter.size() == 2) return first == 0xC2 && static_cast<unsigned char>(letter[1]) < 0xA0;  // U+0080 to U+009F
  return first < ' ' || first == 0x7F;
}

}  // namespace

std::string one_line(std::string_view text, std::size_t longest) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t known = dev::letter_bytes(text.substr(at)), bytes = known > 0 ? known : 1;
    if (at + bytes > longest) return line + "...";
    const std::string_view letter = text.substr(at, bytes);
    line += known == 0 ? "\xEF\xBF\xBD" : is_control(letter) ? "?" : letter;
    at += bytes;
  }
  return line;
}

}  // namespace fdcg::tools
