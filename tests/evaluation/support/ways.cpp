// SPDX-License-Identifier: Apache-2.0
#include "ways.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "point.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

using namespace plain;

// In the plane, of unit length; any direction where nothing is left.
Point flattened(const Point& a, const Point& normal) {
  const Point along = unit(a - normal * dot(a, normal));
  return dot(along, along) > 0 ? along : Point{1, 0, 0};
}
Point direction(Random& random) {
  const bake::Vec3 d = random.direction();
  return {d.x, d.y, d.z};
}

constexpr double kTopSpeed_m_per_s = 0.49;
constexpr double kLift_m = 3e-3;        // above the surface, between contacts
constexpr double kHandKnot_s = 0.02;    // 10 Hz is half of 50 knots a second
constexpr double kFineKnot_s = 0.0025;  // of motions that are drawn along the mesh

// Where the control points of a uniform cubic B-spline come from, one after the other. The curve's speed never exceeds the
// distance of two neighbouring points over the knots' interval, and straight runs of points give straight lines.
class Pen {
 public:
  explicit Pen(double knot_s) : knot_s_(knot_s) {}
  virtual ~Pen() = default;
  virtual Point next() = 0;
  [[nodiscard]] double knot_s() const { return knot_s_; }

 private:
  double knot_s_;
};

// ---- hand ------------------------------------------------------------------------------------------------------------------

class HandPen : public Pen {
 public:
  HandPen(const Ground& ground, double depth_m, std::uint64_t seed)
      : Pen(kHandKnot_s), ground_(ground), random_(seed), depth_m_(depth_m) {
    const std::uint32_t corner = random_.below(static_cast<std::uint32_t>(ground.soup().points.size()));
    anchor_ = ground.closest(ground.corner(corner) + ground.corner_normal(corner) * kLift_m);
    heading_ = flattened(direction(random_), anchor_.feature_normal);
    walk(kLift_m);
    anchor_ = ground.closest(anchor_.point + anchor_.normal * kLift_m);
    normal_ = anchor_.feature_normal;
    last_ = anchor_.point + normal_ * kLift_m;
  }

  Point next() override {
    if (left_-- == 0) begin_action();
    constexpr double kEase = 0.3;  // of the way to what is wanted, a knot: a time constant of some 60 ms
    speed_ += kEase * (wanted_speed_ - speed_);
    deep_ += kEase * (wanted_deep_ - deep_);
    walk(speed_ * kHandKnot_s);
    // On an edge towards both faces, and more so to its own: else the hand would come to lie in the other one's plane.
    normal_ = unit(normal_ + unit(anchor_.normal + anchor_.feature_normal));
    const Point wanted = anchor_.point - normal_ * deep_;
    const Point step = wanted - last_;
    const double most = kTopSpeed_m_per_s * kHandKnot_s;
    last_ = length(step) > most ? last_ + step * (most / length(step)) : wanted;
    return last_;
  }

 private:
  void begin_action() {
    left_ = 15 + random_.below(45);  // 0.3 to 1.2 s
    if (touches_left_-- == 0) {      // lifts
      touches_left_ = 2 + random_.below(3);
      wanted_speed_ = random_.uniform(0, 0.2);
      wanted_deep_ = -kLift_m;
      left_ /= 2;
    } else if (random_.chance(0.25)) {  // presses
      wanted_speed_ = 0;
      wanted_deep_ = depth_m_ * random_.uniform(0.5, 2);
    } else {  // slides
      wanted_speed_ = kTopSpeed_m_per_s * std::pow(10, random_.uniform(-2, 0));
      wanted_deep_ = depth_m_ * random_.uniform(0.3, 1);
    }
    turn_ = random_.uniform(-0.2, 0.2);
  }

  // Along the surface in pieces short enough to go around edges, each pulled inwards a little: else an anchor would stay on a
  // convex edge for ever.
  void walk(double way_m) {
    constexpr double kPiece_m = 1e-3, kPull = 0.3;
    const Point side = cross(normal_, heading_);
    heading_ = unit(heading_ + side * turn_);
    for (double left = way_m; left > 0; left -= kPiece_m) {
      const double piece = std::min(left, kPiece_m);
      heading_ = flattened(heading_, anchor_.normal);
      anchor_ = ground_.closest(anchor_.point + heading_ * piece - anchor_.normal * (kPull * piece));
    }
  }

