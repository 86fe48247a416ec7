// SPDX-License-Identifier: Apache-2.0
// A row of contenders.csv: one contender along one way.
#pragma once

#include <string>
#include <vector>

#include "bodies.hpp"
#include "metrics.hpp"
#include "timing.hpp"
#include "way_file.hpp"

namespace fdcg::test {

struct ContenderRow {
  const Body& body;
  const WayFile& along;
  const ContenderInfo& info;
  const Timing& timing;
  Metrics metrics;
  double creep_m = 0;
  LoopEnergy energy;
  double contact_instructions = 0;
};

const std::vector<std::string>& contender_columns();
// Says the most of it on standard output too.
std::vector<std::string> cells_of(const ContenderRow& row, const std::vector<TrueBody::Tick>& truth);
const char* name_of(BodyGroup group);

}  // namespace fdcg::test
