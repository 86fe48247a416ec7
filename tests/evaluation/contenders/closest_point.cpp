// SPDX-License-Identifier: Apache-2.0
// Contenders without memory of the surface: the closest point of the mesh is felt, whatever way the HIP has come.
#include <chrono>
#include <limits>

#include "contender.hpp"
#include "embree_scene.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

class EmbreeClosest : public Contender {
 public:
  explicit EmbreeClosest(const bake::PolygonSoup& soup) : begin_(std::chrono::steady_clock::now()), scene_(soup) {
    info_.name = "embree_closest";
    info_.family = "closest_point";
    info_.precision = "f32";
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    info_.bytes = scene_.bytes();
    reset();
  }
  void reset() override { has_last_ = false; }
  void step(const Point& hip_m, Feel& feel) override {
    // A little more than the last answer's distance, so that rounding does not lose it.
    constexpr double kMore = 1.0001, kAtLeast_m = 1e-7;
    const float radius =
        has_last_ ? static_cast<float>(length(hip_m - last_) * kMore + kAtLeast_m) : std::numeric_limits<float>::infinity();
    const EmbreeScene::Nearest nearest = scene_.nearest(hip_m, radius);
    feel = {hip_m, {}, false, 0};
    if (nearest.triangle == EmbreeScene::kNone) return;
    last_ = {nearest.point[0], nearest.point[1], nearest.point[2]};
    has_last_ = true;
    if (dot(hip_m - last_, scene_.normal(nearest.triangle)) >= 0) return;
    feel.god_object = last_;
    feel.force = (last_ - hip_m) * kStiffness_n_per_m;
    feel.in_contact = true;
  }

 private:
  std::chrono::steady_clock::time_point begin_;
  EmbreeScene scene_;
  Point last_{};
  bool has_last_ = false;
};

}  // namespace

std::unique_ptr<Contender> make_embree_closest(const bake::PolygonSoup& soup) {
  return std::make_unique<EmbreeClosest>(soup);
}

}  // namespace fdcg::test
