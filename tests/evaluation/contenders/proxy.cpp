// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "contender.hpp"
#include "embree_scene.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

constexpr double kGap_m = 1e-6;  // between proxy and surface: 1e-5 of the body, 250 units in the last place of its floats

class Proxy : public Contender {
 public:
  explicit Proxy(const bake::PolygonSoup& soup) : begin_(std::chrono::steady_clock::now()), scene_(soup) {
    info_.name = "ray_proxy";
    info_.family = "proxy";
    info_.precision = "f32";
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    info_.bytes = scene_.bytes();
    reset();
  }
  void reset() override { is_started_ = false; }
  void step(const Point& hip_m, Feel& feel) override {
    if (!is_started_) proxy_ = hip_m;
    is_started_ = true;
    feel = {hip_m, {}, false, 0};
    const EmbreeScene::Hit first = scene_.cast(proxy_, hip_m);
    if (first.triangle == EmbreeScene::kNone) {
      proxy_ = hip_m;
      return;
    }
    slide(hip_m, first, feel.transitions);
    feel.god_object = proxy_;
    feel.force = (proxy_ - hip_m) * kStiffness_n_per_m;
    feel.in_contact = true;
  }

 private:
  // In front of what was met on the way to `goal`.
  void stop_at(const EmbreeScene::Hit& hit, const Point& goal) {
    const Point& n = scene_.normal(hit.triangle);
    const Point met = proxy_ + (goal - proxy_) * static_cast<double>(hit.part);
    const double height = dot(met - scene_.corner(hit.triangle), n);
    proxy_ = met + n * (kGap_m - height);
  }

  void slide(const Point& hip, const EmbreeScene::Hit& first, std::uint32_t& planes) {
    const Point n1 = scene_.normal(first.triangle);
    stop_at(first, hip);
    planes = 1;
    const Point on_plane = hip + n1 * dot(proxy_ - hip, n1);
    const EmbreeScene::Hit second = scene_.cast(proxy_, on_plane);
    if (second.triangle == EmbreeScene::kNone) {
      proxy_ = on_plane;
      return;
    }
    stop_at(second, on_plane);
    planes = 2;
    const Point along = cross(n1, scene_.normal(second.triangle));
    if (!(dot(along, along) > 0)) return;
    const Point on_line = proxy_ + along * (dot(hip - proxy_, along) / dot(along, along));
    const EmbreeScene::Hit third = scene_.cast(proxy_, on_line);
    if (third.triangle == EmbreeScene::kNone) {
      proxy_ = on_line;
      return;
    }
    stop_at(third, on_line);
    planes = 3;
  }

  std::chrono::steady_clock::time_point begin_;
  EmbreeScene scene_;
  Point proxy_{};
  bool is_started_ = false;
};

}  // namespace

std::unique_ptr<Contender> make_proxy(const bake::PolygonSoup& soup) {
  return std::make_unique<Proxy>(soup);
}

}  // namespace fdcg::test
