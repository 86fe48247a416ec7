// SPDX-License-Identifier: Apache-2.0
#include "grasp_object.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "../common/terminal.hpp"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"
#include "points.hpp"

namespace fdcg::tools {
namespace {

using bake::Vec3;

// The point of a triangle with corners a, b, c that is nearest to p: by the regions that the planes through its corners and
// sides cut out (Ericson 2004, 5.1.5).
Vec3 nearest_of_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = plus(b, -1, a), ac = plus(c, -1, a);
  const Vec3 ap = plus(p, -1, a), bp = plus(p, -1, b), cp = plus(p, -1, c);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double in_c = d1 * d4 - d3 * d2, in_b = d5 * d2 - d1 * d6, in_a = d3 * d6 - d5 * d4;
  if (in_c <= 0 && d1 >= 0 && d3 <= 0) return plus(a, d1 / (d1 - d3), ab);
  if (in_b <= 0 && d2 >= 0 && d6 <= 0) return plus(a, d2 / (d2 - d6), ac);
  if (in_a <= 0 && d4 >= d3 && d5 >= d6) return plus(b, (d4 - d3) / (d4 - d3 + d5 - d6), plus(c, -1, b));
  const double sum = in_a + in_b + in_c;
  return plus(plus(a, in_b / sum, ab), in_c / sum, ac);
}

}  // namespace

bool is_graph_file(const std::string& path) {
  constexpr unsigned char kMagic[] = {0x89, 'F', 'D', 'C', 'G'};  // schemas/fdcg-v1.md
  unsigned char start[sizeof kMagic] = {};
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  const bool is_graph =
      std::fread(start, 1, sizeof start, file) == sizeof start && std::memcmp(start, kMagic, sizeof start) == 0;
  std::fclose(file);
  return is_graph;
}

