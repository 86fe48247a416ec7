// SPDX-License-Identifier: Apache-2.0
// X3D in XML (Web3D, ISO/IEC 19776): IndexedFaceSet, IndexedTriangleSet and TriangleSet in Transforms. What else makes a shape
// is counted.
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "import/scene_soup.hpp"
#include "import/soup_reader.hpp"
#include "import/xml_file.hpp"

namespace fdcg::bake {
namespace {

using xml::Node;

constexpr std::array<std::string_view, 20> kOtherShapes = {"Box",
                                                           "Cone",
                                                           "Cylinder",
                                                           "Sphere",
                                                           "ElevationGrid",
                                                           "Extrusion",
                                                           "Text",
                                                           "LineSet",
                                                           "PointSet",
                                                           "IndexedLineSet",
                                                           "IndexedTriangleStripSet",
                                                           "IndexedTriangleFanSet",
                                                           "TriangleFanSet",
                                                           "TriangleStripSet",
                                                           "QuadSet",
                                                           "IndexedQuadSet",
                                                           "NurbsPatchSurface",
                                                           "NurbsTrimmedSurface",
                                                           "ArcClose2D",
                                                           "Disk2D"};

Matrix moved(const std::array<double, 3>& by, double sign) {
  Matrix m = kIdentity;
  for (std::size_t k = 0; k < 3; ++k)
    m[12 + k] = sign * by[k];
  return m;
}

class X3dReader {
 public:
  X3dReader(const MeshText& input, PolygonSoup& soup) : file_(input.bytes), scene_(soup, input.bytes.size()) {}

  void read() {
    index_names(file_.root(), 0);
    show_children(xml::child(file_.root(), "Scene"), nullptr, 0);
    scene_.finish();
  }

 private:
  void index_names(const Node& node, int depth) {
    if (depth > xml::kMaxDepth) fail_depth(node);
    for (Node below = xml::first_element(node); below; below = xml::next_element(below)) {
      if (const std::string_view name = xml::attribute(below, "DEF"); !name.empty()) defined_[name] = below;
      index_names(below, depth + 1);
    }
  }
  [[noreturn]] void fail_depth(const Node& node) const {
    file_.fail(node,
               "nests or uses nodes more than " + std::to_string(xml::kMaxDepth) + " deep, perhaps itself; export it again");
  }

  // The node itself, or what it uses.
  [[nodiscard]] Node used(const Node& node) const {
    const std::string_view name = xml::attribute(node, "USE");
    if (name.empty()) return node;
    const auto found = defined_.find(name);
    if (found == defined_.end())
      file_.fail(node, "uses '" + readable_name(name) + "', and no node of the file has this name; export it again");
    return found->second;
  }

  // ---- numbers: commas are blanks

  template <class Use>
  std::uint64_t for_each_number(const Node& node, const char* attribute, const Use& use) const {
    std::string text(xml::attribute(node, attribute));
    for (char& c : text)
      c = c == ',' ? ' ' : c;
    TextScanner scan(text, {});
    std::uint64_t count = 0;
    for (; scan.find_token(); ++count) {
      double value = 0;
      if (!scan.read_real(value)) {
        file_.fail(node, "has " + scan.quote() + " as value " + std::to_string(count) + " of '" + attribute +
                             "', which is not a number");
      }
      use(value, printed(scan));
    }
    return count;
  }

  template <std::size_t kCount>
  std::array<double, kCount> numbers(const Node& node, const char* attribute, std::array<double, kCount> values) const {
    if (!xml::has(node, attribute)) return values;
    std::size_t at = 0;
    const std::uint64_t there = for_each_number(node, attribute, [&](double value, const Printed&) {
      if (at < kCount) values[at++] = value;
    });
    if (there != kCount) {
      file_.fail(node, "has " + std::to_string(there) + " numbers in '" + attribute + "', not " + std::to_string(kCount));
    }
    return values;
  }

  // ---- nodes

  void show_children(const Node& parent, const Matrix* above, int depth) {
    for (Node node = xml::first_element(parent); node; node = xml::next_element(node))
      show(used(node), above, depth + 1);
  }

  void show(const Node& node, const Matrix* above, int depth) {
    scene_.charge_node();
    if (depth > xml::kMaxDepth) fail_depth(node);
    const std::string_view kind = xml::name_of(node);
    if (kind == "Shape") return show_shape(node, above);
    if (kind == "Inline") return scene_.ignore("inlined files");
    if (kind == "Switch" || kind == "LOD") {  // of which one child is shown
      const Node first = xml::first_element(node);
      scene_.ignore("choices (the first is shown)");
      if (first) show(used(first), above, depth + 1);
      return;
    }
    if (kind != "Transform") return show_children(node, above, depth);
    const Matrix own = transform_of(node), world = above == nullptr ? own : own == kIdentity ? *above : product(*above, own);
    if (!is_finite(world)) file_.fail(node, "has a transform that with those above it gives more than a double holds");
    show_children(node, world == kIdentity ? nullptr : &world, depth);
  }

