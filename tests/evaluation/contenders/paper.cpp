// SPDX-License-Identifier: Apache-2.0
// The algorithm as the paper has it, section by section. Repaired are the signs alone: the depth is positive inside, Voronoi
// and end planes point out of their feature, slip begins when the god-object is outside the friction circle. Kept is all else
// that the contact model corrects: the product test of 5, that any crossing will do (5c), no sight of the face's plane in 5d,
// the vertex's rules of 5g and 7, a load on edges that ignores the wedge (6), and that free space is entered without a look
// (7).
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "contender.hpp"
#include "embree_scene.hpp"
#include "fdcg/fdcg.h"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

// Section 7 changes state "until the god-object does not need to be moved" and sets no bound; this is one, for a program that
// must end. Its cycles run into it.
constexpr std::uint32_t kMostChanges = 100;

struct Plane {
  Point normal{};
  double offset = 0;
  [[nodiscard]] double side(const Point& x) const { return dot(normal, x) + offset; }
};

struct Node {
  Plane plane;
  std::vector<std::uint32_t> connections;
};
struct Connection {
  std::uint32_t corner[2], node[2];  // node[1] FDCG_NONE on a boundary
  std::uint32_t type;
  double length;
  Point direction;
  Plane voronoi[2];
};
struct Corner {
  Point point;
  std::vector<std::uint32_t> connections, nodes;
};

// Its connection graph, in the object's frame.
class PaperGraph {
 public:
  explicit PaperGraph(const fdcg_graph& graph) {
    const fdcg_header& header = *graph.header;
    const Point origin = {header.origin[0], header.origin[1], header.origin[2]};
    const auto plane = [&](const double* normal, double offset) {
      const Point n = {normal[0], normal[1], normal[2]};
      return Plane{n, offset - dot(n, origin)};
    };
    connections.resize(header.connection_count);
    for (std::uint32_t c = 0; c < header.connection_count; ++c) {
      const fdcg_connection_info info = fdcg_get_connection(&graph, c);
      connections[c] = {{info.corner[0], info.corner[1]},
                        {info.node[0], info.node[1]},
                        info.type,
                        info.length,
                        {info.direction[0], info.direction[1], info.direction[2]},
                        {}};
    }
    corners.resize(header.corner_count);
    for (std::uint32_t v = 0; v < header.corner_count; ++v) {
      const fdcg_corner_info info = fdcg_get_corner(&graph, v);
      corners[v].point = Point{info.point[0], info.point[1], info.point[2]} + origin;
    }
    for (std::uint32_t f = 0; f < header.node_count; ++f) {
      const fdcg_node_info info = fdcg_get_node(&graph, f);
      Node node{plane(info.normal, info.offset), {}};
      for (std::uint32_t k = 0; k < info.side_count; ++k) {
        const fdcg_side_info side = fdcg_get_side(&graph, f, k);
        node.connections.push_back(side.connection);
        connections[side.connection].voronoi[side.which] = plane(side.voronoi_normal, side.voronoi_offset);
        corners[side.corner].nodes.push_back(f);
      }
      nodes.push_back(std::move(node));
    }
    for (std::uint32_t c = 0; c < connections.size(); ++c) {
      for (const std::uint32_t v : connections[c].corner)
        corners[v].connections.push_back(c);
    }
  }
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = nodes.size() * sizeof(Node) + connections.size() * sizeof(Connection) + corners.size() * sizeof(Corner);
    for (const Node& node : nodes)
      sum += node.connections.size() * sizeof(std::uint32_t);
    for (const Corner& corner : corners)
      sum += (corner.connections.size() + corner.nodes.size()) * sizeof(std::uint32_t);
    return sum;
  }

  std::vector<Node> nodes;
  std::vector<Connection> connections;
  std::vector<Corner> corners;
};

std::vector<std::byte> compiled_graph(const bake::PolygonSoup& soup) {
  bake::CompileOptions options;
  options.merge = false;
  options.jobs = 1;
  auto compiled = bake::compile(soup, options);
  if (!compiled || compiled->bytes.empty()) throw std::runtime_error(soup.name + " does not compile");
  return std::move(compiled->bytes);
}

