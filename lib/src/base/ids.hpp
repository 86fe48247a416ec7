// SPDX-License-Identifier: Apache-2.0
// Indices as distinct types, so that mixing a vertex with a face does not compile. `+id` is the number.
#pragma once

#include <cstdint>

namespace fdcg::bake {

enum class VertexId : std::uint32_t {};    // of a welded Mesh
enum class FaceId : std::uint32_t {};      // of a Mesh
enum class HalfedgeId : std::uint32_t {};  // a slot of Mesh::corners: the edge from that corner to the next of its face

inline constexpr std::uint32_t kNone = 0xFFFFFFFFu;

constexpr std::uint32_t operator+(VertexId id) {
  return static_cast<std::uint32_t>(id);
}
constexpr std::uint32_t operator+(FaceId id) {
  return static_cast<std::uint32_t>(id);
}
constexpr std::uint32_t operator+(HalfedgeId id) {
  return static_cast<std::uint32_t>(id);
}

}  // namespace fdcg::bake
