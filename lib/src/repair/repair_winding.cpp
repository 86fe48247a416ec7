// SPDX-License-Identifier: Apache-2.0
// Flips faces: within patches of mixed winding, and closed patches that are inside out. The same stage as compile --orient.
#include <algorithm>

#include "repair/repair.hpp"
#include "topology/orient.hpp"

namespace fdcg::bake {
namespace {

void flip(Workpiece& piece, const std::vector<FaceId>& faces) {
  for (const FaceId f : faces) {
    const auto corners = piece.soup.corners.begin();
    std::reverse(corners + piece.soup.face_first[+f] + 1, corners + piece.soup.face_first[+f + 1]);
  }
}

}  // namespace

RepairAction orient_step(Workpiece& piece) {
  View view(piece);
  Patches patches = find_patches(view.mesh, view.topology, view.states);
  const std::vector<FaceId> flipped = make_winding_consistent(view.mesh, view.topology, view.states, patches);
  flip(piece, flipped);
  Tally tally;
  for (const FaceId f : flipped)
    tally.done.push_back(piece.source_face[+f]);
  for (const Patch& patch : patches.patches) {
    if (!patch.is_orientable) tally.left.push_back(piece.source_face[+patch.first_face]);
  }
  RepairAction action =
      action_of(piece, "orient", Kind::faces,
                counted(flipped.size(), "face was", "faces were") + " turned to agree with the rest of the patch", tally);
  if (action.left != 0) {
    action.left_message = counted(action.left, "patch was left as found: no turning makes it",
                                  "patches were left as found: no turning makes them") +
                          " consistent; each is listed by its first face";
  }
  return action;
}

RepairAction reverse_inside_out_step(Workpiece& piece) {
  View view(piece);
  Patches patches = find_patches(view.mesh, view.topology, view.states);
  const std::vector<FaceId> flipped = reverse_inside_out(view.mesh, view.topology, view.states, patches);
  flip(piece, flipped);
  Tally tally;
  std::vector<bool> is_told(patches.patches.size(), false);
  for (const FaceId f : flipped) {
    const std::uint32_t p = patches.of_face[+f];
    if (!is_told[p]) tally.done.push_back(piece.source_face[+patches.patches[p].first_face]);
    is_told[p] = true;
  }
  return action_of(piece, "reverse-inside-out", Kind::faces,
                   counted(tally.done.size(), "closed patch", "closed patches") + " of " +
                       counted(flipped.size(), "face", "faces") + " turned outwards; each is listed by its first face",
                   tally);
}

}  // namespace fdcg::bake
