// SPDX-License-Identifier: Apache-2.0
// Stereolithography: triangles, each with its normal; floats in binary, numbers of any length in text.
#include <vector>

#include "base/vec3.hpp"
#include "export/export.hpp"

namespace fdcg::bake {
namespace {

using FloatVec = std::array<float, 3>;

FloatVec as_floats(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// The unit normal; zero, as the format demands, for a degenerate triangle.
FloatVec normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const double length = std::hypot(n.x, n.y, n.z);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return as_floats({n.x / length, n.y / length, n.z / length});
}

std::array<Vec3, 3> triangle(const PolygonSoup& soup, std::size_t f) {
  const std::uint32_t* const corner = &soup.corners[soup.face_first[f]];
  return {soup.points[corner[0]], soup.points[corner[1]], soup.points[corner[2]]};
}

void write_binary(const PolygonSoup& soup, std::string& out) {
  constexpr std::size_t kHeader = 80, kTriangle = 50;  // bytes
  out.reserve(kHeader + 4 + soup.face_count() * kTriangle);
  out += "binary STL";  // not "solid", which marks the text format
  out.resize(kHeader, '\0');
  put_bytes(out, static_cast<std::uint32_t>(soup.face_count()));
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::array<Vec3, 3> corner = triangle(soup, f);
    for (const FloatVec& row :
         {normal_of(corner[0], corner[1], corner[2]), as_floats(corner[0]), as_floats(corner[1]), as_floats(corner[2])}) {
      for (const float c : row)
        put_bytes(out, c);
    }
    put_bytes(out, std::uint16_t{0});
  }
}

void write_text(const PolygonSoup& soup, std::string& out) {
  constexpr std::size_t kLikelyTriangle = 280;  // bytes
  out.reserve(soup.face_count() * kLikelyTriangle);
  auto part = soup.parts.begin();
  std::string name;
  const auto start_solid = [&](std::size_t f) {
    for (; part != soup.parts.end() && part->first_face <= f; ++part) {
      name.clear();
      put_name(name, part->name);
    }
    out += "solid " + name + "\n";
  };
  start_solid(0);
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    if (part != soup.parts.end() && part->first_face == f) {
      out += "endsolid " + name + "\n";
      start_solid(f);
    }
    const std::array<Vec3, 3> corner = triangle(soup, f);
    out += "facet normal";
    for (const float c : normal_of(corner[0], corner[1], corner[2])) {
      out += ' ';
      put_number(out, c);
    }
    out += "\n outer loop\n";
    for (const Vec3& point : corner) {
      out += "  vertex ";
      put_point(out, point);
      out += '\n';
    }
    out += " endloop\nendfacet\n";
  }
  out += "endsolid " + name + "\n";
}

std::string place(const char* kind, std::size_t index, const std::vector<std::uint32_t>& lines) {
  std::string text = kind + (" " + std::to_string(index));
  if (index < lines.size()) text += " (line " + std::to_string(lines[index]) + ")";
  return text;
}

}  // namespace

std::string stl_refusal(const PolygonSoup& soup, bool is_text) {
  constexpr const char* kRemedy = "; write OFF, OBJ or PLY in its place";
  std::vector<bool> is_used(soup.points.size(), false);
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t count = soup.face_first[f + 1] - soup.face_first[f];
    if (count != 3) {
      return place("face", f, soup.face_line) + " has " + std::to_string(count) + " corners and STL holds triangles only" +
             kRemedy;
    }
    for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
      if (soup.corners[c] == PolygonSoup::kInvalidVertex) {
        return place("face", f, soup.face_line) + " names a vertex that there is not, which STL cannot say" + kRemedy;
      }
      is_used[soup.corners[c]] = true;
    }
  }
  for (std::size_t v = 0; v < soup.points.size() && !is_text; ++v) {
    if (is_float(soup.points[v])) continue;
    const Vec3& p = soup.points[v];
    std::string text = place("vertex", v, soup.point_line) + " has the coordinate ";
    put_number(text, !is_float(p.x) ? p.x : !is_float(p.y) ? p.y : p.z);
    return text +
           ", which is no 32-bit float, and binary STL holds no other; write OFF, OBJ, PLY or text STL (--ascii) in its place";
  }
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    if (!is_used[v]) return place("vertex", v, soup.point_line) + " belongs to no face and STL holds faces only" + kRemedy;
  }
  return {};
}

void write_stl(const PolygonSoup& soup, bool is_text, std::string& out) {
  is_text ? write_text(soup, out) : write_binary(soup, out);
}

}  // namespace fdcg::bake
