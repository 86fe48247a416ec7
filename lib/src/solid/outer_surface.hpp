// SPDX-License-Identifier: Apache-2.0
// The outer surface of facets that may pass through each other, in coordinates that a file can hold.
#pragma once

#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "solid/facets.hpp"

namespace fdcg::bake {

struct OuterSurfaceOptions {
  bool as_floats = false;  // coordinates are rounded to floats in place of doubles
  unsigned jobs = 1;
  Progress progress{};
};

struct OuterSurface {
  enum class Outcome : std::uint8_t {
    done,
    too_many_pairs,  // of facets that meet: more than kMostMeetingPairs
    not_closed,      // the facets given
    not_settled,     // rounding brought back facets that meet, in each round
    fault,           // of the program
  };
  Outcome outcome = Outcome::done;
  // Closed; no two facets have a point in common but a shared corner or side, and the front of each is outside. Edges may have
  // more than two facets, where solids touch.
  FacetSet set;
  std::uint64_t pairs = 0;           // of facets given that met
  std::uint64_t cut = 0;             // facets given that were cut
  std::vector<std::uint32_t> inner;  // sources of facets given of which nothing stays
  int rounds = 0;                    // of rounding, 1 where it did no harm
  std::uint64_t met_again = 0;       // pairs that rounding brought back, in all rounds
  double moved = 0;                  // no point is farther than this from where it exactly was
};

// The boundary of all that closed facets enclose, that is, where their winding number is above 0. Exact, but for the rounding
// of points to the coordinates of the result; where that makes facets meet, the result is cut again, until it does not: in
// later rounds the points around go to a coarser grid.
[[nodiscard]] OuterSurface outer_surface(FacetSet set, const OuterSurfaceOptions& options);

}  // namespace fdcg::bake
