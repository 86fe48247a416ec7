// SPDX-License-Identifier: Apache-2.0
// Physical laws that the step has to obey, each measured by a part of its own. Every part writes its tables into
// LawOptions::output, says its bars, and gives the same numbers for the same seed on any number of threads.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>

#include "table.hpp"

namespace fdcg::test {

struct LawOptions {
  bool is_quick = false;
  std::string output = ".";
  std::uint64_t seed = 1;
  unsigned threads = 2;
};

constexpr double kPi = std::numbers::pi;
constexpr double kObject_m = 0.1;  // the largest coordinate of every body: its extent

// Coulomb's law: stick or slip over a grid of friction and lean (coulomb_ramps.csv), and the ratio of tangential to normal
// force over slides (coulomb_slides.csv).
void measure_ramps(const LawOptions& options, Bars& bars);
void measure_slides(const LawOptions& options, Bars& bars);

// The work that closed loops of the HIP do on the user, against what sampling allows (energy.csv, energy_histogram.csv).
void measure_energy(const LawOptions& options, Bars& bars);

// Sphere, cylinder, torus and cone by formula against eight levels of tessellation (tessellation.csv).
void measure_tessellation(const LawOptions& options, Bars& bars);

// What is felt of a sphere's facets, with and without shading (shading.csv).
void measure_shading(const LawOptions& options, Bars& bars);

// Heights on a flat face against their formula, and what they cost (relief.csv).
void measure_relief(const LawOptions& options, Bars& bars);

// The same of scans (scans.csv), where Debian's libcgal-demo has them.
void measure_scans(const LawOptions& options, Bars& bars);

// Break-away, leap, turn and the saw-tooth of a pulled hand against their formulas (stick_slip.csv, stick_slip_trace.csv).
void measure_stick_slip(const LawOptions& options, Bars& bars);

// Ticks at rest under static friction (creep.csv).
void measure_creep(const LawOptions& options, Bars& bars);

}  // namespace fdcg::test
