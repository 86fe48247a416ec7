// SPDX-License-Identifier: Apache-2.0
// Shared by the writers of the mesh formats: numbers as text and as bytes, and the refusal of meshes that a format cannot hold.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// One writer per format. They append to `out`, which is empty, and keep every face, vertex and coordinate of the soup; a corner
// without a vertex is written as an invalid index. Linear.
void write_off(const PolygonSoup& soup, std::string& out);
void write_obj(const PolygonSoup& soup, std::string& out);
void write_ply(const PolygonSoup& soup, bool is_text, std::string& out);
// Triangles alone, each with points of its own; `soup` is one that stl_refusal() lets pass.
void write_stl(const PolygonSoup& soup, bool is_text, std::string& out);

// What STL cannot represent of this soup, and the remedy: the first face that is not a triangle, else (binary) the first
// coordinate that is not a float, else the first vertex that belongs to no face. Empty: STL can represent it.
std::string stl_refusal(const PolygonSoup& soup, bool is_text);

// Whether the coordinate is exactly representable as float; NaN and infinities are.
inline bool is_float(double c) {
  return !std::isfinite(c) || (std::fabs(c) <= static_cast<double>(std::numeric_limits<float>::max()) &&
                               static_cast<double>(static_cast<float>(c)) == c);
}
inline bool is_float(const Vec3& p) {
  return is_float(p.x) && is_float(p.y) && is_float(p.z);
}

// Appends the shortest digits that read back as the same number; nan, inf and -inf in the spelling of C libraries.
template <class Number>
void put_number(std::string& out, Number value) {
  constexpr std::size_t kLongest = 32;  // "-2.2250738585072014e-308" has 24
  std::array<char, kLongest> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  out.append(text.data(), end);
}

// "x y z"
inline void put_point(std::string& out, const Vec3& p) {
  put_number(out, p.x);
  out += ' ';
  put_number(out, p.y);
  out += ' ';
  put_number(out, p.z);
}

// Appends the bytes of a scalar, the least significant first.
template <class Scalar>
void put_bytes(std::string& out, Scalar value) {
  std::array<char, sizeof(Scalar)> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

// A name as the rest of a line of text: control characters become blanks.
inline void put_name(std::string& out, std::string_view name) {
  for (const char c : name)
    out += static_cast<unsigned char>(c) < ' ' || c == '\x7F' ? ' ' : c;
}

}  // namespace fdcg::bake
