// SPDX-License-Identifier: Apache-2.0
// What tests of the step share: a compiled mesh in memory, a contact with its parameters, a little geometry.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "hip_walk.hpp"

namespace fdcg::test {

// Compiles a soup and opens the bytes. Throws std::runtime_error with the report where the compiler or the reader refuses.
class CompiledMesh {
 public:
  explicit CompiledMesh(const bake::PolygonSoup& soup, const bake::CompileOptions& options = {});
  CompiledMesh(const CompiledMesh&) = delete;
  CompiledMesh& operator=(const CompiledMesh&) = delete;
  [[nodiscard]] const fdcg_graph& view() const { return view_; }

 private:
  std::vector<std::uint64_t> storage_;
  fdcg_graph view_{};
};

fdcg_params contact_params(double mu_static, double mu_dynamic, std::uint32_t edge_friction = FDCG_EDGE_WEDGE);

// One contact on one graph; counts what must never happen.
class Contact {
 public:
  Contact(const fdcg_graph& graph, const fdcg_params& params) : graph_(&graph), params_(params) {}

  const fdcg_result& step(const Hip& hip_object_m);
  const fdcg_result& step(double x, double y, double z) { return step(Hip{x, y, z}); }

  [[nodiscard]] Hip god_object() const { return {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]}; }
  [[nodiscard]] Hip force() const { return {result.force_n[0], result.force_n[1], result.force_n[2]}; }
  [[nodiscard]] std::string describe() const;

  fdcg_contact state{};
  fdcg_result result{};
  std::uint64_t bound_hits = 0;

 private:
  const fdcg_graph* graph_;
  fdcg_params params_;
};

double dot(const Hip& a, const Hip& b);
double norm(const Hip& a);
Hip difference(const Hip& a, const Hip& b);
double distance(const Hip& a, const Hip& b);
Hip point_of(const bake::Vec3& v);
bake::Vec3 vec_of(const Hip& v);

// How often the closed mesh winds around a point: 1 inside, 0 outside; in between only within rounding of the surface.
double winding_number(const bake::PolygonSoup& soup, const Hip& point);
// From a point to the nearest of the mesh (faces as triangle fans), and that point.
Hip closest_point(const bake::PolygonSoup& soup, const Hip& point);
// Largest coordinate.
double extent(const bake::PolygonSoup& soup);

}  // namespace fdcg::test
