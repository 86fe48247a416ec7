// SPDX-License-Identifier: Apache-2.0
// The search for a clear ball that a deformable mesh can track (deform_watch.hpp): by boxes alone; no triangle is updated for
// it.
#pragma once

#include "deform/deform_upkeep.hpp"
#include "step/clear_ball.hpp"
#include "step/contact_internals.hpp"

namespace fdcg {

// The radius of a ball around `at` that no box reaches into, local, and its `reach2` in tree units; 0 where it would be below
// `way`. Cost: at most 24 records.
template <class Real>
[[gnu::noinline]] double quiet_radius(const Upkeep<Real>& upkeep, Vec3<double> at, double way, double* reach2) {
  constexpr double kWaysAhead = 32, kLeastReach = 1.0 / 256;  // as in clear_radius
  constexpr double kEnough = 8;                               // ways: boxes that are no nearer need not be made tight
  constexpr double kKept = 1 - 1.0 / 512, kFar = 8;           // tree units
  constexpr int kMostVisits = 24;
  const fdcg_deform& deform = upkeep.deform();
  const Vec3<double> p = at * deform.per_tree_unit;
  const double size = norm1(p), length = way * deform.per_tree_unit;
  if (!(size < kFar) || !(length < kFar)) return 0;  // too far away: the step handles it
  const double margin = 5 * tree_rounding<double>(2 * size, 2 * size * RealLimits<Real>::kEpsilon);
  const double reach = greater_of(kWaysAhead * length, kLeastReach), enough = kEnough * length + margin;
  const float point[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  const auto too_near = static_cast<float>(length + margin), too_near2 = too_near * too_near;
  const auto enough2 = static_cast<float>(enough * enough);
  auto clear2 = static_cast<float>(reach * reach);
  WaitingBoxes waiting(deform.tree);
  for (int visits = 0; !waiting.is_empty() && clear2 > too_near2;) {
    const WaitingBoxes::Item next = waiting.pop();
    if (!(next.key < clear2)) continue;
    if (visits++ == kMostVisits) return 0;
    float distance2[FDCG_TREE_WAYS];
    const fdcg_box8& boxes = deform.boxes[deform.tree.first[next.level] + next.index];
    const uint32_t lanes = deform.tree.lanes(next.level, next.index);
    uint32_t near = squared_distances(boxes, point, clear2, distance2) & lanes, too_loose = near;
    for (uint32_t j = 0; j < FDCG_TREE_WAYS; ++j)
      too_loose &= ~(uint32_t{!(distance2[j] < enough2)} << j);
    if (upkeep.has_tightened(next.level, next.index, too_loose))
      near = squared_distances(boxes, point, clear2, distance2) & lanes;
    if (next.level > 0) {
      waiting.push(next, near, distance2);
      continue;
    }
    for (; near != 0; near &= near - 1)
      clear2 = lesser_of(clear2, distance2[__builtin_ctz(near)]);
  }
  const double radius = root(double{clear2}) * kKept - margin;
  if (!(radius > length)) return 0;
  *reach2 = (radius + margin / 2) * (radius + margin / 2);
  return radius / deform.per_tree_unit;
}

// A ball around `hip` that holds the contact's god-object too: it becomes the contact's, and the mesh tracks it.
template <class Real>
bool find_quiet_ball(const Upkeep<Real>& upkeep, Vec3<double> hip, fdcg_deform_contact* contact) {
  fdcg_deform& deform = upkeep.deform();
  ClearBall& ball = internals_of(contact->contact).clear_ball;
  if (deform.watched.holds(contact->ball, ball)) deform.watched.remove(contact->ball);
  double reach2;
  const double radius = quiet_radius(upkeep, hip, norm(hip - vec(contact->contact.god_object)), &reach2);
  if (!(radius > 0)) return false;
  ball = {{hip.x, hip.y, hip.z}, radius * radius, 0, 0, 0, 0};
  contact->ball = deform.watched.add({{hip.x, hip.y, hip.z}, ball.radius2, reach2});
  return true;
}

}  // namespace fdcg
