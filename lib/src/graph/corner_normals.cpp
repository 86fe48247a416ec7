// SPDX-License-Identifier: Apache-2.0
#include "graph/corner_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/vec3.hpp"
#include "graph/source_corners.hpp"
#include "shared/octahedral.hpp"

namespace fdcg::bake {
namespace {

constexpr double kLeastLean = 0.5;    // cosine between a corner's normal and its triangle's
constexpr double kFlat = 1 - 0.5e-8;  // within 1e-4 rad they are one
constexpr fdcg_node_normals kFlatNode = {
    {{FDCG_FLAT_NORMAL, FDCG_FLAT_NORMAL}, {FDCG_FLAT_NORMAL, FDCG_FLAT_NORMAL}, {FDCG_FLAT_NORMAL, FDCG_FLAT_NORMAL}}};

bool is_flat(const fdcg_node_normals& node) {
  return std::all_of(std::begin(node.corner), std::end(node.corner),
                     [](const auto& code) { return code[0] == FDCG_FLAT_NORMAL; });
}

Vec3 scaled_to_unit(const Vec3& v) {
  const double size = length(v);
  return size > 0 && std::isfinite(size) ? (1 / size) * v : Vec3{};
}

class Averager {
 public:
  Averager(const Triangulation& cut, double crease_rad)
      : mesh_(cut.mesh), topology_(cut.topology), least_cosine_(std::cos(crease_rad)) {
    const std::uint32_t faces = mesh_.face_count();
    normal_.resize(faces);
    for (std::uint32_t f = 0; f < faces; ++f) {
      const Vec3 a = point(3 * f), b = point(3 * f + 1), c = point(3 * f + 2);
      normal_[f] = scaled_to_unit(cross(b - a, c - a));
    }
  }

  [[nodiscard]] const Vec3& normal(std::uint32_t face) const { return normal_[face]; }

  // One for each slot, of unit length: of the sum over the triangles around its vertex that no crease divides from its own.
  std::vector<Vec3> run() {
    const auto slots = static_cast<std::uint32_t>(mesh_.corners.size());
    std::vector<Vec3> result(slots);
    std::vector<std::uint8_t> is_done(slots, 0);
    std::vector<std::uint32_t> group;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      if (is_done[slot] != 0) continue;
      gather(slot, group);
      Vec3 sum;
      for (const std::uint32_t member : group)
        sum = sum + weighted_normal(member);
      const Vec3 mean = scaled_to_unit(sum);
      for (const std::uint32_t member : group) {
        result[member] = mean;
        is_done[member] = 1;
      }
    }
    return result;
  }