  const Ground& ground_;
  Random random_;
  double depth_m_, speed_ = 0, wanted_speed_ = 0, deep_ = -kLift_m, wanted_deep_ = -kLift_m, turn_ = 0;
  std::uint32_t left_ = 0, touches_left_ = 2;
  Ground::Closest anchor_;
  Point normal_{}, heading_{}, last_{};
};

// ---- along edges -----------------------------------------------------------------------------------------------------------

class EdgePen : public Pen {
 public:
  EdgePen(const Ground& ground, double depth_m, std::uint64_t seed)
      : Pen(kFineKnot_s), ground_(ground), random_(seed), depth_m_(depth_m) {
    do {
      to_ = random_.below(static_cast<std::uint32_t>(ground.soup().points.size()));
    } while (ground.neighbours(to_).empty());
    from_ = ground.neighbours(to_)[0];
    choose_edge();
  }

  Point next() override {
    constexpr double kWay_m = 0.1 * kFineKnot_s;  // 0.1 m/s, less where edges are short
    constexpr int kPieces = 4;                    // at least so many of an edge
    const Point a = ground_.corner(from_), b = ground_.corner(to_);
    const double edge = length(b - a);
    const Point normal = unit(ground_.corner_normal(from_) * (1 - done_) + ground_.corner_normal(to_) * done_);
    const Point on_edge = a + (b - a) * done_;
    done_ += std::min(kWay_m / edge, 1.0 / kPieces);
    if (done_ >= 1) choose_edge();
    return on_edge - normal * (depth_m_ * deep());
  }

 private:
  // Above the edge for a tenth of each second, smoothly.
  double deep() {
    constexpr int kPeriod = 400, kAbove = 40, kRamp = 10;
    const int phase = knot_++ % kPeriod;
    if (phase < kAbove) return -1;
    return std::min(1.0, -1 + 2.0 * std::min(phase - kAbove, kPeriod - phase) / kRamp);
  }

  // On to a neighbour, rather straight on than round a sharp bend, back only from a dead end.
  void choose_edge() {
    const Point ahead = unit(ground_.corner(to_) - ground_.corner(from_));
    std::uint32_t best = from_;
    double best_score = -10;
    for (const std::uint32_t other : ground_.neighbours(to_)) {
      if (other == from_) continue;
      const double score = dot(unit(ground_.corner(other) - ground_.corner(to_)), ahead) + random_.unit();
      if (score > best_score) best = other, best_score = score;
    }
    from_ = to_;
    to_ = best;
    done_ = 0;
  }

  const Ground& ground_;
  Random random_;
  double depth_m_, done_ = 0;
  std::uint32_t from_ = 0, to_ = 0;
  int knot_ = 0;
};

// ---- visits to corners -----------------------------------------------------------------------------------------------------

// From above a corner into it, there for a while, out again and through the air to the next.
class CornerPen : public Pen {
 public:
  CornerPen(const Ground& ground, double depth_m, double stay_s, std::uint64_t seed)
      : Pen(kFineKnot_s), ground_(ground), random_(seed), depth_m_(depth_m), stay_(static_cast<int>(stay_s / kFineKnot_s)) {}

  Point next() override {
    if (knot_ == 0) begin_visit();
    const int knot = knot_++;
    if (knot < flight_) {
      const double part = static_cast<double>(knot) / flight_;
      return lifted(start_ * (1 - part) + top() * part);
    }
    const int in_visit = knot - flight_, from_end = 2 * kDive + stay_ - in_visit;
    if (from_end == 0) {
      start_ = top();
      knot_ = 0;
    }
    const double part = std::clamp(static_cast<double>(std::min(in_visit, from_end)) / kDive, 0.0, 1.0);
    return ground_corner() + in_place(in_visit) + normal() * (kLift_m * (1 - part) - deep_ * part) + aside_;
  }

 protected:
  virtual std::uint32_t choose_corner() {
    constexpr int kCandidates = 16;
    std::uint32_t best = 0;
    double best_sharpness = -1;
    for (int i = 0; i < kCandidates; ++i) {
      const std::uint32_t corner = random_.below(static_cast<std::uint32_t>(ground_.soup().points.size()));
      if (const double sharp = std::abs(rise(corner)); sharp > best_sharpness) best = corner, best_sharpness = sharp;
    }
    return best;
  }
  // Added to the place in the corner, `knot` knots after the dive began.
  virtual Point in_place(int) { return {}; }

