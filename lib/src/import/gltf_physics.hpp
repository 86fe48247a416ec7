// SPDX-License-Identifier: Apache-2.0
// KHR_physics_rigid_bodies and KHR_implicit_shapes of a glTF file: what its nodes state of mass, materials and shapes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fdcg/physics.hpp"
#include "import/placing.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::bake::gltf {

// In the frame of its node; along y where it has an axis.
struct ImplicitShape {
  enum class Kind { box, sphere, capsule, cylinder, plane, other } kind = Kind::other;
  std::string name;                               // of the kind, as in the file
  std::array<double, 3> size{};                   // box; plane: 0 where it has no end
  double radius = 0, top_radius = 0, height = 0;  // radius: at the bottom, -y
};

struct Collider {
  std::optional<std::uint32_t> shape, geometry_node, material;  // indices
};

// Of each node, by its index; physics.material.size() and others as the file has them.
struct NodePhysics {
  std::optional<PhysicsBody> motion;  // in the node's frame, without a name
  std::optional<Collider> collider;
  bool is_trigger = false;
};

struct Physics {
  std::vector<PhysicsMaterial> materials;
  std::vector<ImplicitShape> shapes;
  std::vector<NodePhysics> nodes;  // empty: none has any
  std::string trouble;             // why it was left out; empty: it was not
};

// Never throws Refusal: the triangles do not need it.
Physics read_physics(const json::Value& root);

// A shape as a surface of a scene, at its place; null: where it is. Without its names.
StatedShape placed_shape(const ImplicitShape& shape, const Matrix* world);

// The eight corners of a box in its own frame: bit k of the number is the sign along axis k. And its faces, outward.
std::array<Vec3, 8> corners_of_box(const ImplicitShape& box);
inline constexpr std::array<std::array<std::uint32_t, 4>, 6> kBoxFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

}  // namespace fdcg::bake::gltf
