// SPDX-License-Identifier: Apache-2.0
// What the nodes of a glTF scene state of physics, each in its place.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

class ScenePhysics {
 public:
  // The document outlives this.
  explicit ScenePhysics(const Document& document);

  // A node that the scene shows, after its parent. `world`: null where it is the identity.
  void add(Index node, const Matrix* world, const std::string& name);
  // When all were added.
  void finish();

  // The physics material of a node's mesh: that of its own collider, else of the collider that has its geometry, else the one
  // that all colliders of its body share. Null: none.
  [[nodiscard]] const std::string* material_of(Index node) const;

  [[nodiscard]] StatedPhysics& stated() { return stated_; }
  [[nodiscard]] const ImplicitShape& shape(std::size_t s) const { return document_.physics.shapes[shape_of_[s].shape]; }
  [[nodiscard]] Index node(std::size_t s) const { return shape_of_[s].node; }
  [[nodiscard]] std::uint64_t triggers() const { return triggers_; }

 private:
  struct ShownShape {
    Index shape, node;
  };
  void add_collider(Index node, const Matrix* world, const std::string& name, const Collider& collider);
  [[nodiscard]] bool has_any() const { return !document_.physics.nodes.empty(); }

  static constexpr Index kSeveral = kNone - 1;
  const Document& document_;
  StatedPhysics stated_;
  std::vector<ShownShape> shape_of_;       // of each of stated_.shapes
  std::vector<Index> body_, material_;     // of each node; none
  std::map<Index, Index> body_material_;   // by the node of the motion; kSeveral
  std::map<Index, Index> named_material_;  // by the node that has a collider's geometry
  std::uint64_t triggers_ = 0;
};

}  // namespace fdcg::bake::gltf