  // Of the edge that rises most from the corner's tangent plane (concave, positive) or falls most (convex, negative): its sine.
  [[nodiscard]] double rise(std::uint32_t corner) const {
    double most = 0;
    for (const std::uint32_t other : ground_.neighbours(corner)) {
      const double sine = dot(unit(ground_.corner(other) - ground_.corner(corner)), ground_.corner_normal(corner));
      if (std::abs(sine) > std::abs(most)) most = sine;
    }
    return most;
  }
  [[nodiscard]] const Ground& ground() const { return ground_; }
  [[nodiscard]] Random& random() { return random_; }
  [[nodiscard]] Point ground_corner() const { return ground_.corner(corner_); }
  [[nodiscard]] const Point& normal() const { return ground_.corner_normal(corner_); }

 private:
  static constexpr int kDive = 40;  // knots from the top into the corner: 0.1 s

  [[nodiscard]] Point top() const { return ground_corner() + normal() * kLift_m; }
  [[nodiscard]] Point lifted(const Point& point) const {
    const Ground::Closest found = ground_.closest(point);
    const double height = dot(point - found.point, found.feature_normal);
    return height < kLift_m ? found.point + found.feature_normal * kLift_m : point;
  }
  void begin_visit() {
    constexpr double kFlight_m_per_s = 0.4;
    corner_ = choose_corner();
    deep_ = depth_m_ * random_.uniform(0.3, 1.5);
    aside_ = random_.chance(0.5) ? Point{} : direction(random_) * (0.05 * depth_m_);
    if (is_first_) start_ = top();
    is_first_ = false;
    flight_ = 1 + static_cast<int>(length(top() - start_) / (kFlight_m_per_s * kFineKnot_s));
  }

  const Ground& ground_;
  Random random_;
  double depth_m_, deep_ = 0;
  int stay_, knot_ = 0, flight_ = 0;
  bool is_first_ = true;
  std::uint32_t corner_ = 0;
  Point start_{}, aside_{};
};

class TremorPen : public CornerPen {
 public:
  TremorPen(const Ground& ground, double depth_m, std::uint64_t seed) : CornerPen(ground, depth_m, 1, seed) {
    for (double& f : frequency_hz_)
      f = random().uniform(8, 12);
  }

 private:
  std::uint32_t choose_corner() override {
    constexpr int kCandidates = 64;
    std::uint32_t best = 0;
    double best_rise = -10;
    for (int i = 0; i < kCandidates; ++i) {
      const std::uint32_t corner = random().below(static_cast<std::uint32_t>(ground().soup().points.size()));
      if (const double r = rise(corner); r > best_rise) best = corner, best_rise = r;
    }
    return best;
  }
  Point in_place(int knot) override {
    constexpr double kAmplitude_m = 2e-4;
    Point offset;
    for (std::size_t k = 0; k < 3; ++k)
      offset[k] = kAmplitude_m * std::sin(2 * std::numbers::pi * frequency_hz_[k] * knot * kFineKnot_s);
    return offset;
  }

  std::array<double, 3> frequency_hz_{};
};

class OrbitPen : public CornerPen {
 public:
  OrbitPen(const Ground& ground, double depth_m, std::uint64_t seed) : CornerPen(ground, depth_m, 2, seed) {
    std::vector<std::uint32_t> corners(ground.soup().points.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i)
      corners[i] = i;
    const std::size_t kept = std::min<std::size_t>(corners.size(), 4);
    std::partial_sort(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(kept), corners.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                        const std::size_t va = ground.neighbours(a).size(), vb = ground.neighbours(b).size();
                        return va != vb ? va > vb : a < b;
                      });
    // those of as many edges as the second busiest; a single busy one is visited alone
    const auto valence = [&](std::size_t i) { return ground.neighbours(corners[i]).size(); };
    busiest_.assign(corners.begin(),
                    corners.begin() + (kept > 1 && 2 * valence(1) < valence(0) ? 1 : static_cast<std::ptrdiff_t>(kept)));
  }

 private:
  std::uint32_t choose_corner() override { return busiest_[next_++ % busiest_.size()]; }
  Point in_place(int knot) override {
    constexpr double kTurns_hz = 5, kSwell_hz = 0.7, kLeast_m = 2e-5, kMost_m = 2e-3;
    const double t = knot * kFineKnot_s, angle = 2 * std::numbers::pi * kTurns_hz * t;
    const double swell = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * kSwell_hz * t);
    const double radius = kLeast_m * std::pow(kMost_m / kLeast_m, swell);
    const Point u = flattened(std::abs(normal()[0]) < 0.8 ? Point{1, 0, 0} : Point{0, 1, 0}, normal());
    const Point v = cross(normal(), u);
    const Point around = ground_corner() + u * (radius * std::cos(angle)) + v * (radius * std::sin(angle));
    return ground().closest(around).point - ground_corner();
  }

  std::vector<std::uint32_t> busiest_;
  std::size_t next_ = 0;
};

