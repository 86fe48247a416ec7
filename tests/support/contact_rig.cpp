// SPDX-License-Identifier: Apache-2.0
#include "contact_rig.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "fp_trap.hpp"
#include "meshes.hpp"
#include "vector.hpp"

namespace fdcg::test {
namespace {

using Wide = long double;
using Point = Vector<Wide>;

Point wide(const Hip& v) {
  return {v[0], v[1], v[2]};
}
Point wide(const bake::Vec3& v) {
  return {v.x, v.y, v.z};
}

// The nearest point of a triangle: its plane's where that falls inside, else the nearest on its edges.
Point nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point corners[3] = {a, b, c};
  const Point n = cross(b - a, c - a);
  bool is_above = true;
  for (int k = 0; k < 3; ++k) {
    const Point &v = corners[k], &w = corners[(k + 1) % 3];
    is_above = is_above && dot(cross(w - v, p - v), n) >= 0;
  }
  if (is_above && dot(n, n) > 0) return p - n * (dot(p - a, n) / dot(n, n));
  Point best = a;
  for (int k = 0; k < 3; ++k) {
    const Point &v = corners[k], &w = corners[(k + 1) % 3];
    const Wide t = std::clamp<Wide>(dot(p - v, w - v) / dot(w - v, w - v), 0, 1);
    const Point q = v + (w - v) * t;
    if (length(q - p) < length(best - p)) best = q;
  }
  return best;
}

}  // namespace

CompiledMesh::CompiledMesh(const bake::PolygonSoup& soup, const bake::CompileOptions& options) {
  const auto compiled = bake::compile(soup, options);
  if (!compiled) throw std::runtime_error(soup.name + ": " + compiled.error().message);
  if (compiled->bytes.empty()) throw std::runtime_error(soup.name + ": refused");
  storage_.resize((compiled->bytes.size() + 7) / 8);
  std::memcpy(storage_.data(), compiled->bytes.data(), compiled->bytes.size());
  fdcg_error error{};
  if (fdcg_open_memory(storage_.data(), compiled->bytes.size(), FDCG_VERIFY_FULL, &view_, &error) != FDCG_OK) {
    throw std::runtime_error(soup.name + ": " + error.message);
  }
}

fdcg_params contact_params(double mu_static, double mu_dynamic, std::uint32_t edge_friction) {
  fdcg_params params = fdcg_make_params();
  params.mu_static = mu_static;
  params.mu_dynamic = mu_dynamic;
  params.edge_friction = edge_friction;
  return params;
}

const fdcg_result& Contact::step(const Hip& hip_object_m) {
  const FpTrap trap(hip_object_m.data());
  fdcg_step(graph_, &params_, &state, hip_object_m.data(), &result);
  bound_hits += (result.flags & FDCG_RESULT_TRANSITION_BOUND) != 0;
  return result;
}

std::string Contact::describe() const {
  static const char* const names[] = {"free", "face", "edge", "vertex"};
  std::ostringstream text;
  text.precision(17);
  text << names[result.state] << ' ' << static_cast<std::int32_t>(result.feature) << " at (" << result.god_object_m[0] << ", "
       << result.god_object_m[1] << ", " << result.god_object_m[2] << ") for HIP (" << state.hip[0] << ", " << state.hip[1]
       << ", " << state.hip[2] << "), " << (result.slipping ? "slips" : "sticks") << ", transitions " << result.transitions;
  return text.str();
}

double dot(const Hip& a, const Hip& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double norm(const Hip& a) {
  return std::sqrt(dot(a, a));
}
Hip difference(const Hip& a, const Hip& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double distance(const Hip& a, const Hip& b) {
  return norm(difference(a, b));
}
Hip point_of(const bake::Vec3& v) {
  return {v.x, v.y, v.z};
}
bake::Vec3 vec_of(const Hip& v) {
  return {v[0], v[1], v[2]};
}

double winding_number(const bake::PolygonSoup& soup, const Hip& point) {
  // Solid angle of a triangle: van Oosterom and Strackee 1983.
  Wide sum = 0;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const Polygon face = face_corners(soup, f);
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      const Point a = wide(soup.points[face[0]]) - wide(point), b = wide(soup.points[face[k]]) - wide(point),
                  c = wide(soup.points[face[k + 1]]) - wide(point);
      const Wide la = length(a), lb = length(b), lc = length(c);
      sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
  }
  return static_cast<double>(sum / (2 * std::numbers::pi_v<Wide>));
}

Hip closest_point(const bake::PolygonSoup& soup, const Hip& point) {
  Point best{std::numeric_limits<Wide>::max() / 4, 0, 0};
  Wide best_distance = std::numeric_limits<Wide>::infinity();
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const Polygon face = face_corners(soup, f);
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      const Point q = nearest_on_triangle(wide(point), wide(soup.points[face[0]]), wide(soup.points[face[k]]),
                                          wide(soup.points[face[k + 1]]));
      const Wide d = length(q - wide(point));
      if (d < best_distance) {
        best_distance = d;
        best = q;
      }
    }
  }
  return {static_cast<double>(best.x), static_cast<double>(best.y), static_cast<double>(best.z)};
}

double extent(const bake::PolygonSoup& soup) {
  double largest = 0;
  for (const bake::Vec3& p : soup.points)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest;
}

}  // namespace fdcg::test
