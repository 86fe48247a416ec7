// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "base/vec3.hpp"
#include "exact/outline.hpp"
#include "validate/check_rules.hpp"

namespace fdcg::bake::checks {
namespace {

// Whether every corner lies within the tolerance of the plane of the area vector through the corners' mean. The tolerance is
// four times the effect of moving every coordinate by the quantum of input and storage: one for the corner, one for the plane,
// and two for programs that transform an object and so round more than once.
bool is_planar_within_quantum(const Subject& subject, FaceId f) {
  const Mesh& mesh = subject.mesh;
  const std::uint32_t first = mesh.face_first[+f], end = mesh.face_first[+f + 1];
  const auto point = [&](std::uint32_t h) -> const Vec3& { return mesh.points[+mesh.corners[h]]; };
  const Vec3 o = point(first);
  Vec3 n, sum, largest;
  for (std::uint32_t h = first; h < end; ++h) {
    const Vec3& p = point(h);
    const Vec3& q = point(h + 1 < end ? h + 1 : first);
    const Vec3 a{p.x - o.x, p.y - o.y, p.z - o.z}, b{q.x - o.x, q.y - o.y, q.z - o.z};
    n = {n.x + (a.y * b.z - a.z * b.y), n.y + (a.z * b.x - a.x * b.z), n.z + (a.x * b.y - a.y * b.x)};
    sum = {sum.x + a.x, sum.y + a.y, sum.z + a.z};
    largest = {std::max(largest.x, std::abs(p.x)), std::max(largest.y, std::abs(p.y)), std::max(largest.z, std::abs(p.z))};
  }
  const double length = std::hypot(n.x, n.y, n.z);
  if (!(length > 0)) return false;
  const double corners = end - first;
  const Vec3 mean{sum.x / corners, sum.y / corners, sum.z / corners};
  const double stored = subject.precision == Precision::f32 ? 0x1p-24 : 0;
  const auto quantum = [&](double local, double origin) {
    const double input = std::max(subject.soup.relative_quantum * (local + std::abs(origin)), subject.soup.absolute_quantum);
    return input + stored * local;
  };
  constexpr double kTolerance = 4;
  const double limit = kTolerance *
                       (std::abs(n.x) * quantum(largest.x, mesh.origin.x) + std::abs(n.y) * quantum(largest.y, mesh.origin.y) +
                        std::abs(n.z) * quantum(largest.z, mesh.origin.z)) /
                       length;
  for (std::uint32_t h = first; h < end; ++h) {
    const Vec3& p = point(h);
    const double x = p.x - o.x - mean.x, y = p.y - o.y - mean.y, z = p.z - o.z - mean.z;
    if (!(std::abs(x * n.x + y * n.y + z * n.z) / length <= limit)) return false;
  }
  return true;
}

// The kind of degeneracy, which determines the remedy.
struct DegenerateKinds {
  std::uint64_t point_like = 0, doubled = 0, collinear = 0;

  void count(const Mesh& mesh, FaceState state, FaceId f) {
    if (state == FaceState::sound) {
      ++collinear;
      return;
    }
    const auto corners = mesh.corners.begin();
    std::vector<VertexId> distinct(corners + mesh.face_first[+f], corners + mesh.face_first[+f + 1]);
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    ++(distinct.size() < 3 ? point_like : doubled);
  }

  [[nodiscard]] std::string message(const Rule& rule) const {
    const auto clause = [](std::uint64_t n, const char* one, const char* many) { return n == 1 ? one : many; };
    const std::string shapeless = clause(point_like, "names fewer than three vertices", "name fewer than three vertices");
    const std::string twice = clause(doubled, "names a corner twice", "name a corner twice");
    const std::string straight = clause(collinear, "has all corners on one line", "have all corners on one line");
    const std::uint64_t total = point_like + doubled + collinear;
    const std::string faces = std::to_string(total) + clause(total, " face ", " faces ");
    if (doubled == total)
      return faces + twice + ", as around a bridge to a hole. Triangulate such polygons in the modelling program.";
    constexpr const char* kDelete = ". Delete faces without area and join the long edge to its neighbours.";
    if (point_like == total) return faces + shapeless + kDelete;
    if (collinear == total) return faces + straight + kDelete;
    std::string out = faces + "are degenerate:";
    const auto add = [&](std::uint64_t n, const std::string& what) {
      if (n != 0) out += (out.back() == ':' ? " " : ", ") + std::to_string(n) + " " + what;
    };
    add(point_like, shapeless);
    add(doubled, twice);
    add(collinear, straight);
    return out + ". " + std::string(rule.remedy);
  }
};

// The corners of one face after another, in reused memory.
class Loops {
 public:
  explicit Loops(const Mesh& mesh) : mesh_(mesh) {}
  std::span<const Vec3> of(std::uint32_t f) {
    points_.clear();
    for (std::uint32_t h = mesh_.face_first[f]; h < mesh_.face_first[f + 1]; ++h)
      points_.push_back(mesh_.points[+mesh_.corners[h]]);
    return points_;
  }

