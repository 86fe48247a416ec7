// SPDX-License-Identifier: Apache-2.0
// Proves (without sampling) that every point of a triangle lies within a distance of a surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// A triangle of a surface. Corners have identifiers, by which shared edges are recognised.
struct NamedTriangle {
  std::array<Vec3, 3> point;
  std::array<std::uint32_t, 3> name;
};

// An upper bound of the distance from `p` to the triangle, tight up to rounding error.
[[nodiscard]] double distance_bound(const Vec3& p, const std::array<Vec3, 3>& triangle);

// A conservative test: if it passes, each point of the triangle lies within `distance` of one of the candidates; it may fail
// where the surface is near. Three proofs are tried.
//   Convexity  The distance to a convex set is a convex function: if all three corners are near one candidate, all points are.
//   Covering   Candidates whose corners all lie within the distance of the triangle's plane are projected onto it. The winding
//              number of their projection changes only across edges that belong to one of them alone. If no such edge enters
//              the triangle and one point is covered, all points are, by a point vertically above or below.
//   Parts      Else the triangle is divided in four and each part is tested, to a bounded depth.
// A millionth of the distance is reserved for rounding errors. Coordinates should be local (their magnitude not much larger
// than the object), and the distance more than kLeastShare of them, else the test always fails.
class SurfaceCover {
 public:
  static constexpr double kLeastShare = 0x1p-28;  // rounding of coordinates is then below a millionth of the distance

  static constexpr int kParts = 85;  // 1 + 4 + 16 + 64: three levels, where all need them

  // `largest`: of all coordinates, in magnitude.
  SurfaceCover(double distance, double largest);

  [[nodiscard]] bool is_near(const Vec3& p, const std::array<Vec3, 3>& triangle) const {
    return distance_bound(p, triangle) <= reach_;
  }
  // `used` receives the candidates that the proof uses, in no order. Work: candidates times parts, of which there are at most
  // `parts`.
  bool covers(const std::array<Vec3, 3>& triangle, std::span<const NamedTriangle> candidates, std::vector<std::uint32_t>& used,
              int parts = kParts);

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
    double reach = 0;      // largest distance of a candidate from the plane
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

  double reach_;  // the distance without the reserve
  double slack_;  // the part of the reserve used for shrinking a triangle
  bool is_usable_;
  int parts_left_ = 0;
  std::span<const NamedTriangle> candidates_;
  Frame frame_;
  std::vector<Projected> sheet_;
  std::vector<std::array<std::uint32_t, 4>> edges_;  // two names, candidate in the sheet, corner
};

}  // namespace fdcg::bake
