// SPDX-License-Identifier: Apache-2.0
// Whether every point of a triangle lies within a distance of a surface: proved, not sampled.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A triangle of a surface. Corners have names, so that triangles which share an edge are known to.
struct NamedTriangle {
  std::array<Vec3, 3> point;
  std::array<std::uint32_t, 3> name;
};

// The distance from `p` to the triangle, its inside and border included; never less than it is, and more by rounding only.
[[nodiscard]] double distance_bound(const Vec3& p, const std::array<Vec3, 3>& triangle);

// A test that may fail where the surface is near, but never passes where it is not: each point of a triangle that passes lies
// within `distance` of one of the candidates. Three proofs are tried.
//   Convexity  The distance to a convex set is a convex function: all three corners near one candidate, all points near it.
//   Covering   Candidates whose corners all lie within the distance of the triangle's plane are projected onto it. How often
//   they
//              cover a point of the plane, counted with their winding, changes only across edges that one of them alone has.
//              Where no such edge enters the triangle and one point is covered, all are, by something right above or below.
//   Parts      Else the triangle is cut in four, and each is tried again, a bounded number of times.
// Rounding is paid for out of the distance: a millionth of it is kept back. Coordinates should be local (their magnitude not
// much larger than the object), and the distance more than kLeastShare of them, else nothing passes.
class SurfaceCover {
 public:
  static constexpr double kLeastShare = 0x1p-28;  // where coordinates are rounded by less than a millionth of the distance

  // `largest`: of all coordinates, in magnitude.
  SurfaceCover(double distance, double largest);

  [[nodiscard]] bool is_near(const Vec3& p, const std::array<Vec3, 3>& triangle) const {
    return distance_bound(p, triangle) <= reach_;
  }
  // `used` gets the candidates that the proof rests on, in no order. Work: candidates times parts.
  bool covers(const std::array<Vec3, 3>& triangle, std::span<const NamedTriangle> candidates, std::vector<std::uint32_t>& used);

 private:
  bool is_covered(const std::array<Vec3, 3>& triangle, std::vector<std::uint32_t>& used);
  bool is_near_one(const std::array<Vec3, 3>& triangle, std::vector<std::uint32_t>& used, bool& is_far);
  bool is_below_a_sheet(const std::array<Vec3, 3>& triangle, std::vector<std::uint32_t>& used);

  bool set_frame(const std::array<Vec3, 3>& triangle);
  void gather_sheet();
  [[nodiscard]] bool has_border_inside() const;

  using Triangle2 = std::array<std::array<double, 2>, 3>;
  struct Frame {
    Vec3 origin, x, y, normal;
    double reach = 0;      // how far from the plane a candidate may be
    double longest = 0;    // edge of the triangle
    Triangle2 triangle{};  // a little smaller

    [[nodiscard]] std::array<double, 2> flat(const Vec3& p) const {
      const Vec3 d{p.x - origin.x, p.y - origin.y, p.z - origin.z};
      return {d.x * x.x + d.y * x.y + d.z * x.z, d.x * y.x + d.y * y.y + d.z * y.z};
    }
  };
  struct Projected {
    Triangle2 point;
    std::uint32_t candidate;
  };

  double reach_;  // what the proofs have: the distance less what is kept back
  double slack_;  // of what is kept back, for shrinking a triangle
  bool is_usable_;
  int parts_left_ = 0;
  std::span<const NamedTriangle> candidates_;
  Frame frame_;
  std::vector<Projected> sheet_;
  std::vector<std::array<std::uint32_t, 4>> edges_;  // two names, candidate in the sheet, corner
};

}  // namespace fdcg::bake
