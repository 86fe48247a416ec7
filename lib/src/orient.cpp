// SPDX-License-Identifier: Apache-2.0
#include "orient.hpp"

#include <algorithm>
#include <cstddef>

#include "edges.hpp"
#include "face_geometry.hpp"
#include "patches.hpp"

namespace fdcg::bake {
namespace {

Patches analyse(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states) {
  const FaceGeometry geometry(mesh, states);
  return find_patches(mesh, topology, states, odd_edges(mesh, topology), geometry);
}

void flip(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states, const std::vector<bool>& is_flipped) {
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!is_flipped[f]) continue;
    const auto corners = mesh.corners.begin();
    std::reverse(corners + mesh.face_first[f] + 1, corners + mesh.face_first[f + 1]);
  }
  topology = pair_halfedges(mesh, states);
}

// The smaller part of each patch of mixed winding.
std::vector<bool> minority(const Patches& patches) {
  std::vector<bool> is_flipped(patches.of_face.size(), false);
  if (patches.is_turned.empty()) return is_flipped;
  std::vector<std::uint32_t> turned(patches.patches.size(), 0);
  for (std::size_t f = 0; f < is_flipped.size(); ++f) {
    if (patches.is_turned[f] != 0) ++turned[patches.of_face[f]];
  }
  for (std::size_t f = 0; f < is_flipped.size(); ++f) {
    const std::uint32_t p = patches.of_face[f];
    if (p == kNone || !patches.patches[p].is_orientable) continue;
    const bool flips_turned = turned[p] <= patches.patches[p].faces - turned[p];
    is_flipped[f] = (patches.is_turned[f] != 0) == flips_turned && turned[p] != 0;
  }
  return is_flipped;
}

// The patches that look to the wrong side. `was_mixed` tells which were made consistent just now.
std::vector<bool> wrong_sided(const Mesh& mesh, const Patches& patches, const std::vector<bool>& was_mixed) {
  std::vector<bool> is_wrong(patches.patches.size(), false);
  for (const std::uint32_t p : inside_out_patches(mesh, patches))
    is_wrong[p] = true;
  std::vector<std::uint32_t> perhaps_cavities;
  for (std::uint32_t p = 0; p < patches.patches.size(); ++p) {
    if (was_mixed[p] && patches.patches[p].encloses() && patches.patches[p].volume_sign > 0) perhaps_cavities.push_back(p);
  }
  if (perhaps_cavities.empty() || patches.patches.size() == 1) return is_wrong;
  const std::vector<std::uint32_t> depths = nesting_depths(mesh, patches, perhaps_cavities);
  for (std::size_t i = 0; i < perhaps_cavities.size(); ++i)
    is_wrong[perhaps_cavities[i]] = depths[i] % 2 == 1;
  return is_wrong;
}

}  // namespace

std::vector<FaceId> orient(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states) {
  Patches patches = analyse(mesh, topology, states);
  std::vector<bool> was_mixed(patches.patches.size());
  for (std::size_t p = 0; p < was_mixed.size(); ++p)
    was_mixed[p] = !patches.patches[p].is_consistent;
  std::vector<bool> is_flipped = minority(patches);
  if (std::find(is_flipped.begin(), is_flipped.end(), true) != is_flipped.end()) {
    flip(mesh, topology, states, is_flipped);
    patches = analyse(mesh, topology, states);  // flipping changes no patch, so that the numbers still hold
  }

  const std::vector<bool> is_wrong = wrong_sided(mesh, patches, was_mixed);
  if (std::find(is_wrong.begin(), is_wrong.end(), true) != is_wrong.end()) {
    std::vector<bool> again(is_flipped.size(), false);
    for (std::size_t f = 0; f < again.size(); ++f) {
      again[f] = patches.of_face[f] != kNone && is_wrong[patches.of_face[f]];
      if (again[f]) is_flipped[f] = !is_flipped[f];
    }
    flip(mesh, topology, states, again);
  }

  std::vector<FaceId> flipped;
  for (std::uint32_t f = 0; f < is_flipped.size(); ++f) {
    if (is_flipped[f]) flipped.push_back(FaceId{f});
  }
  return flipped;
}

}  // namespace fdcg::bake