  [[nodiscard]] Matrix transform_of(const Node& node) const {
    const auto centre = numbers<3>(node, "center", {0, 0, 0}), scale = numbers<3>(node, "scale", {1, 1, 1});
    const auto turn = numbers<4>(node, "rotation", {0, 0, 1, 0}), stretch = numbers<4>(node, "scaleOrientation", {0, 0, 1, 0});
    Matrix sized = kIdentity;
    sized[0] = scale[0], sized[5] = scale[1], sized[10] = scale[2];
    Matrix result = moved(numbers<3>(node, "translation", {0, 0, 0}), 1);
    for (const Matrix& next : {moved(centre, 1), rotation(node, turn, 1), rotation(node, stretch, 1), sized,
                               rotation(node, stretch, -1), moved(centre, -1)}) {
      if (next != kIdentity) result = product(result, next);
    }
    return result;
  }

  // An axis and radians.
  [[nodiscard]] Matrix rotation(const Node& node, const std::array<double, 4>& turn, double sign) const {
    if (turn[3] == 0) return kIdentity;
    const double length = std::hypot(turn[0], turn[1], turn[2]);
    if (!(length > 0 && std::isfinite(length) && std::isfinite(turn[3])))
      file_.fail(node, "turns about an axis without direction, or by no finite angle; export the scene again");
    return turned_about({turn[0] / length, turn[1] / length, turn[2] / length}, std::cos(turn[3]), sign * std::sin(turn[3]));
  }

  // ---- shapes

  void show_shape(const Node& shape, const Matrix* world) {
    for (Node below = xml::first_element(shape); below; below = xml::next_element(below)) {
      const Node node = used(below);
      const std::string_view kind = xml::name_of(node);
      const bool is_face_set = kind == "IndexedFaceSet", is_indexed = kind == "IndexedTriangleSet";
      if (is_face_set || is_indexed || kind == "TriangleSet") {
        show_faces(shape, node, is_face_set ? "coordIndex" : is_indexed ? "index" : nullptr, is_face_set, world);
      } else {
        for (const std::string_view other : kOtherShapes)
          scene_.ignore("shapes of the kind " + std::string(other), kind == other ? 1 : 0);
      }
    }
  }

  [[nodiscard]] PrintedPoints points_of(const Node& geometry) const {
    PrintedPoints result;
    Node coordinate = xml::child(geometry, "Coordinate");
    if (!coordinate) coordinate = xml::child(geometry, "CoordinateDouble");
    if (!coordinate) return result;
    coordinate = used(coordinate);
    std::array<double, 3> xyz{};
    std::size_t at = 0;
    for_each_number(coordinate, "point", [&](double value, const Printed& number) {
      result.precision.note(value, number);
      xyz[at++] = value;
      if (at < 3) return;
      result.points.push_back({xyz[0], xyz[1], xyz[2]});
      at = 0;
    });
    if (at != 0) file_.fail(coordinate, "has coordinates that are no multiple of three; fetch or export the file again");
    return result;
  }

  // `list`: the attribute with the vertex numbers; null: the points in their order. Triangles, or polygons that -1 ends.
  void show_faces(const Node& shape, const Node& geometry, const char* list, bool has_ends, const Matrix* world) {
    const PrintedPoints points = points_of(geometry);
    scene_.charge_numbers(3 * points.points.size());
    const std::uint32_t first = scene_.add_points(points, world);
    const std::string_view name = xml::attribute(shape, "DEF");
    scene_.begin_part(name.empty() ? "shape" : readable_name(name), {}, first);
    const bool is_turned = (world != nullptr && is_mirrored(*world)) != (xml::attribute(geometry, "ccw") == "false");
    std::vector<std::uint32_t> face;
    const auto add = [&] {
      if (!face.empty()) scene_.add_face(face, first, points.points.size(), is_turned);
      face.clear();
    };
    const auto take = [&](double value, const Printed&) {
      if (value == -1 && has_ends) return add();
      const bool is_known = value >= 0 && value < static_cast<double>(kMaxPoints) && value == std::floor(value);
      face.push_back(is_known ? static_cast<std::uint32_t>(value) : PolygonSoup::kInvalidVertex);
      if (face.size() > kMaxFaceCorners) {
        file_.fail(geometry,
                   "has a polygon of more than " + std::to_string(kMaxFaceCorners) + " corners; cut it into smaller ones");
      }
      if (!has_ends && face.size() == 3) add();
    };
    if (list != nullptr) {
      scene_.charge_numbers(for_each_number(geometry, list, take));
    } else {
      for (std::size_t i = 0; i < points.points.size(); ++i)
        take(static_cast<double>(i), {});
    }
    if (has_ends) return add();
    scene_.ignore("corners left over after the last triangle", face.size());
  }

  xml::File file_;
  SceneSoup scene_;
  std::map<std::string_view, Node> defined_;  // by DEF
};

}  // namespace

Result<PolygonSoup> read_x3d(const MeshText& input) {
  PolygonSoup soup;
  soup.name = input.name;
  soup.format = Format::x3d;
  soup.metres_per_unit = 1;  // by the format's definition
  soup.face_first.push_back(0);
  try {
    X3dReader(input, soup).read();
  } catch (const xml::Refusal& refusal) {
    return refuse(input.name, refusal.message, "unreadable");
  }
  return soup;
}

}  // namespace fdcg::bake
