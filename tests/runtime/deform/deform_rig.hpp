// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of deformable meshes: a compiled deformable mesh with its memory and the corner of each vertex of its
// soup; arithmetic on positions; the number of steps.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "fdcg/deform.h"

namespace fdcg::test {

// FDCG_STEPS where it is set.
inline std::uint64_t steps_or(std::uint64_t standard) {
  const char* const asked = std::getenv("FDCG_STEPS");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : standard;
}

inline bake::Vec3 operator+(const bake::Vec3& a, const bake::Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline bake::Vec3 operator*(double s, const bake::Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}

inline bake::CompileOptions triangle_options(bake::Precision precision = bake::Precision::f64) {
  bake::CompileOptions options;
  options.triangles = true;
  options.precision = precision;
  return options;
}

// Every number of a graph that depends on its corners' places, as bytes.
inline std::vector<unsigned char> bytes_of(const fdcg_graph& graph) {
  std::vector<unsigned char> bytes;
  const auto add = [&bytes](const auto& record) {
    const auto* const from = reinterpret_cast<const unsigned char*>(&record);
    bytes.insert(bytes.end(), from, from + sizeof record);
  };
  for (std::uint32_t n = 0; n < graph.header->node_count; ++n) {
    add(fdcg_get_node(&graph, n));
    for (std::uint32_t k = 0; k < 3; ++k)
      add(fdcg_get_side(&graph, n, k));
  }
  for (std::uint32_t c = 0; c < graph.header->connection_count; ++c)
    add(fdcg_get_connection(&graph, c));
  for (std::uint32_t c = 0; c < graph.header->corner_count; ++c)
    add(fdcg_get_corner(&graph, c));
  return bytes;
}

class DeformableMesh {
 public:
  explicit DeformableMesh(const bake::PolygonSoup& soup, const bake::CompileOptions& options = triangle_options(),
                          double margin_m = 0)
      : compiled_(soup, options), points_(soup.points) {
    const std::uint64_t bytes = fdcg_deform_bytes(&compiled_.view());
    REQUIRE(bytes > 0);
    memory_.resize(bytes / 8 + 1);
    fdcg_deform_config config = fdcg_make_deform_config();
    config.margin_m = margin_m;
    fdcg_error error;
    const fdcg_status status = fdcg_deform_create(memory_.data(), bytes, &compiled_.view(), &config, &deform_, &error);
    INFO(error.message);
    REQUIRE(status == FDCG_OK);
    corner_of_.resize(points_.size());
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const double at[3] = {points_[v].x, points_[v].y, points_[v].z};
      REQUIRE(fdcg_deform_find(deform_, at, &corner_of_[v], &error) == FDCG_OK);
    }
  }
  DeformableMesh(const DeformableMesh&) = delete;
  DeformableMesh& operator=(const DeformableMesh&) = delete;

  void move(std::size_t vertex, const bake::Vec3& to) {
    const double at[3] = {to.x, to.y, to.z};
    fdcg_error error;
    const fdcg_status status = fdcg_deform_move(deform_, corner_of_[vertex], at, &error);
    if (status != FDCG_OK) FAIL(error.message);
    points_[vertex] = to;
  }
  // Many at once, in order.
  void move(const std::vector<std::size_t>& vertices, const std::vector<double>& places) {
    moving_.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      moving_.push_back(corner_of_[vertices[i]]);
      points_[vertices[i]] = {places[3 * i], places[3 * i + 1], places[3 * i + 2]};
    }
    fdcg_error error;
    if (fdcg_deform_move_corners(deform_, moving_.data(), places.data(), moving_.size(), &error) != FDCG_OK)
      FAIL(error.message);
  }
  fdcg_result step(const fdcg_params& params, fdcg_deform_contact* contact, const Hip& hip) {
    fdcg_result result;
    fdcg_deform_step(deform_, &params, contact, hip.data(), &result);
    return result;
  }

  [[nodiscard]] fdcg_deform* deform() { return deform_; }
  [[nodiscard]] const fdcg_graph& compiled() const { return compiled_.view(); }
  [[nodiscard]] const fdcg_graph& updated() { return *fdcg_deform_get_graph(deform_); }
  // The numbers of a mesh made anew from the same file, whose vertices are where this one's are.
  [[nodiscard]] std::vector<unsigned char> bytes_anew() const {
    std::vector<std::uint64_t> memory(memory_.size());
    const fdcg_deform_config config = fdcg_make_deform_config();
    fdcg_deform* anew = nullptr;
    fdcg_error error;
    if (fdcg_deform_create(memory.data(), memory.size() * 8, &compiled_.view(), &config, &anew, &error) != FDCG_OK)
      FAIL(error.message);
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const double at[3] = {points_[v].x, points_[v].y, points_[v].z};
      if (fdcg_deform_move(anew, corner_of_[v], at, &error) != FDCG_OK) FAIL(error.message);
    }
    return bytes_of(*fdcg_deform_get_graph(anew));
  }
  [[nodiscard]] std::uint32_t corner_of(std::size_t vertex) const { return corner_of_[vertex]; }
  [[nodiscard]] const std::vector<bake::Vec3>& points() const { return points_; }

 private:
  CompiledMesh compiled_;
  std::vector<bake::Vec3> points_;  // where they were moved to
  std::vector<std::uint64_t> memory_;
  std::vector<std::uint32_t> corner_of_, moving_;
  fdcg_deform* deform_ = nullptr;
};

}  // namespace fdcg::test
