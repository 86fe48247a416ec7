// SPDX-License-Identifier: Apache-2.0
#include "hand_path.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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
constexpr double kFastest = 0.0005;   // of the object's size a tick, across the picture plane
constexpr double kMostDepth = 0.005;  // m: 5 N at the default stiffness, however large the object is
constexpr double kAbove = 0.1;        // of the size: where the hand starts above what it will touch
constexpr double kLowest = 0.25;      // of the size: how far it goes below, where the surface ends under it
constexpr int kProbeSteps = 300;      // from one side of the object to the other
constexpr int kProbes = 9;            // along the way of the hand

Vec operator+(const Vec& a, const Vec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator-(const Vec& a, const Vec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec operator*(double s, const Vec& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

// Where the hand wants to be in the picture, and how deep it presses, both in parts of the object's size.
struct Wish {
  double right, up, depth;
};
Wish wish_at(double t) {
  const double along = t / kStrokeTime, phase = 2 * std::numbers::pi * kStrokes * along;
  const double middle = 0.07 * along, reach = 0.13 - 0.05 * along;  // stays clear of the outline
  return {middle - reach * std::cos(phase), 0.02 - 0.18 * along, 0.0045 + 0.002 * std::sin(5 * std::numbers::pi * along)};
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

class Hand {
 public:
  explicit Hand(const fdcg_graph& graph) : graph_(graph), params_(fdcg_make_params()) {
    params_.mu_static = params_.mu_dynamic = 0;
    const fdcg_header& header = *graph.header;
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      centre_[i] = (0.5 * (header.bounds_min[i] + header.bounds_max[i]) + header.origin[i]) * header.metres_per_unit;
      const double side = (header.bounds_max[i] - header.bounds_min[i]) * header.metres_per_unit;
      square += side * side;
    }
    size_ = std::sqrt(square);
  }

  // The height at which a hand that comes straight down first touches; none where it passes by.
  [[nodiscard]] std::optional<double> probe(const View& view, double right, double up) const {
    fdcg_contact contact{};
    fdcg_result result{};
    for (int i = 0; i <= kProbeSteps; ++i) {
      const double height = (0.6 - 1.2 * i / kProbeSteps) * size_;
      const Vec hip = view.place(right, up, height);
      fdcg_step(&graph_, &params_, &contact, hip.data(), &result);
      if (result.state != FDCG_FREE) return height;
    }
    return std::nullopt;
  }

  // The first view and place whose whole way has something under it; otherwise the one with the most.
  [[nodiscard]] bool choose() {
    constexpr double kDegree = std::numbers::pi / 180;
    constexpr double kViews[][2] = {{25, 12}, {25, 80}, {115, 12}, {205, 12}, {295, 12}, {25, -80}};
    constexpr double kShifts[][2] = {{0, 0}, {0.15, 0.1}, {-0.15, 0.1}, {0, 0.25}, {0, -0.1}, {0.25, 0.1}, {-0.25, 0.1}};
    int most = 0;
    for (const auto& angles : kViews) {
      const View view = view_from(centre_, angles[0] * kDegree, angles[1] * kDegree);
      for (const auto& shift : kShifts) {
        int touched = 0;
        double start = 0;
        for (int i = 0; i < kProbes; ++i) {
          const Wish wish = wish_at(kStrokeTime * i / (kProbes - 1) * 0.97);
          const auto height = probe(view, (wish.right + shift[0]) * size_, (wish.up + shift[1]) * size_);
          if (i == 0 && !height) break;  // nothing where it would come down
          if (i == 0) start = *height;
          touched += height.has_value();
        }
        if (touched <= most) continue;
        most = touched;
        view_ = view;
        shift_ = {shift[0], shift[1]};
        touch_height_ = start;
        if (most == kProbes) return true;
      }
    }
    return most > 0;
  }

  // It goes over the plane as it wishes, and presses so that the spring of a frictionless contact keeps the wished length.
  [[nodiscard]] std::vector<TrajectoryPoint> path() const {
    std::vector<TrajectoryPoint> points;
    fdcg_contact contact{};
    fdcg_result result{};
    const double fastest = kFastest * size_;
    double height = touch_height_ + kAbove * size_, speed = 0, t = 0, touch_time = 0;
    bool touched = false;
    for (long tick = 0; !touched || t < touch_time + kStrokeTime + kLiftTime; ++tick) {
      t = static_cast<double>(tick) * kTick;
      const Wish wish = wish_at(touched ? std::min(t - touch_time, kStrokeTime) : 0);
      const Vec hip = view_.place((wish.right + shift_[0]) * size_, (wish.up + shift_[1]) * size_, height);
      points.push_back({t, hip});
      fdcg_step(&graph_, &params_, &contact, hip.data(), &result);
      if (!touched && result.state != FDCG_FREE) {
        touched = true;
        touch_time = t;
      }
      const Vec spring = Vec{result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]} - hip;
      const double depth = std::min(wish.depth * size_, kMostDepth * wish.depth / 0.0065);
      const double error = depth - std::hypot(spring[0], spring[1], spring[2]);
      const bool is_leaving = touched && t > touch_time + kStrokeTime;
      const double wanted = is_leaving ? fastest : -std::clamp(kFollow * error, -fastest, fastest);
      const double before = speed;
      speed += kEase * (wanted - before);
      height = std::max(height + speed, touch_height_ - kLowest * size_);
      if (!touched && height <= touch_height_ - kLowest * size_) return {};
    }
    return points;
  }

 private:
  const fdcg_graph& graph_;
  fdcg_params params_;
  Vec centre_{};
  double size_ = 0;  // the bounding box's diagonal, metres
  View view_{};
  std::array<double, 2> shift_{};
  double touch_height_ = 0;
};

}  // namespace

std::vector<TrajectoryPoint> slide_path(const fdcg_graph& graph, std::string* problem) {
  Hand hand(graph);
  std::vector<TrajectoryPoint> points;
  if (hand.choose()) points = hand.path();
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
