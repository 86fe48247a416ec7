// SPDX-License-Identifier: Apache-2.0
// The graphs that the step benchmarks run on: bodies of 0.1 m, compiled in memory, and ways for a hand to go along them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::test {

constexpr double kObject_m = 0.1;  // size of every body

using Point = std::array<double, 3>;

// A compiled mesh and the view of it. Ends the program where the mesh does not compile.
class BenchGraph {
 public:
  BenchGraph(const bake::PolygonSoup& soup, const bake::CompileOptions& options);
  ~BenchGraph() { fdcg_close(&view_); }
  BenchGraph(const BenchGraph&) = delete;
  BenchGraph& operator=(const BenchGraph&) = delete;

  [[nodiscard]] const fdcg_graph& view() const { return view_; }
  [[nodiscard]] double bytes_per_face() const { return static_cast<double>(bytes_.size()) / view_.header->source_face_count; }

 private:
  std::vector<std::byte> bytes_;
  fdcg_graph view_ = {};
};

enum class Body {
  cube,    // 12 triangles, flat neighbours not merged
  block,   // the same merged: 6 faces
  sphere,  // geodesic: all edges convex
  rough    // the same with its points pushed in and out by up to a tenth of an edge: half of its edges concave
};

bake::PolygonSoup make_body(Body body, int parts);
constexpr int faces_of(Body body, int parts) {
  return body == Body::cube ? 12 : body == Body::block ? 6 : 20 * parts * parts;
}

// Where a body's surface is, and how densely a way along it crosses edges.
class Surface {
 public:
  Surface(Body body, int parts);
  // The point at `depth` below the surface (negative: above) in the direction of a unit vector from the middle.
  [[nodiscard]] Point point(const Point& direction, double depth_m) const;
  // A HIP inside the solid does not go round a sharp rim: it stays in contact with the side that it came through. So a slide
  // leaves a cube's side before its rim and comes back on the next.
  [[nodiscard]] bool is_near_rim(const Point& direction) const;
  // Metres of way that cross one face in the mean.
  [[nodiscard]] double face_way_m() const { return face_way_m_; }
  [[nodiscard]] double edge_m() const { return edge_m_; }

 private:
  std::vector<Point> normals_;  // of the faces' planes, where they are few enough to matter; all as far from the middle
  std::vector<double> offsets_m_;
  double face_way_m_ = 0, edge_m_ = 0;
  bool is_box_ = false;
};

// HIPs in metres, one a tick.
using Path = std::vector<Point>;

// Along the surface on a great circle that turns as it goes, so that no place is met again soon; every quarter of a second the
// hand leaves the surface and comes back. `way_m` a tick, `depth_m` under the surface.
Path slide(const Surface& surface, double way_m, double depth_m, int ticks);
// The same at a height above the surface, never touching.
Path hover(const Surface& surface, double way_m, double height_m, int ticks);
// Along a line that passes the body at ten times its size.
Path far_away(double way_m, int ticks);
// Anywhere in a cube of 1.2 times the body, another place every tick.
Path teleports(int ticks, unsigned seed);

}  // namespace fdcg::test
