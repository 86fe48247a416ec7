// SPDX-License-Identifier: Apache-2.0
#include "repair/boundary_loops.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace {

struct Way {
  VertexId from, to;
  FaceId face;
};

class LoopFinder {
 public:
  LoopFinder(const Mesh& mesh, const Topology& topology) : mesh_(mesh) {
    for (std::uint32_t h = 0; h < topology.twin.size(); ++h) {
      if (topology.twin[h] != Topology::kBoundary) continue;
      const FaceId f = topology.face(HalfedgeId{h});
      // A patch runs against the faces that it joins.
      ways_.push_back({mesh.corners[+next(mesh, f, HalfedgeId{h})], mesh.corners[h], f});
    }
    for (std::uint32_t w = static_cast<std::uint32_t>(ways_.size()); w-- > 0;)
      out_[+ways_[w].from].push_back(w);
  }

  std::vector<BoundaryLoop> run() {
    is_taken_.assign(ways_.size(), false);
    for (std::uint32_t w = 0; w < ways_.size(); ++w) {
      if (!is_taken_[w]) walk(w);
    }
    return std::move(loops_);
  }

 private:
  // Whenever the walk comes back to a vertex, the way since then is a loop.
  void walk(std::uint32_t first) {
    std::vector<std::uint32_t> path;
    std::unordered_map<std::uint32_t, std::size_t> place;  // in the path, of the vertex from which a way starts
    for (std::uint32_t w = first;;) {
      is_taken_[w] = true;
      place[+ways_[w].from] = path.size();
      path.push_back(w);
      const std::uint32_t at = +ways_[w].to;
      if (const auto seen = place.find(at); seen != place.end()) {
        const std::size_t begin = seen->second;  // of its own: the loop's places are erased, that one too
        close(path, begin);
        for (std::size_t i = begin; i < path.size(); ++i)
          place.erase(+ways_[path[i]].from);
        path.resize(begin);
      }
      std::vector<std::uint32_t>& out = out_[at];
      while (!out.empty() && is_taken_[out.back()])
        out.pop_back();
      if (out.empty()) return;
      w = out.back();
    }
  }

  void close(const std::vector<std::uint32_t>& path, std::size_t begin) {
    BoundaryLoop loop;
    Vec3 low = mesh_.points[+ways_[path[begin]].from], high = low;
    for (std::size_t i = begin; i < path.size(); ++i) {
      const VertexId v = ways_[path[i]].from;
      const Vec3& p = mesh_.points[+v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      loop.corners.push_back(v);
      loop.faces.push_back(ways_[path[i]].face);
    }
    loop.size = length(high - low);
    loop.is_slit = is_slit(loop.corners);
    loops_.push_back(std::move(loop));
  }

  [[nodiscard]] bool is_slit(const std::vector<VertexId>& corners) const {
    const auto at = [&](std::size_t i) -> const Vec3& { return mesh_.points[+corners[i]]; };
    std::size_t second = 1;
    while (second < corners.size() && at(second) == at(0))
      ++second;
    for (std::size_t i = second + 1; i < corners.size(); ++i) {
      if (!exact::collinear(at(0), at(second), at(i))) return false;
    }
    return true;
  }

  const Mesh& mesh_;
  std::vector<Way> ways_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> out_;  // of each vertex, the first way last
  std::vector<bool> is_taken_;
  std::vector<BoundaryLoop> loops_;
};

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const Mesh& mesh, const Topology& topology) {
  return LoopFinder(mesh, topology).run();
}

}  // namespace fdcg::bake