class Paper : public Contender {
 public:
  explicit Paper(const bake::PolygonSoup& soup)
      : begin_(std::chrono::steady_clock::now()),
        file_(compiled_graph(soup)),
        view_(opened(file_)),
        graph_(view_),
        scene_(soup) {
    node_of_face_.assign(view_.source_map, view_.source_map + view_.header->source_face_count);
    info_.name = "paper";
    info_.family = "paper";
    info_.has_friction = true;
    info_.planes = "stored";
    info_.bytes = graph_.bytes() + scene_.bytes();
    file_ = {};
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    reset();
  }
  void reset() override {
    is_started_ = is_slipping_ = false;
    state_ = FDCG_FREE;
  }
  void set_friction(double mu_static, double mu_dynamic) override {
    mu_static_ = mu_static;
    mu_dynamic_ = mu_dynamic;
    reset();
  }

  void step(const Point& hip_m, Feel& feel) override {
    if (!is_started_) last_hip_ = god_object_ = hip_m;
    is_started_ = true;
    hip_ = hip_m;
    changes_ = 0;
    while (changes_ < kMostChanges && !rests()) {
    }
    last_hip_ = hip_m;
    feel.transitions = changes_;
    feel.in_contact = state_ != FDCG_FREE;
    feel.god_object = feel.in_contact ? god_object_ : hip_m;
    feel.force = (feel.god_object - hip_m) * kStiffness_n_per_m;
  }

