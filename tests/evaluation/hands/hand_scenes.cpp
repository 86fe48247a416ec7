// SPDX-License-Identifier: Apache-2.0
#include "hand_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "bodies.hpp"
#include "meshes.hpp"
#include "point.hpp"
#include "reference_walker.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

constexpr std::uint64_t kTurn = 20;
constexpr double kMuStatic = 0.6, kMuDynamic = 0.4;

Point turned(const Point& p) {
  const Vec3 r = rotated(random_rotation(kTurn), {p[0], p[1], p[2]});
  return {r.x, r.y, r.z};
}
PolygonSoup body(const PolygonSoup& soup, double scale) {
  return transformed(triangulated(soup), random_rotation(kTurn), scale);
}

// Targets in the body's own frame: each stretch comes to its point in so many seconds, without a jump of velocity at its ends,
// and trembles meanwhile, most in its middle.
class Motion {
 public:
  Motion(double rate_hz, const Point& start_m) : rate_hz_(rate_hz), at_m_(start_m) {}

  Motion& to(const Point& end_m, double seconds, const Point& tremor_m = {}, double tremor_hz = 0) {
    const auto ticks = static_cast<std::size_t>(seconds * rate_hz_);
    for (std::size_t i = 1; i <= ticks; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(ticks), eased = t * t * t * (10 + t * (6 * t - 15));
      const double fades = std::sin(std::numbers::pi * t);
      const double swing = fades * fades * std::sin(2 * std::numbers::pi * tremor_hz * t * seconds);
      targets_m_.push_back(turned(at_m_ + (end_m - at_m_) * eased + tremor_m * swing));
    }
    at_m_ = end_m;
    return *this;
  }
  Motion& hold(double seconds) {
    held_from_ = targets_m_.size();
    to(at_m_, seconds);
    held_to_ = targets_m_.size();
    return *this;
  }
  [[nodiscard]] HandScene scene(std::string name, std::string what, PolygonSoup soup, bool has_friction) const {
    HandScene scene{std::move(name), std::move(what), std::move(soup), 0, 0, targets_m_, held_from_, held_to_};
    if (has_friction) scene.mu_static = kMuStatic, scene.mu_dynamic = kMuDynamic;
    return scene;
  }

 private:
  double rate_hz_;
  Point at_m_;
  std::vector<Point> targets_m_;
  std::size_t held_from_ = 0, held_to_ = 0;
};

constexpr double kPress_m = 7e-3;  // of the target below the surface: the device sinks in by two sevenths of it
constexpr double kHalf_m = kBody_m / 2;

class TruthContender : public Contender {
 public:
  explicit TruthContender(const bake::PolygonSoup& soup) {
    bake::CompileOptions options;
    options.merge = false;
    auto compiled = bake::compile(soup, options);
    if (!compiled || compiled->bytes.empty()) throw std::runtime_error(soup.name + " does not compile");
    file_ = std::move(compiled->bytes);
    fdcg_error error{};
    if (fdcg_open_memory(file_.data(), file_.size(), FDCG_VERIFY_TRUSTED, &view_, &error) != FDCG_OK)
      throw std::runtime_error(error.message);
    surface_ = std::make_unique<ReferenceSurface<long double>>(view_);
    info_.name = info_.family = "truth";
    info_.precision = "long double";
    info_.has_friction = true;
    set_friction(0, 0);
  }
  void reset() override { walker_->contact = {}; }
  void set_friction(double mu_static, double mu_dynamic) override {
    walker_ = std::make_unique<ReferenceWalker<long double>>(*surface_, ReferenceFriction{mu_static, mu_dynamic, true});
  }
  void step(const Ground::Point& hip_m, Feel& feel) override {
    walker_->step(surface_->local(hip_m.data()));
    const ReferenceContact<long double>& contact = walker_->contact;
    feel = {};
    feel.god_object = hip_m;
    feel.in_contact = contact.state != FDCG_FREE;
    if (!feel.in_contact) return;
    const Vector<long double> depth = contact.god_object - contact.hip;
    const long double along[3] = {depth.x, depth.y, depth.z};
    for (std::size_t k = 0; k < 3; ++k) {
      feel.god_object[k] = static_cast<double>(hip_m[k] + along[k]);
      feel.force[k] = static_cast<double>(along[k]) * kStiffness_n_per_m;
    }
  }

 private:
  std::vector<std::byte> file_;
  fdcg_graph view_{};
  std::unique_ptr<ReferenceSurface<long double>> surface_;
  std::unique_ptr<ReferenceWalker<long double>> walker_;
};

