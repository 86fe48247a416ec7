// SPDX-License-Identifier: Apache-2.0
#include "hand.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pointed_bodies.hpp"

namespace fdcg::test {
namespace {

Hip plus(const Hip& a, const Hip& b, double s) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
Hip between(const Hip& a, const Hip& b, double part) {
  return plus(a, difference(b, a), part);
}
Hip cross(const Hip& a, const Hip& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Hip unit(const Hip& a) {
  const double length = norm(a);
  return length > 0 ? plus({}, a, 1 / length) : Hip{1, 0, 0};
}

// Ticks of each motion.
constexpr std::uint32_t kTicks[] = {1000, 600, 500, 400, 400, 240, 5, 8, 800, 1000, 300, 400, 110};
static_assert(std::size(kTicks) == static_cast<std::size_t>(Motion::count));
constexpr std::string_view kNames[] = {"wander", "slide",   "tremor", "dive",   "on-planes",  "creep",   "aim",
                                       "jump",   "encoder", "object", "inside", "not-finite", "approach"};
static_assert(std::size(kNames) == static_cast<std::size_t>(Motion::count));

}  // namespace

std::string_view name_of(Motion motion) {
  return kNames[static_cast<std::size_t>(motion)];
}

Hand::Hand(const Specimen& specimen, std::uint64_t seed)
    : specimen_(specimen), random_(seed), walk_(specimen.body.soup, seed ^ 0x5DEECE66Du) {
  const fdcg_header& h = specimen.header();
  is_float_ = h.real_bytes == sizeof(float);
  for (std::size_t i = 0; i < 3; ++i) {
    middle_[i] = (h.bounds_min[i] + h.bounds_max[i]) / 2;
    size_ = std::max(size_, (h.bounds_max[i] - h.bounds_min[i]) / 2);
  }
}

std::uint32_t Hand::begin(Motion motion) {
  motion_ = motion;
  tick_ = 0;
  stay_ = 0;
  pick_side();
  corner_ = some_corner();
  anchor_ = specimen_.corners[corner_].point;
  normal_ = unit(specimen_.corners[corner_].normal);
  heading_ = direction();
  depth_ = share(-5, -0.5);
  amount_ = share(-4, -1.5);
  phase_ = random_.uniform(0, 6.283);
  place_ = around(middle_, 2.5 * size_);
  if (motion == Motion::creep) anchor_ = surface_point();
  if (motion == Motion::encoder)
    amount_ = random_.chance(0.5) ? std::exp2(std::floor(std::log2(size_)) - 5 - random_.below(7))
                                  : size_ * random_.uniform(1e-4, 1e-2);
  if (motion == Motion::approach) begin_approach();
  if (motion == Motion::object) anchor_ = around(surface_point(), share(-4, -0.5));
  return kTicks[static_cast<std::size_t>(motion)];
}

Hip Hand::metres(const Hip& local) const {
  const fdcg_header& h = specimen_.header();
  Hip m;
  for (std::size_t i = 0; i < 3; ++i)
    m[i] = (local[i] + h.origin[i]) * h.metres_per_unit;
  return m;
}

Hip Hand::next(const Hip& god_object, bool is_free) {
  Hip hip;
  if (motion_ == Motion::wander || (motion_ == Motion::inside && tick_ > 0)) {
    hip = wander(god_object);
  } else if (motion_ == Motion::not_finite) {
    hip = random_.chance(0.1) ? not_finite() : wander(god_object);
  } else {
    hip = metres(local_next(god_object, is_free));
  }
  ++tick_;
  return hip;
}

Hip Hand::wander(const Hip& god_object) {  // in source units
  const fdcg_header& h = specimen_.header();
  Hip hip = walk_.next({god_object[0] + h.origin[0], god_object[1] + h.origin[1], god_object[2] + h.origin[2]});
  for (double& x : hip)
    x *= h.metres_per_unit;
  return hip;
}

Hip Hand::local_next(const Hip& god_object, bool is_free) {
  switch (motion_) {
    case Motion::slide:
      return slide(god_object, is_free);
    case Motion::tremor:
      return tremor();
    case Motion::dive:
      return dive();
    case Motion::on_planes:
      return on_planes();
    case Motion::creep:
      return creep();
    case Motion::aim:
      return aim();
    case Motion::jump:
      return jump();
    case Motion::encoder:
      return encoder(is_free);
    case Motion::object:
      return object();
    case Motion::approach:
      return way_[std::min<std::size_t>(tick_, way_.size() - 1)];
    default:
      return inside_point();
  }
}

void Hand::begin_approach() {
  constexpr double kSpeeds[] = {0.1, 0.3, 1};
  const auto& focus = specimen_.focus_corners;
  const CornerShape& tip = specimen_.corners[focus[random_.below(static_cast<std::uint32_t>(focus.size()))]];
  const Approach approach = kApproaches[random_.below(std::size(kApproaches))];
  way_ = hand_way({tip.point, unit(tip.normal)}, approach, kSpeeds[random_.below(3)], random_);
}

// ---- what motions share ----------------------------------------------------------------------------------------------------

Hip Hand::direction() {
  const bake::Vec3 d = random_.direction();
  return {d.x, d.y, d.z};
}
Hip Hand::around(const Hip& p, double length) {
  return plus(p, direction(), length);
}
double Hand::share(double low, double high) {
  return size_ * std::exp2(random_.uniform(low, high) * 3.321928094887362);
}
Hip Hand::anywhere(double sizes) {
  Hip p = middle_;
  for (double& x : p)
    x += sizes * size_ * random_.uniform(-1, 1);
  return p;
}

void Hand::pick_side() {
  node_ = random_.below(static_cast<std::uint32_t>(specimen_.nodes.size()));
  const fdcg_graph& g = specimen_.graph();
  side_ = random_.below(specimen_.nodes[node_].side_count);
  corner_ = fdcg_get_side(&g, node_, side_).corner;
}

std::uint32_t Hand::some_corner() {
  const auto& focus = specimen_.focus_corners;
  if (!focus.empty() && random_.chance(0.6)) return focus[random_.below(static_cast<std::uint32_t>(focus.size()))];
  return random_.below(static_cast<std::uint32_t>(specimen_.corners.size()));
}

// On a corner, an edge (at dyadic parts or anywhere) or a face.
Hip Hand::surface_point() {
  pick_side();
  const fdcg_graph& g = specimen_.graph();
  const std::uint32_t count = specimen_.nodes[node_].side_count;
  const Hip& a = specimen_.corners[corner_].point;
  const Hip& b = specimen_.corners[fdcg_get_side(&g, node_, (side_ + 1) % count).corner].point;
  const Hip& c = specimen_.corners[fdcg_get_side(&g, node_, (side_ + 2) % count).corner].point;
  switch (random_.below(4)) {
    case 0:
      return specimen_.corners[some_corner()].point;
    case 1:
      return between(a, b, random_.below(17) / 16.0);
    case 2:
      return between(a, b, random_.unit());
    default:
      return between(between(a, b, random_.unit()), c, random_.unit());
  }
}

Hip Hand::inside_point() {
  const Hip p = surface_point();
  return between(p, surface_point(), random_.uniform(0.2, 0.8));
}

// Off by some units in the last place, or not at all.
Hip Hand::nudged(Hip p) {
  if (random_.chance(0.4)) return p;
  for (double& x : p) {
    const std::uint32_t n = random_.below(3);
    const double sign = random_.chance(0.5) ? 1 : -1;
    if (std::abs(x) < 1e-9 * size_) {  // numbers near zero are closer than any rounding of the body's
      x += sign * n * (is_float_ ? 0x1p-25 : 0x1p-54) * size_;
      continue;
    }
    for (std::uint32_t k = 0; k < n; ++k) {
      x = is_float_ ? static_cast<double>(std::nextafter(static_cast<float>(x), static_cast<float>(sign * INFINITY)))
                    : std::nextafter(x, sign * INFINITY);
    }
  }
  return p;
}

// ---- motions ---------------------------------------------------------------------------------------------------------------

Hip Hand::slide(const Hip& god_object, bool is_free) {
  if (is_free && (stay_ == 0 || tick_ == 0)) {  // come down on a face
    pick_side();
    place_ = surface_point();
    normal_ = specimen_.nodes[node_].normal;
    heading_ = direction();
    stay_ = 4 + random_.below(3);
  }
  if (stay_ > 0) {
    --stay_;
    return plus(place_, normal_, stay_ > 1 ? 0.02 * size_ * stay_ : -depth_);
  }
  if (is_free) return place_;
  // Out of the surface, as the spring has it, and on along it.
  const Hip spring = difference(god_object, place_);
  if (dot(spring, spring) > 0) normal_ = unit(spring);
  if (random_.chance(0.03)) heading_ = direction();
  if (random_.chance(0.01)) depth_ = share(-6, -0.5);
  const Hip along = plus(heading_, normal_, -dot(heading_, normal_));
  place_ = plus(plus(god_object, normal_, -depth_), along, amount_);
  return place_;
}

Hip Hand::tremor() {
  constexpr double kTremor = 0.002;  // 0.2 mm of 0.1 m
  if (tick_ < 4) return plus(anchor_, normal_, size_ * (0.2 - 0.05 * tick_));
  if (random_.chance(0.01)) phase_ = random_.uniform(-1.5, 3);
  if (tick_ > 100 && random_.chance(0.02)) return plus(anchor_, normal_, 0.02 * size_);  // lifts, and comes back
  return plus(plus(anchor_, normal_, -phase_ * 0.001 * size_), direction(), kTremor * size_ * random_.unit());
}

Hip Hand::dive() {
  if (tick_ < 3) return plus(anchor_, normal_, size_ * (0.3 - 0.1 * tick_));
  const Hip u = unit(cross(normal_, heading_)), v = cross(normal_, u);
  if (random_.chance(0.02)) amount_ = share(-8, -0.5) * (random_.chance(0.2) ? 0 : 1);
  if (random_.chance(0.02)) depth_ = share(-8, -0.3);
  if (random_.chance(0.1)) place_[0] = random_.uniform(-1, 1);  // radians a tick
  phase_ += place_[0];
  return plus(plus(plus(anchor_, normal_, -depth_), u, amount_ * std::cos(phase_)), v, amount_ * std::sin(phase_));
}

Hip Hand::on_planes() {
  const fdcg_graph& g = specimen_.graph();
  if (stay_ == 0) {  // another place, or the same edge's other face
    stay_ = 10 + random_.below(40);
    const std::uint32_t across = fdcg_get_side(&g, node_, side_).across;
    if (random_.chance(0.4) && across != FDCG_NONE) {
      node_ = across;
      side_ = random_.below(specimen_.nodes[node_].side_count);
    } else {
      pick_side();
    }
    depth_ = share(-6, -0.7);
    amount_ = random_.below(9) / 8.0;
  }
  --stay_;
  const NodeShape& node = specimen_.nodes[node_];
  const Rim& rim = specimen_.rims[node.first_side + side_];
  const Hip& a = specimen_.corners[fdcg_get_side(&g, node_, side_).corner].point;
  const Hip& b = specimen_.corners[fdcg_get_side(&g, node_, (side_ + 1) % node.side_count).corner].point;
  const Hip on_edge = between(a, b, amount_);
  switch (random_.below(10)) {
    case 0:
      return nudged(on_edge);
    case 1:
      return plus(on_edge, node.normal, depth_);
    case 2:
      return nudged(plus(on_edge, node.normal, -depth_));  // on the Voronoi plane, behind the face
    case 3:
      return plus(plus(on_edge, node.normal, -depth_), rim.normal, depth_ * random_.uniform(-1, 1));
    case 4:
      return nudged(plus(on_edge, rim.normal, depth_ * random_.uniform(-2, 2)));  // on the face's plane
    case 5:
      amount_ = random_.chance(0.5) ? random_.below(9) / 8.0 : random_.unit();  // slides along
      return plus(between(a, b, amount_), node.normal, -depth_);
    case 6:
      depth_ *= random_.chance(0.5) ? 0.5 : 2;
      return plus(on_edge, node.normal, -depth_);
    case 7:
      return plus(a, node.normal, random_.chance(0.5) ? -depth_ : depth_);
    default:
      return place_ = random_.chance(0.5) ? place_ : plus(on_edge, node.normal, -depth_);  // held
  }
}

Hip Hand::creep() {
  const double step = size_ * (is_float_ ? 0x1p-24 : 1e-12);
  const double beside = tick_ == 0 ? 100 : 60 - static_cast<double>(tick_ % 120);  // there, through, and back again
  return plus(anchor_, heading_, (tick_ / 120 % 2 == 0 ? beside : -beside) * step);
}

Hip Hand::aim() {
  if (tick_ == 0) return place_ = anywhere(2);
  const Hip target = surface_point();
  switch (random_.below(5)) {
    case 0:
      return place_ = nudged(target);
    case 1:
      return place_ = nudged(between(place_, target, 1 + std::exp2(random_.uniform(-50, 1))));
    case 2: {  // through it exactly where the numbers allow: as far beyond
      const Hip step = difference(target, place_);
      return place_ = plus(target, step, random_.chance(0.5) ? 1 : 0.5);
    }
    case 3:
      return place_ = anywhere(2);
    default:
      return place_ = nudged(between(target, surface_point(), random_.uniform(-0.5, 1.5)));
  }
}

Hip Hand::jump() {
  const double far = random_.chance(0.1) ? std::exp2(random_.uniform(0, 20)) : 1;
  if (tick_ == 0 || random_.chance(0.2)) return place_ = around(middle_, 2.5 * far * size_);
  const Hip through = surface_point();
  return place_ = plus(through, difference(through, place_), random_.chance(0.5) ? 1 : random_.uniform(0.1, 3) * far);
}

Hip Hand::encoder(bool is_free) {
  if (tick_ == 0) place_ = around(middle_, 1.8 * size_);
  const Hip goal = is_free ? middle_ : heading_;
  if (random_.chance(0.02)) heading_ = anywhere(1.5);
  for (std::size_t i = 0; i < 3; ++i) {
    const double pull = is_free ? 0.05 : 0.02;
    place_[i] += (goal[i] - place_[i]) * pull + amount_ * (static_cast<double>(random_.below(7)) - 3);
  }
  Hip hip;
  for (std::size_t i = 0; i < 3; ++i)
    hip[i] = std::round(place_[i] / amount_) * amount_;
  return hip;
}

// The hand stands still in the world at anchor_; the object swings about an axis through its middle, and rises.
Hip Hand::object() {
  const double t = tick_;
  const double angle = 0.5 * std::sin(0.004 * t + phase_) + amount_ / size_ * t;
  const Hip moved = plus(anchor_, normal_, size_ * 0.4 * std::cos(0.003 * t));
  const Hip r = difference(moved, middle_);
  const double c = std::cos(angle), s = std::sin(angle), along = dot(heading_, r) * (1 - c);
  const Hip across = cross(heading_, r);
  Hip hip = middle_;
  for (std::size_t i = 0; i < 3; ++i)
    hip[i] += r[i] * c + across[i] * s + heading_[i] * along;
  return hip;
}

Hip Hand::not_finite() {
  constexpr double kOdd[] = {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::max(),
                             1e160,
                             -1e69,
                             1e60,
                             1e9,
                             std::numeric_limits<double>::denorm_min(),
                             1e-310,
                             -0.0};
  Hip hip = metres(surface_point());
  for (std::uint32_t n = 1 + random_.below(3); n > 0; --n)
    hip[random_.below(3)] = kOdd[random_.below(std::size(kOdd))];
  return hip;
}

}  // namespace fdcg::test
