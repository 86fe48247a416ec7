// SPDX-License-Identifier: Apache-2.0
// A mesh file as another library reads it, and the comparison with a soup, face by face.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

using PlacedFace = std::vector<bake::Vec3>;  // its corners, in the order of the winding

struct JudgeScene {
  std::vector<PlacedFace> faces;
  double metres_per_unit = 0;  // 0: the judge does not say
  std::string trouble;         // why it cannot read the file; empty: it could
};

// The trouble with every file where a judge was not built in.
inline constexpr const char* kNoJudge = "this build has no lib3mf of version 1";

JudgeScene read_with_assimp(const std::filesystem::path& path);
JudgeScene read_with_lib3mf(const std::filesystem::path& path);  // 3MF alone

// The soup's faces. One with a corner that the file does not have has none.
std::vector<PlacedFace> faces_in_place(const bake::PolygonSoup& soup);

// How the two sets of faces differ. Faces are the same where corners are, from whichever of them one starts, within
// `tolerance`. Each face is matched once.
struct FaceDifference {
  std::vector<std::size_t> ours, theirs;  // without a partner
  std::size_t turned = 0;                 // partners of opposite winding
};
FaceDifference compare_faces(const std::vector<PlacedFace>& ours, const std::vector<PlacedFace>& theirs, double tolerance);

// The largest coordinate, which tolerances go by.
double extent_of(const std::vector<PlacedFace>& faces);

std::string shown(const PlacedFace& face);

}  // namespace fdcg::test