// Across the top of a cube, over its edge, down its side, and off.
Motion over_an_edge(double rate_hz) {
  const double under = kHalf_m - kPress_m;
  return Motion(rate_hz, {-0.02, 0.004, kHalf_m + 0.01})
      .to({-0.02, 0.004, under}, 0.3)
      .hold(0.2)
      .to({kHalf_m + 0.012, -0.006, under}, 0.9)
      .to({under, -0.003, under - 0.02}, 0.5)
      .to({kHalf_m + 0.01, 0, under - 0.02}, 0.3);
}

// Into a groove of 60 degrees, along it with the hand going from wall to wall, and out.
Motion along_a_groove(double rate_hz) {
  return Motion(rate_hz, {-0.03, 0.002, 0.02})
      .to({-0.03, 0.001, -kPress_m}, 0.4)
      .hold(0.2)
      .to({0.03, 0, -kPress_m}, 1.2, {0, 4e-3, 0}, 3)
      .to({0.03, 0, 0.02}, 0.4);
}

// Into a corner of three walls, trembling there, and along one of its edges.
Motion into_a_corner(double rate_hz) {
  const Point deep = {-kPress_m, -kPress_m, -kPress_m};
  return Motion(rate_hz, {0.02, 0.018, 0.022})
      .to(deep, 0.4)
      .hold(0.2)
      .to(deep, 0.5, {5e-3, -3e-3, 4e-3}, 9)
      .to({0.02, -kPress_m, -kPress_m}, 0.4)
      .to({0.02, 0.02, 0.02}, 0.3);
}

// Around a ball of 80 facets.
Motion around_a_ball(double rate_hz) {
  constexpr double kAngle = 0.3;
  const double out = kHalf_m + 0.01, under = kHalf_m * 0.95 - kPress_m;
  Motion motion(rate_hz, {out, 0.001, 0.003});
  motion.to({under, 0.001, 0.003}, 0.3).hold(0.2);
  for (int i = 1; i <= 4; ++i)
    motion.to({under * std::cos(i * kAngle), under * std::sin(i * kAngle), 0.003}, 0.2);
  return motion.to({out * std::cos(4 * kAngle), out * std::sin(4 * kAngle), 0.003}, 0.3);
}

// On a plate of a millimetre, three times as deep as it is thick.
Motion on_a_plate(double rate_hz) {
  constexpr double kDeep_m = 0.01;
  return Motion(rate_hz, {-0.01, 0.002, 0.01})
      .to({-0.01, 0.002, -kDeep_m}, 0.4)
      .hold(0.2)
      .to({0.015, -0.004, -kDeep_m}, 0.6)
      .to({0.015, -0.004, 0.01}, 0.4);
}

}  // namespace

std::vector<HandScene> hand_scenes(double rate_hz) {
  const PolygonSoup block = body(cube(), kBody_m), groove = body(v_groove(std::numbers::pi / 3), kHalf_m),
                    pit = body(corner_pit(), kHalf_m), ball = body(geodesic_sphere(2), kHalf_m),
                    plate = body(thin_plate(0.01, 4), kBody_m);
  return {over_an_edge(rate_hz).scene("edge", "across a face and over an edge", block, false),
          over_an_edge(rate_hz).scene("edge_rubbed", "the same with friction", block, true),
          along_a_groove(rate_hz).scene("groove", "along a groove, from wall to wall", groove, false),
          along_a_groove(rate_hz).scene("groove_rubbed", "the same with friction", groove, true),
          into_a_corner(rate_hz).scene("corner", "a tremor in a corner of three walls", pit, false),
          around_a_ball(rate_hz).scene("ball", "around a ball of 80 facets", ball, false),
          around_a_ball(rate_hz).scene("ball_rubbed", "the same with friction", ball, true),
          on_a_plate(rate_hz).scene("plate", "on a plate, deeper than it is thick", plate, false)};
}

std::vector<HoldScene> hold_scenes() {
  constexpr double kDeep_m = 5e-3, kOut_m = 5e-3;
  const auto hold = [](const Point& outside, const Point& held) { return Hold{turned(outside), turned(held)}; };
  return {{"face", body(cube(), kBody_m), hold({0.011, 0.007, kHalf_m + kOut_m}, {0.011, 0.007, kHalf_m - kDeep_m})},
          {"beside_an_edge", body(cube(), kBody_m),
           hold({kHalf_m - 4e-3, 0.007, kHalf_m + kOut_m}, {kHalf_m - 4e-3, 0.007, kHalf_m - kDeep_m})},
          {"groove", body(v_groove(std::numbers::pi / 3), kHalf_m), hold({0.011, 7e-4, kOut_m}, {0.011, 0, -kDeep_m})},
          {"corner", body(corner_pit(), kHalf_m), hold({kOut_m, kOut_m, kOut_m}, {-3e-3, -2.5e-3, -3.5e-3})}};
}

std::unique_ptr<Contender> make_truth(const bake::PolygonSoup& soup) {
  return std::make_unique<TruthContender>(soup);
}

}  // namespace fdcg::test
