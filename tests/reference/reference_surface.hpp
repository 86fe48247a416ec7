// SPDX-License-Identifier: Apache-2.0
// The surface of an opened graph in a wide number type, for the reference: taken from the file are the corners' coordinates,
// which indices hang together, and the types. Planes, edge vectors and corner normals are computed anew; only of a node marked
// FDCG_NODE_INEXACT, whose corners span no plane, the stored plane is used.
//
// Side functions multiply out before they divide, so that with HighPrecision the sign of an exact zero is zero.
#pragma once

#include <array>
#include <boost/multiprecision/mpfr.hpp>
#include <cstdint>
#include <vector>

#include "fdcg/fdcg.h"
#include "vector.hpp"

namespace fdcg::test {

// 150 decimal digits (some 500 bits): the orientation of points given as double is exact for any sensible range of exponents.
using HighPrecision =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<150, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

// 256 bits: as far beyond double as any forward error asks for, at half the cost.
using Mpfr256 =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<77, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

// A plane with a normal that was not normalised: side(x) = direction . (x - point) / scale.
template <class Real>
struct ReferencePlane {
  Vector<Real> direction, point;
  Real scale{1};  // the direction's length

  [[nodiscard]] Real side(const Vector<Real>& x) const { return dot(direction, x - point) / scale; }
  [[nodiscard]] Vector<Real> normal() const { return direction * Real(1 / scale); }
};

template <class Real>
class ReferenceSurface {
 public:
  struct Face {
    std::vector<std::uint32_t> corners, connections;  // connection k runs from corner k to corner k + 1
    ReferencePlane<Real> plane;
    Vector<Real> normal;
    bool is_exact = true;
  };
  struct Edge {
    std::array<std::uint32_t, 2> corner{}, face{};  // face[1] FDCG_NONE on a boundary
    std::uint32_t type = FDCG_CONVEX;
    Vector<Real> span, direction;  // from corner[0] to corner[1]; of unit length
    Real length{0};
    std::array<ReferencePlane<Real>, 2> voronoi;  // out of face[0], out of face[1]
  };
  struct Corner {
    Vector<Real> point, normal;
    std::vector<std::uint32_t> connections, faces;
    bool is_open = false;
  };

  explicit ReferenceSurface(const fdcg_graph& graph);

  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<Corner> corners;
  std::vector<std::array<double, 4>> coarse_planes;  // of the faces: unit normal, offset; for a first look
  double extent = 0;                                 // header.extent
  double epsilon = 0;                                // of the file's number type
  std::array<double, 3> origin{};
  double metres_per_unit = 1;
  bool is_f32 = false;

  // The HIP as the step sees it: local, rounded as the file's number type asks.
  [[nodiscard]] std::array<double, 3> local(const double hip_object_m[3]) const;

  // Connections between two exact nodes whose type is not the sign of (n_a x n_b) . e, folds aside. Exact with HighPrecision.
  [[nodiscard]] std::vector<std::uint32_t> wrong_types() const;

 private:
  void read(const fdcg_graph& graph);
  void derive_plane(Face& face);
  void derive_edge(Edge& edge);
  void derive_corner_normal(Corner& corner);
};

}  // namespace fdcg::test
