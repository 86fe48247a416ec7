// SPDX-License-Identifier: Apache-2.0
// PLY (Turk 1994): the header, and what the readers of text and binary bodies share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "import/soup_reader.hpp"

namespace fdcg::bake::ply {

enum class Encoding { ascii, little_endian, big_endian };
enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Kind { vertex, face, tristrips, other };  // of an element
// Of a property, in an element that is read.
enum class Role { none, x, y, z, indices, nx, ny, nz, red, green, blue, alpha, u, v };

[[nodiscard]] constexpr std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Role role = Role::none;
  bool is_list = false;
  Scalar count = Scalar::u8;  // of a list
  Scalar value = Scalar::f32;
};

struct ElementKind {
  std::string name;
  Kind kind = Kind::other;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  // Bytes of a row in a binary body; with lists, the minimum.
  [[nodiscard]] std::size_t least_bytes() const {
    std::size_t bytes = 0;
    for (const Property& p : properties)
      bytes += size_of(p.is_list ? p.count : p.value);
    return bytes;
  }
  [[nodiscard]] bool has_lists() const {
    return std::any_of(properties.begin(), properties.end(), [](const Property& p) { return p.is_list; });
  }
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<ElementKind> elements;
  std::uint64_t vertex_count = 0;
  std::size_t body_offset = 0;  // where the first row starts
  std::uint32_t body_line = 1;  // its line, in a text body
};

// Whether x, y and z are all declared as floats.
[[nodiscard]] inline bool has_float_coordinates(const Header& header) {
  for (const ElementKind& element : header.elements) {
    if (element.kind != Kind::vertex) continue;
    return std::all_of(element.properties.begin(), element.properties.end(), [](const Property& p) {
      return (p.role != Role::x && p.role != Role::y && p.role != Role::z) || p.value == Scalar::f32;
    });
  }
  return false;
}

// Whether it is what VertexExtras keeps.
[[nodiscard]] inline bool is_extra(Role role) {
  return role >= Role::nx;
}
// Which component of a place or of a normal.
[[nodiscard]] inline double& component_of(Vec3& v, Role role) {
  return role == Role::x || role == Role::nx ? v.x : role == Role::y || role == Role::ny ? v.y : v.z;
}

// Reads and checks the header: the elements and properties that a mesh needs are there, once each, with usable types.
Result<Header> read_header(const MeshText& input);

// Whether a number in a list of strips ends a strip: -1, also where an unsigned type made a large number of it.
[[nodiscard]] inline bool ends_strip(double number, Scalar type, std::uint64_t vertex_count) {
  if (number == -1) return true;
  const bool is_all_ones = (type == Scalar::u8 && number == 0xFF) || (type == Scalar::u16 && number == 0xFFFF) ||
                           (type == Scalar::u32 && number == 0xFFFFFFFFu);
  return is_all_ones && number >= static_cast<double>(vertex_count);
}

// Turns the triangle strips of a list of vertex numbers into triangles: -1 starts a new strip.
class StripDecoder {
 public:
  // Ends the current strip. False if it had vertices, but too few for a triangle.
  bool restart() {
    const bool is_short = length_ == 1 || length_ == 2;
    length_ = 0;
    return !is_short;
  }
  // True if the vertex completes a triangle, which is then in corners(), wound like the first of its strip.
  bool add(std::uint32_t vertex) {
    last_ = {last_[1], last_[2], vertex};
    ++length_;
    return length_ >= 3;
  }
  // Whether the triangle is not a face but a joint between concatenated strips: it repeats a vertex.
  [[nodiscard]] bool is_joint() const {
    const auto& [a, b, c] = last_;
    const bool is_known =
        a != PolygonSoup::kInvalidVertex && b != PolygonSoup::kInvalidVertex && c != PolygonSoup::kInvalidVertex;
    return is_known && (a == b || b == c || c == a);
  }
  [[nodiscard]] std::array<std::uint32_t, 3> corners() const {
    if (length_ % 2 == 1) return last_;
    return {last_[1], last_[0], last_[2]};
  }

 private:
  std::array<std::uint32_t, 3> last_{};
  std::uint64_t length_ = 0;
};

// What StripDecoder leaves out, as Ignored::what.
inline constexpr std::string_view kStripJoints = "strip joints", kShortStrips = "strips of fewer than three vertices";

// Ignored::what of an element that holds no faces: "'edge' elements".
std::string ignored_name(const ElementKind& element);

// "row N of M of element 'name'", for messages.
std::string row_name(const ElementKind& element, std::uint64_t row);

Result<PolygonSoup> read_ascii_body(const MeshText& input, const Header& header);
Result<PolygonSoup> read_binary_body(const MeshText& input, const Header& header);

}  // namespace fdcg::bake::ply
