// SPDX-License-Identifier: Apache-2.0
// A finger-proxy as the reference of CHAI3D describes its own: a ball of a radius that is swept towards the hand through a tree
// of boxes, in doubles; an epsilon that it keeps from what it touches; up to three contacts, of which one is worked out a tick;
// a cone of friction by which its goal comes nearer. Written from that description alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <new>
#include <vector>

#include "fdcg_rival.h"

namespace {

constexpr double kRadius_m = 2e-6, kEpsilon_m = 1e-6;  // of bodies of 0.1 m
constexpr std::uint32_t kLeaf = 4;                     // triangles

using Point = std::array<double, 3>;

Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point operator*(const Point& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}
double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Point& a) {
  return std::sqrt(dot(a, a));
}

struct Triangle {
  Point corners[3], normal;  // of unit length; 0: it has no area
};

struct Box {  // of triangles first..last, or of the two boxes `next`, `next` + 1
  Point low, high;
  std::uint32_t first = 0, last = 0, next = 0;
};

struct Hit {
  double part = 2;  // of the way; over 1: none
  Point normal{};   // from what is met to the ball
};

class Proxy {
 public:
  Proxy(const fdcg_rival_mesh& mesh, double stiffness_n_per_m) : stiffness_n_per_m_(stiffness_n_per_m) {
    for (std::uint64_t t = 0; t < mesh.triangle_count; ++t) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const double* p = mesh.points_m + 3 * std::uint64_t{mesh.corners[3 * t + k]};
        triangle.corners[k] = {p[0], p[1], p[2]};
      }
      triangle.normal = cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
      if (const double area = length(triangle.normal); area > 0) triangle.normal = triangle.normal * (1 / area);
      triangles_.push_back(triangle);
    }
    boxes_.push_back({{}, {}, 0, static_cast<std::uint32_t>(triangles_.size()), 0});
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      divide(i);
  }
  void reset() { is_started_ = false, is_touching_ = false, contacts_ = 0; }
  void set_friction(double mu_static, double mu_dynamic) { mu_static_ = mu_static, mu_dynamic_ = mu_dynamic; }
  [[nodiscard]] std::uint64_t memory() const { return triangles_.size() * sizeof(Triangle) + boxes_.size() * sizeof(Box); }

  void step(const Point& hip, fdcg_rival_result& result) {
    if (!is_started_) at_ = hip;
    is_started_ = true;
    if (contacts_ == 2 && dot(hip - at_, normals_[1]) >= 0) contacts_ = 1;  // it would pull
    if (contacts_ >= 1 && dot(hip - at_, normals_[0]) >= 0) contacts_ = 0;
    switch (contacts_) {
      case 0:
        is_touching_ = go(hip);
        break;
      case 1:
        go(with_friction(hip, at_ + tangential(hip - at_)));
        break;
      default: {
        const Point line = cross(normals_[0], normals_[1]);
        const double square = dot(line, line);
        if (square > 0) go(with_friction(hip, at_ + line * (dot(hip - at_, line) / square)));
        contacts_ = 0;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double offset = is_touching_ ? at_[k] - hip[k] : 0;
      result.god_object_m[k] = hip[k] + offset;
      result.force_n[k] = stiffness_n_per_m_ * offset;
    }
    result.is_in_contact = is_touching_;
    result.reserved = 0;
  }

 private:
  [[nodiscard]] Point tangential(const Point& way) const { return way - normals_[0] * dot(way, normals_[0]); }

  // Within the static cone it stays; beyond it slides as far as to the rim of the dynamic one.
  [[nodiscard]] Point with_friction(const Point& hip, const Point& goal) const {
    const double pressed = -dot(hip - at_, normals_[0]), along = length(goal - at_);
    if (mu_static_ == 0 || !(along > 0)) return goal;
    if (along <= mu_static_ * pressed) return at_;
    return at_ + (goal - at_) * std::max(0.0, 1 - mu_dynamic_ * pressed / along);
  }

  // As far as the goal or epsilon before what is met; whether anything is. The next tick then looks at one contact more.
  bool go(const Point& goal) {
    const Hit hit = sweep(at_, goal);
    if (hit.part > 1) {
      at_ = goal;
      contacts_ = 0;
      return false;
    }
    at_ = at_ + (goal - at_) * hit.part + hit.normal * kEpsilon_m;
    normals_[std::min<std::size_t>(contacts_, 1)] = hit.normal;
    ++contacts_;
    return true;
  }

  void divide(std::size_t i) {
    Box& box = boxes_[i];
    box.low.fill(HUGE_VAL), box.high.fill(-HUGE_VAL);
    for (std::uint32_t t = box.first; t < box.last; ++t) {
      for (const Point& p : triangles_[t].corners) {
        for (std::size_t k = 0; k < 3; ++k)
          box.low[k] = std::min(box.low[k], p[k] - kRadius_m), box.high[k] = std::max(box.high[k], p[k] + kRadius_m);
      }
    }
    if (box.last - box.first <= kLeaf) return;
    const Point size = box.high - box.low;
    const auto axis = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    const auto centre = [&](const Triangle& t) { return t.corners[0][axis] + t.corners[1][axis] + t.corners[2][axis]; };
    const std::uint32_t first = box.first, last = box.last, middle = first + (last - first) / 2;
    std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + last,
                     [&](const Triangle& a, const Triangle& b) { return centre(a) < centre(b); });
    box.next = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back({{}, {}, first, middle, 0});
    boxes_.push_back({{}, {}, middle, last, 0});
  }

  [[nodiscard]] Hit sweep(const Point& from, const Point& to) const {
    Hit hit;
    std::uint32_t waiting[64], count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const Box& box = boxes_[waiting[--count]];
      double enters = 0, leaves = std::min(hit.part, 1.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const double way = to[k] - from[k];
        if (way == 0) {
          if (from[k] < box.low[k] || from[k] > box.high[k]) leaves = -1;
          continue;
        }
        const double a = (box.low[k] - from[k]) / way, b = (box.high[k] - from[k]) / way;
        enters = std::max(enters, std::min(a, b)), leaves = std::min(leaves, std::max(a, b));
      }
      if (enters > leaves) continue;
      if (box.next != 0) {
        waiting[count++] = box.next, waiting[count++] = box.next + 1;
        continue;
      }
      for (std::uint32_t t = box.first; t < box.last; ++t)
        meet(triangles_[t], from, to, hit);
    }
    return hit;
  }

  // The ball against face, sides and corners; from in front of the face alone.
  static void meet(const Triangle& t, const Point& from, const Point& to, Hit& hit) {
    const Point way = to - from;
    const double height = dot(from - t.corners[0], t.normal) - kRadius_m, falls = dot(way, t.normal);
    if (!(falls < 0) || height < -kRadius_m) return;
    const double part = std::max(0.0, -height / falls);
    if (part < hit.part && part <= 1) {
      const Point foot = from + way * part - t.normal * kRadius_m;
      bool is_over = true;
      for (std::size_t k = 0; k < 3; ++k)
        is_over = is_over && dot(cross(t.corners[(k + 1) % 3] - t.corners[k], t.normal), foot - t.corners[k]) <= 0;
      if (is_over) {
        hit = {part, t.normal};
        return;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = t.corners[k], &b = t.corners[(k + 1) % 3];
      meet_rod(a, b - a, from, way, hit);
      meet_rod(a, {}, from, way, hit);
    }
  }

  // A rod of the ball's radius about a side; about a corner, where `side` is nothing.
  static void meet_rod(const Point& a, const Point& side, const Point& from, const Point& way, Hit& hit) {
    const double square = dot(side, side);
    const Point off = from - a;
    const auto across = [&](const Point& v) { return square > 0 ? v - side * (dot(v, side) / square) : v; };
    const Point u = across(way), v = across(off);
    const double uu = dot(u, u), uv = dot(u, v), under = uv * uv - uu * (dot(v, v) - kRadius_m * kRadius_m);
    if (!(uu > 0) || !(uv < 0) || under < 0) return;
    const double part = std::max(0.0, (-uv - std::sqrt(under)) / uu);
    if (part >= hit.part || part > 1) return;
    const Point met = off + way * part;
    const double along = dot(met, side);
    if (square > 0 && (along < 0 || along > square)) return;
    const Point out = across(met);
    if (const double far = length(out); far > 0) hit = {part, out * (1 / far)};
  }

  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;
  double stiffness_n_per_m_, mu_static_ = 0, mu_dynamic_ = 0;
  Point at_{}, normals_[2] = {};
  bool is_started_ = false, is_touching_ = false;
  std::size_t contacts_ = 0;  // known: the next tick's goal is on their planes
};

void* load(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]) {
  try {
    return new Proxy(*mesh, stiffness_n_per_m);
  } catch (const std::bad_alloc&) {
    std::snprintf(error, 256, "no memory");
    return nullptr;
  }
}

void unload(void* body) {
  delete static_cast<Proxy*>(body);
}

void reset(void* body) {
  static_cast<Proxy*>(body)->reset();
}

void step(void* body, const double hip_m[3], fdcg_rival_result* result) {
  static_cast<Proxy*>(body)->step({hip_m[0], hip_m[1], hip_m[2]}, *result);
}

uint64_t memory(const void* body) {
  return static_cast<const Proxy*>(body)->memory();
}

void set_friction(void* body, double mu_static, double mu_dynamic) {
  static_cast<Proxy*>(body)->set_friction(mu_static, mu_dynamic);
}

constexpr fdcg_rival kRival = {FDCG_RIVAL_ABI, 0,      "finger_proxy", "proxy", "f64",  "radius 2, epsilon 1 micrometres",
                               load,           unload, reset,          step,    memory, set_friction};

}  // namespace

const fdcg_rival* fdcg_rival_get(uint32_t abi) {
  return abi == FDCG_RIVAL_ABI ? &kRival : nullptr;
}
