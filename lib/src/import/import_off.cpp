// SPDX-License-Identifier: Apache-2.0
// Object File Format of Geomview, text: [ST][C][N]OFF, counts, vertices, faces. Its binary and four-dimensional kinds are
// refused.
#include <algorithm>
#include <cstdint>
#include <string>

#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

// The letters before OFF tell what follows x y z on a vertex's line. Geomview's order is ST, C, N, 4, n; others write NCOFF.
struct OffKeyword {
  bool is_valid = false, has_texture = false, has_colour = false, has_normal = false, is_homogeneous = false,
       has_dimension = false;
};

OffKeyword parse_keyword(std::string_view word) {
  OffKeyword keyword;
  const auto take = [&word](std::string_view prefix) {
    if (!word.starts_with(prefix)) return false;
    word.remove_prefix(prefix.size());
    return true;
  };
  while (!keyword.is_valid && !word.empty()) {
    if (!keyword.has_texture && take("ST")) {
      keyword.has_texture = true;
    } else if (!keyword.has_colour && take("C")) {
      keyword.has_colour = true;
    } else if (!keyword.has_normal && take("N")) {
      keyword.has_normal = true;
    } else if (!keyword.is_homogeneous && take("4")) {
      keyword.is_homogeneous = true;
    } else if (!keyword.has_dimension && take("n")) {
      keyword.has_dimension = true;
    } else {
      keyword.is_valid = word == "OFF";
      break;
    }
  }
  return keyword.is_valid ? keyword : OffKeyword{};
}

class OffReader : TextSoupReader {
 public:
  explicit OffReader(const MeshText& input) : TextSoupReader(input, Format::off, {.hash_comments = true}) {}

  Result<PolygonSoup> read() {
    const bool is_read = read_header() && read_vertices() && read_faces() && check_end();
    set_quanta();
    return result(is_read);
  }

 private:
  // How vertices and faces are separated. Usually each has its own line, on which undeclared values (normals, colours) may
  // follow. Some writers put several records on a line; then there are no further values.
  enum class Layout { unknown, lines, stream };

  bool read_header() {
    if (!scan_.find_token()) return fail("holds no OFF header and nothing else");
    TextScanner ahead = scan_;
    const OffKeyword keyword = parse_keyword(ahead.read_word());
    if (keyword.is_homogeneous || keyword.has_dimension) {
      return fail_here("is of the kind " + scan_.quote() + ", not three-dimensional; write it as OFF");
    }
    if (keyword.is_valid) {
      scan_ = ahead;
      has_announced_values_ = keyword.has_texture || keyword.has_colour || keyword.has_normal;
    } else if (scan_.peek() < '0' || scan_.peek() > '9') {  // the keyword may be left out
      return fail_here("starts with " + scan_.quote() + " in place of the keyword OFF; is it another format?");
    }
    if (!scan_.line_done()) {
      ahead = scan_;
      if (ahead.read_word() == "BINARY")
        return fail_here("is binary OFF, which is not read; write it as text OFF or binary PLY");
    }
    return read_count("vertex", vertex_count_) && read_count("face", face_count_) && skip_edge_count();
  }

  bool read_count(const char* what, std::uint64_t& count) {
    if (!scan_.find_token()) return fail_here(std::string("truncated: the file ends before the ") + what + " count");
    return scan_.read_count(count) ||
           fail_here(std::string("the ") + what + " count " + scan_.quote() + " is not a whole number of 0 or more");
  }

  // The third count (edges) is not used, and some writers omit it.
  bool skip_edge_count() {
    std::int64_t edges = 0;
    if (!scan_.line_done() && !scan_.read_integer(edges))
      return fail_here("the edge count " + scan_.quote() + " is not a number");
    return true;
  }

