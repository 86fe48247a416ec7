// SPDX-License-Identifier: Apache-2.0
#include "topology/orient.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "topology/edges.hpp"
#include "topology/face_geometry.hpp"
#include "topology/patches.hpp"

namespace fdcg::bake {
namespace {

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

// Of the patches that had mixed winding and are consistent now, those with inward normals.
std::vector<bool> wrong_sided(const Mesh& mesh, const Patches& patches, const std::vector<bool>& was_mixed) {
  std::vector<bool> is_wrong(patches.patches.size(), false);
  std::vector<std::uint32_t> asked;
  std::size_t enclosing = 0;
  for (std::uint32_t p = 0; p < patches.patches.size(); ++p) {
    if (!patches.patches[p].encloses()) continue;
    ++enclosing;
    if (was_mixed[p]) asked.push_back(p);
  }
  std::vector<std::uint32_t> depths(asked.size(), 0);
  if (enclosing > 1) depths = nesting_depths(mesh, patches, asked);
  for (std::size_t i = 0; i < asked.size(); ++i)
    is_wrong[asked[i]] = (patches.patches[asked[i]].volume_sign < 0) == (depths[i] % 2 == 0);
  return is_wrong;
}

// Marks the faces of the patches, or unmarks them where they are marked.
void toggle_faces(const Patches& patches, const std::vector<bool>& is_chosen, std::vector<bool>& is_marked) {
  for (std::size_t f = 0; f < is_marked.size(); ++f) {
    if (patches.of_face[f] != kNone && is_chosen[patches.of_face[f]]) is_marked[f] = !is_marked[f];
  }
}

bool any(const std::vector<bool>& is_marked) {
  return std::find(is_marked.begin(), is_marked.end(), true) != is_marked.end();
}

// Flips the patches, and returns their faces, marked. `patches` follows.
std::vector<bool> turn(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states, const std::vector<bool>& is_chosen,
                       Patches& patches) {
  std::vector<bool> is_flipped(mesh.face_count(), false);
  toggle_faces(patches, is_chosen, is_flipped);
  flip(mesh, topology, states, is_flipped);
  for (std::size_t p = 0; p < is_chosen.size(); ++p) {
    if (is_chosen[p]) patches.patches[p].volume_sign *= -1;
  }
  return is_flipped;
}

std::vector<FaceId> marked_faces(const std::vector<bool>& is_marked) {
  std::vector<FaceId> faces;
  for (std::uint32_t f = 0; f < is_marked.size(); ++f) {
    if (is_marked[f]) faces.push_back(FaceId{f});
  }
  return faces;
}

}  // namespace

Patches find_patches(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states) {
  const FaceGeometry geometry(mesh, states);
  return find_patches(mesh, topology, states, odd_edges(mesh, topology), geometry);
}

std::vector<FaceId> make_winding_consistent(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states,
                                            Patches& patches) {
  std::vector<bool> is_flipped = minority(patches);
  if (!any(is_flipped)) return {};
  std::vector<bool> was_mixed(patches.patches.size());
  for (std::size_t p = 0; p < was_mixed.size(); ++p)
    was_mixed[p] = !patches.patches[p].is_consistent;
  flip(mesh, topology, states, is_flipped);
  patches = find_patches(mesh, topology, states);  // flipping changes no patch, so the indices remain valid
  const std::vector<bool> is_wrong = wrong_sided(mesh, patches, was_mixed);
  if (any(is_wrong)) {
    turn(mesh, topology, states, is_wrong, patches);
    toggle_faces(patches, is_wrong, is_flipped);
  }
  return marked_faces(is_flipped);
}

std::vector<FaceId> reverse_inside_out(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states, Patches& patches) {
  std::vector<bool> is_wrong(patches.patches.size(), false);
  for (const std::uint32_t p : inside_out_patches(mesh, patches))
    is_wrong[p] = true;
  if (!any(is_wrong)) return {};
  return marked_faces(turn(mesh, topology, states, is_wrong, patches));
}

std::vector<FaceId> orient(Mesh& mesh, Topology& topology, const std::vector<FaceState>& states) {
  Patches patches = find_patches(mesh, topology, states);
  const std::vector<FaceId> first = make_winding_consistent(mesh, topology, states, patches);
  const std::vector<FaceId> second = reverse_inside_out(mesh, topology, states, patches);  // of other patches
  std::vector<FaceId> flipped;
  std::merge(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(flipped));
  return flipped;
}

}  // namespace fdcg::bake
