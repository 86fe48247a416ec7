// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: the statements v and f (and its old name fo); o, g and usemtl name parts; vn, vt and mtllib where they are
// asked for. Other statements describe appearance and are skipped, or are counted as ignored elements.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "base/srgb.hpp"
#include "import/obj_appearance.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

// What is ignored with a statement that is not read; nothing for statements about appearance or inside a curve.
struct Unread {
  std::string_view keyword, what;
};
constexpr Unread kUnread[] = {
    {"vn", ""},
    {"vt", ""},
    {"vp", ""},
    {"s", ""},
    {"mg", ""},
    {"mtllib", ""},
    {"usemap", ""},
    {"maplib", ""},
    {"bevel", ""},
    {"c_interp", ""},
    {"d_interp", ""},
    {"lod", ""},
    {"shadow_obj", ""},
    {"trace_obj", ""},
    {"ctech", ""},
    {"stech", ""},
    {"cstype", ""},
    {"deg", ""},
    {"bmat", ""},
    {"step", ""},
    {"parm", ""},
    {"trim", ""},
    {"hole", ""},
    {"scrv", ""},
    {"sp", ""},
    {"end", ""},
    {"con", ""},
    {"res", ""},
    {"l", "line elements"},
    {"p", "point elements"},
    {"curv", "free-form curves"},
    {"curv2", "free-form curves"},
    {"cdc", "free-form curves"},
    {"cdp", "free-form curves"},
    {"surf", "free-form surfaces"},
    {"bzp", "free-form surfaces"},
    {"bsp", "free-form surfaces"},
    {"call", "calls of other files"},
    {"csh", "calls of other programs"},
};

class ObjReader : TextSoupReader {
 public:
  explicit ObjReader(const MeshText& input)
      : TextSoupReader(input, Format::obj, {.hash_comments = true, .continuation = true}),
        appearance_(input.file, input.wants_heights) {}

  Result<PolygonSoup> read() {
    const bool is_read = read_statements();
    if (is_read) drop_missing_vertices();
    if (is_read) name_normals();
    set_quanta();
    Result<PolygonSoup> soup = result(is_read);
    if (!soup || !input_.wants_appearance) return soup;
    if (const auto problem = appearance_.finish(*soup)) return *problem;
    return soup;
  }

 private:
  bool read_statements() {
    while (scan_.find_token()) {
      const std::string_view keyword = scan_.read_word();
      if (keyword == "v") {
        if (!read_vertex()) return false;
      } else if (keyword == "f" || keyword == "fo") {
        if (!read_face()) return false;
      } else if (keyword == "vn" && input_.wants_normals) {
        if (!read_normal()) return false;
      } else if (keyword == "vt" && input_.wants_appearance) {
        if (!read_place()) return false;
      } else if (keyword == "mtllib" && input_.wants_appearance) {
        appearance_.add_libraries(scan_.read_rest_of_line());
      } else if (keyword != "vn" && keyword != "vt") {
        read_other(keyword);
      }
      scan_.next_line();
      advance(scan_.offset());
    }
    return true;
  }

  void read_other(std::string_view keyword) {
    std::string* const name = keyword == "o" ? &object_ : keyword == "g" ? &group_ : keyword == "usemtl" ? &material_ : nullptr;
    if (name != nullptr) {
      const std::string_view given = scan_.read_rest_of_line();
      *name = readable_name(given);
      if (name == &material_) set_material(given);
      is_new_part_ = true;
      return;
    }
    const auto* const unread =
        std::find_if(std::begin(kUnread), std::end(kUnread), [keyword](const Unread& u) { return u.keyword == keyword; });
    if (unread == std::end(kUnread)) {
      ignore("unknown statements");
    } else if (!unread->what.empty()) {
      ignore(unread->what);
    }
  }

  // Object, group and material, as far as they have names; several changes before a face start one part.
  void begin_named_part() {
    is_new_part_ = false;
    if (takes_no_parts()) return;
    std::string name;
    name.reserve(object_.size() + group_.size() + material_.size() + 2);
    name = object_;
    for (const std::string* const more : {&group_, &material_}) {
      if (!name.empty() && !more->empty()) name += '/';
      name += *more;
    }
    if (name != part_name()) begin_part(std::move(name));
  }
  [[nodiscard]] std::string_view part_name() const {
    return soup_.parts.empty() ? std::string_view() : std::string_view(soup_.parts.back().name);
  }

  // x y z, perhaps followed by a weight or a colour.
  bool read_vertex() {
    const std::uint32_t line = scan_.line();
    std::array<double, 3> xyz{};
    for (double& value : xyz) {
      if (scan_.line_done()) return fail_at_line(line, "a vertex needs three coordinates, but the line ends early");
      if (!read_coordinate(value)) return fail_here("the vertex coordinate " + not_a_number());
    }
    if (soup_.points.size() >= kMaxPoints) return fail_here("more than 4,294,967,040 vertices; cut the mesh into parts");
    if (input_.wants_appearance) read_colour();
    soup_.points.push_back({xyz[0], xyz[1], xyz[2]});
    soup_.point_line.push_back(line);
    return true;
  }

