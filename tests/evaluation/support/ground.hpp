// SPDX-License-Identifier: Apache-2.0
// Where a body's surface is: what ways are made along, and what tells inside from outside for judges. In double, by CGAL's
// tree; good to rounding, not exact.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

class Ground {
 public:
  using Point = std::array<double, 3>;

  // Convex faces, vertices shared by index. About a microsecond a face, some 400 bytes a face.
  explicit Ground(bake::PolygonSoup soup);
  ~Ground();
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;

  struct Closest {
    Point point, normal;     // on the surface; the face's own, outward, of unit length
    Point feature_normal;    // angle-weighted over the faces at the vertex or edge that the point is on (Baerentzen and Aanaes
                             // 2005): its sign tells inside; of unit length
    std::uint32_t face = 0;  // of the soup
    double distance = 0;     // of the asked point, never negative
  };
  // Some microseconds at a million faces. Safe from several threads.
  [[nodiscard]] Closest closest(const Point& point) const;
  // The same of one triangle: faces cut into fans, in order; where all faces are triangles, of face `triangle`.
  [[nodiscard]] Closest closest_of(const Point& point, std::uint32_t triangle) const;
  // Negative inside. Of closed bodies only.
  [[nodiscard]] double signed_distance(const Point& point) const;

  [[nodiscard]] const bake::PolygonSoup& soup() const { return soup_; }
  [[nodiscard]] const Point& low() const { return low_; }
  [[nodiscard]] const Point& high() const { return high_; }
  [[nodiscard]] Point corner(std::uint32_t index) const;
  [[nodiscard]] const Point& corner_normal(std::uint32_t index) const { return corner_normals_[index]; }
  // The corners that an edge leads to, in no special order; an edge between two faces once.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t corner) const;
  [[nodiscard]] const Point& face_normal(std::uint32_t face) const { return face_normals_[face]; }

 private:
  struct Tree;
  struct EdgeUse {
    std::uint64_t ends;  // lesser corner << 32 | greater
    std::uint32_t face;
  };
  void find_normals();
  void find_edges();
  [[nodiscard]] Point edge_normal(std::uint32_t a, std::uint32_t b, std::uint32_t face) const;

  bake::PolygonSoup soup_;
  Point low_{}, high_{};
  std::vector<Point> face_normals_, corner_normals_;
  std::vector<EdgeUse> edges_;  // by ends
  std::vector<std::uint32_t> neighbours_, first_neighbour_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace fdcg::test
