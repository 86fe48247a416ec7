// SPDX-License-Identifier: Apache-2.0
#include "import/threemf_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shared/text.hpp"

namespace fdcg::bake::threemf {
namespace {

constexpr std::string_view kModelType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

// Extensions that a file may require and that leave the triangles as they are (or that are read here), by how their namespaces
// start or go on.
constexpr std::array<std::string_view, 4> kReadExtensions = {"/3dmanufacturing/material/", "/3dmanufacturing/production/",
                                                             "/3dmanufacturing/slice/", "/3dmanufacturing/trianglesets/"};

std::string shown(std::string_view text) {
  return "'" + printable(text, 64) + "'";
}

std::string in_package(std::string_view path) {
  return std::string(path.substr(path.starts_with('/') ? 1 : 0));
}

// The namespace that a prefix stands for at the root.
std::string_view namespace_of(const Node& root, std::string_view prefix) {
  return root.attribute(("xmlns:" + std::string(prefix)).c_str()).value();
}

void check_extensions(const xml::File& file) {
  const Node root = file.root();
  const std::string_view required = xml::attribute(root, "requiredextensions");
  TextScanner scan(required, {});
  while (scan.find_token()) {
    const std::string_view prefix = scan.read_word(), uri = namespace_of(root, prefix);
    const bool is_read = std::any_of(kReadExtensions.begin(), kReadExtensions.end(),
                                     [uri](std::string_view known) { return uri.find(known) != std::string_view::npos; });
    if (is_read) continue;
    file.fail(root, "requires the extension " + shown(uri.empty() ? prefix : uri) +
                        ", which may change the triangles and is not read; export it without");
  }
}

double metres_of(const xml::File& file) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr std::array<Unit, 6> kUnits = {
      {{"millimeter", 1e-3}, {"micron", 1e-6}, {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}}};
  const std::string_view name = xml::attribute(file.root(), "unit");
  if (name.empty()) return 1e-3;
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return unit.metres;
  }
  file.fail(file.root(), "has the unit " + shown(name) + "; it must be micron, millimeter, centimeter, inch, foot or meter");
}

}  // namespace

// ---- the package

Part::Part(std::string name_in_package, std::string unpacked)
    : name(std::move(name_in_package)), bytes(std::move(unpacked)), file(bytes, name) {
  if (xml::name_of(file.root()) != "model") file.fail(file.root(), "is the root, and no 3MF model; export the file again");
  check_extensions(file);
  const Node resources = xml::child(file.root(), "resources");
  for (Node node = xml::first_element(resources); node; node = xml::next_element(node)) {
    const std::string_view id = xml::attribute(node, "id"), kind = xml::name_of(node);
    if (id.empty()) continue;
    const bool is_new = kind == "object" ? objects.emplace(id, node).second : groups.emplace(id, Group{}).second;
    if (!is_new) file.fail(node, "has the id " + shown(id) + ", which another resource has; export the file again");
    if (kind == "object") continue;
    Group& group = groups[id];
    for (Node item = xml::first_element(node); item; item = xml::next_element(item)) {
      ++group.count;
      if (kind == "basematerials") group.materials.emplace_back(xml::attribute(item, "name"));
    }
  }
}

Package::Package(std::string_view bytes) : zip_(bytes) {
  root_ = open(root_name(), true);
}

// What the package's relationships say, else the usual name.
std::string Package::root_name() {
  const std::optional<std::string> relations = zip_.read("_rels/.rels");
  if (relations) {
    const xml::File file(*relations, "_rels/.rels");
    unpacked_ += relations->size();
    for (Node relation = xml::child(file.root(), "Relationship"); relation; relation = xml::next(relation)) {
      if (xml::attribute(relation, "Type") == kModelType) return in_package(xml::attribute(relation, "Target"));
    }
  }
  const std::string usual = zip_.find_ending("3dmodel.model");
  if (usual.empty())
    throw xml::Refusal{"is a ZIP archive and holds no 3MF model (_rels/.rels names none); unpack the mesh first"};
  return usual;
}

std::unique_ptr<Part> Package::open(const std::string& name, bool is_root) {
  std::optional<std::string> bytes = zip_.read(name);
  if (!bytes) throw xml::Refusal{"names the part " + shown(name) + " of its archive, and there is none; export the file again"};
  unpacked_ += bytes->size();
  return std::make_unique<Part>(is_root ? std::string() : name, std::move(*bytes));
}

Part& Package::part(std::string_view path, const Part& from, const Node& reference) {
  const std::string name = in_package(path);
  const auto known = parts_.find(name);
  if (known != parts_.end()) return *known->second;
  std::unique_ptr<Part> part = open(name, false);
  if (xml::has(part->file.root(), "unit") && metres_of(part->file) != metres_per_unit()) {
    from.file.fail(reference,
                   "names the part " + shown(name) + ", whose unit is not that of the package's model; export it again");
  }
  return *parts_.emplace(name, std::move(part)).first->second;
}

double Package::metres_per_unit() const {
  return metres_of(root_->file);
}

// ---- objects

Node object_of(const Part& part, const Part& from, const Node& reference) {
  const std::string_view id = xml::attribute(reference, "objectid");
  const auto found = part.objects.find(id);
  if (found == part.objects.end()) {
    from.file.fail(reference, "names the object " + shown(id) + ", and " +
                                  (part.name.empty() ? std::string("the model") : "part " + shown(part.name)) +
                                  " has none of this id; export the file again");
  }
  return found->second;
}

