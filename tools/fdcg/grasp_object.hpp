// SPDX-License-Identifier: Apache-2.0
// The object that is grasped: where its surface is, its centre and its size.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::tools {

// Whether the file begins as an FDCG file; no where it cannot be read.
bool is_graph_file(const std::string& path);

// The point of a surface that is nearest to another.
struct SurfacePoint {
  bake::Vec3 point_m{};
  bake::Vec3 outward{};     // the face's unit normal
  double distance_m = 0;    // from the point that was asked for
  std::uint32_t node = 0;   // the face, as `fdcg inspect --dump` numbers them
  bool is_on_edge = false;  // faces of other normals are as near; this is the one whose normal looks most towards the point
                            // asked for, the first of equal ones
};

// Faces are convex polygons of the object's frame, metres.
class GraspObject {
 public:
  // An FDCG file, verified in full, or a mesh, compiled with these options, in the unit that it states unless one was given;
  // "-" is no name of either. The failure's exit code is 1 where the mesh has errors, 3 where it cannot be read.
  static bake::Result<GraspObject> load(const std::string& path, const bake::CompileOptions& options, bool is_unit_given);

  // `point_m` finite. Work: linear in the faces.
  [[nodiscard]] SurfacePoint nearest(const bake::Vec3& point_m) const;
  // Of the enclosed volume; none where the surface is open or encloses none.
  [[nodiscard]] std::optional<bake::Vec3> centroid_m() const;
  // As the FDCG file says it (compile --density, --mass).
  [[nodiscard]] std::optional<double> mass_kg() const { return mass_kg_; }
  [[nodiscard]] double farthest_from(const bake::Vec3& centre_m) const;  // the largest distance of a corner
  [[nodiscard]] std::uint32_t face_count() const { return static_cast<std::uint32_t>(normals_.size()); }
  [[nodiscard]] double size_m() const { return size_m_; }  // the diagonal of its box

 private:
  void take(const fdcg_graph& graph);

  std::vector<bake::Vec3> corners_;
  std::vector<std::uint32_t> face_first_, face_corners_;
  std::vector<bake::Vec3> normals_;              // outward
  std::optional<bake::Vec3> stored_centroid_m_;  // exact; not in a file without mass properties
  std::optional<double> mass_kg_;
  double size_m_ = 0;
  bool is_closed_ = false;
};

}  // namespace fdcg::tools
