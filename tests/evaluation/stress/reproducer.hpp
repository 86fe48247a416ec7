// SPDX-License-Identifier: Apache-2.0
// A failing mesh and path in one file: an OBJ file that any viewer opens, whose comments hold the path and the parameters.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "judge.hpp"

namespace fdcg::test {

struct Reproducer {
  Body body;
  fdcg_params params{};
  std::vector<Hip> path_m;  // one HIP a tick, from a new contact on
  Fault fault = Fault::count;
  std::string command;  // that found it
};

// Numbers are written so that they come back bit for bit: coordinates with 17 digits, HIPs hexadecimal. Both throw
// std::runtime_error, naming the file.
void write_reproducer(const std::string& path, const Reproducer& reproducer);
Reproducer read_reproducer(const std::string& path);

// Steps the path; the first tick (from 0) with the fault, or -1. `log`: if given, gets a line for each tick up to there.
std::int64_t first_fault(const Specimen& specimen, const Reproducer& reproducer, std::vector<std::string>* log = nullptr);

}  // namespace fdcg::test
