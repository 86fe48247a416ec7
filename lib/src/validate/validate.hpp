// SPDX-License-Identifier: Apache-2.0
// The checks themselves, on a welded mesh; validate() of bake.hpp and compile() both end here, so that they cannot disagree.
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

// A soup made ready for the checks, by compile as by validate.
struct Prepared {
  Mesh mesh;
  std::vector<FaceState> states;
  Topology topology;
  std::uint64_t flipped_faces = 0;  // by orient
};
[[nodiscard]] Prepared prepare(const PolygonSoup& soup, const Weld& weld, Precision precision, bool orient, unsigned jobs);

// Runs the rules of the catalogue but unreadable (import's); Report::checks
// names those that ran. `mesh` is weld_points(soup, ...), perhaps oriented; `states` and `topology` are those of face_states
// and pair_halfedges. Report::vertices counts the welded vertices, as the rules do. Elements speak of the soup's own numbers:
// of joined vertices the first. An element names at most 32 faces and counts the rest. Near linear.
[[nodiscard]] Report check(const PolygonSoup& soup, const Mesh& mesh, const Topology& topology,
                           const std::vector<FaceState>& states, const CheckOptions& options);

}  // namespace fdcg::bake
