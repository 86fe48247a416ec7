// SPDX-License-Identifier: Apache-2.0
// What tests and benchmarks of piles share: a scene, a pile, boxes of a size and a mass.
#pragma once

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/pile.h"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "scene_rig.hpp"

namespace fdcg::test {

inline Place operator+(const Place& a, const Place& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Place operator-(const Place& a, const Place& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Place operator*(const Place& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
inline double dot(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Place& a) {
  return std::sqrt(dot(a, a));
}
inline Place place(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

inline fdcg_params friction(double mu_static, double mu_dynamic, double stiffness_n_per_m = 1000) {
  fdcg_params params = fdcg_make_params();
  params.mu_static = mu_static;
  params.mu_dynamic = mu_dynamic;
  params.stiffness_n_per_m = stiffness_n_per_m;
  return params;
}

// Throws where anything is refused.
class PileRig {
 public:
  explicit PileRig(const fdcg_pile_config& config = fdcg_make_pile_config(),
                   const fdcg_scene_config& scene = fdcg_make_scene_config())
      : scene_(scene), memory_((fdcg_pile_bytes(&config) + 7) / 8) {
    expect(fdcg_pile_create(memory_.data(), memory_.size() * 8, &config, &pile_, &error_));
  }

  // Solid of any soup, compiled once for as many as use it. kg 0: not a body, but fixed.
  std::size_t shape(const bake::PolygonSoup& soup, bake::Precision precision = bake::Precision::f64) {
    bake::CompileOptions options;
    options.precision = precision;
    options.density_kg_per_m3 = 1000;
    auto compiled = bake::compile(soup, options);
    if (!compiled || compiled->bytes.empty()) throw std::runtime_error("cannot compile " + soup.name);
    shapes_.push_back({std::move(compiled->bytes), {}});
    Shape& shape = shapes_.back();
    expect(fdcg_open_memory(shape.bytes.data(), shape.bytes.size(), FDCG_VERIFY_FULL, &shape.graph, &error_));
    return shapes_.size() - 1;
  }
  std::size_t box(double x, double y, double z) { return shape(grid_box(1, 1, 1, {x, y, z})); }

  fdcg_object_id add_fixed(std::size_t shape, const fdcg_params& params, const fdcg_pose& pose) {
    const fdcg_object_id object = scene_.add(shapes_.at(shape).graph, params, pose);
    expect(fdcg_pile_add(pile_, scene_.get(), object, nullptr, 0, &error_));
    return object;
  }
  // Its index among bodies().
  std::size_t add_body(std::size_t shape, double mass_kg, const fdcg_params& params, const fdcg_pose& pose,
                       const fdcg_body_config& like = fdcg_make_body_config(), std::uint32_t most_points = 20) {
    const fdcg_graph& graph = shapes_.at(shape).graph;
    fdcg_scene_body body = {};
    body.object = scene_.add(graph, params, pose);
    fdcg_mass mass;
    expect(fdcg_get_mass(&graph, &mass, &error_));
    fdcg_body_config config = like;
    const double cube = pose.scale * pose.scale * pose.scale;
    expect(fdcg_body_set_mass(&config, &mass, mass_kg / (mass.volume_m3 * cube), pose.scale, &error_));
    expect(fdcg_body_init(&body.body, &config, &pose, &error_));
    double points[32][3];
    std::uint32_t count = 0;
    expect(fdcg_pick_points(&graph, points, most_points, &count, &error_));
    expect(fdcg_pile_add(pile_, scene_.get(), body.object, points, count, &error_));
    bodies_.push_back(body);
    return bodies_.size() - 1;
  }
  void ground(const Place& normal, double offset_m, const fdcg_params& params) {
    expect(fdcg_pile_set_ground(pile_, normal.data(), offset_m, &params, &error_));
  }
  void tick(std::uint32_t substeps = 1, double tick_s = 1e-3) {
    reactions_.resize(64);
    expect(fdcg_scene_step_pile(scene_.get(), pile_, bodies_.data(), static_cast<std::uint32_t>(bodies_.size()), substeps,
                                tick_s, reactions_.data(), 64, &error_));
  }
  void ticks(int count, std::uint32_t substeps = 1) {
    for (int i = 0; i < count; ++i)
      tick(substeps);
  }

  [[nodiscard]] fdcg_body& body(std::size_t i) { return bodies_.at(i).body; }
  [[nodiscard]] fdcg_object_id object(std::size_t i) const { return bodies_.at(i).object; }
  [[nodiscard]] std::vector<fdcg_scene_body>& bodies() { return bodies_; }
  [[nodiscard]] Place centre(std::size_t i) const { return place(bodies_.at(i).body.centre_m); }
  [[nodiscard]] Place velocity(std::size_t i) const { return place(bodies_.at(i).body.velocity_m_per_s); }
  [[nodiscard]] std::vector<fdcg_pile_touch> touches() const {
    std::vector<fdcg_pile_touch> list(fdcg_pile_get_touches(pile_, nullptr, 0));
    fdcg_pile_get_touches(pile_, list.data(), static_cast<std::uint32_t>(list.size()));
    return list;
  }
  [[nodiscard]] SceneRig& scene() { return scene_; }
  [[nodiscard]] std::vector<std::uint64_t>& memory() { return memory_; }
  [[nodiscard]] fdcg_pile* pile() const { return pile_; }
  [[nodiscard]] const fdcg_graph& graph(std::size_t shape) const { return shapes_.at(shape).graph; }

 private:
  struct Shape {
    std::vector<std::byte> bytes;
    fdcg_graph graph;
  };
  void expect(fdcg_status status) const {
    if (status != FDCG_OK) throw std::runtime_error(error_.message);
  }

  SceneRig scene_;
  std::vector<std::uint64_t> memory_;
  fdcg_pile* pile_ = nullptr;
  std::deque<Shape> shapes_;  // graphs point into them
  std::vector<fdcg_scene_body> bodies_;
  std::vector<fdcg_reaction> reactions_;
  fdcg_error error_ = {};
};

}  // namespace fdcg::test