  bool read_vertices() {
    constexpr std::size_t kLeastBytes = 6;  // "0 0 0\n"
    if (vertex_count_ > kMaxPoints) return fail_promise("vertices", 0, vertex_count_);
    const auto likely = static_cast<std::size_t>(std::min<std::uint64_t>(vertex_count_, scan_.remaining() / kLeastBytes + 1));
    soup_.points.reserve(likely);
    soup_.point_line.reserve(likely);
    for (std::uint64_t i = 0; i < vertex_count_; ++i) {
      if (!scan_.find_token()) return fail_promise("vertices", i, vertex_count_);
      const std::uint32_t line = scan_.line();
      std::array<double, 3> xyz{};
      for (double& value : xyz) {
        if (!scan_.find_token()) return fail_promise("vertices", i, vertex_count_);
        if (!read_coordinate(value)) {
          return fail_here("vertex " + std::to_string(i) + ": " + not_a_number());
        }
      }
      soup_.points.push_back({xyz[0], xyz[1], xyz[2]});
      soup_.point_line.push_back(line);
      if (!scan_.line_done() && !skip_further_values(vertex_count_ - i + face_count_, vertex_layout_)) return false;
      advance(scan_.offset());
    }
    return true;
  }

  bool read_faces() {
    constexpr std::size_t kLeastBytes = 2;  // "0\n"
    const auto likely = static_cast<std::size_t>(std::min<std::uint64_t>(face_count_, scan_.remaining() / kLeastBytes + 1));
    soup_.face_first.reserve(likely + 1);
    soup_.face_line.reserve(likely);
    soup_.corners.reserve(std::min(likely * 3, scan_.remaining() / kLeastBytes + 1));
    for (std::uint64_t f = 0; f < face_count_; ++f) {
      if (!scan_.find_token()) return fail_promise("faces", f, face_count_);
      soup_.face_line.push_back(scan_.line());
      std::uint64_t count = 0;
      if (!scan_.read_count(count)) {
        return fail_here("face " + std::to_string(f) + ": the corner count " + scan_.quote() +
                         " is not a whole number of 0 or more");
      }
      if (count > kMaxFaceCorners) return fail_big_face(count);
      for (std::uint64_t k = 0; k < count; ++k) {
        std::int64_t index = 0;
        if (!scan_.find_token()) return fail_promise("faces", f, face_count_);
        if (!scan_.read_integer(index)) {
          return fail_here("face " + std::to_string(f) + ": the vertex number " + scan_.quote() + " is not a whole number");
        }
        const bool is_known = index >= 0 && index < static_cast<std::int64_t>(soup_.points.size());
        soup_.corners.push_back(is_known ? static_cast<std::uint32_t>(index) : PolygonSoup::kInvalidVertex);
      }
      if (!close_face()) return false;
      if (!scan_.line_done() && !skip_further_values(face_count_ - f, face_layout_)) return false;
      advance(scan_.offset());
    }
    return true;
  }

  // Skips further values on the line of a vertex or face, unless the file has several records on a line. `records` remain to be
  // read, the present one included.
  bool skip_further_values(std::uint64_t records, Layout& layout) {
    if (layout == Layout::unknown) layout = has_a_line_for_each(records) ? Layout::lines : Layout::stream;
    if (layout == Layout::lines) {
      scan_.next_line();
      return true;
    }
    if (has_announced_values_) {
      return fail_here("fewer lines are left than vertices and faces (" + std::to_string(records) +
                       "): the file is truncated, or it has several on a line, which only plain OFF can have");
    }
    return true;
  }

  [[nodiscard]] bool has_a_line_for_each(std::uint64_t records) const {
    TextScanner ahead = scan_;
    for (std::uint64_t lines = 0; lines < records; ++lines) {
      if (!ahead.find_token()) return false;
      ahead.next_line();
    }
    return true;
  }

  bool check_end() {
    if (!scan_.find_token()) return true;
    return fail_here("the header promises " + std::to_string(vertex_count_) + " vertices and " + std::to_string(face_count_) +
                     " faces, but data follows them: " + scan_.quote() + "; correct the counts");
  }

  bool fail_promise(const char* what, std::uint64_t found, std::uint64_t promised) {
    return fail_here("truncated: the header promises " + std::to_string(promised) + " " + what + ", the file ends after " +
                     std::to_string(found) + "; fetch or export it again");
  }

  std::uint64_t vertex_count_ = 0, face_count_ = 0;
  bool has_announced_values_ = false;
  Layout vertex_layout_ = Layout::unknown, face_layout_ = Layout::unknown;
};

}  // namespace

bool is_off_keyword(std::string_view word) {
  return parse_keyword(word).is_valid;
}

Result<PolygonSoup> read_off(const MeshText& input) {
  return OffReader(input).read();
}

}  // namespace fdcg::bake