bake::Result<GraspObject> GraspObject::load(const std::string& path, const bake::CompileOptions& options, bool is_unit_given) {
  GraspObject object;
  fdcg_graph graph{};
  fdcg_error error{};
  if (is_graph_file(path)) {
    if (fdcg_open_file(path.c_str(), FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) return bake::Failure{kFile, error.message};
    object.take(graph);
    fdcg_close(&graph);
    return object;
  }
  const auto soup = import_input(path, {});
  if (!soup) return soup.error();
  bake::CompileOptions with_unit = options;
  if (!is_unit_given && soup->metres_per_unit > 0) with_unit.metres_per_unit = soup->metres_per_unit;
  const auto compiled = bake::compile(*soup, with_unit);
  if (!compiled) return compiled.error();
  if (compiled->file().empty())
    return bake::Failure{kFindings, bake::report_text(compiled->report, wants_colour(Stream::standard_error))};
  const auto bytes = compiled->file();
  if (fdcg_open_memory(bytes.data(), bytes.size(), FDCG_VERIFY_TRUSTED, &graph, &error) != FDCG_OK)
    return bake::Failure{kUsage, path + ": this scale makes a graph that the runtime refuses: " + error.message};
  object.take(graph);
  return object;
}

void GraspObject::take(const fdcg_graph& graph) {
  const fdcg_header& header = *graph.header;
  const auto placed = [&header](const double(&local)[3]) {
    return Vec3{(local[0] + header.origin[0]) * header.metres_per_unit, (local[1] + header.origin[1]) * header.metres_per_unit,
                (local[2] + header.origin[2]) * header.metres_per_unit};
  };
  for (std::uint32_t c = 0; c < header.corner_count; ++c)
    corners_.push_back(placed(fdcg_get_corner(&graph, c).point));
  face_first_.push_back(0);
  for (std::uint32_t n = 0; n < header.node_count; ++n) {
    const fdcg_node_info node = fdcg_get_node(&graph, n);
    for (std::uint32_t s = 0; s < node.side_count; ++s)
      face_corners_.push_back(fdcg_get_side(&graph, n, s).corner);
    face_first_.push_back(static_cast<std::uint32_t>(face_corners_.size()));
    const Vec3 normal{node.normal[0], node.normal[1], node.normal[2]};
    normals_.push_back(plus({}, 1 / std::sqrt(dot(normal, normal)), normal));  // f32 files hold it to seven digits
  }
  fdcg_mass mass{};
  fdcg_error error{};
  if (fdcg_get_mass(&graph, &mass, &error) == FDCG_OK) {
    stored_centroid_m_ = Vec3{mass.centroid_m[0], mass.centroid_m[1], mass.centroid_m[2]};
    if (mass.mass_kg > 0) mass_kg_ = mass.mass_kg;
  }
  const Vec3 across = plus(placed(header.bounds_max), -1, placed(header.bounds_min));
  size_m_ = std::sqrt(dot(across, across));
  is_closed_ = header.connection_type_count[FDCG_BOUNDARY] == 0;
}

SurfacePoint GraspObject::nearest(const Vec3& point_m) const {
  struct Near {
    Vec3 point{};
    double squared = std::numeric_limits<double>::infinity();
  };
  const auto nearest_of_face = [&](std::uint32_t f) {
    Near best;
    const Vec3& a = corners_[face_corners_[face_first_[f]]];
    for (std::uint32_t k = face_first_[f] + 1; k + 1 < face_first_[f + 1]; ++k) {
      const Vec3 q = nearest_of_triangle(point_m, a, corners_[face_corners_[k]], corners_[face_corners_[k + 1]]);
      const Vec3 away = plus(q, -1, point_m);
      if (dot(away, away) < best.squared) best = {q, dot(away, away)};
    }
    return best;
  };
  Near best;
  for (std::uint32_t f = 0; f < face_count(); ++f) {
    const Near near = nearest_of_face(f);
    if (near.squared < best.squared) best = near;
  }
  constexpr double kSame = 1e-9, kSameNormal = 1 - 1e-9;  // of the object's size; cosine
  const double limit = std::sqrt(best.squared) + kSame * size_m_;
  const Vec3 outward = plus(point_m, -1, best.point);
  SurfacePoint found;
  double towards = -std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> as_near;
  for (std::uint32_t f = 0; f < face_count(); ++f) {
    const Near near = nearest_of_face(f);
    if (!(near.squared <= limit * limit)) continue;
    as_near.push_back(f);
    const double look = dot(normals_[f], outward);
    if (look > towards + kSame * size_m_) towards = look, found.node = f, found.point_m = near.point;
  }
  found.outward = normals_[found.node];
  found.distance_m = std::sqrt(best.squared);
  found.is_on_edge = std::any_of(as_near.begin(), as_near.end(),
                                 [&](std::uint32_t f) { return dot(normals_[f], found.outward) < kSameNormal; });
  return found;
}

std::optional<Vec3> GraspObject::centroid_m() const {
  if (stored_centroid_m_) return stored_centroid_m_;
  if (!is_closed_) return std::nullopt;
  const Vec3 base = corners_.front();  // near the object: nothing is lost far from the frame's origin
  double volume6 = 0;
  Vec3 moment{};
  for (std::uint32_t f = 0; f < face_count(); ++f) {
    const Vec3 a = plus(corners_[face_corners_[face_first_[f]]], -1, base);
    for (std::uint32_t k = face_first_[f] + 1; k + 1 < face_first_[f + 1]; ++k) {
      const Vec3 b = plus(corners_[face_corners_[k]], -1, base), c = plus(corners_[face_corners_[k + 1]], -1, base);
      const double part = dot(a, cross(b, c));
      volume6 += part;
      moment = plus(moment, part / 4, plus(plus(a, 1, b), 1, c));
    }
  }
  constexpr double kLeastVolume = 1e-12;  // of the box's diagonal cubed, as six times a volume
  if (!(volume6 > kLeastVolume * size_m_ * size_m_ * size_m_)) return std::nullopt;
  return plus(base, 1 / volume6, moment);
}

double GraspObject::farthest_from(const Vec3& centre_m) const {
  double farthest = 0;
  for (const Vec3& corner : corners_) {
    const Vec3 arm = plus(corner, -1, centre_m);
    farthest = std::max(farthest, std::sqrt(dot(arm, arm)));
  }
  return farthest;
}

}  // namespace fdcg::tools
