// SPDX-License-Identifier: Apache-2.0
// 3MF (3MF Consortium): what the build shows, flattened. Coordinates stay in the file's unit.
#include <map>
#include <string>

#include "import/scene_soup.hpp"
#include "import/soup_reader.hpp"
#include "import/threemf_model.hpp"

namespace fdcg::bake {
namespace threemf {
namespace {

class BuildReader {
 public:
  BuildReader(Package& package, const MeshText& input, PolygonSoup& soup)
      : package_(package), scene_(soup, input.bytes.size() + package.unpacked_bytes()) {}

  void read() {
    Part& root = package_.root();
    const Node build = xml::child(root.file.root(), "build");
    for (Node item = xml::child(build, "item"); item; item = xml::next(item))
      show(root, item, nullptr, "", 0);
    std::uint64_t unbuilt = 0;
    for (const auto& [id, object] : root.objects)
      unbuilt += xml::child(object, "mesh") && !meshes_.contains(object.internal_object()) ? 1 : 0;
    scene_.ignore("objects that are not built", unbuilt);
    scene_.finish();
  }

 private:
  // What an <item> or a <component> refers to.
  void show(Part& from, const Node& reference, const Matrix* above, const std::string& path, int depth) {
    scene_.charge_node();
    if (depth > xml::kMaxDepth) {
      from.file.fail(reference, "nests components more than " + std::to_string(xml::kMaxDepth) +
                                    " deep, perhaps itself; export the file again");
    }
    Part* part = &from;
    if (xml::has(reference, "path")) {
      const std::size_t before = package_.unpacked_bytes();
      part = &package_.part(xml::attribute(reference, "path"), from, reference);
      scene_.grow_bytes(package_.unpacked_bytes() - before);
    }
    const Node object = object_of(*part, from, reference);
    const Matrix own = transform_of(from, reference);
    const Matrix world = above == nullptr ? own : own == kIdentity ? *above : product(*above, own);
    if (!is_finite(world)) from.file.fail(reference, "has a transform that with those above it gives more than a double holds");
    const Matrix* const place = world == kIdentity ? nullptr : &world;
    std::string name = path;
    if (depth < kNamedLevels) name += (path.empty() ? "" : "/") + name_of(object);
    if (const Node components = xml::child(object, "components")) {
      for (Node component = xml::child(components, "component"); component; component = xml::next(component))
        show(*part, component, place, name, depth + 1);
    } else if (xml::child(object, "mesh")) {
      show_mesh(*part, object, place, name);
    } else {
      scene_.ignore("objects without a mesh");
    }
  }

  static std::string name_of(const Node& object) {
    const std::string_view name = xml::attribute(object, "name");
    return name.empty() ? "object " + readable_name(xml::attribute(object, "id")) : readable_name(name);
  }

  void show_mesh(const Part& part, const Node& object, const Matrix* world, const std::string& name) {
    auto known = meshes_.find(object.internal_object());
    if (known == meshes_.end()) known = meshes_.emplace(object.internal_object(), read_mesh(part, object, scene_)).first;
    const Mesh& mesh = known->second;
    const std::uint32_t first = scene_.add_points(mesh.points, world);
    const bool is_turned = world != nullptr && is_mirrored(*world);
    std::uint32_t material = 0;
    scene_.begin_part(name, {}, first);
    for (std::size_t t = 0; t < mesh.materials.size(); ++t) {
      if (mesh.materials[t] != material) {
        material = mesh.materials[t];
        scene_.set_material(mesh.names[material]);
      }
      scene_.add_face({mesh.corners.data() + 3 * t, 3}, first, mesh.points.points.size(), is_turned);
    }
  }

  static constexpr int kNamedLevels = 4;  // of a part's name

  Package& package_;
  SceneSoup scene_;
  std::map<const void*, Mesh> meshes_;  // by <object>
};

// Of an archive that holds a COLLADA scene in place of a 3MF package (.zae). Throws Refusal.
std::optional<std::string> packed_scene(const MeshText& input) {
  ZipFile zip(input.bytes);
  if (!zip.find_ending(".model").empty()) return std::nullopt;
  if (!zip.find_ending(".usdc").empty() || !zip.find_ending(".usda").empty())
    throw xml::Refusal{"is USDZ, which is not read; in Blender import it and export glTF, or OBJ or PLY"};
  const std::string scene = zip.find_ending(".dae");
  return scene.empty() ? std::nullopt : zip.read(scene);
}

}  // namespace
}  // namespace threemf

Result<PolygonSoup> read_3mf(const MeshText& input) {
  PolygonSoup soup;
  soup.name = input.name;
  soup.format = Format::threemf;
  soup.face_first.push_back(0);
  try {
    if (const std::optional<std::string> scene = threemf::packed_scene(input))
      return read_dae({*scene, input.name, input.progress, input.file});
    threemf::Package package(input.bytes);
    soup.metres_per_unit = package.metres_per_unit();
    threemf::BuildReader(package, input, soup).read();
  } catch (const xml::Refusal& refusal) {
    return refuse(input.name, refusal.message, "unreadable");
  }
  return soup;
}

}  // namespace fdcg::bake
