// SPDX-License-Identifier: Apache-2.0
// A triangulation of points and segments in one plane, exact in every decision that its validity rests on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solid/meeting_points.hpp"

namespace fdcg::bake {

// Starts as one triangle, which holds everything that is inserted. Segments may touch, cross and overlap: where they cross, a
// point is made. Shapes are kept near to those of a Delaunay triangulation, by rounded arithmetic: they are a matter of taste,
// and only diagonals of strictly convex quadrilaterals, exactly so, are exchanged.
class PlaneTriangulation {
 public:
  using Local = std::uint32_t;  // the number of a vertex in here
  static constexpr std::uint32_t kNothing = 0xFFFFFFFFu;

  struct Face {
    std::array<Local, 3> corner;                                        // counter-clockwise as seen
    std::array<std::uint32_t, 3> across{kNothing, kNothing, kNothing};  // the face at the side from corner i to the next
    std::array<std::uint32_t, 3> line{kNothing, kNothing, kNothing};    // the support line of that side where it is a segment
    std::array<std::int32_t, 3> along{};  // of the segments there: those that run this way less the others
  };

  // `triangle`: whose plane it is. It is seen along the axis, from the side on which its corners are counter-clockwise.
  PlaneTriangulation(MeetingPoints& meeting, std::uint32_t triangle, int axis);

  // The first triangle, counter-clockwise as seen. Once, before anything else.
  void start(const std::array<PointId, 3>& corners);
  // A point of the first triangle; the vertex at its place, which may be an earlier one.
  Local insert(PointId p);
  // `along`: counted on its sides as Face::along. False by a fault of this class only.
  [[nodiscard]] bool insert_segment(Local a, Local b, const SupportLine& line, std::int32_t along);
  // Exchanges diagonals for better shapes.
  void improve();

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] PointId point(Local v) const { return vertices_[v]; }

 private:
  struct Corner {  // corner i of a face
    std::uint32_t face, i;
  };
  struct Place {
    enum class Kind : std::uint8_t { face, side, vertex } kind;
    std::uint32_t face, i;
  };

  [[nodiscard]] int orient(Local a, Local b, Local c) const;
  [[nodiscard]] bool is_ahead(Local from, Local to, Local x) const;
  [[nodiscard]] Place locate(PointId p);
  [[nodiscard]] std::optional<Place> place_in(std::uint32_t f, PointId p, std::uint32_t& beyond) const;
  Local add_vertex(PointId p);
  void link(std::uint32_t f, std::uint32_t i, std::uint32_t g);
  [[nodiscard]] std::uint32_t side_from(std::uint32_t f, Local v) const;
  void split_face(std::uint32_t f, Local v);
  void split_side(std::uint32_t f, std::uint32_t i, Local v);
  bool flip(std::uint32_t f, std::uint32_t i);
  [[nodiscard]] bool is_better_flipped(std::uint32_t f, std::uint32_t i) const;
  void legalise(Local v);
  // All corners at the vertex.
  [[nodiscard]] const std::vector<Corner>& corners_at(Local v);
  [[nodiscard]] std::optional<Corner> side_between(Local a, Local b);
  void mark(Local a, Local b, std::uint32_t line, std::int32_t along);

  struct Step {
    Local next;            // the vertex to go on to
    bool is_made = false;  // it still has to become a neighbour
  };
  [[nodiscard]] std::optional<Step> step_towards(Local a, Local b, std::uint32_t line);
  [[nodiscard]] bool make_side(Local a, Local b);

  MeetingPoints& meeting_;
  std::uint32_t triangle_;
  int axis_, sign_ = 1;
  Vec3 origin_, x_, y_;  // of flat coordinates, for shapes
  std::vector<PointId> vertices_;
  std::vector<std::array<double, 2>> flat_;
  std::vector<std::uint32_t> face_at_;  // some face at each vertex
  std::vector<Face> faces_;
  std::vector<SupportLine> lines_;
  std::vector<std::array<Local, 2>> crossed_;  // by the segment that is being made
  std::vector<Corner> around_;
  std::uint32_t last_ = 0;
};

}  // namespace fdcg::bake