 private:
  [[nodiscard]] const Vec3& point(std::uint32_t slot) const { return mesh_.points[+mesh_.corners[slot]]; }
  static std::uint32_t after(std::uint32_t slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
  static std::uint32_t before(std::uint32_t slot) { return slot % 3 == 0 ? slot + 2 : slot - 1; }

  // N. Max, "Weights for computing vertex normals from facet normals", 1999: sin(angle) / (|u| |v|). Exact on spheres, and two
  // halves of a rectangle count as the whole.
  [[nodiscard]] Vec3 weighted_normal(std::uint32_t slot) const {
    const Vec3 u = point(after(slot)) - point(slot), v = point(before(slot)) - point(slot);
    const double size2 = squared_length(u) * squared_length(v);
    const Vec3 sum = (1 / size2) * cross(u, v);
    return size2 > 0 && std::isfinite(squared_length(sum)) ? sum : Vec3{};
  }
  // Whether the edge that starts at this slot is smooth.
  [[nodiscard]] bool is_smooth(std::uint32_t slot) const {
    const HalfedgeId twin = topology_.twin[slot];
    return is_halfedge(twin) && dot(normal_[slot / 3], normal_[+twin / 3]) >= least_cosine_;
  }
  // Counter-clockwise from the last crease before the slot.
  void gather(std::uint32_t slot, std::vector<std::uint32_t>& group) const {
    std::uint32_t first = slot;
    while (is_smooth(first)) {
      const std::uint32_t right = after(+topology_.twin[first]);
      if (right == slot) break;
      first = right;
    }
    group.assign(1, first);
    for (std::uint32_t at = first; is_smooth(before(at));) {
      at = +topology_.twin[before(at)];
      if (at == first) break;
      group.push_back(at);
    }
  }

  const Mesh& mesh_;
  const Topology& topology_;
  double least_cosine_;
  std::vector<Vec3> normal_;
};

// What the mesh file says of the source face's corner there; none: it says nothing.
std::optional<Vec3> file_normal(const PolygonSoup& soup, const SourceCorners& corners, std::uint32_t slot) {
  const std::uint32_t corner = corners.at(slot);
  if (corner == kNone) return std::nullopt;
  const Vec3 found = scaled_to_unit(soup.corner_normals[corner]);
  return found == Vec3{} ? std::nullopt : std::optional(found);
}

}  // namespace

std::vector<Vec3> smooth_normals(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face,
                                 const Triangulation& cut, const CompileOptions& options) {
  Averager averager(cut, options.crease_rad);
  std::vector<Vec3> normals = averager.run();
  const SourceCorners corners(soup, source_face, cut);
  for (std::uint32_t slot = 0; slot < normals.size(); ++slot) {
    const Vec3 own = averager.normal(slot / 3);
    if (normals[slot] == Vec3{}) normals[slot] = own == Vec3{} ? Vec3{0, 0, 1} : own;
    if (soup.corner_normals.empty()) continue;
    const std::optional<Vec3> given = file_normal(soup, corners, slot);
    if (given) normals[slot] = options.orient && dot(*given, own) < 0 ? -*given : *given;
  }
  return normals;
}

CornerNormals find_corner_normals(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face,
                                  const Triangulation& cut, const CompileOptions& options) {
  CornerNormals found;
  if (options.normals == Normals::none) return found;
  Averager averager(cut, options.crease_rad);
  const bool has_file = options.normals == Normals::file;
  const std::vector<Vec3> mean = has_file ? std::vector<Vec3>{} : averager.run();
  const SourceCorners corners(soup, source_face, cut);
  std::vector<fdcg_node_normals> of_face(cut.mesh.face_count(), kFlatNode);
  for (std::uint32_t f = 0; f < of_face.size(); ++f) {
    const Vec3 own = averager.normal(f);
    bool is_plane = true;
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::optional<Vec3> normal = has_file ? file_normal(soup, corners, 3 * f + k) : std::optional(mean[3 * f + k]);
      if (!normal) continue;
      if (has_file && options.orient && dot(*normal, own) < 0) normal = -*normal;
      const double lean = dot(*normal, own);
      if (!(lean >= kLeastLean)) {
        ++found.unusable;
        continue;
      }
      is_plane = is_plane && lean >= kFlat;
      octahedral_encode({normal->x, normal->y, normal->z}, of_face[f].corner[k]);
    }
    if (is_plane) of_face[f] = kFlatNode;
    found.shaded += is_plane ? 0 : 1;
  }
  if (found.shaded > 0) found.of_face = std::move(of_face);
  return found;
}

void split_by_normals(const CornerNormals& normals, Regions& regions) {
  if (normals.of_face.empty() || regions.list.empty()) return;
  for (std::uint32_t t = 0; t < regions.of_face.size(); ++t) {
    const std::uint32_t r = regions.of_face[t];
    if (r == kNone || is_flat(normals.of_face[t])) continue;
    Region piece = regions.list[r];
    if (piece.whole == kNone) piece.whole = regions.list[r].whole = r;
    regions.of_face[t] = static_cast<std::uint32_t>(regions.list.size());
    regions.list.push_back(piece);
  }
}

std::vector<fdcg_node_normals> normals_of_faces(const CornerNormals& normals, const std::vector<VertexId>& corners,
                                                const Merged& faces) {
  if (normals.of_face.empty()) return {};
  if (faces.face_of_triangle.empty()) return normals.of_face;
  std::vector<fdcg_node_normals> result(faces.mesh.face_count(), kFlatNode);
  for (std::uint32_t t = 0; t < normals.of_face.size(); ++t) {
    if (is_flat(normals.of_face[t])) continue;
    const std::uint32_t face = faces.face_of_triangle[t], first = faces.mesh.face_first[face];
    for (std::uint32_t i = 0; i < 3; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (faces.mesh.corners[first + i] == corners[3 * t + k])
          std::copy_n(normals.of_face[t].corner[k], 2, result[face].corner[i]);
      }
    }
  }
  return result;
}

}  // namespace fdcg::bake
