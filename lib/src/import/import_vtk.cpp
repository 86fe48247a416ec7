// SPDX-License-Identifier: Apache-2.0
// VTK polydata in the legacy format (Kitware, file versions 1.0 to 5.1): text, or big-endian binary. Polygons and triangle
// strips; lines and vertices are counted.
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

// The kinds of numbers that a file may name, and how many bytes each has in binary files.
struct Kind {
  std::string_view name;
  std::size_t bytes = 0;
  enum class Class { whole, natural, real } what = Class::whole;
};
constexpr std::array kKinds = {Kind{"float", 4, Kind::Class::real},
                               Kind{"double", 8, Kind::Class::real},
                               Kind{"int", 4},
                               Kind{"unsigned_int", 4, Kind::Class::natural},
                               Kind{"long", 8},
                               Kind{"unsigned_long", 8, Kind::Class::natural},
                               Kind{"vtktypeint64", 8},
                               Kind{"vtkidtype", 8},
                               Kind{"short", 2},
                               Kind{"unsigned_short", 2, Kind::Class::natural},
                               Kind{"char", 1},
                               Kind{"unsigned_char", 1, Kind::Class::natural}};

class VtkReader : TextSoupReader {
 public:
  explicit VtkReader(const MeshText& input) : TextSoupReader(input, Format::vtk, {}) {}

  Result<PolygonSoup> read() {
    const bool is_read = read_header() && read_sections();
    if (is_read) {
      drop_missing_vertices();
      soup_.is_text = !is_binary_;
      if (soup_.is_text) set_quanta(are_floats_);
    }
    return result(is_read);
  }

 private:
  // "# vtk DataFile Version 3.0", a title, ASCII or BINARY, DATASET POLYDATA
  bool read_header() {
    scan_.next_line();
    scan_.next_line();
    if (!scan_.find_token()) return fail_here("truncated: the file ends in its header; fetch or export it again");
    is_binary_ = scan_.take_keyword("binary");
    if (!is_binary_ && !scan_.take_keyword("ascii")) return fail_here(scan_.quote() + " is neither ASCII nor BINARY");
    if (!scan_.find_token() || !scan_.take_keyword("dataset") || !scan_.find_token())
      return fail_here("no DATASET follows the header; export the file again");
    if (scan_.take_keyword("polydata")) return true;
    return fail_here("the dataset is " + scan_.quote() +
                     " and no POLYDATA; extract its surface (vtkGeometryFilter; ParaView: Extract Surface) and save that");
  }

  bool read_sections() {
    while (scan_.find_token()) {
      const std::string name = lower_word();
      if (name == "points") {
        if (!read_points()) return false;
      } else if (name == "polygons" || name == "triangle_strips" || name == "lines" || name == "vertices") {
        if (!read_cells(name)) return false;
      } else if (name == "metadata") {
        skip_block();
      } else if (name == "field" || name == "point_data" || name == "cell_data") {
        return name != "field" || fail_here("FIELD data before the cells is not read; write the file without it");
      } else {
        return fail_here("'" + readable_name(name) + "' is no part of polydata; export the file again");
      }
      advance(scan_.offset());
    }
    return true;
  }

  // METADATA ends with an empty line.
  void skip_block() {
    scan_.next_line();
    while (!scan_.at_end() && !scan_.line_done())
      scan_.next_line();
  }

  std::string lower_word() {
    std::string word(scan_.read_word());
    for (char& c : word)
      c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return word;
  }

  // ---- numbers

  bool read_count(std::uint64_t& count) {
    if (scan_.line_done() || !scan_.read_count(count)) return fail_here(scan_.quote() + " is not a whole number of 0 or more");
    return true;
  }

  bool read_kind(const Kind*& kind) {
    if (scan_.line_done()) return fail_here("the kind of numbers is missing; export the file again");
    const std::string name = lower_word();
    for (const Kind& known : kKinds) {
      if (known.name == name) kind = &known;
    }
    return kind != nullptr ||
           fail_here("'" + readable_name(name) + "' is no kind of numbers; use float, double or vtktypeint64");
  }

