// SPDX-License-Identifier: Apache-2.0
// The work budgets of a step, by which it ends in bounded time on any mesh: units of 15 to 40 instructions. The rules that move
// the god-object over the surface have one budget, the sweeps through free space another. The step continues until one is
// spent, and then finishes the current piece of work (contact-model BOUND-1 to BOUND-3).
#pragma once

#include <stdint.h>

namespace fdcg {

// Of one step, all its rules together: some 15,000 instructions, 40 changes of state.
#ifndef FDCG_RULE_WORK
#define FDCG_RULE_WORK 1000
#endif
inline constexpr uint32_t kRuleWork = FDCG_RULE_WORK;

// Of one step, all its sweeps together: some 25,000 instructions, past busy corners 60,000.
#ifndef FDCG_SWEEP_WORK
#define FDCG_SWEEP_WORK 1700
#endif
inline constexpr uint32_t kSweepWork = FDCG_SWEEP_WORK;

// Of one step, all questions whether a way that met nothing has come in all the same (missed_way.hpp).
inline constexpr uint32_t kMissedWork = 4000;

// Of one look for a clear ball.
inline constexpr uint32_t kClearWork = 1200;

// Of one step on a deformable mesh, all that it brings up to date (deform_upkeep.hpp): some 90,000 instructions. Where it is
// spent the step's sweeps have no work left either.
#ifndef FDCG_UPKEEP_WORK
#define FDCG_UPKEEP_WORK 6000
#endif
inline constexpr uint32_t kUpkeepWork = FDCG_UPKEEP_WORK;

inline constexpr uint32_t kBoxWork = 16;          // eight boxes tested, and put in order
inline constexpr uint32_t kLeafWork = 4;          // a leaf taken up, besides its nodes
inline constexpr uint32_t kGlanceWork = 3;        // one node fetched, both ends of the way against its plane
inline constexpr uint32_t kNodeWork = 5;          // ... and where that does not decide
inline constexpr uint32_t kBesideWork = 1;        // ... both ends of the way against one of its sides
inline constexpr uint32_t kClearVisitWork = 25;   // a record or a leaf and its nodes, how far from a place
inline constexpr uint32_t kDerivedSideWork = 16;  // ... and one side's Voronoi plane where it has to be derived
inline constexpr uint32_t kNearPlaneWork = 18;    // ... one end so near that its side is found from the corners
inline constexpr uint32_t kOrientationWork = 6;   // one side's edge against the way, where rounding cannot matter
inline constexpr uint32_t kPairsWork = 30;        // ... and where it does: 800 instructions
inline constexpr uint32_t kExactWork = 70;        // ... additional within 2^-98 of the size of a plane: 1,150
inline constexpr uint32_t kLongExactWork = 290;   // ... with coordinates of very different sizes: 8,000
inline constexpr uint32_t kTransitionWork = 10;   // one change of state
inline constexpr uint32_t kSideWork = 4;          // one side of a face that the god-object slides on
inline constexpr uint32_t kEdgeWork = 15;         // the rule of an edge
inline constexpr uint32_t kFanWork = 8;           // one edge of a corner and the face beside it
inline constexpr uint32_t kFanSignWork = 4;       // one corner against a plane, where rounding cannot matter
inline constexpr uint32_t kArcWork = 12;          // a way as seen from a busy corner
inline constexpr uint32_t kArcPlaneWork = 3;      // ... its plane against one box of the corner's fan tree
inline constexpr uint32_t kArcBoxWork = 7;        // ... and its two ends
inline constexpr uint32_t kFanEntryWork = 2;      // one entry of a fan fetched
inline constexpr uint32_t kFanBoxWork = 5;        // one box of a corner's fan tree
inline constexpr uint32_t kRenewedNodeWork = 55;  // a node's plane computed anew
inline constexpr uint32_t kRenewedLeafWork = 85;  // a leaf's box
inline constexpr uint32_t kRenewedBoxWork = 40;   // the box of a record

// Subtracts `units` from the remaining budget, down to 0.
inline void spend(uint32_t* work_left, uint32_t units) {
  *work_left = *work_left > units ? *work_left - units : 0;
}

}  // namespace fdcg
