// SPDX-License-Identifier: Apache-2.0
// The meshes of a COLLADA file: sources of positions, and the kinds of primitives that hold faces.
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "import/dae_document.hpp"
#include "shared/text.hpp"

namespace fdcg::bake::dae {
namespace {

constexpr std::uint64_t kMaxStride = 256;

class MeshReader {
 public:
  MeshReader(const Document& document, const Node& geometry, SceneSoup& scene)
      : document_(document), file_(document.file()), geometry_(geometry), scene_(scene) {}

  Mesh read() {
    Node mesh = xml::child(geometry_, "mesh");
    if (!mesh) mesh = xml::child(geometry_, "convex_mesh");
    if (xml::has(mesh, "convex_hull_of")) scene_.ignore("convex hulls of other meshes");
    for (const char* const kind : {"spline", "brep"}) {
      if (xml::child(geometry_, kind)) scene_.ignore("splines and exact surfaces");
    }
    for (Node node = xml::first_element(mesh); node; node = xml::next_element(node)) {
      const std::string_view kind = xml::name_of(node), id = xml::attribute(node, "id");
      if ((kind == "source" || kind == "vertices") && !id.empty()) local_.emplace(id, node);
    }
    for (Node node = xml::first_element(mesh); node; node = xml::next_element(node))
      read_primitive(node);
    return std::move(mesh_);
  }

 private:
  // ---- positions

  [[nodiscard]] Node resolve(const Node& from, std::string_view kind) const {
    std::string_view id = xml::attribute(from, "source");
    if (id.starts_with('#')) id.remove_prefix(1);
    const auto known = local_.find(id);
    if (known != local_.end() && xml::name_of(known->second) == kind) return known->second;
    const Node found = document_.target(from, "source", kind);
    if (!found) file_.fail(from, "takes numbers from another file, which is not read; export the mesh into one file");
    return found;
  }

  std::size_t source_of(const Node& input) {
    const Node source = resolve(input, "source");
    const auto [known, is_new] = source_index_.emplace(source.internal_object(), mesh_.sources.size());
    if (is_new) mesh_.sources.push_back(read_source(source));
    return known->second;
  }

  // Where the numbers stand that an accessor reads: mostly in the source itself.
  [[nodiscard]] Node array_of(const Node& source, const Node& accessor) const {
    std::string_view id = xml::attribute(accessor, "source");
    if (id.starts_with('#')) id.remove_prefix(1);
    for (const char* const kind : {"float_array", "int_array"}) {
      const Node own = xml::child(source, kind);
      if (own && (!accessor || xml::attribute(own, "id") == id)) return own;
    }
    if (!accessor) file_.fail(source, "has no array of numbers; export the mesh again");
    const Node elsewhere = document_.target(accessor, "source", "float_array");
    if (!elsewhere) file_.fail(accessor, "reads another file, which is not read; export the mesh into one file");
    return elsewhere;
  }

  // Which of the numbers of a record are x, y and z: the parameters of these names, else the first three that have names, else
  // the first three.
  [[nodiscard]] std::array<std::uint64_t, 3> axes_of(const Node& accessor, std::uint64_t stride) const {
    std::array<std::optional<std::uint64_t>, 3> named;
    std::vector<std::uint64_t> with_name;
    std::uint64_t count = 0;
    for (Node param = xml::child(accessor, "param"); param; param = xml::next(param), ++count) {
      const std::string_view name = xml::attribute(param, "name");
      if (name.empty() || count >= stride) continue;
      if (with_name.size() < 3) with_name.push_back(count);
      if (name.size() == 1 && (name[0] | 0x20) >= 'x' && (name[0] | 0x20) <= 'z')
        named[static_cast<std::size_t>((name[0] | 0x20) - 'x')] = count;
    }
    if (named[0] && named[1] && named[2]) return {*named[0], *named[1], *named[2]};
    if (with_name.size() == 3) return {with_name[0], with_name[1], with_name[2]};
    if (with_name.empty() && stride >= 3) return {0, 1, 2};
    file_.fail(accessor, "describes " + std::to_string(with_name.size()) + " coordinates of a position; it must be three");
  }

