// SPDX-License-Identifier: Apache-2.0
#include "graph/fan_runs.hpp"

#include <algorithm>
#include <utility>

#include "fdcg/format.h"

namespace fdcg::bake {
namespace {

class Gatherer {
 public:
  Gatherer(const Mesh& mesh, const Topology& topology) : mesh_(mesh), topology_(topology), faces_at_(mesh.points.size()) {
    for (const auto vertex : mesh.corners)
      ++faces_at_[+vertex];
  }

  [[nodiscard]] bool has_busy() const {
    return std::any_of(faces_at_.begin(), faces_at_.end(), [](std::uint32_t n) { return n > FDCG_BUSY_FAN; });
  }

  std::vector<FanRun> run(std::vector<std::uint32_t>& faces) {
    find_owners();
    std::vector<std::uint32_t> ordered, starts;
    ordered.reserve(faces.size());
    std::vector<bool> has_run(mesh_.points.size());
    for (const std::uint32_t f : faces) {
      const std::uint32_t slot = owner_slot_[f];
      if (slot == kNone) {
        ordered.push_back(f);
      } else if (const std::uint32_t vertex = +mesh_.corners[slot]; !has_run[vertex]) {
        has_run[vertex] = true;
        starts.push_back(slot);
      }
    }
    std::vector<FanRun> runs;
    for (const std::uint32_t slot : starts) {
      const auto first = static_cast<std::uint32_t>(ordered.size());
      append_fan(HalfedgeId{slot}, ordered);
      runs.push_back({+mesh_.corners[slot], first, static_cast<std::uint32_t>(ordered.size()) - first});
    }
    faces = std::move(ordered);
    return runs;
  }

 private:
  // Of each face the slot of its busiest vertex, the lowest of several.
  void find_owners() {
    owner_slot_.assign(mesh_.face_count(), kNone);
    for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) {
      std::uint32_t& owner = owner_slot_[f];
      for (std::uint32_t slot = mesh_.face_first[f]; slot < mesh_.face_first[f + 1]; ++slot) {
        const std::uint32_t v = +mesh_.corners[slot], n = faces_at_[v];
        if (n <= FDCG_BUSY_FAN) continue;
        const std::uint32_t best = owner == kNone ? kNone : +mesh_.corners[owner];
        if (best == kNone || n > faces_at_[best] || (n == faces_at_[best] && v < best)) owner = slot;
      }
    }
  }

  // Counter-clockwise around the vertex at which `start` starts; from the boundary where there is one.
  void append_fan(HalfedgeId start, std::vector<std::uint32_t>& ordered) {
    HalfedgeId slot = start;
    while (topology_.twin[+slot] != Topology::kBoundary) {
      const HalfedgeId twin = topology_.twin[+slot];
      slot = next(mesh_, topology_.face(twin), twin);
      if (slot == start) break;
    }
    const HalfedgeId first = slot;
    do {
      const FaceId face = topology_.face(slot);
      if (owner_slot_[+face] == +slot) ordered.push_back(+face);
      slot = topology_.twin[+previous(mesh_, face, slot)];
    } while (slot != Topology::kBoundary && slot != first);
  }

  const Mesh& mesh_;
  const Topology& topology_;
  std::vector<std::uint32_t> faces_at_;    // each vertex
  std::vector<std::uint32_t> owner_slot_;  // of each face, or kNone
};

}  // namespace

std::vector<FanRun> gather_fans(const Mesh& mesh, const Topology& topology, std::vector<std::uint32_t>& faces) {
  Gatherer gatherer(mesh, topology);
  if (!gatherer.has_busy()) return {};
  return gatherer.run(faces);
}

}  // namespace fdcg::bake
