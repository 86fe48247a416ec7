// SPDX-License-Identifier: Apache-2.0
// Deformable meshes: nothing falls through a surface that moves, god-objects stay on it, and triangles may lose their area.
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>

#include "deform_rig.hpp"
#include "fp_trap.hpp"
#include "meshes.hpp"
#include "random.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

std::uint64_t steps_or(std::uint64_t standard) {
  const char* const asked = std::getenv("FDCG_STEPS");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : standard;
}

bake::Vec3 operator+(const bake::Vec3& a, const bake::Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
bake::Vec3 operator*(double s, const bake::Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}

// How far the god-object is off the feature that it is on; local units.
double off_feature(const fdcg_graph& graph, const fdcg_contact& contact) {
  const auto plane_off = [&contact](const double (&normal)[3], double offset) {
    double sum = offset;
    for (int k = 0; k < 3; ++k)
      sum += normal[k] * contact.god_object[k];
    return sum;
  };
  double off = 0;
  if (contact.state == FDCG_FACE) {
    const fdcg_node_info node = fdcg_get_node(&graph, contact.feature);
    off = std::fabs(plane_off(node.normal, node.offset));
    for (std::uint32_t k = 0; k < 3; ++k) {
      const fdcg_side_info side = fdcg_get_side(&graph, contact.feature, k);
      off = std::max(off, plane_off(side.voronoi_normal, side.voronoi_offset));
    }
  } else if (contact.state == FDCG_EDGE) {
    const fdcg_connection_info edge = fdcg_get_connection(&graph, contact.feature);
    const fdcg_corner_info start = fdcg_get_corner(&graph, edge.corner[0]);
    double along = 0, gap2 = 0;
    for (int k = 0; k < 3; ++k)
      along += edge.direction[k] * (contact.god_object[k] - start.point[k]);
    along = std::min(std::max(along, 0.0), edge.length);
    for (int k = 0; k < 3; ++k) {
      const double gap = contact.god_object[k] - start.point[k] - along * edge.direction[k];
      gap2 += gap * gap;
    }
    off = std::sqrt(gap2);
  } else if (contact.state == FDCG_VERTEX) {
    const fdcg_corner_info corner = fdcg_get_corner(&graph, contact.feature);
    for (int k = 0; k < 3; ++k)
      off = std::max(off, std::fabs(corner.point[k] - contact.god_object[k]));
  }
  return off;
}

// A sheet over [-0.5, 0.5]^2 of n x n squares, each cut into two; its heights change, its vertices' x and y do not.
class Sheet {
 public:
  explicit Sheet(int n, bake::Precision precision = bake::Precision::f64)
      : n_(n), rest_(plane_grid(n, n)), mesh(rest_, triangle_options(precision)) {
    height_.assign(rest_.points.size(), 0.0F);
    vertex_.resize(static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 1));
    for (std::size_t v = 0; v < rest_.points.size(); ++v)
      vertex_[at(cell(rest_.points[v].x + 0.5 / n), cell(rest_.points[v].y + 0.5 / n))] = v;
    for (std::size_t f = 0; f < rest_.face_count(); ++f)
      triangles_.push_back(face_corners(rest_, f));
    of_cell_.resize(static_cast<std::size_t>(n * n));
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      const bake::Vec3 c = (1.0 / 3) * (rest_.points[triangles_[f][0]] + rest_.points[triangles_[f][1]] + rest_.points[triangles_[f][2]]);
      of_cell_[static_cast<std::size_t>(cell(c.x) * n + cell(c.y))].push_back(f);
    }
  }

  [[nodiscard]] std::size_t vertex_count() const { return height_.size(); }
  [[nodiscard]] double updated_extent() { return mesh.updated().header->extent; }
  [[nodiscard]] std::size_t vertex_near(double x, double y) const {
    return vertex_[at(std::min(cell(x + 0.5 / n_), n_), std::min(cell(y + 0.5 / n_), n_))];
  }
  void lift(std::size_t v, double z) {
    height_[v] = static_cast<float>(z);
    mesh.move(v, {rest_.points[v].x, rest_.points[v].y, static_cast<double>(height_[v])});
  }

  // The surface's height at a place, but for rounding.
  [[nodiscard]] double height_at(double x, double y) const {
    double best = -1, height = 0;
    for (const std::size_t f : of_cell_[static_cast<std::size_t>(cell(x) * n_ + cell(y))]) {
      const bake::Vec3 &a = rest_.points[triangles_[f][0]], &b = rest_.points[triangles_[f][1]], &c = rest_.points[triangles_[f][2]];
      const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      const double u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
      const double v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      const double inside = std::min({u, v, 1 - u - v});
      if (inside <= best) continue;
      best = inside;
      height = (1 - u - v) * height_[triangles_[f][0]] + u * height_[triangles_[f][1]] + v * height_[triangles_[f][2]];
    }
    return height;
  }

 private:
  [[nodiscard]] int cell(double x) const {
    return std::min(std::max(static_cast<int>(std::floor((x + 0.5) * n_)), 0), n_);
  }
  [[nodiscard]] std::size_t at(int i, int j) const { return static_cast<std::size_t>(i * (n_ + 1) + j); }

  int n_;
  bake::PolygonSoup rest_;
  std::vector<float> height_;
  std::vector<std::size_t> vertex_;
  std::vector<Polygon> triangles_;
  std::vector<std::vector<std::size_t>> of_cell_;

 public:
  DeformableMesh mesh;
};

}  // namespace

