// SPDX-License-Identifier: Apache-2.0
#include "base/printable.hpp"

#include <algorithm>

namespace fdcg::bake {
namespace {

unsigned char byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

template <class Append>
void each_code_point(std::string_view text, std::size_t max_bytes, std::string& out, const Append& append) {
  std::size_t at = 0;
  while (at < text.size()) {
    const CodePoint point = code_point_at(text, at);
    const std::size_t bytes = std::max<std::size_t>(point.bytes, 1);
    if (at + bytes > max_bytes) {
      out += "...";
      return;
    }
    if (point.bytes == 0) {
      out += kReplacement;
    } else {
      append(point.value, text.substr(at, bytes));
    }
    at += bytes;
  }
}

}  // namespace

CodePoint code_point_at(std::string_view text, std::size_t at) {
  const unsigned char lead = byte_at(text, at);
  if (lead < 0x80) return {lead, 1};
  std::size_t bytes = 0;
  char32_t value = 0;
  unsigned char least = 0x80, most = 0xBF;  // of the second byte
  if (lead >= 0xC2 && lead <= 0xDF) {
    bytes = 2, value = lead & 0x1Fu;
  } else if (lead >= 0xE0 && lead <= 0xEF) {
    bytes = 3, value = lead & 0x0Fu;
    if (lead == 0xE0) least = 0xA0;
    if (lead == 0xED) most = 0x9F;
  } else if (lead >= 0xF0 && lead <= 0xF4) {
    bytes = 4, value = lead & 0x07u;
    if (lead == 0xF0) least = 0x90;
    if (lead == 0xF4) most = 0x8F;
  }
  for (std::size_t i = 1; i < bytes; ++i) {
    const unsigned char next = byte_at(text, at + i);
    if (next < least || next > most) return {};
    value = (value << 6) | (next & 0x3Fu);
    least = 0x80, most = 0xBF;
  }
  return {value, bytes};
}

std::string valid_utf8(std::string_view text, std::size_t max_bytes) {
  std::string out;
  each_code_point(text, max_bytes, out, [&](char32_t, std::string_view bytes) { out += bytes; });
  return out;
}

std::string printable(std::string_view text, std::size_t max_bytes) {
  std::string out;
  each_code_point(text, max_bytes, out, [&](char32_t value, std::string_view bytes) {
    const bool is_control = value < 0x20 || (value >= 0x7F && value < 0xA0);
    out += is_control ? "?" : bytes;
  });
  return out;
}

}  // namespace fdcg::bake
