// SPDX-License-Identifier: Apache-2.0
#include "topology/duplicates.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace fdcg::bake {
namespace {

// A triangle and its copy share all three edges: none is a boundary, and a twin of one of them belongs to the copy.
bool triangle_may_have_copy(const Topology& topology, std::uint32_t first) {
  FaceId across{kNone};
  for (std::uint32_t h = first; h < first + 3; ++h) {
    const HalfedgeId twin = topology.twin[h];
    if (twin == Topology::kBoundary) return false;
    if (+twin >= +Topology::kSkipped) continue;
    const FaceId f = topology.face(twin);
    if (across != FaceId{kNone} && f != across) return false;
    across = f;
  }
  return true;
}

// Does not depend on the order of the corners.
std::uint64_t hash_of(const VertexId* corner, std::uint32_t count) {
  std::uint64_t sum = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint64_t x = (std::uint64_t{+corner[i]} + 1) * 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio
    x = (x ^ x >> 32) * 0xD6E8FEB86659FD93ULL;                                  // odd, bits well spread
    sum += x ^ x >> 32;
  }
  return sum;
}

// Faces of equal hash: sorted by their sorted corners, then by index, so that copies follow their first face.
void compare(const Mesh& mesh, const std::uint32_t* begin, const std::uint32_t* end, std::vector<Duplicate>& out) {
  std::vector<std::pair<std::vector<VertexId>, FaceId>> faces;
  for (const std::uint32_t* f = begin; f < end; ++f) {
    faces.emplace_back(
        std::vector<VertexId>(mesh.corners.begin() + mesh.face_first[*f], mesh.corners.begin() + mesh.face_first[*f + 1]),
        FaceId{*f});
    std::sort(faces.back().first.begin(), faces.back().first.end());
  }
  std::sort(faces.begin(), faces.end());
  std::size_t first = 0;
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].first == faces[first].first) {
      out.push_back({faces[i].second, faces[first].second});
    } else {
      first = i;
    }
  }
}

}  // namespace

std::vector<Duplicate> duplicate_faces(const Mesh& mesh, const Topology& topology, const std::vector<FaceState>& states) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t first = mesh.face_first[f], count = mesh.face_first[f + 1] - first;
    if (states[f] == FaceState::invalid_corner || count == 0) continue;
    if (states[f] == FaceState::sound && count == 3 && !triangle_may_have_copy(topology, first)) continue;
    keys.emplace_back(hash_of(mesh.corners.data() + first, count), f);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Duplicate> duplicates;
  std::vector<std::uint32_t> same;
  for (std::size_t i = 0; i < keys.size();) {
    const std::size_t begin = i;
    same.clear();
    for (; i < keys.size() && keys[i].first == keys[begin].first; ++i)
      same.push_back(keys[i].second);
    if (same.size() > 1) compare(mesh, same.data(), same.data() + same.size(), duplicates);
  }
  std::sort(duplicates.begin(), duplicates.end(), [](const Duplicate& a, const Duplicate& b) { return a.copy < b.copy; });
  return duplicates;
}

}  // namespace fdcg::bake
