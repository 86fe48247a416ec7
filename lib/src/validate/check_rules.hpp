// SPDX-License-Identifier: Apache-2.0
// The rules of the catalogue that run on a mesh: one function per rule, with its name. issues.cpp defines what each counts.
#pragma once

#include "validate/findings.hpp"

namespace fdcg::bake::checks {

// rules_vertices.cpp
void non_finite_coordinate(const Subject& subject, Findings& out);
void non_manifold_vertex(const Subject& subject, Findings& out);
void isolated_vertex(const Subject& subject, Findings& out);
void duplicate_vertex(const Subject& subject, Findings& out);

// rules_faces.cpp
void index_out_of_range(const Subject& subject, Findings& out);
void empty_mesh(const Subject& subject, Findings& out);
void degenerate_face(const Subject& subject, Findings& out);
void self_crossing_face(const Subject& subject, Findings& out);
void duplicate_face(const Subject& subject, Findings& out);
void non_planar_face(const Subject& subject, Findings& out);
void sliver_face(const Subject& subject, Findings& out);

// rules_edges.cpp
void non_manifold_edge(const Subject& subject, Findings& out);
void winding_inconsistent(const Subject& subject, Findings& out);
void folded_edge(const Subject& subject, Findings& out);
void boundary_edge(const Subject& subject, Findings& out);
void t_junction(const Subject& subject, Findings& out);

// rules_patches.cpp
void not_orientable(const Subject& subject, Findings& out);
void inside_out(const Subject& subject, Findings& out);

// rules_intersections.cpp
void self_intersection(const Subject& subject, Findings& out);

}  // namespace fdcg::bake::checks
