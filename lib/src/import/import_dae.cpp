// SPDX-License-Identifier: Apache-2.0
// COLLADA (Khronos, 1.4 and 1.5): the scene that the file shows, flattened. Coordinates stay in the file's unit and axes.
#include <map>
#include <string>

#include "import/dae_document.hpp"
#include "import/dae_transform.hpp"
#include "import/scene_soup.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace dae {
namespace {

class SceneReader {
 public:
  SceneReader(const Document& document, const MeshText& input, PolygonSoup& soup)
      : document_(document), file_(document.file()), input_(input), scene_(soup, input.bytes.size()) {}

  void read() {
    const Node shown = visual_scene();
    if (!shown) {
      for_each_geometry([this](const Node& geometry) { show_mesh(geometry, geometry, nullptr, {}, {}); });
    } else {
      for (Node node = xml::child(shown, "node"); node; node = xml::next(node))
        show_node(node, nullptr, 0);
      for_each_geometry([this](const Node& geometry) {
        if (!meshes_.contains(geometry.internal_object())) scene_.ignore("meshes of no node");
      });
    }
    scene_.finish();
  }

 private:
  using Names = std::map<std::string_view, std::string>;  // of materials, by symbol

  // The one that the file shows, else its first; empty: it has none.
  [[nodiscard]] Node visual_scene() const {
    const Node instance = xml::child(xml::child(document_.root(), "scene"), "instance_visual_scene");
    if (instance) {
      const Node chosen = document_.target(instance, "url", "visual_scene");
      if (!chosen) file_.fail(instance, "shows the scene of another file, which is not read; name that file");
      return chosen;
    }
    return xml::child(xml::child(document_.root(), "library_visual_scenes"), "visual_scene");
  }

  template <class Use>
  void for_each_geometry(const Use& use) const {
    for (Node library = xml::child(document_.root(), "library_geometries"); library; library = xml::next(library)) {
      for (Node geometry = xml::child(library, "geometry"); geometry; geometry = xml::next(geometry))
        use(geometry);
    }
  }

  // ---- nodes and their transforms

  void show_node(const Node& node, const Matrix* above, int depth) {
    scene_.charge_node();
    if (depth > xml::kMaxDepth) {
      file_.fail(node, "nests or instances nodes more than " + std::to_string(xml::kMaxDepth) +
                           " deep, perhaps itself; export the scene again");
    }
    Matrix world = above != nullptr ? *above : kIdentity;
    for (Node child = xml::first_element(node); child; child = xml::next_element(child)) {
      const Matrix own = transform_of(file_, child);
      if (own != kIdentity) world = world == kIdentity ? own : product(world, own);
    }
    if (!is_finite(world)) file_.fail(node, "has a transform that with those above it gives more than a double holds");
    const Matrix* const place = world == kIdentity ? nullptr : &world;  // so that untransformed points keep their bits
    for (Node child = xml::first_element(node); child; child = xml::next_element(child)) {
      const std::string_view kind = xml::name_of(child);
      const bool is_shown =
          kind == "instance_geometry" || kind == "instance_controller" || kind == "instance_node" || kind == "node";
      if (is_shown) show_child(node, child, place, depth);
    }
  }

  void show_child(const Node& node, const Node& child, const Matrix* place, int depth) {
    const std::string_view kind = xml::name_of(child);
    if (kind == "node") return show_node(child, place, depth + 1);
    if (kind == "instance_node") {
      const Node instanced = document_.target(child, "url", "node");
      return instanced ? show_node(instanced, place, depth + 1) : scene_.ignore("nodes of other files");
    }
    const Node geometry = kind == "instance_geometry" ? document_.target(child, "url", "geometry") : base_of(child);
    if (!geometry) return scene_.ignore("meshes of other files");
    std::string name = readable_name(xml::attribute(node, xml::has(node, "name") ? "name" : "id"));
    if (name.empty()) name = "node";
    show_mesh(node, geometry, place, name, materials_of(child));
  }