  PrintedPoints read_source(const Node& source) {
    const Node accessor = xml::child(xml::child(source, "technique_common"), "accessor");
    const Node array = array_of(source, accessor);
    PrintedPoints result;
    std::vector<double> numbers;
    const std::uint64_t there = file_.for_each_real(array, [&](double value, const Printed& number) {
      numbers.push_back(value);
      result.precision.note(value, number);
    });
    scene_.charge_numbers(there);
    const std::uint64_t promised = file_.count(array, "count", there);
    if (promised != there) {
      file_.fail(array, (promised > there ? "is truncated: it promises " : "promises ") + std::to_string(promised) +
                            " numbers and holds " + std::to_string(there) + "; fetch or export the file again");
    }
    const std::uint64_t stride = accessor ? file_.count(accessor, "stride", 1) : 3;
    if (stride == 0 || stride > kMaxStride)
      file_.fail(accessor, "has stride " + std::to_string(stride) + "; it must be 1 to " + std::to_string(kMaxStride));
    const std::array<std::uint64_t, 3> axes = axes_of(accessor, stride);
    const std::uint64_t offset = accessor ? file_.count(accessor, "offset", 0) : 0;
    const std::uint64_t last = offset + *std::max_element(axes.begin(), axes.end());  // of the first record
    const std::uint64_t records = last < there ? (there - 1 - last) / stride + 1 : 0;
    const std::uint64_t count = accessor ? file_.count(accessor, "count", records) : records;
    if (count > records) {
      file_.fail(accessor, "promises " + std::to_string(count) + " positions, its array holds " + std::to_string(records) +
                               "; fetch or export the file again");
    }
    result.points.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double* const record = numbers.data() + offset + i * stride;
      result.points.push_back({record[axes[0]], record[axes[1]], record[axes[2]]});
    }
    return result;
  }

  // ---- primitives

  struct Layout {
    std::uint64_t stride = 0, at = 0;  // numbers of a corner, and which of them is the vertex
  };

  void read_primitive(const Node& node) {
    const std::string_view kind = xml::name_of(node);
    if (kind == "lines" || kind == "linestrips") return scene_.ignore("line elements", file_.count(node, "count", 1));
    const bool is_face_kind =
        kind == "triangles" || kind == "polylist" || kind == "polygons" || kind == "trifans" || kind == "tristrips";
    if (!is_face_kind) return;
    Primitive primitive;
    primitive.material = xml::attribute(node, "material");
    const std::optional<Layout> layout = read_inputs(node, primitive);
    if (!layout) {
      if (file_.count(node, "count", 0) != 0 || xml::child(node, "p"))
        file_.fail(node, "of " + mesh_name() + " has no input VERTEX with positions; export the mesh again");
      return;  // empty
    }
    if (kind == "triangles") read_triangles(node, *layout, primitive);
    if (kind == "polylist") read_polylist(node, *layout, primitive);
    if (kind == "polygons") read_polygons(node, *layout, primitive);
    if (kind == "trifans" || kind == "tristrips") read_runs(node, *layout, kind == "tristrips", primitive);
    mesh_.primitives.push_back(std::move(primitive));
  }

  std::optional<Layout> read_inputs(const Node& node, Primitive& primitive) {
    Layout layout;
    Node positions;
    for (Node input = xml::child(node, "input"); input; input = xml::next(input)) {
      const std::uint64_t offset = file_.count(input, "offset", 0);
      if (offset >= kMaxStride)
        file_.fail(input, "has offset " + std::to_string(offset) + "; the limit is " + std::to_string(kMaxStride - 1));
      layout.stride = std::max(layout.stride, offset + 1);
      const std::string_view semantic = xml::attribute(input, "semantic");
      if (positions || (semantic != "VERTEX" && semantic != "POSITION")) continue;
      layout.at = offset;
      positions = semantic == "POSITION" ? input : position_input(resolve(input, "vertices"));
    }
    if (!positions) return std::nullopt;
    primitive.source = source_of(positions);
    return layout;
  }

  static Node position_input(const Node& vertices) {
    Node input = xml::child(vertices, "input");
    while (input && xml::attribute(input, "semantic") != "POSITION")
      input = xml::next(input);
    return input;
  }

  // The corners of a <p>, appended; returns how many.
  std::size_t read_corners(const Node& p, const Layout& layout, std::vector<std::uint32_t>& corners) const {
    const std::size_t before = corners.size();
    std::uint64_t place = 0;
    const std::uint64_t there = file_.for_each_whole(p, [&](std::int64_t value) {
      if (place == layout.at) {
        const bool is_known = value >= 0 && value < static_cast<std::int64_t>(kMaxPoints);
        corners.push_back(is_known ? static_cast<std::uint32_t>(value) : PolygonSoup::kInvalidVertex);
      }
      if (++place == layout.stride) place = 0;
    });
    if (there % layout.stride != 0) {
      file_.fail(p, "of " + mesh_name() + " has " + std::to_string(there) + " numbers, not a multiple of the " +
                        std::to_string(layout.stride) + " of a corner; fetch or export the file again");
    }
    return corners.size() - before;
  }

  std::size_t read_all_corners(const Node& node, const Layout& layout, std::vector<std::uint32_t>& corners) const {
    std::size_t count = 0;
    for (Node p = xml::child(node, "p"); p; p = xml::next(p))
      count += read_corners(p, layout, corners);
    return count;
  }