  // After the line that announces them. True where `count` values of `bytes` may stand there.
  bool begin_values(std::uint64_t count, std::size_t bytes, const char* what) {
    if (is_binary_) scan_.next_line();
    const std::uint64_t least = is_binary_ ? bytes : 2, there = (scan_.remaining() + (is_binary_ ? 0 : 1)) / least;
    if (count <= there) return true;
    return fail_here("truncated: " + std::to_string(count) + " " + what + " are promised, and at most " +
                     std::to_string(there) + " have room in the rest of the file; fetch or export it again");
  }

  std::uint64_t take_bits(std::size_t bytes) {
    std::uint64_t bits = 0;
    const std::string_view raw = input_.bytes.substr(scan_.offset(), bytes);
    for (const char byte : raw)
      bits = bits << 8 | static_cast<unsigned char>(byte);
    scan_.skip(bytes);
    return bits;
  }

  bool take_real(const Kind& kind, double& value) {
    if (!is_binary_) {
      if (!scan_.find_token()) return fail_here("truncated: the file ends among its points; fetch or export it again");
      return read_coordinate(value) || fail_here("the coordinate " + not_a_number());
    }
    const std::uint64_t bits = take_bits(kind.bytes);
    if (kind.what != Kind::Class::real) {
      value = kind.what == Kind::Class::natural ? static_cast<double>(bits) : static_cast<double>(extended(bits, kind.bytes));
    } else {
      value = kind.bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                              : std::bit_cast<double>(bits);
    }
    return true;
  }

  static std::int64_t extended(std::uint64_t bits, std::size_t bytes) {
    const unsigned shift = static_cast<unsigned>(64 - 8 * bytes);
    return static_cast<std::int64_t>(bits << shift) >> shift;
  }

  bool take_whole(std::size_t bytes, std::int64_t& value) {
    if (is_binary_) {
      value = extended(take_bits(bytes), bytes);
      return true;
    }
    if (!scan_.find_token()) return fail_here("truncated: the file ends among its cells; fetch or export it again");
    return scan_.read_integer(value) || fail_here(scan_.quote() + " is not a whole number");
  }

  // ---- sections

