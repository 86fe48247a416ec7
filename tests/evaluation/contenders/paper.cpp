// SPDX-License-Identifier: Apache-2.0
// The algorithm as the paper has it, section by section. Repaired are the signs alone (contact-model PAPER-1 to PAPER-3): the
// depth is positive inside, Voronoi and end planes point out of their feature, slip begins when the god-object is outside the
// friction circle. At PaperLevel::printed all else is as it stands there: the product test (Melder 2004, section 5), that any
// crossing will do (5c), no sight of the face's plane in 5d, the vertex's rules of 5g and 7. At every level a load on edges
// ignores the wedge (6), and free space is entered without a look (7).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "contender.hpp"
#include "embree_scene.hpp"
#include "fdcg/fdcg.h"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

// Melder 2004, section 7, changes state "until the god-object does not need to be moved" and sets no bound; this is one, for a
// program that must end. Its cycles run into it.
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
  // The Voronoi plane out of a node.
  [[nodiscard]] const Plane& out_of(std::uint32_t from) const { return voronoi[node[0] == from ? 0 : 1]; }
};
struct Corner {
  Point point, normal;
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
      corners[v].normal = {info.normal[0], info.normal[1], info.normal[2]};
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
  Paper(const bake::PolygonSoup& soup, PaperLevel level)
      : level_(level),
        begin_(std::chrono::steady_clock::now()),
        file_(compiled_graph(soup)),
        view_(opened(file_)),
        graph_(view_),
        scene_(soup) {
    node_of_face_.assign(view_.source_map, view_.source_map + view_.header->source_face_count);
    constexpr const char* kNames[] = {"paper", "paper_crossings", "paper_edges", "paper_vertices"};
    info_.name = kNames[static_cast<std::size_t>(level)];
    info_.family = level == PaperLevel::printed ? "paper" : "ablation";
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

  // Melder 2004, section 2, steps 3 to 5: where the god-object goes about a surface point under such a load.
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
    if (level_ >= PaperLevel::crossings) return rests_within(node, target);
    for (const std::uint32_t c : node.connections) {  // 5c
      const Plane& plane = graph_.connections[c].out_of(feature_);
      const double before = plane.side(god_object_), now = plane.side(target);
      if (!(now * before < 0)) continue;
      god_object_ = god_object_ + (target - god_object_) * (before / (before - now));
      return change(FDCG_EDGE, c);
    }
    god_object_ = target;
    return true;
  }

  // To the target, or to the first edge crossed on the way.
  bool rests_within(const Node& node, const Point& target) {
    double first = std::numeric_limits<double>::infinity();
    std::uint32_t crossed = FDCG_NONE;
    for (const std::uint32_t c : node.connections) {
      const Plane& plane = graph_.connections[c].out_of(feature_);
      const double before = plane.side(god_object_), now = plane.side(target);
      if (!(now >= 0 && now > before)) continue;
      const double part = std::max(0.0, -before / (now - before));
      if (part < first) first = part, crossed = c;
    }
    if (crossed == FDCG_NONE) {
      god_object_ = target;
      return true;
    }
    const Connection& edge = graph_.connections[crossed];
    const Point& start = graph_.corners[edge.corner[0]].point;
    const double along = dot(god_object_ + (target - god_object_) * first - start, edge.direction);
    const double near_end = 8 * std::numeric_limits<double>::epsilon() * (length(start) + edge.length);
    if (along <= near_end || along >= edge.length - near_end) return to_end(edge, along > edge.length / 2);
    god_object_ = start + edge.direction * along;
    return change(FDCG_EDGE, crossed);
  }

  bool to_end(const Connection& edge, bool is_second) {
    const std::uint32_t end = edge.corner[is_second ? 1 : 0];
    god_object_ = graph_.corners[end].point;
    return change(FDCG_VERTEX, end);
  }