  void fail_count(const Node& node, const char* things, std::uint64_t promised, std::uint64_t there) const {
    file_.fail(node, "of " + mesh_name() + (promised > there ? " is truncated: it promises " : " promises ") +
                         std::to_string(promised) + " " + things + " and holds " + std::to_string(there) +
                         "; fetch or export the file again");
  }

  void read_triangles(const Node& node, const Layout& layout, Primitive& primitive) const {
    const std::size_t corners = read_all_corners(node, layout, primitive.corners);
    const std::uint64_t promised = file_.count(node, "count", corners / 3);
    if (promised > kMaxCorners || promised * 3 != corners) fail_count(node, "triangles", promised, corners / 3);
    for (std::size_t c = 3; c <= corners; c += 3)
      primitive.face_first.push_back(static_cast<std::uint32_t>(c));
  }

  void read_polylist(const Node& node, const Layout& layout, Primitive& primitive) const {
    std::uint64_t corners = 0;
    for (Node vcount = xml::child(node, "vcount"); vcount; vcount = xml::next(vcount)) {
      file_.for_each_whole(vcount, [&](std::int64_t value) {
        if (value < 0 || value > kMaxFaceCorners) fail_corners(vcount, primitive.face_first.size() - 1, value);
        corners += static_cast<std::uint64_t>(value);
        if (corners > kMaxCorners) file_.fail(vcount, "sums to more than 4,294,967,040 corners; cut the mesh into parts");
        primitive.face_first.push_back(static_cast<std::uint32_t>(corners));
      });
    }
    const std::uint64_t faces = primitive.face_first.size() - 1, promised = file_.count(node, "count", faces);
    if (promised != faces) fail_count(node, "polygons", promised, faces);
    const std::size_t there = read_all_corners(node, layout, primitive.corners);
    if (there != corners) fail_count(node, "corners", corners, there);
  }

  void fail_corners(const Node& node, std::size_t face, std::int64_t corners) const {
    file_.fail(node, "of " + mesh_name() + ": polygon " + std::to_string(face) + " has " + std::to_string(corners) +
                         " corners; the limit is " + std::to_string(kMaxFaceCorners) + ": cut it into smaller polygons");
  }

  void read_polygons(const Node& node, const Layout& layout, Primitive& primitive) const {
    if (const Node holed = xml::child(node, "ph"))
      file_.fail(holed, "of " + mesh_name() + " is a polygon with holes, which is not read; triangulate on export");
    for (Node p = xml::child(node, "p"); p; p = xml::next(p)) {
      const std::size_t corners = read_corners(p, layout, primitive.corners);
      if (corners > kMaxFaceCorners) fail_corners(p, primitive.face_first.size() - 1, static_cast<std::int64_t>(corners));
      primitive.face_first.push_back(static_cast<std::uint32_t>(primitive.corners.size()));
    }
    const std::uint64_t faces = primitive.face_first.size() - 1, promised = file_.count(node, "count", faces);
    if (promised != faces) fail_count(node, "polygons", promised, faces);
  }

  // Fans and strips, each a <p>.
  void read_runs(const Node& node, const Layout& layout, bool is_strip, Primitive& primitive) const {
    primitive.is_strip = is_strip;
    std::vector<std::uint32_t> run;
    std::uint64_t runs = 0;
    for (Node p = xml::child(node, "p"); p; p = xml::next(p), ++runs) {
      run.clear();
      const std::size_t corners = read_corners(p, layout, run);
      if (corners < 3) scene_.ignore(is_strip ? "strips of fewer than three vertices" : "fans of fewer than three vertices");
      for (std::size_t i = 0; i + 2 < corners; ++i) {
        const bool is_turned = is_strip && i % 2 == 1;
        const std::uint32_t a = run[is_strip ? i : 0], b = run[i + 1], c = run[i + 2];
        primitive.corners.insert(primitive.corners.end(), {a, is_turned ? c : b, is_turned ? b : c});
        primitive.face_first.push_back(static_cast<std::uint32_t>(primitive.corners.size()));
      }
    }
    const std::uint64_t promised = file_.count(node, "count", runs);
    if (promised != runs) fail_count(node, is_strip ? "strips" : "fans", promised, runs);
  }

  [[nodiscard]] std::string mesh_name() const {
    const std::string_view id = xml::attribute(geometry_, "id");
    return "geometry '" + printable(id.empty() ? xml::attribute(geometry_, "name") : id, 64) + "'";
  }

  const Document& document_;
  const xml::File& file_;
  Node geometry_;
  SceneSoup& scene_;
  Mesh mesh_;
  std::map<std::string_view, Node> local_;  // sources and vertices of this mesh
  std::map<const void*, std::size_t> source_index_;
};

}  // namespace

Mesh read_mesh(const Document& document, const Node& geometry, SceneSoup& scene) {
  return MeshReader(document, geometry, scene).read();
}

}  // namespace fdcg::bake::dae
