// SPDX-License-Identifier: Apache-2.0
#include "ramp.hpp"

#include <cmath>
#include <numbers>

#include "laws.hpp"

namespace fdcg::test {
namespace {

constexpr int kSeams = 16;  // cells a side of the flat grid
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFar_m = 1e6 * kObject_m;
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

const char* name_of(RampGraph graph) {
  switch (graph) {
    case RampGraph::plain:
      return "plain";
    case RampGraph::compiled:
      return "compiled";
    case RampGraph::far_away:
      return "far away";
    default:
      return "derived";
  }
}

Ramp::Ramp(const RampShape& shape, bake::Precision precision, std::uint64_t orientation_seed, RampGraph graph)
    : rotation_(shape.kind == RampKind::exact_seams ? kUnturned : random_rotation(orientation_seed)) {
  if (graph == RampGraph::far_away) offset_ = {0.7 * kFar_m, -0.6 * kFar_m, 0.4 * kFar_m};
  // every shape has points at +-1 along an axis: the same size for all
  const PolygonSoup turned = triangulated(transformed(unit_soup(shape), rotation_, kObject_m, offset_));
  if (graph == RampGraph::plain) {
    plain_ = std::make_unique<PlainGraph>(turned, precision);
  } else {
    bake::CompileOptions options;
    options.precision = precision;
    options.jobs = 1;
    options.merge = options.store_planes = graph != RampGraph::derived;
    compiled_ = std::make_unique<CompiledMesh>(turned, options);
  }
  surface_ = std::make_unique<ReferenceSurface<Wide>>(view());
}

Hip Ramp::place(double x, double y, double z) const {
  const Vec3 p = rotated(rotation_, {x, y, z});
  return {p.x + offset_.x, p.y + offset_.y, p.z + offset_.z};
}

}  // namespace fdcg::test
