// SPDX-License-Identifier: Apache-2.0
// Does the geometry agree with the records? Opening a file does not check this, since the step stays within its bounds either
// way. For files whose checksums match but whose writer is in doubt.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::tools {

struct Invariant {
  std::string name;
  std::uint64_t checked = 0;
  std::uint64_t violations = 0;
  double worst = 0;         // largest deviation met
  double limit = 0;         // what it may be: rounding of the file's precision, scaled with the object
  std::int64_t first = -1;  // the record of the first violation
};

// Every invariant over every record of a graph that FDCG_VERIFY_FULL has passed. Cost: linear in the file.
std::vector<Invariant> check_invariants(const fdcg_graph& graph, const bake::Progress& progress = {});

// The one about mass properties; none where the file has no such section. A part of check_invariants.
std::vector<Invariant> check_mass(const fdcg_graph& graph);

}  // namespace fdcg::tools