TEST_CASE("a sheet that heaves under and over a finger never lets it through") {
  constexpr double kEpsilon = 2.2204460492503131e-16;
  const std::uint64_t steps = steps_or(60000);
  const int n = std::getenv("FDCG_SHEET") != nullptr ? std::atoi(std::getenv("FDCG_SHEET")) : 40;
  Sheet sheet(n);
  const double extent = sheet.updated_extent();
  Random random(17);
  fdcg_deform_contact contact = {};
  const fdcg_params params = contact_params(0.5, 0.3);
  const auto moving = static_cast<std::uint32_t>(sheet.vertex_count() / 100) + 1;
  Hip hip = {0.013, 0.021, 0.3};
  std::uint64_t caught = 0, touched = 0, freed = 0;
  std::uint32_t last_state = FDCG_FREE;
  for (std::uint64_t i = 0; i < steps; ++i) {
    const bool is_still = random.chance(0.3);
    for (std::uint32_t m = 0; m < moving && !random.chance(0.02); ++m) {
      const bool is_near = random.chance(0.5);
      const std::size_t v = is_near ? sheet.vertex_near(hip[0] + random.uniform(-0.1, 0.1), hip[1] + random.uniform(-0.1, 0.1))
                                    : random.below(static_cast<std::uint32_t>(sheet.vertex_count()));
      sheet.lift(v, random.uniform(-0.2, 0.2));
    }
    if (!is_still) {
      const double size = random.chance(0.1) ? 0.3 : 0.02;
      for (int k = 0; k < 3; ++k)
        hip[static_cast<std::size_t>(k)] += random.uniform(-size, size);
      hip[0] = std::min(std::max(hip[0], -0.4), 0.4);
      hip[1] = std::min(std::max(hip[1], -0.4), 0.4);
      hip[2] = std::min(std::max(hip[2], -0.3), 0.4);
      // close over the sheet, or on it but for rounding, where the next tick's motion may pass it
      if (random.chance(0.1)) hip[2] = sheet.height_at(hip[0], hip[1]) + (random.chance(0.3) ? 0 : random.uniform(0, 0.05));
    }
    const FpTrap trap(hip.data());
    const fdcg_result result = sheet.mesh.step(params, &contact, hip);
    const double above = hip[2] - sheet.height_at(hip[0], hip[1]);
    INFO("step " << i << " hip " << hip[0] << " " << hip[1] << " " << hip[2] << " above " << above << " state " << result.state
                 << " flags " << result.flags);
    if ((result.flags & FDCG_RESULT_SWEEP_BOUND) == 0 && result.state == FDCG_FREE) REQUIRE(above >= -16 * kEpsilon);
    if (result.state != FDCG_FREE) {
      // compared with the planes that were looked at; those of the whole are computed now and then below
      REQUIRE(std::isfinite(result.god_object_m[2]));
      const double off = result.god_object_m[2] - sheet.height_at(result.god_object_m[0], result.god_object_m[1]);
      REQUIRE(std::fabs(off) <= 64 * kEpsilon * extent);
    }
    caught += (result.flags & FDCG_DEFORM_CAUGHT) != 0;
    touched += result.state != FDCG_FREE;
    freed += result.state == FDCG_FREE && last_state != FDCG_FREE;
    last_state = result.state;
    if (i % 64 == 0) REQUIRE(off_feature(sheet.mesh.updated(), contact.contact) <= 8 * kEpsilon * extent);
  }
  std::ostringstream said;
  said << caught << " caught, " << touched << " in touch, " << freed << " freed of " << steps;
  INFO(said.str());
  CHECK(caught > steps / 200);
  CHECK(touched > steps / 10);
  CHECK(freed > steps / 200);
}
