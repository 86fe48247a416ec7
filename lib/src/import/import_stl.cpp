// SPDX-License-Identifier: Apache-2.0
// Stereolithography: binary (80 bytes of anything, a count, 50 bytes a triangle) and text (solids of facets). Each triangle has
// three points of its own; the weld joins them.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kStlHeaderBytes = 84;  // 80 of anything, then the number of triangles
constexpr std::size_t kTriangleBytes = 50;   // normal, three vertices, two bytes of anything
constexpr std::size_t kNormalBytes = 12;

double load_f32(const char* bytes) {
  return std::bit_cast<float>(load_u32(bytes));
}

class BinaryStlReader : SoupReader {
 public:
  explicit BinaryStlReader(const MeshText& input) : SoupReader(input, Format::stl) {}

  Result<PolygonSoup> read() { return result(read_all()); }

 private:
  bool read_all() {
    const std::string_view bytes = input_.bytes;
    if (bytes.size() < kStlHeaderBytes) {
      return fail("truncated: a binary STL starts with 84 bytes, the file has " + std::to_string(bytes.size()));
    }
    const std::uint64_t count = load_u32(bytes.data() + 80), there = bytes.size() - kStlHeaderBytes;
    // Fewer extra bytes than a triangle are padding; more would be faces missing from the count.
    if (count * kTriangleBytes > there || there - count * kTriangleBytes >= kTriangleBytes) {
      return fail((count * kTriangleBytes > there ? "truncated: " : "contradicts itself: ") +
                  ("the header promises " + std::to_string(count)) + " triangles (" +
                  std::to_string(kStlHeaderBytes + count * kTriangleBytes) + " bytes), the file has " +
                  std::to_string(bytes.size()) + " bytes; fetch or export it again");
    }
    if (count * 3 > kMaxCorners) return fail("holds more than 4,294,967,040 face corners; cut the mesh into parts");
    soup_.relative_quantum = 0x1p-24;
    read_triangles(static_cast<std::size_t>(count));
    return true;
  }

  void read_triangles(std::size_t count) {
    constexpr std::size_t kBlock =
        256;  // triangles turned at a time, in the first-level cache, so that no memory is zeroed first
    std::array<Vec3, kBlock * 3> points;
    soup_.points.reserve(count * 3);
    soup_.corners.reserve(count * 3);
    soup_.face_first.reserve(count + 1);
    const char* record = input_.bytes.data() + kStlHeaderBytes;
    for (std::size_t done = 0; done < count; done += kBlock) {
      const std::size_t n = std::min(kBlock, count - done);
      for (std::size_t i = 0; i < n; ++i, record += kTriangleBytes) {
        for (std::size_t k = 0; k < 3; ++k) {
          const char* xyz = record + kNormalBytes + 12 * k;
          points[3 * i + k] = {load_f32(xyz), load_f32(xyz + 4), load_f32(xyz + 8)};
        }
      }
      soup_.points.insert(soup_.points.end(), points.begin(), points.begin() + static_cast<std::ptrdiff_t>(3 * n));
      advance(kStlHeaderBytes + done * kTriangleBytes);
    }
    for (std::uint32_t c = 0; c < count * 3; ++c)
      soup_.corners.push_back(c);
    for (std::uint32_t f = 1; f <= count; ++f)
      soup_.face_first.push_back(3 * f);
  }
};

class TextStlReader : TextSoupReader {
 public:
  explicit TextStlReader(const MeshText& input) : TextSoupReader(input, Format::stl, {}) {}

  Result<PolygonSoup> read() {
    const bool is_read = read_solids();
    set_quanta();
    return result(is_read);
  }

 private:
  bool read_solids() {
    while (scan_.find_token()) {
      if (!expect("solid")) return false;
      name_ = readable_name(scan_.read_rest_of_line());  // of any words
      is_new_solid_ = true;
      while (look("facet")) {
        if (!read_facet()) return false;
        advance(scan_.offset());
      }
      if (!expect("endsolid")) return false;
      scan_.next_line();
    }
    return true;
  }

  // The stored normal is ignored, since it is often wrong, zero or not a number; the vertices define it.
  bool read_facet() {
    const std::uint32_t line = scan_.line();
    if (!expect("facet")) return false;
    scan_.next_line();
    do {
      if (!expect("outer") || !expect("loop")) return false;
      if (is_new_solid_) begin_solid();
      soup_.face_line.push_back(line);
      while (look("vertex")) {
        if (!read_vertex()) return false;
      }
      if (!expect("endloop") || !close_face()) return false;
    } while (look("outer"));
    return expect("endfacet");
  }

  bool read_vertex() {
    if (!expect("vertex")) return false;
    const std::uint32_t line = scan_.line();
    std::array<double, 3> xyz{};
    for (double& value : xyz) {
      if (!scan_.find_token()) return fail_end("a coordinate");
      if (!read_coordinate(value)) return fail_here("the vertex coordinate " + not_a_number());
    }
    if (soup_.points.size() >= kMaxPoints) return fail_here("more than 4,294,967,040 vertices; cut the mesh into parts");
    soup_.corners.push_back(static_cast<std::uint32_t>(soup_.points.size()));
    soup_.points.push_back({xyz[0], xyz[1], xyz[2]});
    soup_.point_line.push_back(line);
    return true;
  }

  // A solid starts a part only if it has a name, or if the previous part ends here.
  void begin_solid() {
    is_new_solid_ = false;
    if ((!name_.empty() || !soup_.parts.empty()) && !takes_no_parts()) begin_part(name_);
  }

  bool look(std::string_view keyword) { return scan_.find_token() && scan_.is_keyword(keyword); }
  bool expect(const char* keyword) {
    if (!scan_.find_token()) return fail_end(std::string("'") + keyword + "'");
    return scan_.take_keyword(keyword) || fail_here("found " + scan_.quote() + " where '" + keyword + "' was due");
  }
  bool fail_end(const std::string& due) {
    return fail_here("truncated: the file ends after " + std::to_string(soup_.face_first.size() - 1) + " facets where " + due +
                     " was due; fetch or export it again");
  }

  std::string name_;  // of the current solid
  bool is_new_solid_ = false;
};

// Text files start with "solid"; so do the headers of some binary files, which contain a zero byte soon after.
bool is_text(std::string_view bytes) {
  constexpr std::size_t kLook = 512;
  TextScanner scan(bytes, {});
  return scan.find_token() && scan.is_keyword("solid") && bytes.substr(0, kLook).find('\0') == std::string_view::npos;
}

}  // namespace

bool has_binary_stl_size(std::string_view bytes) {
  return bytes.size() >= kStlHeaderBytes &&
         bytes.size() - kStlHeaderBytes == std::uint64_t{load_u32(bytes.data() + 80)} * kTriangleBytes;
}

Result<PolygonSoup> read_stl(const MeshText& input) {
  if (!has_binary_stl_size(input.bytes) && is_text(input.bytes)) return TextStlReader(input).read();
  return BinaryStlReader(input).read();
}

}  // namespace fdcg::bake
