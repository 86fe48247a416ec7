// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "contender.hpp"
#include "embree_scene.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

constexpr double kMargin_m = 3e-3;

class DistanceGrid : public Contender {
 public:
  DistanceGrid(const Ground& ground, int resolution) {
    const auto begin = std::chrono::steady_clock::now();
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, ground.high()[k] - ground.low()[k] + 2 * kMargin_m);
    cell_ = longest / (resolution - 1);
    for (std::size_t k = 0; k < 3; ++k) {
      origin_[k] = ground.low()[k] - kMargin_m;
      count_[k] = 2 + static_cast<int>((ground.high()[k] - ground.low()[k] + 2 * kMargin_m) / cell_);
    }
    bake(ground);
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    info_.bytes = distances_.size() * sizeof(float);
    info_.name = "grid_" + std::to_string(resolution);
    info_.family = "distance_grid";
    info_.precision = "f32";
  }
  void reset() override {}
  void step(const Point& hip_m, Feel& feel) override {
    feel = {hip_m, {}, false, 0};
    int cell[3];
    double u[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = (hip_m[k] - origin_[k]) / cell_;
      if (!(at >= 0 && at < count_[k] - 1)) return;
      cell[k] = static_cast<int>(at);
      u[k] = at - cell[k];
    }
    const float* low = &distances_[index(cell[0], cell[1], cell[2])];
    const std::size_t dy = static_cast<std::size_t>(count_[2]), dx = dy * static_cast<std::size_t>(count_[1]);
    double along_z[4], rise_z[4];  // of the four columns (x, y)
    for (std::size_t column = 0; column < 4; ++column) {
      const float* d = low + (column >> 1) * dx + (column & 1) * dy;
      rise_z[column] = double{d[1]} - d[0];
      along_z[column] = d[0] + u[2] * rise_z[column];
    }
    const auto mix = [](double a, double b, double part) { return a + part * (b - a); };
    const double y0 = mix(along_z[0], along_z[1], u[1]), y1 = mix(along_z[2], along_z[3], u[1]);
    const double distance = mix(y0, y1, u[0]);
    if (distance >= 0) return;
    const Point gradient = unit({y1 - y0, mix(along_z[1] - along_z[0], along_z[3] - along_z[2], u[0]),
                                 mix(mix(rise_z[0], rise_z[1], u[1]), mix(rise_z[2], rise_z[3], u[1]), u[0])});
    feel.god_object = hip_m - gradient * distance;
    feel.force = gradient * (-distance * kStiffness_n_per_m);
    feel.in_contact = true;
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(x) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(count_[2]) +
           static_cast<std::size_t>(z);
  }

  [[nodiscard]] Point place(int x, int y, int z) const {
    return {origin_[0] + x * cell_, origin_[1] + y * cell_, origin_[2] + z * cell_};
  }

  // Near the surface, where a HIP comes, the nearest triangle by Embree, its distance and sign in double. Farther off, as such
  // grids are commonly baked, the nearest of the triangles that the neighbours have, swept forth and back.
  void bake(const Ground& ground) {
    constexpr double kBand_m = 4e-3, kBandCells = 3;
    const EmbreeScene scene(ground.soup());
    const auto band = static_cast<float>(std::max(kBand_m, kBandCells * cell_));
    distances_.assign(index(count_[0] - 1, count_[1] - 1, count_[2] - 1) + 1, 0);
    std::vector<std::uint32_t> triangles(distances_.size(), EmbreeScene::kNone);
    for (int x = 0; x < count_[0]; ++x) {
      for (int y = 0; y < count_[1]; ++y) {
        for (int z = 0; z < count_[2]; ++z) {
          const Point point = place(x, y, z);
          const std::uint32_t triangle = triangles[index(x, y, z)] = scene.nearest(point, band).triangle;
          if (triangle == EmbreeScene::kNone) continue;
          const Ground::Closest closest = ground.closest_of(point, triangle);
          const bool is_inside = dot(point - closest.point, closest.feature_normal) < 0;
          distances_[index(x, y, z)] = static_cast<float>(is_inside ? -closest.distance : closest.distance);
        }
      }
    }
    std::vector<bool> is_exact(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
      is_exact[i] = triangles[i] != EmbreeScene::kNone;
    for (const int step : {1, -1})
      sweep(scene, is_exact, triangles, step);
  }

  void sweep(const EmbreeScene& scene, const std::vector<bool>& is_exact, std::vector<std::uint32_t>& triangles, int step) {
    const auto at = [&](int i, int axis) { return step > 0 ? i : count_[axis] - 1 - i; };
    for (int i = 0; i < count_[0]; ++i) {
      for (int j = 0; j < count_[1]; ++j) {
        for (int k = 0; k < count_[2]; ++k) {
          const int place_of[3] = {at(i, 0), at(j, 1), at(k, 2)};
          const std::size_t here = index(place_of[0], place_of[1], place_of[2]);
          if (is_exact[here]) continue;
          for (int axis = 0; axis < 3; ++axis) {
            int other[3] = {place_of[0], place_of[1], place_of[2]};
            other[axis] -= step;
            if (other[axis] < 0 || other[axis] >= count_[axis]) continue;
            const std::size_t there = index(other[0], other[1], other[2]);
            if (triangles[there] != EmbreeScene::kNone)
              offer(scene, place_of, triangles[there], distances_[there] < 0, triangles[here]);
          }
        }
      }
    }
  }

  // No surface lies between two neighbours that are not both near it: they are on the same side.
  void offer(const EmbreeScene& scene, const int* place_of, std::uint32_t triangle, bool is_inside, std::uint32_t& own) {
    const auto distance = static_cast<float>(scene.distance(triangle, place(place_of[0], place_of[1], place_of[2])));
    float& kept = distances_[index(place_of[0], place_of[1], place_of[2])];
    if (own != EmbreeScene::kNone && distance >= std::abs(kept)) return;
    own = triangle;
    kept = is_inside ? -distance : distance;
  }

  double cell_ = 0;
  Point origin_{};
  int count_[3] = {};
  std::vector<float> distances_;
};

}  // namespace

std::unique_ptr<Contender> make_distance_grid(const Ground& ground, int resolution) {
  return std::make_unique<DistanceGrid>(ground, resolution);
}

}  // namespace fdcg::test
