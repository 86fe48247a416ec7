// SPDX-License-Identifier: Apache-2.0
// What tests of surfaces share: random shapes, a contact on one, a hand that wanders about it.
#pragma once

#include <string>

#include "fdcg/surface.h"
#include "fp_trap.hpp"
#include "random.hpp"
#include "surface_reference.hpp"

namespace fdcg::test {

inline const char* name_of(std::uint32_t kind) {
  static const char* const kNames[] = {"plane", "sphere", "cylinder", "capsule", "box", "cone", "torus", "ellipsoid"};
  return kNames[kind];
}

// Sizes from 1 down to 1 / `thinnest` of `size`.
inline fdcg_surface random_surface(std::uint32_t kind, bool is_hollow, double size, double thinnest, Random& random) {
  const auto part = [&] { return size * std::exp(random.uniform(-std::log(thinnest), 0)); };
  fdcg_surface s = fdcg_make_plane();
  s.kind = kind;
  s.is_hollow = is_hollow && kind != FDCG_SURFACE_PLANE ? 1 : 0;
  if (kind == FDCG_SURFACE_PLANE) return s;
  if (kind == FDCG_SURFACE_BOX || kind == FDCG_SURFACE_ELLIPSOID) {
    for (double& half : s.half_m)
      half = part();
    return s;
  }
  s.radius_m = part();
  if (kind == FDCG_SURFACE_TORUS) s.tube_radius_m = s.radius_m * random.uniform(1 / thinnest, 0.95);
  if (kind == FDCG_SURFACE_CYLINDER || kind == FDCG_SURFACE_CAPSULE || kind == FDCG_SURFACE_CONE) s.length_m = part();
  if (kind == FDCG_SURFACE_CONE) {
    const double draw = random.uniform(0, 1);
    s.top_radius_m = draw < 0.4 ? 0 : part();
    if (draw < 0.2) std::swap(s.radius_m, s.top_radius_m);
  }
  return s;
}

inline std::string describe(const fdcg_surface& s) {
  return std::string(s.is_hollow != 0 ? "hollow " : "") + name_of(s.kind) + " radius " + std::to_string(s.radius_m) + " top " +
         std::to_string(s.top_radius_m) + " tube " + std::to_string(s.tube_radius_m) + " length " + std::to_string(s.length_m) +
         " half " + std::to_string(s.half_m[0]) + " " + std::to_string(s.half_m[1]) + " " + std::to_string(s.half_m[2]);
}

// One contact on one surface.
class SurfaceContact {
 public:
  SurfaceContact(const fdcg_surface& surface, double mu_static, double mu_dynamic) : surface_(surface) {
    params_.mu_static = mu_static;
    params_.mu_dynamic = mu_dynamic;
  }
  const fdcg_result& step(const Place& hip) {
    const FpTrap trap(hip.data());
    fdcg_surface_step(&surface_, &params_, &state, hip.data(), &result);
    return result;
  }
  [[nodiscard]] Place normal() const {
    Place n;
    fdcg_surface_get_normal(&surface_, &result, n.data());
    return n;
  }
  [[nodiscard]] Place god_object() const { return {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]}; }
  [[nodiscard]] const fdcg_params& params() const { return params_; }
  [[nodiscard]] const fdcg_surface& surface() const { return surface_; }

  fdcg_contact state{};
  fdcg_result result{};

 private:
  fdcg_surface surface_;
  fdcg_params params_ = fdcg_make_params();
};

// A hand about a surface of this extent: slow and quick strokes, tremor, standstill, jumps, and the places where shapes have
// their edges, axes and middles.
class SurfaceHand {
 public:
  SurfaceHand(double extent, std::uint64_t seed) : extent_(extent), random_(seed) { at_ = somewhere(1.5); }

  Place next() {
    if (left_ == 0) choose();
    --left_;
    for (int k = 0; k < 3; ++k) {
      at_[k] += velocity_[k] + (tremor_ > 0 ? tremor_ * random_.uniform(-1, 1) : 0);
      if (std::abs(at_[k]) > 2 * extent_) velocity_[k] = -velocity_[k];
    }
    return at_;
  }

 private:
  Place somewhere(double extents) {
    Place p;
    for (double& x : p) {
      x = extent_ * extents * random_.uniform(-1, 1);
      if (random_.uniform(0, 1) < 0.1) x = 0;  // an axis, a middle
    }
    return p;
  }
  void choose() {
    const double draw = random_.uniform(0, 1);
    left_ = 1 + static_cast<int>(random_.uniform(0, 60));
    velocity_ = {0, 0, 0};
    tremor_ = 0;
    if (draw < 0.1) {
      at_ = somewhere(1.2);  // a jump
      left_ = 1;
    } else if (draw < 0.13) {
      at_ = somewhere(1e6);
      left_ = 1;
    } else if (draw < 0.16) {
      at_ = {0, 0, 0};
      left_ = 1;
    } else if (draw < 0.3) {
      tremor_ = extent_ * std::pow(10.0, random_.uniform(-12, -2));
    } else if (draw < 0.4) {
      left_ = 5;  // still
    } else {      // a stroke to some place
      const Place to = somewhere(1.1);
      left_ = 1 + static_cast<int>(std::pow(10.0, random_.uniform(0, 2.5)));
      for (int k = 0; k < 3; ++k)
        velocity_[k] = (to[k] - at_[k]) / left_;
    }
  }

  double extent_;
  Random random_;
  Place at_{}, velocity_{};
  double tremor_ = 0;
  int left_ = 0;
};

}  // namespace fdcg::test
