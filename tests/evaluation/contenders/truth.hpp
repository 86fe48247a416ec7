// SPDX-License-Identifier: Apache-2.0
// What a HIP's way should feel like: the contact model's god-object, tick by tick, from where the way has come.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contender.hpp"
#include "reference_walker.hpp"
#include "ways.hpp"

namespace fdcg::test {

// A decision within this part of the extent is a tie to floats, to doubles: so near, the contact model takes a place to be on a
// plane (FACE-5, 4 eps (|x|_1 + extent), here with |x|_1 of one extent).
// What is a tie to doubles is decided in 256 bits, from where long double stands, before another answer is taken to be as
// right.
constexpr double kTie = 0x1p-20, kTieOfDoubles = 0x1p-49;

constexpr double kApart_m = 5e-6;  // of two answers: far beyond rounding and a proxy's gap, and no hand feels it

// From here on brute force takes gigabytes and minutes: the truth is this runtime's in double, unmerged, and at sampled ticks
// checked to be the closest point of the mesh, which is sufficient, not necessary.
constexpr std::uint32_t kLargestBruteForce = 2'000'000;  // faces

// Up to here a tie is decided in 256 bits: another surface, of three kilobytes a face, made when the first tie is met.
constexpr std::uint32_t kLargestIn256Bits = 200'000;  // faces

// A body's unmerged graph in some precision, and the contact model on it: by brute force in long double, and in 256 bits where
// those do not surely decide.
class ModelOfBody {
 public:
  ModelOfBody(const Ground& ground, bake::Precision precision);

  // Null: the body is too large.
  [[nodiscard]] const ReferenceSurface<long double>* surface() const { return surface_.get(); }
  [[nodiscard]] const fdcg_graph& view() const { return view_; }
  [[nodiscard]] bool is_decided_in_256_bits() const { return view_.header->node_count <= kLargestIn256Bits; }
  ReferenceStep step(ReferenceWalker<long double>& walker, const std::array<double, 3>& hip_local,
                     const ReferenceFriction& friction) const;
  [[nodiscard]] Feel feel_of(const ReferenceContact<long double>& contact, const Ground::Point& hip_m,
                             const Ground::Point& shift_m) const;

 private:
  std::vector<std::byte> file_;
  fdcg_graph view_{};
  std::unique_ptr<ReferenceSurface<long double>> surface_;
  mutable std::unique_ptr<ReferenceSurface<Mpfr256>> widest_;  // from the first tie on
};

// A body's unmerged graph in double, with what the truth is computed from. For one thread at a time.
class TrueBody {
 public:
  // Some kilobyte a face.
  explicit TrueBody(const Ground& ground);

  using Feature = std::pair<std::uint32_t, std::uint32_t>;  // state, index
  // What the god-object was on in a tick, in order, from where the one before ended.
  struct Visit {
    std::vector<Feature> features;  // empty: not known, or a HIP that was free and clear of everything
    double margin = 1;              // as ReferenceStep's: below a tie another way is as right
  };
  struct Tick {
    Feel feel;
    std::uint32_t state = FDCG_FREE, feature = FDCG_NONE;
    Visit visit;
    // Answers that are as right. A decision that is closer than floats tell apart, kTie of the extent, is a tie: from there on
    // four more walkers are followed, of hands that are kTie of the extent off, one to each corner of a tetrahedron, so that
    // every plane is passed on both sides. One ends when it is on the truth's feature again. Here are those that are kApart_m
    // or more off; the last `as_right_in_doubles` are of kTieOfDoubles, and alone as right for what computes in double.
    std::vector<Feel> others;
    std::size_t as_right_in_doubles = 0;
    // The model's own answer where HIP and corners are rounded to floats, as a graph of floats has them (contact-model TICK-4):
    // no tie for who computes so. Of ways that meet a tie; among the others too where it is as far off.
    std::optional<Feel> in_floats;
    [[nodiscard]] std::span<const Feel> others_for(bool is_double) const {
      return std::span(others).last(is_double ? as_right_in_doubles : others.size());
    }
  };
  // Sweeps through free space are skipped where the ground is farther than the way is long.
  [[nodiscard]] std::vector<Tick> follow(const Way& way, const ReferenceFriction& friction) const;
  // What follow() is by, for a table: for a body too large, how many of the sampled contacts passed the check.
  [[nodiscard]] std::string reference(const Way& way, const std::vector<Tick>& ticks) const;

  // Where a way stands: what the next tick needs to know of the last.
  struct Place {
    Feature feature{FDCG_FREE, FDCG_NONE};
    Ground::Point god_object{}, hip{};
  };
  // The tick that leads from there to this HIP; moves `place` to its end. Not for bodies that are too large for brute force.
  [[nodiscard]] Visit visit(Place* place, const Ground::Point& hip_m, const ReferenceFriction& friction) const;
  [[nodiscard]] bool can_visit() const { return model_.surface() != nullptr; }

  // From a point to the closed feature, in metres.
  [[nodiscard]] double distance_to(std::uint32_t state, std::uint32_t feature, const Ground::Point& point) const;

 private:
  class Branches;
  class Walk;
  [[nodiscard]] std::vector<Tick> follow_by_runtime(const Way& way, const ReferenceFriction& friction) const;
  void follow_in_floats(const Way& way, const ReferenceFriction& friction, std::vector<Tick>& ticks) const;

  const Ground& ground_;
  ModelOfBody model_;
  mutable std::unique_ptr<ModelOfBody> in_floats_;  // from the first tie on
};

}  // namespace fdcg::test