  // Three numbers after a vertex, or after its weight. Others are no colour.
  void read_colour() {
    std::array<double, 4> more{};
    std::size_t count = 0;
    while (count < more.size() && !scan_.line_done() && scan_.read_real(more[count]))
      ++count;
    if (count < 3) return;
    const double* const rgb = more.data() + (count - 3);
    appearance_.add_colour(soup_.points.size(), {linear_of_srgb(rgb[0]), linear_of_srgb(rgb[1]), linear_of_srgb(rgb[2]), 1});
  }

  // u v, of which v may be left out, and perhaps w.
  bool read_place() {
    std::array<double, 2> uv{};
    for (std::size_t k = 0; k < 2; ++k) {
      if (scan_.line_done()) {
        if (k == 0) return fail_here("a texture coordinate needs a number, but the line ends early");
        break;
      }
      if (!scan_.read_real(uv[k])) return fail_here("the number of a texture coordinate " + not_a_number());
    }
    appearance_.add_place(uv[0], uv[1]);
    return true;
  }

  bool read_normal() {
    std::array<double, 3> xyz{};
    for (double& value : xyz) {
      if (scan_.line_done()) return fail_here("a normal needs three numbers, but the line ends early");
      if (!scan_.read_real(value)) return fail_here("the number of a normal " + not_a_number());
    }
    normals_.push_back({xyz[0], xyz[1], xyz[2]});
    return true;
  }

  // Of "/vt/vn" or "//vn" the number of the normal, counted from 1; 0: none.
  [[nodiscard]] std::int64_t normal_in(std::string_view more) const {
    const std::size_t at = more.find('/', 1);
    std::int64_t number = 0;
    if (at == std::string_view::npos) return 0;
    const auto [end, error] = std::from_chars(more.data() + at + 1, more.data() + more.size(), number);
    if (error != std::errc() || end != more.data() + more.size()) return 0;
    return number < 0 ? static_cast<std::int64_t>(normals_.size()) + 1 + number : number;
  }

  // Normals may stand after the faces that name them.
  void name_normals() {
    if (normals_.empty()) return;
    normal_of_corner_.resize(soup_.corners.size(), 0);
    soup_.corner_normals.resize(soup_.corners.size());
    for (std::size_t i = 0; i < normal_of_corner_.size(); ++i) {
      const std::int64_t number = normal_of_corner_[i];
      if (number >= 1 && number <= static_cast<std::int64_t>(normals_.size()))
        soup_.corner_normals[i] = normals_[static_cast<std::size_t>(number - 1)];
    }
  }

  // v, v/vt, v//vn or v/vt/vn for each corner.
  bool read_face() {
    if (is_new_part_) begin_named_part();
    soup_.face_line.push_back(scan_.line());
    while (!scan_.line_done()) {
      std::int64_t index = 0;
      if (!scan_.read_integer_prefix(index))
        return fail_here("the face corner " + scan_.quote() + " does not start with a vertex number");
      if (!scan_.token_ended()) {
        if (scan_.peek() != '/')
          return fail_here("a face corner has " + scan_.quote() + " after its vertex number, in place of '/'");
        const std::string_view more = scan_.read_word();
        if (input_.wants_normals) {
          normal_of_corner_.resize(soup_.corners.size(), 0);
          normal_of_corner_.push_back(normal_in(more));
        }
        if (input_.wants_appearance) appearance_.add_corner(soup_.corners.size(), more);
      }
      soup_.corners.push_back(resolve(index));
    }
    return close_face();
  }

  // Indices count from 1, negative ones backwards from the latest vertex. A positive one may refer to a later vertex.
  std::uint32_t resolve(std::int64_t number) {
    const auto known = static_cast<std::int64_t>(soup_.points.size());
    const std::int64_t index = number < 0 ? known + number : number - 1;
    if (index < 0 || index >= static_cast<std::int64_t>(kMaxPoints)) return PolygonSoup::kInvalidVertex;
    largest_index_ = std::max(largest_index_, index);
    return static_cast<std::uint32_t>(index);
  }

  void drop_missing_vertices() {
    if (largest_index_ < static_cast<std::int64_t>(soup_.points.size())) return;
    for (std::uint32_t& corner : soup_.corners) {
      if (corner >= soup_.points.size()) corner = PolygonSoup::kInvalidVertex;
    }
  }

  ObjAppearance appearance_;
  std::int64_t largest_index_ = -1;
  std::vector<Vec3> normals_;
  std::vector<std::int64_t> normal_of_corner_;  // counted from 1, 0: none; of the corners up to the last that has one
  std::string object_, group_, material_;       // at the cursor
  bool is_new_part_ = false;
};

}  // namespace

Result<PolygonSoup> read_obj(const MeshText& input) {
  return ObjReader(input).read();
}

}  // namespace fdcg::bake
