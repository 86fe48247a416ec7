// SPDX-License-Identifier: Apache-2.0
#include "topology/face_triangles.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "base/parallel.hpp"
#include "exact/exact.hpp"
#include "exact/outline.hpp"
#include "exact/polygon_cut.hpp"

namespace fdcg::bake {

// Cuts one face after another; one to a thread.
class FaceTriangles::Cutter {
 public:
  explicit Cutter(const Mesh& mesh) : mesh_(mesh) {}

  void cut(std::uint32_t f, std::vector<Cut>& out) {
    const std::uint32_t first = mesh_.face_first[f], count = mesh_.face_first[f + 1] - first;
    const auto add = [&](const Ear& ear) {
      Cut triangle{{}, FaceId{f}, 0};
      for (unsigned i = 0; i < 3; ++i) {
        const std::uint32_t from = ear[i], to = ear[(i + 1) % 3];
        triangle.corner[i] = mesh_.corners[first + from];
        if (to != (from + 1) % count) triangle.seams = static_cast<std::uint8_t>(triangle.seams | 1u << i);
      }
      out.push_back(triangle);
    };
    if (count == 3) return add({0, 1, 2});
    polygon_.clear();
    for (std::uint32_t i = 0; i < count; ++i)
      polygon_.push_back(mesh_.points[+mesh_.corners[first + i]]);
    const std::optional<Projection> view = simple_view(polygon_);
    const std::span<const Ear> ears = view ? cutter_.cut(*view, polygon_) : std::span<const Ear>{};
    if (!ears.empty()) return std::for_each(ears.begin(), ears.end(), add), void();
    for (std::uint32_t i = 1; i + 1 < count; ++i) {
      if (!exact::collinear(polygon_[0], polygon_[i], polygon_[i + 1])) add({0, i, i + 1});
    }
  }

 private:
  const Mesh& mesh_;
  std::vector<Vec3> polygon_;
  PolygonCutter cutter_;
};

FaceTriangles::FaceTriangles(const Mesh& mesh, const FaceGeometry& geometry, unsigned jobs)
    : mesh_(mesh), is_plain_(geometry.has_triangles_only()) {
  if (is_plain_) return;
  constexpr std::size_t kGrain = 1024;
  std::vector<std::vector<Cut>> batches((mesh.face_count() + kGrain - 1) / kGrain);
  parallel_for(jobs, mesh.face_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    Cutter cutter(mesh);
    for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f) {
      if (geometry.is_finite(FaceId{f}) && !geometry.is_degenerate(FaceId{f})) cutter.cut(f, batches[begin / kGrain]);
    }
  });
  for (const std::vector<Cut>& batch : batches)
    cut_.insert(cut_.end(), batch.begin(), batch.end());
}

}  // namespace fdcg::bake
