// SPDX-License-Identifier: Apache-2.0
// Ways with their truth, and contenders' answers, as text that any language reads: docs/rivals.md has the format.
#pragma once

#include <string>
#include <vector>

#include "truth.hpp"
#include "ways.hpp"

namespace fdcg::test {

struct WayFile {
  std::string body, mesh;  // mesh: a file, beside this one where it is not absolute
  std::string way;         // what kind of motion
  std::uint64_t seed = 0;
  double rate_hz = 1000, mu_static = 0, mu_dynamic = 0;
  std::string reference;  // what the truth is by
  Way hips;
  std::vector<Ground::Point> true_god_objects;  // empty: the file has none
};

// FOLDER/NAME.way and, where it is not there yet, FOLDER/BODY.off. Throws std::runtime_error.
void write_way(const std::string& folder, const WayFile& file, const std::vector<TrueBody::Tick>& truth,
               const bake::PolygonSoup& soup);
// FOLDER/NAME.CONTENDER.answers.
void write_answers(const std::string& folder, const WayFile& file, const std::string& contender, const std::string& precision,
                   const std::vector<Feel>& felt);
// body.way.seed.rate.friction
std::string name_of(const WayFile& file);

// How files of plain columns, recordings say, are to be read: three columns next to each other are the HIP in the mesh's frame.
struct PlainColumns {
  int first = 1;  // column of x; the first is 1
  double unit_m = 1, rate_hz = 1000;
};

// Throws std::runtime_error, naming file and line. A file without the format's first line is plain columns, set apart by
// blanks, commas or semicolons; it has neither mesh nor truth.
WayFile read_way(const std::string& path, const PlainColumns& columns);

}  // namespace fdcg::test
