// SPDX-License-Identifier: Apache-2.0
#include "ramp.hpp"

#include <cmath>
#include <numbers>

#include "laws.hpp"

namespace fdcg::test {
namespace {

constexpr int kSeams = 16;  // cells a side of the flat grid
constexpr double kDegree = std::numbers::pi / 180;
constexpr Rotation kUnturned = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

PolygonSoup unit_soup(const RampShape& shape) {
  switch (shape.kind) {
    case RampKind::face:
      return make_soup("face", {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}});
    case RampKind::exact_seams:
    case RampKind::rounded_seams:
      return scaled(plane_grid(kSeams, kSeams), 2);
    case RampKind::groove:
      return v_groove(shape.opening_deg * kDegree);
    default:
      return prism(shape.sides);
  }
}

}  // namespace

std::string RampShape::name() const {
  switch (kind) {
    case RampKind::face:
      return "face";
    case RampKind::exact_seams:
      return "exact seams";
    case RampKind::rounded_seams:
      return "rounded seams";
    case RampKind::groove:
      return "groove";
    default:
      return "convex edges";
  }
}

std::vector<RampShape> ramp_shapes() {
  std::vector<RampShape> shapes = {{RampKind::face}, {RampKind::exact_seams}, {RampKind::rounded_seams}};
  for (const double opening_deg : {30, 60, 90, 120, 150})
    shapes.push_back({RampKind::groove, opening_deg});
  for (const int sides : {5, 6, 8, 12, 36})
    shapes.push_back({RampKind::convex_edges, 180 - 360.0 / sides, sides});
  return shapes;
}

Ramp::Ramp(const RampShape& shape, bake::Precision precision, std::uint64_t orientation_seed)
    : rotation_(shape.kind == RampKind::exact_seams ? kUnturned : random_rotation(orientation_seed)) {
  // v_groove and prism have points at +-1 along every axis: the same size for all
  const PolygonSoup turned = triangulated(transformed(unit_soup(shape), rotation_, kObject_m));
  graph_ = std::make_unique<PlainGraph>(turned, precision);
  surface_ = std::make_unique<ReferenceSurface<Wide>>(graph_->view());
}

Hip Ramp::place(double x, double y, double z) const {
  return point_of(rotated(rotation_, {x, y, z}));
}

}  // namespace fdcg::test