 private:
  const Mesh& mesh_;
  std::vector<Vec3> points_;
};

bool has_area(const Subject& subject, std::uint32_t f) {
  return subject.states[f] == FaceState::sound && subject.geometry.is_finite(FaceId{f}) &&
         !subject.geometry.is_degenerate(FaceId{f});
}

bool has_inside(std::span<const Vec3> polygon) {
  return simple_view(polygon).has_value();
}

// A float file rounds by 6e-8 of its extent: a face of a hundredth of the extent in length that is thinner than this has a
// normal turned by up to half a degree.
constexpr double kThinnest = 1e-3;

// Width and length as issues.cpp states them, of corners whose coordinates are of a size near 1.
bool is_thin(std::span<const Vec3> polygon) {
  Vec3 twice_area;
  double outline = 0, longest = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double squared = squared_length(q - p);
    longest = std::max(longest, squared);
    if (polygon.size() > 3) outline += std::sqrt(squared);
    twice_area = twice_area + cross(p - polygon[0], q - polygon[0]);
  }
  const double least = kThinnest * (polygon.size() == 3 ? longest : outline * outline / 2);
  return squared_length(twice_area) < least * least;
}

bool is_sliver(std::span<const Vec3> polygon, std::vector<Vec3>& scaled) {
  double size = 0;
  for (const Vec3& p : polygon)
    size = std::max(size, largest_component(p - polygon[0]));
  constexpr double kLeast = 1e-60, kMost = 1e60;  // fourth powers, and squares of kThinnest, are in range
  if (size > kLeast && size < kMost) return is_thin(polygon);
  const double half = std::isfinite(size) ? 1 : 0.5;  // halved, differences of finite coordinates are finite
  const int exponent = std::isfinite(size) ? -std::ilogb(size) : -std::numeric_limits<double>::max_exponent;
  scaled.clear();
  for (const Vec3& p : polygon) {
    const Vec3 d = half * p - half * polygon[0];
    scaled.push_back({std::scalbn(d.x, exponent), std::scalbn(d.y, exponent), std::scalbn(d.z, exponent)});
  }
  return is_thin(scaled);
}

}  // namespace

void index_out_of_range(const Subject& subject, Findings& out) {
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (subject.states[f] == FaceState::invalid_corner) out.at_face(FaceId{f});
  }
}

void empty_mesh(const Subject& subject, Findings& out) {
  if (subject.mesh.face_count() == 0) out.at_file();
}

void degenerate_face(const Subject& subject, Findings& out) {
  DegenerateKinds kinds;
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (!subject.geometry.is_degenerate(FaceId{f})) continue;
    out.at_face(FaceId{f});
    kinds.count(subject.mesh, subject.states[f], FaceId{f});
  }
  if (out.total() != 0) out.say(kinds.message(*find_rule("degenerate-face")));
}

void self_crossing_face(const Subject& subject, Findings& out) {
  Loops loops(subject.mesh);
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    const bool is_polygon = subject.mesh.face_first[f + 1] - subject.mesh.face_first[f] > 3;
    if (is_polygon && has_area(subject, f) && !has_inside(loops.of(f))) out.at_face(FaceId{f});
  }
}

void duplicate_face(const Subject& subject, Findings& out) {
  for (const Duplicate& duplicate : subject.duplicates)
    out.at_face(duplicate.copy, duplicate.first);
}

void non_planar_face(const Subject& subject, Findings& out) {
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    const FaceId face{f};
    if (subject.mesh.face_first[f + 1] - subject.mesh.face_first[f] < 4) continue;
    if (!subject.geometry.is_finite(face) || subject.geometry.is_degenerate(face)) continue;
    if (!is_planar_within_quantum(subject, face) && !subject.geometry.is_flat(face)) out.at_face(face);
  }
}

void sliver_face(const Subject& subject, Findings& out) {
  Loops loops(subject.mesh);
  std::vector<Vec3> scaled;
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (!has_area(subject, f)) continue;
    const std::span<const Vec3> corners = loops.of(f);
    if (is_sliver(corners, scaled) && (corners.size() == 3 || has_inside(corners))) out.at_face(FaceId{f});
  }
}

}  // namespace fdcg::bake::checks