  bool read_points() {
    std::uint64_t count = 0;
    const Kind* kind = nullptr;
    if (!read_count(count) || !read_kind(kind)) return false;
    are_floats_ = kind->bytes == 4 && kind->what == Kind::Class::real;
    if (!soup_.points.empty()) return fail_here("POINTS stands twice; export the file again");
    if (count > kMaxPoints) return fail_here("more than 4,294,967,040 points; cut the mesh into parts");
    if (!begin_values(3 * count, kind->bytes, "coordinates")) return false;
    soup_.points.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      std::array<double, 3> xyz{};
      for (double& value : xyz) {
        if (!take_real(*kind, value)) return false;
        if (&value == xyz.data() && !is_binary_) soup_.point_line.push_back(scan_.line());
      }
      soup_.points.push_back({xyz[0], xyz[1], xyz[2]});
      advance(scan_.offset());
    }
    return true;
  }

  // "POLYGONS n size", with a count before the corners of each; or, from version 5 on, the numbers of offsets and of corners,
  // each list under a name.
  bool read_cells(const std::string& name) {
    std::uint64_t count = 0, size = 0;
    if (!read_count(count) || !read_count(size)) return false;
    TextScanner ahead = scan_;
    ahead.next_line();
    if (ahead.find_token() && ahead.is_keyword("offsets")) return read_listed_cells(name, count, size);
    if (!begin_values(size, 4, "numbers")) return false;
    std::vector<std::int64_t> corners;
    std::uint64_t used = 0;
    for (std::uint64_t cell = 0; cell < count; ++cell) {
      std::int64_t length = 0;
      if (used >= size || !take_whole(4, length)) return used < size ? false : fail_size(name, size, cell);
      const std::uint32_t line = scan_.line();
      if (length < 0 || static_cast<std::uint64_t>(length) > size - used - 1) return fail_size(name, size, cell);
      corners.resize(static_cast<std::size_t>(length));
      for (std::int64_t& corner : corners) {
        if (!take_whole(4, corner)) return false;
      }
      used += 1 + static_cast<std::uint64_t>(length);
      if (!add_cell(name, corners.data(), corners.size(), line)) return false;
      advance(scan_.offset());
    }
    if (used != size) return fail_size(name, size, count);
    return true;
  }

  bool fail_size(const std::string& name, std::uint64_t size, std::uint64_t cell) {
    return fail_here("cell " + std::to_string(cell) + " of '" + name + "' does not fit the " + std::to_string(size) +
                     " numbers that are promised; fetch or export the file again");
  }

  bool read_list(const char* name, std::uint64_t count, std::vector<std::int64_t>& values) {
    const Kind* kind = nullptr;
    if (!scan_.find_token() || !scan_.take_keyword(name))
      return fail_here(std::string(name) + " is missing; export the file again");
    if (!read_kind(kind) || !begin_values(count, kind->bytes, "numbers")) return false;
    if (kind->what == Kind::Class::real) return fail_here("vertex numbers are of the kind '" + std::string(kind->name) + "'");
    values.resize(static_cast<std::size_t>(count));
    for (std::int64_t& value : values) {
      if (!take_whole(kind->bytes, value)) return false;
    }
    return true;
  }

  bool read_listed_cells(const std::string& name, std::uint64_t offsets, std::uint64_t corners) {
    std::vector<std::int64_t> first, corner;
    if (!read_list("offsets", offsets, first) || !read_list("connectivity", corners, corner)) return false;
    for (std::size_t cell = 0; cell + 1 < first.size(); ++cell) {
      const bool is_sound =
          first[cell] >= 0 && first[cell] <= first[cell + 1] && static_cast<std::uint64_t>(first[cell + 1]) <= corner.size();
      if (!is_sound) return fail_size(name, corners, cell);
      if (!add_cell(name, corner.data() + first[cell], static_cast<std::size_t>(first[cell + 1] - first[cell]), scan_.line()))
        return false;
    }
    return true;
  }

  bool add_cell(const std::string& name, const std::int64_t* corners, std::size_t count, std::uint32_t line) {
    if (name == "lines") return ignore("line elements"), true;
    if (name == "vertices") return ignore("vertex elements"), true;
    if (name == "polygons") {
      for (std::size_t k = 0; k < count; ++k)
        soup_.corners.push_back(resolved(corners[k]));
      return close(line);
    }
    if (count < 3) ignore("strips of fewer than three vertices");
    for (std::size_t i = 0; i + 2 < count; ++i) {
      const std::int64_t a = corners[i], b = corners[i + 1], c = corners[i + 2];
      if (a == b || b == c || c == a) {
        ignore("strip joints");
        continue;
      }
      for (const std::int64_t corner : {a, i % 2 == 1 ? c : b, i % 2 == 1 ? b : c})
        soup_.corners.push_back(resolved(corner));
      if (!close(line)) return false;
    }
    return true;
  }

  bool close(std::uint32_t line) {
    if (!is_binary_) soup_.face_line.push_back(line);
    return close_face();
  }

  static std::uint32_t resolved(std::int64_t number) {
    return number >= 0 && number < static_cast<std::int64_t>(kMaxPoints) ? static_cast<std::uint32_t>(number)
                                                                         : PolygonSoup::kInvalidVertex;
  }

  void drop_missing_vertices() {  // points may follow the cells
    for (std::uint32_t& corner : soup_.corners) {
      if (corner >= soup_.points.size()) corner = PolygonSoup::kInvalidVertex;
    }
  }

  bool is_binary_ = false, are_floats_ = false;
};

}  // namespace

Result<PolygonSoup> read_vtk(const MeshText& input) {
  if (xml_root_name(input.bytes) == "VTKFile") return read_vtp(input);
  return VtkReader(input).read();
}

}  // namespace fdcg::bake
