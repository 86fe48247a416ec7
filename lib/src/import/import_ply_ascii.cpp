// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "import/import_ply.hpp"
#include "import/ply_extras.hpp"

namespace fdcg::bake::ply {
namespace {

class AsciiBody : TextSoupReader {
 public:
  AsciiBody(const Header& header, const MeshText& body) : TextSoupReader(body, Format::ply, {}), header_(header) {}

  Result<PolygonSoup> read() {
    bool is_read = true;
    for (const ElementKind& element : header_.elements)
      is_read = is_read && read_element(element);
    is_read = is_read && check_end();
    set_quanta(has_float_coordinates(header_));
    extras_.spread(soup_);
    return result(is_read);
  }

 private:
  // Lines count from the top of the file.
  [[nodiscard]] std::uint32_t line() const { return scan_.line() + header_.body_line - 1; }
  bool fail_here(const std::string& what) { return fail_at_line(line(), what); }

  bool read_element(const ElementKind& element) {
    if (element.properties.empty()) return true;
    if (element.kind == Kind::other) ignore(ignored_name(element), element.count);
    const std::uint64_t possible = (scan_.remaining() + 1) / (2 * element.properties.size());  // a digit and a blank each
    if (element.count > possible) {
      return fail("truncated: the header promises " + std::to_string(element.count) + " rows of element '" +
                  element.name.substr(0, 32) + "', the " + std::to_string(scan_.remaining()) + " bytes from line " +
                  std::to_string(line()) + " on hold " + std::to_string(possible) + " at most; fetch or export it again");
    }
    reserve(element);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!scan_.find_token()) return fail_end(element, row);
      if (!(element.kind == Kind::vertex ? read_vertex(element, row) : read_row(element, row))) return false;
      if (!scan_.line_done()) {
        return fail_here(row_name(element, row) + " has more values than the header lists, from " + scan_.quote() + " on");
      }
      advance(scan_.offset());
    }
    return true;
  }

  void reserve(const ElementKind& element) {
    const auto rows = static_cast<std::size_t>(element.count);
    if (element.kind == Kind::vertex) {
      extras_.begin(element);
      soup_.points.reserve(rows);
      soup_.point_line.reserve(rows);
    } else if (element.kind == Kind::face) {
      soup_.face_first.reserve(soup_.face_first.size() + rows);
      soup_.face_line.reserve(soup_.face_line.size() + rows);
      soup_.corners.reserve(soup_.corners.size() + std::min(rows * 3, scan_.remaining() / 2));
    }
  }

  bool read_vertex(const ElementKind& element, std::uint64_t row) {
    soup_.point_line.push_back(line());
    Vec3 point;
    for (const Property& property : element.properties) {
      if (property.role == Role::none) {
        if (!skip_value(element, row, property)) return false;
        continue;
      }
      if (!scan_.find_token()) return fail_end(element, row);
      double value = 0;
      const bool has_read = is_extra(property.role) ? scan_.read_real(value) : read_coordinate(value);
      if (!has_read) return fail_here(row_name(element, row) + ": " + not_a_number());
      if (is_extra(property.role)) {
        extras_.set(static_cast<std::size_t>(row), property, value);
      } else {
        component_of(point, property.role) = value;
      }
    }
    soup_.points.push_back(point);
    return true;
  }

  bool read_row(const ElementKind& element, std::uint64_t row) {
    const std::uint32_t row_line = line();
    for (const Property& property : element.properties) {
      if (property.role != Role::indices) {
        if (!skip_value(element, row, property)) return false;
        continue;
      }
      std::uint64_t count = 0;
      if (!read_list_count(element, row, count)) return false;
      if (!(element.kind == Kind::face ? read_face(element, row, property.value, count, row_line)
                                       : read_strips(element, row, property.value, count, row_line))) {
        return false;
      }
    }
    return true;
  }

