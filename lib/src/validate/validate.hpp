// SPDX-License-Identifier: Apache-2.0
// The checks on a welded mesh, shared by validate() of bake.hpp and compile().
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

struct CheckOptions {
  std::set<std::string> allow;                                // of these, the rules that can be allowed
  std::map<std::string, std::optional<Severity>> severities;  // in place of the catalogue's; none: the rule is not run
  std::optional<Severity> fail_on = Severity::error;
  std::size_t max_elements = kListedElements;  // listed under a rule
  Precision precision = Precision::f64;        // that weld_points rounded to: non-planar-face tolerates it
  unsigned jobs = 1;                           // threads; the report does not depend on it
  Progress progress;                           // called from one thread at a time
  EachElement each_element{};
};

// A soup prepared for the checks, in the same way by compile and validate.
struct Prepared {
  Mesh mesh;
  std::vector<FaceState> states;
  Topology topology;
  std::uint64_t flipped_faces = 0;  // by orient
};
[[nodiscard]] Prepared prepare(const PolygonSoup& soup, const Weld& weld, Precision precision, bool orient, unsigned jobs);

// Runs the rules of the catalogue except `unreadable` (reported by import); Report::checks names those that ran. `mesh` is
// weld_points(soup, ...), possibly oriented; `states` and `topology` are those of face_states and pair_halfedges.
// Report::vertices counts the welded vertices, as the rules do. Elements have the indices of the soup, for joined vertices that
// of the first. An element lists at most 32 faces and counts the rest. Near linear.
[[nodiscard]] Report check(const PolygonSoup& soup, const Mesh& mesh, const Topology& topology,
                           const std::vector<FaceState>& states, const CheckOptions& options);

}  // namespace fdcg::bake
