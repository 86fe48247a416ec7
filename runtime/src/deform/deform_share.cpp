// SPDX-License-Identifier: Apache-2.0
// Which corners of a deformable mesh bear a force.
#include "base/config.hpp"
#include "base/message.hpp"
#include "deform/deform_upkeep.hpp"
#include "graph/graph_view.hpp"

namespace fdcg {
namespace {

double not_negative(double value) {
  return value > 0 ? value : 0;
}

// Of a point in a triangle, or near it; of one without area equal shares.
void share_on_triangle(const Vec3<double> (&corner)[3], Vec3<double> at, double weights[3]) {
  const Vec3<double> a = corner[0], b = corner[1], c = corner[2], normal = cross(b - a, c - a);
  weights[0] = not_negative(dot(cross(b - at, c - at), normal));
  weights[1] = not_negative(dot(cross(c - at, a - at), normal));
  weights[2] = not_negative(dot(cross(a - at, b - at), normal));
  const double sum = weights[0] + weights[1] + weights[2];
  for (int k = 0; k < 3; ++k)
    weights[k] = sum > 0 ? weights[k] / sum : 1.0 / 3;
}

void share_on_edge(Vec3<double> a, Vec3<double> b, Vec3<double> at, double weights[3]) {
  const Vec3<double> along = b - a;
  const double length2 = dot(along, along), share = length2 > 0 ? dot(at - a, along) / length2 : 0.5;
  weights[1] = share < 0 ? 0 : share > 1 ? 1 : share;
  weights[0] = 1 - weights[1];
}

template <class Real>
void share_out(const fdcg_deform& deform, const fdcg_result& result, uint32_t corners[3], double weights[3]) {
  const Upkeep<Real> upkeep(const_cast<fdcg_deform&>(deform));
  const RigidView<Real> view(deform.graph);
  const Vec3<double> at = vec(result.god_object_m) * (1 / deform.header.metres_per_unit) - vec(deform.header.origin);
  if (result.state == FDCG_VERTEX) {
    corners[0] = result.feature;
    weights[0] = 1;
    return;
  }
  const uint32_t count = result.state == FDCG_FACE ? 3 : 2;
  Vec3<double> place[3];
  for (uint32_t k = 0; k < count; ++k) {
    corners[k] = count == 3 ? view.node(result.feature).corner(k) : view.connection(result.feature).corner(k);
    place[k] = widen(upkeep.point(corners[k]));
  }
  if (count == 3) return share_on_triangle(place, at, weights);
  share_on_edge(place[0], place[1], at, weights);
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_deform_share(const fdcg_deform* deform, const fdcg_result* result, uint32_t corners[3],
                                         double weights[3], fdcg_error* error) {
  using namespace fdcg;
  if (deform == nullptr || result == nullptr || corners == nullptr || weights == nullptr)
    return refuse(error, "deform, result, corners or weights: null pointer");
  const uint32_t count[] = {0, deform->header.node_count, deform->header.connection_count, deform->header.corner_count};
  if (result->state > FDCG_VERTEX || (result->state != FDCG_FREE && result->feature >= count[result->state])) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("result: state ", result->state, ", feature ", result->feature, " is not of this mesh");
  }
  for (int k = 0; k < 3; ++k)
    corners[k] = FDCG_NONE, weights[k] = 0;
  if (result->state == FDCG_FREE) return FDCG_OK;
  with_real_of(deform->header, [&](auto real) { share_out<decltype(real)>(*deform, *result, corners, weights); });
  return FDCG_OK;
}
