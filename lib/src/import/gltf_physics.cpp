// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_physics.hpp"

#include "shared/text.hpp"

namespace fdcg::bake::gltf {
namespace {

using json::Refusal;
using json::Value;

constexpr const char* kBodies = "KHR_physics_rigid_bodies";
constexpr const char* kShapes = "KHR_implicit_shapes";
constexpr json::NumberRange kFrom0 = {0, 1e30}, kAbove0 = {0, 1e30, false}, kAnywhere = {-1e30, 1e30};
constexpr std::uint32_t kMostIndex = 0xFFFFFFFE;

class PhysicsReader {
 public:
  explicit PhysicsReader(const Value& root) : root_(root) {}

  Physics read() {
    if (const Value extensions = root_["extensions"]) {
      if (const Value bodies = extensions[kBodies]) read_materials(bodies);
      if (const Value implicit = extensions[kShapes]) read_shapes(implicit);
    }
    const Value nodes = root_["nodes"];
    for (std::size_t n = 0; nodes && n < nodes.size(); ++n)
      read_node(nodes.item(n), n, nodes.size());
    return std::move(physics_);
  }

 private:
  void read_materials(const Value& bodies) {
    const Value list = bodies["physicsMaterials"];
    for (std::size_t m = 0; list && m < list.size(); ++m) {
      const Value item = list.item(m), name = item["name"];
      PhysicsMaterial material;
      if (name) material.name = printable(name.string(), kLongestName);
      if (material.name.empty()) material.name = "physicsMaterials[" + std::to_string(m) + "]";
      material.static_friction = item["staticFriction"].number_or(material.static_friction, kFrom0);
      material.dynamic_friction = item["dynamicFriction"].number_or(material.dynamic_friction, kFrom0);
      material.restitution = item["restitution"].number_or(material.restitution, kFrom0);
      material.friction_combine = combine_of(item["frictionCombine"]);
      material.restitution_combine = combine_of(item["restitutionCombine"]);
      physics_.materials.push_back(std::move(material));
    }
  }

  static std::string combine_of(const Value& item) {
    constexpr const char* kNames[] = {"average", "minimum", "maximum", "multiply"};
    return item ? kNames[item.choice({kNames[0], kNames[1], kNames[2], kNames[3]})] : "";
  }

  void read_shapes(const Value& implicit) {
    const Value list = implicit["shapes"];
    for (std::size_t s = 0; list && s < list.size(); ++s)
      physics_.shapes.push_back(read_shape(list.item(s)));
  }

  static ImplicitShape read_shape(const Value& item) {
    using Kind = ImplicitShape::Kind;
    constexpr std::pair<std::string_view, Kind> kKinds[] = {{"box", Kind::box},
                                                            {"sphere", Kind::sphere},
                                                            {"capsule", Kind::capsule},
                                                            {"cylinder", Kind::cylinder},
                                                            {"plane", Kind::plane}};
    ImplicitShape shape;
    const Value type = item["type"];
    shape.name = printable(type.string(), kLongestName);
    for (const auto& [name, kind] : kKinds) {
      if (type.string() == name) shape.kind = kind;
    }
    const Value sizes = item[type.string()];
    const auto size_or = [&sizes](const char* key, double fallback, const json::NumberRange& range) {
      return sizes ? sizes[key].number_or(fallback, range) : fallback;
    };
    constexpr double kDefault = 0.5, kDefaultRadius = 0.25;
    if (shape.kind == Kind::sphere) shape.radius = size_or("radius", kDefault, kAbove0);
    if (shape.kind == Kind::box) {
      shape.size = {1, 1, 1};
      if (sizes && sizes["size"]) sizes["size"].numbers(shape.size.data(), 3, kAbove0);
    }
    if (shape.kind == Kind::plane) shape.size = {size_or("sizeX", 0, kAbove0), 0, size_or("sizeZ", 0, kAbove0)};
    if (shape.kind == Kind::capsule || shape.kind == Kind::cylinder) {
      shape.height = size_or("height", kDefault, kAbove0);
      shape.radius = size_or("radiusBottom", kDefaultRadius, kFrom0);
      shape.top_radius = size_or("radiusTop", kDefaultRadius, kFrom0);
      if (shape.radius == 0 && shape.top_radius == 0) item.fail(": a radius of it must be above 0");
    }
    return shape;
  }

  void read_node(const Value& item, std::size_t n, std::size_t count) {
    const Value extensions = item["extensions"];
    if (!extensions) return;
    const Value bodies = extensions[kBodies];
    if (!bodies) return;
    NodePhysics node;
    if (const Value motion = bodies["motion"]) node.motion = read_motion(motion);
    if (const Value collider = bodies["collider"]) node.collider = read_collider(collider, count);
    node.is_trigger = static_cast<bool>(bodies["trigger"]);
    if (physics_.nodes.empty()) physics_.nodes.resize(count);
    physics_.nodes[n] = std::move(node);
  }

  // A mass of 0 is one without end, which JSON cannot say.
  static PhysicsBody read_motion(const Value& motion) {
    PhysicsBody body;
    const Value mass = motion["mass"], centre = motion["centerOfMass"];
    if (mass) body.mass_kg = mass.number(kFrom0);
    body.is_kinematic = motion["isKinematic"].boolean_or(false) || (mass && body.mass_kg == 0);
    if (centre) centre.numbers(body.centre_of_mass_m.emplace().data(), 3, kAnywhere);
    return body;
  }

  // Older drafts have the shape in the collider itself.
  Collider read_collider(const Value& from, std::size_t nodes) const {
    Collider collider;
    const Value inner = from["geometry"];
    const Value geometry = inner ? inner : from;
    const Value shape = geometry["shape"], node = geometry["node"], material = from["physicsMaterial"];
    if (shape) collider.shape = index_below(shape, physics_.shapes.size(), "shapes");
    if (node) collider.geometry_node = index_below(node, nodes, "nodes");
    if (material) collider.material = index_below(material, physics_.materials.size(), "physicsMaterials");
    return collider;
  }

  static std::uint32_t index_below(const Value& value, std::size_t count, const char* things) {
    const auto index = static_cast<std::uint64_t>(value.integer(0, kMostIndex));
    if (index >= count)
      value.fail("is " + std::to_string(index) + ", but the file has " + std::to_string(count) + " " + things);
    return static_cast<std::uint32_t>(index);
  }

  static constexpr std::size_t kLongestName = 64;
  const Value& root_;
  Physics physics_;
};

}  // namespace

Physics read_physics(const Value& root) try { return PhysicsReader(root).read(); } catch (const Refusal& refusal) {
  Physics none;
  constexpr std::size_t kShown = 120;
  none.trouble = printable(refusal.message, kShown);
  return none;
}

}  // namespace fdcg::bake::gltf
