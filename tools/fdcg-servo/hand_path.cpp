// SPDX-License-Identifier: Apache-2.0
#include "hand_path.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace fdcg::servo {
namespace {

using Vec = std::array<double, 3>;

constexpr double kTick = 0.001;       // s
constexpr double kStrokeTime = 10;    // s on the surface
constexpr double kLiftTime = 0.3;     // s of leaving
constexpr double kStrokes = 4;        // there and back
constexpr double kFollow = 0.12;      // how much of the error in depth the hand would mend in a tick
constexpr double kEase = 0.4;         // how much of a change of its speed it manages in a tick
constexpr double kFastest = 0.0005;   // of the span a tick, across the picture plane
constexpr double kDepth = 0.0065;     // of the span: the largest depth
constexpr double kMostDepth = 0.005;  // m: 5 N at the default stiffness
constexpr double kAbove = 0.1;        // of the span: where the hand starts above what it will touch
constexpr double kLowest = 0.25;      // of the span: how far it goes below, where the surface ends under it
constexpr int kProbeSteps = 300;      // from one side of the object to the other
constexpr int kMostHalvings = 60;     // of a step of the probe

Vec operator+(const Vec& a, const Vec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator*(double s, const Vec& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

// Where the hand wants to be in the plane, in parts of the span, and how deep, in parts of the largest depth.
struct Wish {
  double right, up, depth;
};
Wish wish_at(double t) {
  const double along = t / kStrokeTime, phase = 2 * std::numbers::pi * kStrokes * along;
  const double middle = 0.07 * along, reach = 0.13 - 0.05 * along;  // stays clear of the outline
  return {middle - reach * std::cos(phase), 0.02 - 0.18 * along,
          (0.0045 + 0.002 * std::sin(5 * std::numbers::pi * along)) / kDepth};
}

// The plane that the hand moves over: right and up in it, toward the hand out of it.
struct View {
  Vec centre, right, up, toward;
  [[nodiscard]] Vec place(double r, double u, double height) const { return centre + r * right + u * up + height * toward; }
};

// Turned about y by so much, then tilted.
View view_from(const Vec& centre, double turn, double tilt) {
  const double st = std::sin(turn), ct = std::cos(turn), sl = std::sin(tilt), cl = std::cos(tilt);
  return {centre, {ct, 0, -st}, {-st * sl, cl, -ct * sl}, {st * cl, sl, ct * cl}};
}

// From where, and which part of the plane: its middle in parts of the object's size, and how far the hand goes in parts of the
// span.
struct Place {
  View view;
  double right = 0, up = 0, reach = 1;
};

// A path, and how it went.
struct Try {
  std::vector<TrajectoryPoint> points;
  std::uint64_t touching = 0;  // ticks
  double deepest = 0;          // the longest spring, in parts of the largest depth that was wished

  [[nodiscard]] bool stays_on() const { return static_cast<double>(touching) > 0.9 * kStrokeTime / kTick; }
  [[nodiscard]] bool is_good() const {
    constexpr double kDeepest = 2.5;
    return stays_on() && deepest < kDeepest;
  }
  [[nodiscard]] bool is_better_than(const Try& other) const {
    if (stays_on() != other.stays_on()) return stays_on();
    return stays_on() ? deepest < other.deepest : touching > other.touching;
  }
};

class Hand {
 public:
  explicit Hand(const fdcg_graph& graph) : graph_(graph), params_(fdcg_make_params()), with_friction_(fdcg_make_params()) {
    params_.mu_static = params_.mu_dynamic = 0;
    const fdcg_header& header = *graph.header;
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      centre_[i] = (0.5 * (header.bounds_min[i] + header.bounds_max[i]) + header.origin[i]) * header.metres_per_unit;
      const double side = (header.bounds_max[i] - header.bounds_min[i]) * header.metres_per_unit;
      square += side * side;
    }
    size_ = std::sqrt(square);
    span_ = std::min(size_, kMostDepth / kDepth);
  }

  // The hand goes over the plane as it wishes, and presses so that the spring of a frictionless contact keeps the wished
  // length. A second contact, with friction, tells how that would feel.
  [[nodiscard]] Try try_path(const Place& place) const {
    Try tried;
    const auto at = [&](const Wish& wish, double height) {
      return place.view.place(place.reach * wish.right * span_ + place.right * size_,
                              place.reach * wish.up * span_ + place.up * size_, height);
    };
    const std::optional<double> surface = probe([&](double height) { return at(wish_at(0), height); });
    if (!surface) return tried;
    fdcg_contact contact{}, felt{};
    fdcg_result result{}, felt_result{};
    const double fastest = kFastest * span_, lowest = *surface - kLowest * span_;
    double height = *surface + kAbove * span_, speed = 0, t = 0, touch_time = 0;
    bool has_touched = false;
    for (long tick = 0; !has_touched || t < touch_time + kStrokeTime + kLiftTime; ++tick) {
      t = static_cast<double>(tick) * kTick;
      const Wish wish = wish_at(has_touched ? std::min(t - touch_time, kStrokeTime) : 0);
      const Vec hip = at(wish, height);
      tried.points.push_back({t, hip});
      fdcg_step(&graph_, &params_, &contact, hip.data(), &result);
      fdcg_step(&graph_, &with_friction_, &felt, hip.data(), &felt_result);
      if (!has_touched && result.state != FDCG_FREE) {
        has_touched = true;
        touch_time = t;
      }
      tried.touching += felt_result.state != FDCG_FREE;
      tried.deepest = std::max(tried.deepest, distance(felt_result.god_object_m, hip) / largest_depth());
      const double error = wish.depth * largest_depth() - distance(result.god_object_m, hip);
      const bool is_leaving = has_touched && t > touch_time + kStrokeTime;
      const double wanted = is_leaving ? fastest : -std::clamp(kFollow * error, -fastest, fastest);
      speed += kEase * (wanted - speed);
      height = std::max(height + speed, lowest);
      if (!has_touched && height <= lowest) return {};
    }
    return tried;
  }

  // The first place where the hand stays on the surface and nowhere falls off an edge; otherwise the best of all.
  [[nodiscard]] std::vector<TrajectoryPoint> best_path() const {
    constexpr double kDegree = std::numbers::pi / 180;
    constexpr double kViews[][2] = {{25, 12}, {25, 80}, {115, 12}, {205, 12}, {295, 12}, {25, -80}};
    constexpr double kShifts[][2] = {{0, 0}, {0.15, 0.1}, {-0.15, 0.1}, {0, 0.25}, {0, -0.1}, {0.25, 0.1}, {-0.25, 0.1}};
    Try best;
    for (const double reach : {1.0, 0.6, 0.3}) {
      for (const auto& angles : kViews) {
        for (const auto& shift : kShifts) {
          Try tried = try_path({view_from(centre_, angles[0] * kDegree, angles[1] * kDegree), shift[0], shift[1], reach});
          if (tried.is_better_than(best)) best = std::move(tried);
          if (best.is_good()) return best.points;
        }
      }
    }
    return best.points;
  }

 private:
  // The height at which a hand that comes straight down first touches, to within a step of the span; none where it passes by.
  template <class At>
  [[nodiscard]] std::optional<double> probe(const At& at) const {
    constexpr double kPart = 1.2 / kProbeSteps;
    fdcg_contact contact{}, free{};
    fdcg_result result{};
    for (int i = 0; i <= kProbeSteps; ++i) {
      const double height = (0.6 - kPart * i) * size_;
      free = contact;
      fdcg_step(&graph_, &params_, &contact, at(height).data(), &result);
      if (result.state == FDCG_FREE) continue;
      double inside = height, outside = height + kPart * size_;
      for (int halving = 0; size_ > span_ && outside - inside > kPart * span_ && halving < kMostHalvings; ++halving) {
        const double middle = inside + (outside - inside) / 2;
        contact = free;
        fdcg_step(&graph_, &params_, &contact, at(middle).data(), &result);
        (result.state == FDCG_FREE ? outside : inside) = middle;
      }
      return inside;
    }
    return std::nullopt;
  }
  [[nodiscard]] double largest_depth() const { return kDepth * span_; }
  static double distance(const double (&a)[3], const Vec& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

  const fdcg_graph& graph_;
  fdcg_params params_, with_friction_;
  Vec centre_{};
  double size_ = 0;  // the bounding box's diagonal, metres
  double span_ = 0;  // metres that the hand moves over: the size, or of a large object a part that suits a hand
};

}  // namespace

std::vector<TrajectoryPoint> slide_path(const fdcg_graph& graph, std::string* problem) {
  std::vector<TrajectoryPoint> points = Hand(graph).best_path();
  if (points.empty()) *problem = "--path slide finds nothing to touch from any side; give a path with --trajectory";
  return points;
}

std::string trajectory_csv(const std::vector<TrajectoryPoint>& points) {
  std::string text = "t,x,y,z\n";
  const auto append = [&text](double value, char end) {
    char digits[40];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17).ptr);
    text += end;
  };
  for (const TrajectoryPoint& point : points) {
    append(point.t_s, ',');
    append(point.hip_object_m[0], ',');
    append(point.hip_object_m[1], ',');
    append(point.hip_object_m[2], '\n');
  }
  return text;
}

}  // namespace fdcg::servo
