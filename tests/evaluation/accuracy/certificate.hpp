// SPDX-License-Identifier: Apache-2.0
// Whether a frictionless god-object is where the model has it, by exact rational arithmetic and from the model's principle
// alone: at rest the god-object is a local minimum of |x - HIP| over the closed outside of the solid. No walk is replayed, so
// no error of a walk can hide in it.
//
// Exact are the stored corners, the planes through them, which edges are convex, and the HIP. Of a node marked
// FDCG_NODE_INEXACT, whose corners span no plane, the stored plane is taken; header.max_deviation then is the limit of
// exactness.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <vector>

#include "fdcg/fdcg.h"
#include "vector.hpp"

namespace fdcg::test {

using Rational = mpq_class;

struct CertifiedFeature {
  std::uint32_t state = FDCG_FREE, index = FDCG_NONE;
  friend bool operator==(const CertifiedFeature&, const CertifiedFeature&) = default;
};

class Certificate {
 public:
  explicit Certificate(const fdcg_graph& graph);

  enum class Verdict {
    certified,      // the runtime's feature holds the minimum
    tie,            // a neighbour does, within rounding of the god-object or of where the runtime's feature would have it
    wrong_feature,  // a neighbour does, elsewhere
    refused         // neither
  };
  struct Answer {
    Verdict verdict = Verdict::refused;
    CertifiedFeature feature;  // that holds the minimum
    double error_ulps = 0;     // of the god-object from it; refused: from the foot of the HIP on the runtime's feature
    // Certified, on a face: the god-object and the minimum both lie on one of its sides but for what contact-model FACE-5
    // allows, so much; 0: they do not.
    double rim_ulps = 0;
  };

  // For a contact (not FDCG_FREE) of a step without friction. Cost: some ten microseconds; one for each feature around where
  // the runtime's own does not hold.
  [[nodiscard]] Answer check(const std::array<double, 3>& hip_local, const fdcg_contact& contact) const;

  // Whether check() finds a minimum, or a tie, for a HIP within `most_ulps` of this one, by trial: backward error.
  [[nodiscard]] bool holds_nearby(const std::array<double, 3>& hip_local, const fdcg_contact& contact, double most_ulps) const;

  // Whether |x - hip| has a local minimum over the closed outside at hip's foot on the feature, the foot lies in the closed
  // feature, and hip is not in front of it.
  [[nodiscard]] bool holds(CertifiedFeature feature, const std::array<double, 3>& hip_local) const;

 private:
  using Point = Vector<Rational>;
  struct Face {
    std::vector<std::uint32_t> corners, connections;  // connection k runs from corner k to corner k + 1
    std::vector<Point> outward;                       // of each side: in the face's plane, out of the face
    Point normal, through;
    Rational normal2;
    bool is_planar = true;
  };
  struct Edge {
    std::array<std::uint32_t, 2> corner{}, face{}, side{};
    std::uint32_t type = FDCG_CONVEX;
    Point span;  // from corner[0] to corner[1]
    Rational span2;
  };
  struct Corner {
    Point point;
    std::vector<std::uint32_t> connections, faces;
    bool is_open = false;
  };

  void read(const fdcg_graph& graph);
  void derive_face(Face& face, const fdcg_node_info& record);
  void derive_type(Edge& edge) const;
  [[nodiscard]] bool feature_holds(CertifiedFeature feature, const Point& hip) const;
  [[nodiscard]] bool face_holds(std::uint32_t f, const Point& hip) const;
  [[nodiscard]] bool edge_holds(std::uint32_t c, const Point& hip) const;
  [[nodiscard]] bool inside_of_edge_holds(const Edge& edge, const Point& hip) const;
  [[nodiscard]] bool corner_holds(std::uint32_t v, const Point& hip) const;
  [[nodiscard]] bool is_behind_corner(std::uint32_t v, const Point& t) const;
  [[nodiscard]] bool climbs_into(const Face& face, std::uint32_t corner, const Point& t) const;
  [[nodiscard]] Point foot(CertifiedFeature feature, const Point& hip) const;
  [[nodiscard]] std::array<double, 3> moved_below(const fdcg_contact& contact, const std::array<double, 3>& hip) const;
  [[nodiscard]] std::array<double, 3> moved_over(const Face& face, const std::array<double, 3>& hip, double by) const;
  [[nodiscard]] std::vector<CertifiedFeature> around(CertifiedFeature feature) const;
  [[nodiscard]] double rim_ulps(CertifiedFeature feature, const Point& minimum, const Point& god_object) const;

  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<Corner> corners_;
  double ulp_, extent_, epsilon_;
  double tie_ulps_;
};

}  // namespace fdcg::test
