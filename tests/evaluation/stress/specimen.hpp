// SPDX-License-Identifier: Apache-2.0
// One body that the runner steps on, with all that its judges look up: the graph, its features' planes, and which points are
// inside. In the graph's own frame ("local") unless a name says otherwise.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "certificate.hpp"
#include "contact_rig.hpp"
#include "descent.hpp"
#include "inside_grid.hpp"

namespace fdcg::test {

inline Hip hip_of(const double (&a)[3]) {
  return {a[0], a[1], a[2]};
}

inline bool is_same(const double (&a)[3], const double (&b)[3]) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// A body as a case makes it.
struct Body {
  bake::PolygonSoup soup;  // source units
  bake::CompileOptions options;
  bool is_closed = true;             // and free of self-intersection: the inside is known
  bool sheets_meet = false;          // faces cross or touch others than their neighbours
  std::vector<std::uint32_t> focus;  // points of the soup at which hands like to be; may be empty
  std::string description;
};

// What a feature is, in double precision: derived from the corners, which are the source's points. Only which corners a feature
// has, and the planes of merged faces whose corners lie off them, are the file's.
struct NodeShape {
  Hip normal;
  double offset;
  std::uint32_t first_side, side_count;  // in Specimen::rims
  bool is_planar;                        // exactly: else the file's plane
};
struct Rim {  // a Voronoi plane
  Hip normal;
  double offset;
  std::uint32_t edge;
};
struct EdgeShape {
  Hip start, direction;
  double length;
  std::uint32_t type;  // fdcg_connection_type
  std::uint32_t corner[2];
  std::uint32_t node[2];  // node[1] FDCG_NONE on a boundary
};
struct CornerShape {
  Hip point, normal;
  bool is_open;    // on a boundary
  bool is_shared;  // another corner is at the same point
};

// Throws std::runtime_error where the compiler refuses the body.
class Specimen {
 public:
  explicit Specimen(Body body);

  const Body body;
  const CompiledMesh mesh;
  std::vector<NodeShape> nodes;
  std::vector<Rim> rims;
  std::vector<EdgeShape> edges;
  std::vector<CornerShape> corners;
  std::vector<std::uint32_t> focus_corners;  // corners of the graph nearest to body.focus
  std::vector<Hip> busy_points;              // corners of more than FDCG_BUSY_FAN connections
  double stated_deviation = 0;               // how far, by its file, the graph's faces lie from the mesh's
  std::unique_ptr<InsideGrid> inside;        // of closed bodies
  std::unique_ptr<Descent> descent;          // at corners that are neither open nor shared
  std::unique_ptr<Certificate> certificate;  // of those whose faces are planar exactly

  [[nodiscard]] const fdcg_graph& graph() const { return mesh.view(); }
  [[nodiscard]] const fdcg_header& header() const { return *mesh.view().header; }
  // Of a node that is planar exactly: 1 in front of it, 0 on its plane, -1 behind it.
  [[nodiscard]] int exact_side(std::uint32_t node, const Hip& x) const;
  [[nodiscard]] double epsilon() const { return header().real_bytes == 8 ? 0x1p-52 : 0x1p-23; }

 private:
  void read_corners();
  void read_shapes();
  [[nodiscard]] std::uint32_t type_between(std::uint32_t a, std::uint32_t b, std::uint32_t stored) const;
  void read_deviation();
  void find_focus();
};

inline double signed_distance(const Hip& normal, double offset, const Hip& x) {
  return normal[0] * x[0] + normal[1] * x[1] + normal[2] * x[2] + offset;
}

inline Hip cross_product(const Hip& a, const Hip& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace fdcg::test
