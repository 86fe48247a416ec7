// SPDX-License-Identifier: Apache-2.0
// Polygon soup -> indexed mesh in the local frame: the first stage after import.
#pragma once

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// Moves the points to the local frame, rounds them to the storage precision, and joins those that `weld` calls equal.
//
// Origin, for each axis on its own: with c the centre and h the half extent of the finite coordinates, it is c where
// |c| >= 3h, else 0. Every coordinate x then lies within [2c/3, 4c/3], so that x - c is exact (Sterbenz' lemma): the local
// frame loses nothing in f64, and in f32 the rounding is relative to the object's size and not to its distance.
//
// Joined vertices: the first of a group in source order represents it (mesh.source_point), vertices keep the order of first
// appearance, and vertices of no face remain. NaN, infinities and coordinates that overflow a float are never joined.
//   exact     equal local coordinates, -0 = 0
//   none      none
//   distance  each point in source order joins the lowest-numbered kept vertex within `distance` of it (local coordinates,
//             found by a grid), else is kept itself. No chains: a vertex never moves by more than `distance`.
//             A distance that is not above 0 means exact.
// Corners with an invalid index become VertexId{kNone}. Linear time; the result does not depend on `jobs`.
[[nodiscard]] Mesh weld_points(const PolygonSoup& soup, const Weld& weld, Precision precision, unsigned jobs = 1);

}  // namespace fdcg::bake
