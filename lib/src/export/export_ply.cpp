// SPDX-License-Identifier: Apache-2.0
// PLY (Turk 1994), text or binary: coordinates are written as float where that is exact.
#include "export/export.hpp"

#include <algorithm>

namespace fdcg::bake {
namespace {

constexpr std::uint32_t kMostInByte = 255;

class PlyWriter {
 public:
  PlyWriter(const PolygonSoup& soup, bool is_text, std::string& out) : soup_(soup), out_(out), is_text_(is_text) {
    is_float_ = std::all_of(soup.points.begin(), soup.points.end(), [](const Vec3& p) { return is_float(p); });
    for (std::size_t f = 0; f < soup.face_count(); ++f)
      has_long_faces_ |= soup.face_first[f + 1] - soup.face_first[f] > kMostInByte;
    // int is what most programs write and all read. Unsigned beyond its range: a corner without a vertex is then 2^32 - 1.
    is_signed_ = soup.points.size() <= std::size_t{1} << 31;
  }

  void write() {
    const std::size_t number = is_text_ ? 20 : is_float_ ? 4 : 8, corner = is_text_ ? 8 : 4;  // likely bytes
    out_.reserve(512 + soup_.points.size() * 3 * number + soup_.face_count() * 4 + soup_.corners.size() * corner);
    write_header();
    if (is_text_) {
      write_text();
    } else if (is_float_) {
      write_binary<float>();
    } else {
      write_binary<double>();
    }
  }

 private:
  void write_header() {
    const std::string real = is_float_ ? "float" : "double";
    out_ += "ply\nformat ";
    out_ += is_text_ ? "ascii" : "binary_little_endian";
    out_ += " 1.0\nelement vertex " + std::to_string(soup_.points.size()) + "\n";
    for (const char* axis : {"x", "y", "z"})
      out_ += "property " + real + " " + axis + "\n";
    out_ += "element face " + std::to_string(soup_.face_count()) + "\nproperty list ";
    out_ += has_long_faces_ ? "uint" : "uchar";
    out_ += is_signed_ ? " int" : " uint";
    out_ += " vertex_indices\nend_header\n";
  }

  void write_text() {
    for (const Vec3& point : soup_.points) {
      put_point(out_, point);
      out_ += '\n';
    }
    for (std::size_t f = 0; f < soup_.face_count(); ++f) {
      put_number(out_, soup_.face_first[f + 1] - soup_.face_first[f]);
      for (std::uint32_t c = soup_.face_first[f]; c < soup_.face_first[f + 1]; ++c) {
        out_ += ' ';
        if (soup_.corners[c] == PolygonSoup::kInvalidVertex) {
          out_ += "-1";
        } else {
          put_number(out_, soup_.corners[c]);
        }
      }
      out_ += '\n';
    }
  }

  template <class Real>
  void write_binary() {
    for (const Vec3& point : soup_.points) {
      for (const double c : {point.x, point.y, point.z})
        put_bytes(out_, static_cast<Real>(c));
    }
    for (std::size_t f = 0; f < soup_.face_count(); ++f) {
      const std::uint32_t count = soup_.face_first[f + 1] - soup_.face_first[f];
      if (has_long_faces_) {
        put_bytes(out_, count);
      } else {
        put_bytes(out_, static_cast<std::uint8_t>(count));
      }
      for (std::uint32_t c = soup_.face_first[f]; c < soup_.face_first[f + 1]; ++c)
        put_bytes(out_, soup_.corners[c]);  // kInvalidVertex is -1 as int
    }
  }

  const PolygonSoup& soup_;
  std::string& out_;
  bool is_text_, is_float_ = true, has_long_faces_ = false, is_signed_ = true;
};

}  // namespace

void write_ply(const PolygonSoup& soup, bool is_text, std::string& out) {
  PlyWriter(soup, is_text, out).write();
}

}  // namespace fdcg::bake