// ---- sampling --------------------------------------------------------------------------------------------------------------

Way sampled(Pen& pen, double rate_hz, std::uint32_t ticks) {
  Way way;
  way.reserve(ticks);
  std::array<Point, 4> p;
  p[0] = p[1] = p[2] = pen.next();  // at rest in the beginning
  p[3] = pen.next();
  std::uint64_t knot = 0;
  for (std::uint32_t i = 0; i < ticks; ++i) {
    const double at = i / (rate_hz * pen.knot_s());
    const auto wanted = static_cast<std::uint64_t>(at);
    for (; knot < wanted; ++knot)
      p = {p[1], p[2], p[3], pen.next()};
    const double u = at - static_cast<double>(wanted), v = 1 - u;
    way.push_back(p[0] * (v * v * v / 6) + p[1] * ((3 * u * u * u - 6 * u * u + 4) / 6) +
                  p[2] * ((3 * v * v * v - 6 * v * v + 4) / 6) + p[3] * (u * u * u / 6));
  }
  return way;
}

Way teleports(const Ground& ground, const WayOptions& options) {
  constexpr double kReach = 1.2;  // of the bounds
  const std::uint32_t hold = std::max(1u, options.hold_ticks);
  Random random(options.seed);
  Way way;
  Point p{};
  for (std::uint32_t i = 0; i < options.ticks; ++i) {
    if (i % hold != 0) {
      way.push_back(p);
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = (ground.low()[k] + ground.high()[k]) / 2, half = (ground.high()[k] - ground.low()[k]) / 2;
      p[k] = middle + kReach * half * (i == 0 ? 1 : random.uniform(-1, 1));
    }
    way.push_back(p);
  }
  return way;
}

}  // namespace

const char* name_of(WayKind kind) {
  for (const WayName& way : kWays) {
    if (way.kind == kind) return way.name;
  }
  return "?";
}

WayKind way_named(const std::string& name) {
  std::string names;
  for (const WayName& way : kWays) {
    if (way.name == name) return way.kind;
    names += (names.empty() ? "" : ", ") + std::string(way.name);
  }
  throw std::invalid_argument("no way '" + name + "'; there are: " + names);
}

Way make_way(const Ground& ground, const WayOptions& options) {
  if (!(options.rate_hz > 0)) throw std::invalid_argument("a way's rate must be positive");
  const auto drawn = [&](Pen&& pen) { return sampled(pen, options.rate_hz, options.ticks); };
  switch (options.kind) {
    case WayKind::hand:
      return drawn(HandPen(ground, options.depth_m, options.seed));
    case WayKind::edge_slide:
      return drawn(EdgePen(ground, options.depth_m, options.seed));
    case WayKind::corner_dive:
      return drawn(CornerPen(ground, options.depth_m, 0.05, options.seed));
    case WayKind::fan_orbit:
      return drawn(OrbitPen(ground, options.depth_m, options.seed));
    case WayKind::tremor:
      return drawn(TremorPen(ground, options.depth_m, options.seed));
    case WayKind::quantised: {
      Way way = drawn(HandPen(ground, options.depth_m, options.seed));
      for (Point& p : way) {
        for (double& c : p)
          c = std::round(c / options.quantum_m) * options.quantum_m;
      }
      return way;
    }
    case WayKind::teleport:
      return teleports(ground, options);
  }
  throw std::invalid_argument("a kind of way that is not in the table");
}

}  // namespace fdcg::test
