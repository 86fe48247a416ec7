// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_scene_physics.hpp"

#include "import/soup_reader.hpp"

namespace fdcg::bake::gltf {

ScenePhysics::ScenePhysics(const Document& document) : document_(document) {
  stated_.materials = document.physics.materials;
  if (!has_any()) return;
  body_.assign(document.nodes.size(), kNone);
  material_.assign(document.nodes.size(), kNone);
}

void ScenePhysics::add(Index node, const Matrix* world, const std::string& name) {
  if (!has_any()) return;
  const NodePhysics& physics = document_.physics.nodes[node];
  const Index parent = document_.nodes[node].parent;
  body_[node] = physics.motion ? node : parent != kNone ? body_[parent] : kNone;
  if (physics.motion) {
    PhysicsBody body = *physics.motion;
    body.node = readable_name(name);
    if (body.centre_of_mass_m && world != nullptr) {
      std::array<double, 3>& c = *body.centre_of_mass_m;
      const Vec3 at = applied(*world, {c[0], c[1], c[2]});
      c = {at.x, at.y, at.z};
    }
    stated_.bodies.push_back(std::move(body));
  }
  if (physics.collider) add_collider(node, world, name, *physics.collider);
  triggers_ += physics.is_trigger ? 1 : 0;
}

void ScenePhysics::add_collider(Index node, const Matrix* world, const std::string& name, const Collider& collider) {
  const Index material = collider.material.value_or(kNone);
  material_[node] = material;
  if (collider.geometry_node && material != kNone) named_material_.emplace(*collider.geometry_node, material);
  if (body_[node] != kNone) {
    const auto [known, is_new] = body_material_.emplace(body_[node], material);
    if (!is_new && known->second != material) known->second = kSeveral;
  }
  if (!collider.shape) return;
  StatedShape shape = placed_shape(document_.physics.shapes[*collider.shape], world);
  shape.node = readable_name(name);
  if (material != kNone) shape.material = stated_.materials[material].name;
  stated_.shapes.push_back(std::move(shape));
  shape_of_.push_back({*collider.shape, node});
}

void ScenePhysics::finish() {
  for (Index n = 0; n < material_.size(); ++n) {
    if (material_[n] != kNone) continue;
    const auto named = named_material_.find(n);
    const auto shared = body_material_.find(body_[n]);
    if (named != named_material_.end()) {
      material_[n] = named->second;
    } else if (body_[n] != kNone && shared != body_material_.end() && shared->second != kSeveral) {
      material_[n] = shared->second;
    }
  }
}

const std::string* ScenePhysics::material_of(Index node) const {
  if (material_.empty() || material_[node] == kNone) return nullptr;
  return &stated_.materials[material_[node]].name;
}

}  // namespace fdcg::bake::gltf