  bool read_face(const ElementKind& element, std::uint64_t row, Scalar type, std::uint64_t count, std::uint32_t row_line) {
    soup_.face_line.push_back(row_line);
    if (count > kMaxFaceCorners) return fail_big_face(count);
    for (std::uint64_t k = 0; k < count; ++k) {
      std::int64_t index = 0;
      if (!read_index(element, row, type, index)) return false;
      soup_.corners.push_back(resolve(index));
    }
    return close_face();
  }

  bool read_strips(const ElementKind& element, std::uint64_t row, Scalar type, std::uint64_t count, std::uint32_t row_line) {
    StripDecoder strip;
    for (std::uint64_t k = 0; k < count; ++k) {
      std::int64_t index = 0;
      if (!read_index(element, row, type, index)) return false;
      if (ends_strip(static_cast<double>(index), type, header_.vertex_count)) {
        if (!strip.restart()) ignore(kShortStrips);
      } else if (strip.add(resolve(index))) {
        if (strip.is_joint()) {
          ignore(kStripJoints);
          continue;
        }
        const auto corners = strip.corners();
        soup_.corners.insert(soup_.corners.end(), corners.begin(), corners.end());
        soup_.face_line.push_back(row_line);
        if (!close_face()) return false;
      }
    }
    if (!strip.restart()) ignore(kShortStrips);
    return true;
  }

  [[nodiscard]] std::uint32_t resolve(std::int64_t index) const {
    const bool is_known = index >= 0 && static_cast<std::uint64_t>(index) < header_.vertex_count;
    return is_known ? static_cast<std::uint32_t>(index) : PolygonSoup::kInvalidVertex;
  }

  bool read_index(const ElementKind& element, std::uint64_t row, Scalar type, std::int64_t& index) {
    if (!scan_.find_token()) return fail_end(element, row);
    if (scan_.read_integer(index)) return true;
    return read_real_index(type, index) ||
           fail_here(row_name(element, row) + ": the vertex number " + scan_.quote() + " is not a whole number");
  }

  // "2.0", in a list of a floating-point type.
  bool read_real_index(Scalar type, std::int64_t& index) {
    constexpr double kFar = 0x1p62;  // no vertex has such a number
    double value = 0;
    TextScanner ahead = scan_;
    if ((type != Scalar::f32 && type != Scalar::f64) || !ahead.read_real(value)) return false;
    if (!std::isfinite(value) || value != std::floor(value)) return false;
    scan_ = ahead;
    index = static_cast<std::int64_t>(std::clamp(value, -kFar, kFar));
    return true;
  }

  bool read_list_count(const ElementKind& element, std::uint64_t row, std::uint64_t& count) {
    if (!scan_.find_token()) return fail_end(element, row);
    return scan_.read_count(count) ||
           fail_here(row_name(element, row) + ": the list's count " + scan_.quote() + " is not a whole number of 0 or more");
  }

  bool skip_value(const ElementKind& element, std::uint64_t row, const Property& property) {
    std::uint64_t words = 1;
    if (property.is_list && !read_list_count(element, row, words)) return false;
    if (words > scan_.remaining()) return fail_long_list(element, row, words);
    for (; words > 0; --words) {
      if (!scan_.find_token()) return fail_end(element, row);
      scan_.read_word();
    }
    return true;
  }

  bool fail_long_list(const ElementKind& element, std::uint64_t row, std::uint64_t count) {
    return fail_here("truncated: " + row_name(element, row) + " has a list of " + std::to_string(count) + " values, the " +
                     std::to_string(scan_.remaining()) + " bytes left hold fewer; fetch or export it again");
  }

  bool fail_end(const ElementKind& element, std::uint64_t row) {
    return fail_here("truncated: the file ends in " + row_name(element, row) + "; fetch or export it again");
  }

  bool check_end() {
    return !scan_.find_token() || fail_here("data follows the last row that the header promises: " + scan_.quote() +
                                            "; correct the counts in the header");
  }

  const Header& header_;
  VertexExtras extras_;
};

}  // namespace

Result<PolygonSoup> read_ascii_body(const MeshText& input, const Header& header) {
  const MeshText body{input.bytes.substr(header.body_offset), input.name, input.progress};
  return AsciiBody(header, body).read();
}

}  // namespace fdcg::bake::ply
