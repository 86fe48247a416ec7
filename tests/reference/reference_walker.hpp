// SPDX-License-Identifier: Apache-2.0
// The contact model (Melder and Harwin 2004 with its gaps closed) by brute force, written apart from the runtime: every face is
// tested in every sweep, every face and edge around a vertex, nothing is cached and no transition is left for the next tick.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reference_surface.hpp"

namespace fdcg::test {

struct ReferenceFriction {
  double mu_static = 0, mu_dynamic = 0;
  bool is_wedge = true;  // false: the load of an edge is HIP's distance from it, as the paper has it
};

template <class Real>
struct ReferenceContact {
  Vector<Real> god_object, hip;  // local
  bool is_started = false;
  std::uint32_t state = FDCG_FREE, feature = FDCG_NONE;
  std::uint32_t seat_state = FDCG_FREE, seat_feature = FDCG_NONE;
  bool is_slipping = false;
};

// What a step did beside moving the contact.
struct ReferenceStep {
  std::uint32_t transitions = 0;
  // The smallest change of any length compared in the step, as a part of the extent, that could have turned a decision; at or
  // below rounding two outcomes are equally right. Divided by the amplification reached before the decision.
  double margin = std::numeric_limits<double>::infinity();
  // How much farther along its way a point of meeting moves than the surface or the way moves across it: where both are nearly
  // parallel, rounding is magnified by this much. The largest of the step, at least 1.
  double amplification = 1;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> visited;  // state and feature, in order
  bool met_again = false;                                        // ended by contact-model TICK-5
};

template <class Real>
class ReferenceWalker {
 public:
  ReferenceWalker(const ReferenceSurface<Real>& surface, const ReferenceFriction& friction)
      : surface_(surface), friction_(friction) {}

  // Moves the contact to a finite HIP in local coordinates.
  ReferenceStep step(const std::array<double, 3>& hip_local);
  // Takes over the runtime's contact.
  void resynchronise(const fdcg_contact& contact);

  ReferenceContact<Real> contact;

 private:
  using Point = Vector<Real>;
  using Face = typename ReferenceSurface<Real>::Face;
  using Edge = typename ReferenceSurface<Real>::Edge;
  using Corner = typename ReferenceSurface<Real>::Corner;
  struct Hit {
    Real t, change;  // where on the segment; by how much it goes below the face's plane from the front
    std::uint32_t state, feature;
    Point point;
  };
  enum class Friction { rests, moves };

  void step_free();
  void step_face();
  void step_edge();
  void step_vertex();

  void change(std::uint32_t state, std::uint32_t feature);
  void release(std::vector<std::uint32_t> left_out_faces);
  void rest() { is_resting_ = true; }
  void seat(std::uint32_t state, std::uint32_t feature);
  Friction decide_friction(const Real& r, const Real& load, const Real& load_error);
  void move_on_face(const Face& face, const Point& target);
  void place_on_edge(std::uint32_t connection, const Real& along);
  Real edge_load(const Edge& edge, const Point& from_line, Real& load_error, bool& is_fold) const;
  std::optional<Hit> sweep(const Point& from, const Point& to);
  Real beside(std::uint32_t face, const Point& point) const;
  std::optional<Hit> meet(std::uint32_t face, const Point& from, const Point& to);
  Hit located(const Face& face, std::uint32_t f, const Real& side_from, const Real& side_to, const Point& from,
              const Point& to);
  void note(const Real& distance);
  void amplify(const Real& way, const Real& change);

  const ReferenceSurface<Real>& surface_;
  ReferenceFriction friction_;
  Point hip_;
  bool is_resting_ = false;
  // The god-object is a HIP, a stored corner or was taken over as double: with HighPrecision a sweep from there is exact, and
  // its signs are no matter of rounding.
  bool is_exact_place_ = false;
  std::vector<std::uint32_t> left_out_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Real> met_;  // squared |GO - HIP| where a feature was entered
  ReferenceStep step_;
};

std::string describe(const ReferenceStep& step);

}  // namespace fdcg::test
