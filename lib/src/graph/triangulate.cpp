// SPDX-License-Identifier: Apache-2.0
#include "graph/triangulate.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "exact/outline.hpp"
#include "exact/polygon_cut.hpp"
#include "graph/merge.hpp"

namespace fdcg::bake {
namespace {

class Triangulator {
 public:
  Triangulator(Mesh mesh, Topology topology) : in_(std::move(mesh)), twins_(std::move(topology)) {}

  Triangulation run() {
    slot_of_.assign(in_.corners.size(), +Topology::kSkipped);
    out_.is_whole.assign(in_.face_count(), 1);
    out_.mesh.face_first.push_back(0);
    for (std::uint32_t f = 0; f < in_.face_count(); ++f)
      cut_face(f);
    for (std::uint32_t slot = 0; slot < slot_of_.size(); ++slot) {
      const HalfedgeId twin = twins_.twin[slot];
      if (slot_of_[slot] == +Topology::kSkipped) continue;
      const bool has_twin = +twin < slot_of_.size() && slot_of_[+twin] != +Topology::kSkipped;
      out_.topology.twin[slot_of_[slot]] = has_twin ? HalfedgeId{slot_of_[+twin]} : Topology::kBoundary;
    }
    out_.mesh.points = std::move(in_.points);
    out_.mesh.source_point = std::move(in_.source_point);
    out_.mesh.origin = in_.origin;
    out_.mesh.joined_vertices = in_.joined_vertices;
    return std::move(out_);
  }

 private:
  void cut_face(std::uint32_t f) {
    const std::uint32_t first = in_.face_first[f], count = in_.face_first[f + 1] - first;
    if (count < 3 || twins_.twin[first] == Topology::kSkipped) return;
    if (count == 3) {
      add_triangle(f, {in_.corners[first], in_.corners[first + 1], in_.corners[first + 2]});
      const auto slot = static_cast<std::uint32_t>(out_.mesh.corners.size() - 3);
      for (std::uint32_t i = 0; i < 3; ++i)
        slot_of_[first + i] = slot + i;
      return;
    }
    polygon_.clear();
    for (std::uint32_t i = 0; i < count; ++i)
      polygon_.push_back(in_.points[+in_.corners[first + i]]);
    const std::optional<Projection> view = simple_view(polygon_);
    out_.is_whole[f] = view && count <= kMaxMergedSides && !turns_of(*view, polygon_).has_right;
    const std::span<const Ear> ears = view ? cutter_.cut(*view, polygon_) : std::span<const Ear>{};
    if (ears.empty()) {
      out_.uncuttable.push_back(f);
      return;
    }
    // Of each edge of what remains, by its first corner: the half-edge across that an earlier ear left, or kNone for an edge
    // of the polygon itself.
    across_.assign(count, kNone);
    for (std::size_t i = 0; i < ears.size(); ++i) {
      const auto& [before, tip, after] = ears[i];
      const auto slot = static_cast<std::uint32_t>(out_.mesh.corners.size());
      add_triangle(f, {in_.corners[first + before], in_.corners[first + tip], in_.corners[first + after]});
      close(first, before, slot);
      close(first, tip, slot + 1);
      if (i + 1 < ears.size()) {
        across_[before] = slot + 2;
      } else {
        close(first, after, slot + 2);
      }
    }
  }

  // The edge that starts at the polygon's corner i is now the half-edge `slot`.
  void close(std::uint32_t first, std::uint32_t i, std::uint32_t slot) {
    if (across_[i] == kNone) {
      slot_of_[first + i] = slot;
    } else {
      out_.topology.twin[slot] = HalfedgeId{across_[i]};
      out_.topology.twin[across_[i]] = HalfedgeId{slot};
    }
  }

  void add_triangle(std::uint32_t f, std::array<VertexId, 3> corners) {
    out_.mesh.corners.insert(out_.mesh.corners.end(), corners.begin(), corners.end());
    out_.mesh.face_first.push_back(static_cast<std::uint32_t>(out_.mesh.corners.size()));
    out_.topology.twin.resize(out_.mesh.corners.size(), Topology::kBoundary);
    out_.polygon.push_back(f);
  }

  Mesh in_;
  Topology twins_;
  Triangulation out_;
  std::vector<std::uint32_t> slot_of_;  // of each half-edge of the input: where it is now
  std::vector<Vec3> polygon_;
  std::vector<std::uint32_t> across_;
  PolygonCutter cutter_;
};

}  // namespace

Triangulation triangulate(Mesh mesh, Topology topology) {
  const bool skips = std::find(topology.twin.begin(), topology.twin.end(), Topology::kSkipped) != topology.twin.end();
  if (topology.face_of.empty() && !skips) {
    Triangulation out;
    out.mesh = std::move(mesh);
    out.topology = std::move(topology);
    return out;
  }
  return Triangulator(std::move(mesh), std::move(topology)).run();
}

}  // namespace fdcg::bake