 private:
  static fdcg_graph opened(const std::vector<std::byte>& file) {
    fdcg_graph view{};
    fdcg_error error{};
    if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_TRUSTED, &view, &error) != FDCG_OK) {
      throw std::runtime_error(error.message);
    }
    return view;
  }

  bool rests() {
    switch (state_) {
      case FDCG_FREE:
        return rests_free();
      case FDCG_FACE:
        return rests_on_face();
      case FDCG_EDGE:
        return rests_on_edge();
      default:
        return rests_on_vertex();
    }
  }
  bool change(std::uint32_t state, std::uint32_t feature) {
    state_ = state;
    feature_ = feature;
    ++changes_;
    if (state != FDCG_FREE) return false;
    is_slipping_ = false;
    return true;
  }

  bool rests_free() {  // 5a
    const EmbreeScene::Hit hit = scene_.cast(last_hip_, hip_);
    if (hit.triangle == EmbreeScene::kNone) return true;
    const std::uint32_t node = node_of_face_[scene_.face(hit.triangle)];
    if (node == FDCG_NONE) return true;
    const Point met = last_hip_ + (hip_ - last_hip_) * static_cast<double>(hit.part);
    const Plane& plane = graph_.nodes[node].plane;
    god_object_ = met - plane.normal * plane.side(met);
    return change(FDCG_FACE, node);
  }

  // Section 2, steps 3 to 5: where the god-object goes about a surface point under such a load.
  Point after_friction(const Point& surface_point, double load) {
    const double r = length(god_object_ - surface_point);
    if (!is_slipping_ && r > mu_static_ * load)
      is_slipping_ = true;
    else if (is_slipping_ && r <= mu_dynamic_ * load)
      is_slipping_ = false;
    const double circle = (is_slipping_ ? mu_dynamic_ : mu_static_) * load;
    return r > circle ? surface_point + (god_object_ - surface_point) * (circle / r) : god_object_;
  }

  bool rests_on_face() {
    const Node& node = graph_.nodes[feature_];
    const double depth = -node.plane.side(hip_);
    if (depth < 0) return change(FDCG_FREE, FDCG_NONE);  // 5b
    const Point target = after_friction(hip_ + node.plane.normal * depth, depth);
    for (const std::uint32_t c : node.connections) {  // 5c
      const Connection& connection = graph_.connections[c];
      const Plane& plane = connection.voronoi[connection.node[0] == feature_ ? 0 : 1];
      const double before = plane.side(god_object_), now = plane.side(target);
      if (!(now * before < 0)) continue;
      god_object_ = god_object_ + (target - god_object_) * (before / (before - now));
      return change(FDCG_EDGE, c);
    }
    god_object_ = target;
    return true;
  }

  bool rests_on_edge() {
    const Connection& edge = graph_.connections[feature_];
    const Plane& a = graph_.nodes[edge.node[0]].plane;
    const bool is_open = edge.node[1] == FDCG_NONE;
    const double side_a = a.side(hip_), side_b = is_open ? 0 : graph_.nodes[edge.node[1]].plane.side(hip_);
    const bool is_acute = !is_open && dot(a.normal, graph_.nodes[edge.node[1]].plane.normal) < 0;
    const bool is_behind_none = side_a >= 0 && side_b >= 0;
    if (edge.type == FDCG_CONVEX && is_acute && (side_a >= 0) != (side_b >= 0)) return change(FDCG_FREE, FDCG_NONE);  // 5e
    if (is_behind_none) return change(FDCG_FREE, FDCG_NONE);                                                          // 7
    const bool in_a = edge.voronoi[0].side(hip_) < 0, in_b = !is_open && edge.voronoi[1].side(hip_) < 0;              // 5d
    if (in_a && in_b) return change(FDCG_FACE, edge.node[std::abs(side_a) <= std::abs(side_b) ? 0 : 1]);
    if (in_a) return change(FDCG_FACE, edge.node[0]);
    if (in_b) return change(FDCG_FACE, edge.node[1]);
    const Point& start = graph_.corners[edge.corner[0]].point;  // 6
    const Point foot = start + edge.direction * dot(hip_ - start, edge.direction);
    const Point target = after_friction(foot, length(hip_ - foot));
    const double along = dot(target - start, edge.direction);
    if (along > 0 && along < edge.length) {
      god_object_ = start + edge.direction * along;
      return true;
    }
    const std::uint32_t end = edge.corner[along > 0 ? 1 : 0];  // 5f
    god_object_ = graph_.corners[end].point;
    return change(FDCG_VERTEX, end);
  }

  bool rests_on_vertex() {
    const Corner& corner = graph_.corners[feature_];
    bool is_behind_any = false;
    for (const std::uint32_t f : corner.nodes)
      is_behind_any = is_behind_any || graph_.nodes[f].plane.side(hip_) < 0;
    if (!is_behind_any) return change(FDCG_FREE, FDCG_NONE);  // 7
    for (const std::uint32_t f : corner.nodes) {
      if (is_in_region(f)) return change(FDCG_FACE, f);  // 7
    }
    for (const std::uint32_t c : corner.connections) {  // 5g
      const Connection& connection = graph_.connections[c];
      if (connection.node[1] == FDCG_NONE) continue;
      if (graph_.nodes[connection.node[0]].plane.side(hip_) < 0 && graph_.nodes[connection.node[1]].plane.side(hip_) < 0) {
        return change(FDCG_EDGE, c);
      }
    }
    return true;
  }

  // The HIP lies in the Voronoi region of a face.
  [[nodiscard]] bool is_in_region(std::uint32_t face) const {
    for (const std::uint32_t c : graph_.nodes[face].connections) {
      const Connection& connection = graph_.connections[c];
      if (connection.voronoi[connection.node[0] == face ? 0 : 1].side(hip_) >= 0) return false;
    }
    return true;
  }

  std::chrono::steady_clock::time_point begin_;
  std::vector<std::byte> file_;
  fdcg_graph view_;
  PaperGraph graph_;
  EmbreeScene scene_;
  std::vector<std::uint32_t> node_of_face_;
  double mu_static_ = 0, mu_dynamic_ = 0;
  Point god_object_{}, hip_{}, last_hip_{};
  std::uint32_t state_ = FDCG_FREE, feature_ = FDCG_NONE, changes_ = 0;
  bool is_started_ = false, is_slipping_ = false;
};

}  // namespace

std::unique_ptr<Contender> make_paper(const bake::PolygonSoup& soup) {
  return std::make_unique<Paper>(soup);
}

}  // namespace fdcg::test