  // The mesh that a controller bends.
  Node base_of(const Node& instance) {
    Node controller = document_.target(instance, "url", "controller");
    for (int depth = 0; controller; ++depth) {
      if (depth > xml::kMaxDepth) file_.fail(controller, "bends itself; export the scene again");
      const Node skin = xml::child(controller, "skin"), morph = xml::child(controller, "morph");
      if (!skin && !morph) file_.fail(controller, "has neither a skin nor a morph; export the scene again");
      scene_.ignore(skin ? "skins (shown at rest)" : "morphs (shown at rest)");
      scene_.charge_node();
      const Node bend = skin ? skin : morph;
      if (!document_.has_target(bend, "source", "controller")) return document_.target(bend, "source", "geometry");
      controller = document_.target(bend, "source", "controller");
    }
    return {};
  }

  [[nodiscard]] Names materials_of(const Node& instance) const {
    Names names;
    const Node common = xml::child(xml::child(instance, "bind_material"), "technique_common");
    for (Node bound = xml::child(common, "instance_material"); bound; bound = xml::next(bound)) {
      std::string_view name = xml::attribute(bound, "symbol");
      if (document_.has_target(bound, "target", "material")) {  // the geometry does not need it
        const Node material = document_.target(bound, "target", "material");
        name = xml::attribute(material, xml::has(material, "name") ? "name" : "id");
      }
      names.emplace(xml::attribute(bound, "symbol"), name);
    }
    return names;
  }

  // ---- meshes

  void show_mesh(const Node& node, const Node& geometry, const Matrix* world, const std::string& node_name,
                 const Names& names) {
    scene_.charge_node();
    auto known = meshes_.find(geometry.internal_object());
    if (known == meshes_.end()) {
      known = meshes_.emplace(geometry.internal_object(), read_mesh(document_, geometry, scene_)).first;
      report(node);
    }
    const Mesh& mesh = known->second;
    std::string name = readable_name(xml::attribute(geometry, xml::has(geometry, "name") ? "name" : "id"));
    if (!node_name.empty()) name = node_name + "/" + name;
    std::vector<std::uint32_t> first(mesh.sources.size());
    for (std::size_t s = 0; s < mesh.sources.size(); ++s)
      first[s] = scene_.add_points(mesh.sources[s], world);
    const bool is_turned = world != nullptr && is_mirrored(*world);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const Primitive& primitive = mesh.primitives[p];
      const auto bound = names.find(primitive.material);
      scene_.begin_part(name + "/primitive " + std::to_string(p), bound != names.end() ? bound->second : primitive.material,
                        first[primitive.source]);
      show_faces(primitive, first[primitive.source], mesh.sources[primitive.source].points.size(), is_turned);
    }
  }

  void show_faces(const Primitive& primitive, std::uint32_t first, std::size_t points, bool is_turned) {
    for (std::size_t f = 0; f + 1 < primitive.face_first.size(); ++f) {
      const std::uint32_t* const c = primitive.corners.data() + primitive.face_first[f];
      const std::size_t count = primitive.face_first[f + 1] - primitive.face_first[f];
      if (primitive.is_strip && c[0] < points && c[1] < points && c[2] < points &&
          (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])) {
        scene_.ignore("strip joints");
      } else {
        scene_.add_face({c, count}, first, points, is_turned);
      }
    }
  }

  void report(const Node& node) const {
    const std::ptrdiff_t offset = node.offset_debug();
    if (input_.progress && offset > 0)
      input_.progress("import", static_cast<double>(offset) / static_cast<double>(input_.bytes.size()));
  }

  const Document& document_;
  const xml::File& file_;
  const MeshText& input_;
  SceneSoup scene_;
  std::map<const void*, Mesh> meshes_;  // by <geometry>
};

}  // namespace
}  // namespace dae

Result<PolygonSoup> read_dae(const MeshText& input) {
  PolygonSoup soup;
  soup.name = input.name;
  soup.format = Format::dae;
  soup.face_first.push_back(0);
  try {
    const dae::Document document(input.bytes);
    soup.metres_per_unit = document.metres_per_unit();
    soup.up_axis = document.up_axis();
    dae::SceneReader(document, input, soup).read();
  } catch (const xml::Refusal& refusal) {
    return refuse(input.name, refusal.message, "unreadable");
  }
  return soup;
}

}  // namespace fdcg::bake