Matrix transform_of(const Part& part, const Node& node) {
  Matrix matrix = kIdentity;
  if (!xml::has(node, "transform")) return matrix;
  const std::string_view text = xml::attribute(node, "transform");
  TextScanner scan(text, {});
  std::array<double, 12> numbers{};
  std::size_t count = 0;
  for (double value = 0; scan.find_token(); ++count) {
    if (!scan.read_real(value)) part.file.fail(node, "has " + scan.quote() + " in its transform, which is not a number");
    if (count < numbers.size()) numbers[count] = value;
  }
  if (count != numbers.size())
    part.file.fail(node, "has a transform of " + std::to_string(count) + " numbers, not 12; export the file again");
  for (std::size_t row = 0; row < 4; ++row) {  // rows of the file, whose vectors are rows, are columns here
    for (std::size_t k = 0; k < 3; ++k)
      matrix[4 * row + k] = numbers[3 * row + k];
  }
  if (!is_finite(matrix)) part.file.fail(node, "has a transform that is not finite; export the file again");
  return matrix;
}

namespace {

class MeshReader {
 public:
  MeshReader(const Part& part, const Node& object, SceneSoup& scene) : part_(part), object_(object), scene_(scene) {}

  Mesh read() {
    const Node mesh = xml::child(object_, "mesh");
    if (xml::child(mesh, "beamlattice")) scene_.ignore("beam lattices");
    const Node vertices = xml::child(mesh, "vertices"), triangles = xml::child(mesh, "triangles");
    for (Node vertex = xml::child(vertices, "vertex"); vertex; vertex = xml::next(vertex))
      read_vertex(vertex);
    scene_.charge_numbers(3 * mesh_.points.points.size());
    const bool has_default = xml::has(object_, "pid") && xml::has(object_, "pindex");
    const std::uint32_t usual =
        has_default ? material(object_, xml::attribute(object_, "pid"), part_.file.count(object_, "pindex", 0)) : 0;
    for (Node triangle = xml::child(triangles, "triangle"); triangle; triangle = xml::next(triangle))
      read_triangle(triangle, usual);
    return std::move(mesh_);
  }

 private:
  void read_vertex(const Node& vertex) {
    constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
    std::array<double, 3> xyz{};
    for (std::size_t k = 0; k < 3; ++k) {
      Printed number;
      xyz[k] = part_.file.real(vertex, kAxes[k], number);
      mesh_.points.precision.note(xyz[k], number);
    }
    if (mesh_.points.points.size() >= kMaxPoints) part_.file.fail(vertex, "is one too many; cut the mesh into parts");
    mesh_.points.points.push_back({xyz[0], xyz[1], xyz[2]});
  }

  void read_triangle(const Node& triangle, std::uint32_t usual) {
    for (const char* const corner : {"v1", "v2", "v3"}) {
      if (!xml::has(triangle, corner)) part_.file.fail(triangle, "has no attribute '" + std::string(corner) + "'");
      const std::uint64_t number = part_.file.count(triangle, corner, 0);
      mesh_.corners.push_back(number < kMaxPoints ? static_cast<std::uint32_t>(number) : PolygonSoup::kInvalidVertex);
    }
    const std::string_view own = xml::attribute(triangle, "pid");
    const std::string_view group = own.empty() ? xml::attribute(object_, "pid") : own;
    std::uint32_t first = usual;
    std::uint64_t before = 0;
    for (const char* const corner : {"p1", "p2", "p3"}) {
      if (!xml::has(triangle, corner)) continue;
      const std::uint64_t index = part_.file.count(triangle, corner, 0);
      if (corner[1] != '1' && index == before) continue;
      const std::uint32_t found = group.empty() ? 0 : material(triangle, group, index);
      if (corner[1] == '1') first = found;
      before = index;
    }
    mesh_.materials.push_back(first);
  }

  // Of a property, in names; 0: it is no material. Every reference is checked, as the format demands.
  std::uint32_t material(const Node& node, std::string_view group_id, std::uint64_t index) {
    const auto group = part_.groups.find(group_id);
    if (group == part_.groups.end())
      part_.file.fail(node,
                      "names the properties " + shown(group_id) + ", and there are none of this id; export the file again");
    if (index >= group->second.count) {
      part_.file.fail(node, "names property " + std::to_string(index) + " of resource " + shown(group_id) + ", which has " +
                                std::to_string(group->second.count) + "; export the file again");
    }
    if (group->second.materials.empty()) return 0;
    const auto [known, is_new] = index_of_.emplace(std::pair(group_id, index), static_cast<std::uint32_t>(mesh_.names.size()));
    if (is_new) mesh_.names.push_back(group->second.materials[index]);
    return known->second;
  }

  const Part& part_;
  Node object_;
  SceneSoup& scene_;
  Mesh mesh_;
  std::map<std::pair<std::string_view, std::uint64_t>, std::uint32_t> index_of_;
};

}  // namespace

Mesh read_mesh(const Part& part, const Node& object, SceneSoup& scene) {
  return MeshReader(part, object, scene).read();
}

}  // namespace fdcg::bake::threemf