  // What becomes active instead of an edge.
  struct Next {
    bool changes = false;
    std::uint32_t state = FDCG_FREE, feature = FDCG_NONE;
  };
  [[nodiscard]] Next from_edge_as_printed(const Connection& edge, double side_a, double side_b) const {
    const bool is_open = edge.node[1] == FDCG_NONE;
    const auto normal = [&](int k) { return graph_.nodes[edge.node[k]].plane.normal; };
    const bool is_acute = !is_open && dot(normal(0), normal(1)) < 0;
    if (edge.type == FDCG_CONVEX && is_acute && (side_a >= 0) != (side_b >= 0)) return {true};            // 5e
    if (side_a >= 0 && side_b >= 0) return {true};                                                        // 7
    const bool in_a = edge.voronoi[0].side(hip_) < 0, in_b = !is_open && edge.voronoi[1].side(hip_) < 0;  // 5d
    if (in_a && (!in_b || std::abs(side_a) <= std::abs(side_b))) return {true, FDCG_FACE, edge.node[0]};
    if (in_b) return {true, FDCG_FACE, edge.node[1]};
    return {};
  }
  [[nodiscard]] Next from_edge_corrected(const Connection& edge, double side_a, double side_b) const {
    const double s_a = edge.voronoi[0].side(hip_);
    if (edge.type == FDCG_BOUNDARY) {
      return side_a < 0 && s_a < 0 ? Next{true, FDCG_FACE, edge.node[0]} : Next{true};
    }
    const double s_b = edge.voronoi[1].side(hip_);
    if (edge.type == FDCG_CONCAVE ? side_a >= 0 && side_b >= 0 : side_a >= 0 || side_b >= 0) return {true};
    const bool to_a = side_a < 0 && s_a < 0, to_b = side_b < 0 && s_b < 0;
    if (to_a && (!to_b || s_a <= s_b)) return {true, FDCG_FACE, edge.node[0]};
    if (to_b) return {true, FDCG_FACE, edge.node[1]};
    return {};
  }

  bool rests_on_edge() {
    const Connection& edge = graph_.connections[feature_];
    const Plane& a = graph_.nodes[edge.node[0]].plane;
    const double side_a = a.side(hip_);
    const double side_b = edge.node[1] == FDCG_NONE ? 0 : graph_.nodes[edge.node[1]].plane.side(hip_);
    const Next next =
        level_ >= PaperLevel::edges ? from_edge_corrected(edge, side_a, side_b) : from_edge_as_printed(edge, side_a, side_b);
    if (next.changes) return change(next.state, next.feature);
    const Point& start = graph_.corners[edge.corner[0]].point;  // 6
    const Point foot = start + edge.direction * dot(hip_ - start, edge.direction);
    const Point target = after_friction(foot, length(hip_ - foot));
    const double along = dot(target - start, edge.direction);
    if (along > 0 && along < edge.length) {
      god_object_ = start + edge.direction * along;
      return true;
    }
    return to_end(edge, along > 0);  // 5f
  }

  // The steepest descent at a vertex.
  bool rests_by_steepest(const Corner& corner) {
    const Point t = hip_ - corner.point;
    double longest = 0, side = dot(t, corner.normal);
    std::uint32_t state = FDCG_VERTEX, feature = feature_;
    const auto offer = [&](double reach, double sign, std::uint32_t offered, std::uint32_t index) {
      if (reach > longest) longest = reach, side = sign, state = offered, feature = index;
    };
    const auto side_of = [&](std::uint32_t node) { return node == FDCG_NONE ? 0 : graph_.nodes[node].plane.side(hip_); };
    for (const std::uint32_t c : corner.connections) {
      const Connection& edge = graph_.connections[c];
      const double along = dot(t, edge.direction) * (edge.corner[0] == feature_ ? 1 : -1);
      offer(along, side_of(edge.node[0]) + side_of(edge.node[1]), FDCG_EDGE, c);
    }
    for (const std::uint32_t f : corner.nodes) {
      bool is_in_sector = true;
      for (const std::uint32_t c : graph_.nodes[f].connections) {
        const Connection& edge = graph_.connections[c];
        const bool meets = edge.corner[0] == feature_ || edge.corner[1] == feature_;
        is_in_sector = is_in_sector && (!meets || dot(edge.out_of(f).normal, t) < 0);
      }
      const double height = dot(t, graph_.nodes[f].plane.normal);
      if (is_in_sector) offer(std::sqrt(std::max(0.0, dot(t, t) - height * height)), side_of(f), FDCG_FACE, f);
    }
    if (side >= 0) return change(FDCG_FREE, FDCG_NONE);
    return state == FDCG_VERTEX || change(state, feature);
  }

  bool rests_on_vertex() {
    const Corner& corner = graph_.corners[feature_];
    if (level_ >= PaperLevel::vertices) return rests_by_steepest(corner);
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
      if (graph_.connections[c].out_of(face).side(hip_) >= 0) return false;
    }
    return true;
  }

  PaperLevel level_;
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

std::unique_ptr<Contender> make_paper(const bake::PolygonSoup& soup, PaperLevel level) {
  return std::make_unique<Paper>(soup, level);
}

}  // namespace fdcg::test
