// SPDX-License-Identifier: Apache-2.0
#include "plain_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "reference_surface.hpp"

namespace fdcg::test {
namespace {

struct TraitsF64 {
  using Number = double;
  using Node = fdcg_node_f64;
  using Connection = fdcg_connection_f64;
  using Corner = fdcg_corner_f64;
  using Plane = fdcg_plane_f64;
};
struct TraitsF32 {
  using Number = float;
  using Node = fdcg_node_f32;
  using Connection = fdcg_connection_f32;
  using Corner = fdcg_corner_f32;
  using Plane = fdcg_plane_f32;
};

using Wide = HighPrecision;
using Point = Vector<Wide>;

template <class Record>
Record* records(std::vector<std::uint64_t>& storage, std::size_t count) {
  storage.assign((sizeof(Record) * count + 7) / 8 + 1, 0);
  return reinterpret_cast<Record*>(storage.data());
}

template <class Plane>
Plane rounded_plane(const Point& direction, const Point& through) {
  using Number = decltype(Plane::offset);
  const Point n = direction * Wide(1 / length(direction));
  return {{static_cast<Number>(n.x), static_cast<Number>(n.y), static_cast<Number>(n.z)},
          static_cast<Number>(-dot(n, through))};
}

struct Halfedge {
  std::uint32_t face, side;
};
using Halfedges = std::map<std::pair<std::uint32_t, std::uint32_t>, Halfedge>;

Halfedges pair_up(const bake::PolygonSoup& soup) {
  Halfedges halfedges;
  for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
    for (std::uint32_t k = 0; k < n; ++k) {
      const auto key = std::pair(soup.corners[first + k], soup.corners[first + (k + 1) % n]);
      if (!halfedges.try_emplace(key, Halfedge{f, k}).second) throw std::invalid_argument("an edge has two faces on one side");
    }
  }
  return halfedges;
}

}  // namespace

PlainGraph::PlainGraph(const bake::PolygonSoup& soup, bake::Precision precision, bool with_hierarchy) {
  header_.real_bytes = precision == bake::Precision::f64 ? 8 : 4;
  header_.metres_per_unit = 1;
  if (precision == bake::Precision::f64) {
    build<TraitsF64>(soup);
  } else {
    build<TraitsF32>(soup);
  }
  if (with_hierarchy) build_hierarchy();
  view_.header = &header_;
  view_.nodes = nodes_.data();
  view_.sides = sides_.data();
  view_.voronoi_planes = voronoi_.data();
  view_.connections = connections_.data();
  view_.corners = corners_.data();
  view_.fans = fans_.data();
  view_.hierarchy = with_hierarchy ? boxes_.data() : nullptr;
}

// One pass a record kind, each short; taken apart they would share all of this function's variables.
template <class Traits>
void PlainGraph::build(const bake::PolygonSoup& soup) {
  using Number = typename Traits::Number;
  const Halfedges halfedges = pair_up(soup);
  const auto node_count = static_cast<std::uint32_t>(soup.face_count()),
             corner_count = static_cast<std::uint32_t>(soup.points.size());
  auto* nodes = records<typename Traits::Node>(nodes_, node_count);
  auto* corners = records<typename Traits::Corner>(corners_, corner_count);
  auto* planes = records<typename Traits::Plane>(voronoi_, soup.corners.size());

  std::vector<Point> points;
  for (int axis = 0; axis < 3; ++axis) {
    header_.bounds_min[axis] = std::numeric_limits<double>::infinity();
    header_.bounds_max[axis] = -header_.bounds_min[axis];
  }
  for (std::uint32_t v = 0; v < corner_count; ++v) {
    const double xyz[3] = {soup.points[v].x, soup.points[v].y, soup.points[v].z};
    for (int axis = 0; axis < 3; ++axis) {
      const Number c = corners[v].point[axis] = static_cast<Number>(xyz[axis]);
      header_.bounds_min[axis] = std::min<double>(header_.bounds_min[axis], c);
      header_.bounds_max[axis] = std::max<double>(header_.bounds_max[axis], c);
      header_.extent = std::max<double>(header_.extent, std::abs(c));
    }
    points.push_back({Wide(corners[v].point[0]), Wide(corners[v].point[1]), Wide(corners[v].point[2])});
  }

  std::vector<Point> directions;
  std::vector<Point> corner_normals(corner_count);
  for (std::uint32_t f = 0; f < node_count; ++f) {
    const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
    const auto at = [&](std::uint32_t k) -> const Point& { return points[soup.corners[first + k % n]]; };
    Point sum, centre;
    for (std::uint32_t k = 0; k < n; ++k) {
      sum = sum + cross(at(k) - at(0), at(k + 1) - at(0));
      centre = centre + at(k) * Wide(Wide(1) / n);
    }
    bool is_planar = true;
    for (std::uint32_t k = 0; k < n; ++k) {
      const Wide off = dot(sum, at(k) - at(0)) / length(sum);
      is_planar = is_planar && off == 0;
      header_.max_deviation = std::max(header_.max_deviation, std::abs(static_cast<double>(off)));
      const Point a = at(k + 1) - at(k), b = at(k + n - 1) - at(k);
      const Wide angle = atan2(length(cross(a, b)), dot(a, b));
      Point& normal = corner_normals[soup.corners[first + k]];
      normal = normal + sum * Wide(angle / length(sum));
    }
    nodes[f].plane = rounded_plane<typename Traits::Plane>(sum, is_planar ? at(0) : centre);
    nodes[f].first_side = first;
    nodes[f].side_count = static_cast<std::uint16_t>(n);
    nodes[f].flags = is_planar ? 0 : FDCG_NODE_INEXACT;
    directions.push_back(sum);
    NodeBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::numeric_limits<double>::infinity();
      box.high[axis] = -box.low[axis];
      for (std::uint32_t k = 0; k < n; ++k) {
        const double c = corners[soup.corners[first + k]].point[axis];
        box.low[axis] = std::min(box.low[axis], c);
        box.high[axis] = std::max(box.high[axis], c);
      }
    }
    node_boxes_.push_back(box);
  }

  sides_.assign(soup.corners.size(), 0);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> connection_of;  // both ways
  auto* connections = records<typename Traits::Connection>(connections_, soup.corners.size());
  for (std::uint32_t f = 0; f < node_count; ++f) {
    const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t v = soup.corners[first + k], w = soup.corners[first + (k + 1) % n];
      const auto [it, is_new] = connection_of.try_emplace({v, w}, header_.connection_count);
      const std::size_t which = is_new ? 0 : 1;
      auto& connection = connections[it->second];
      sides_[first + k] = it->second << 1 | static_cast<std::uint32_t>(which);
      connection.node[which] = f;
      connection.side[which] = static_cast<std::uint16_t>(k);
      planes[first + k] = rounded_plane<typename Traits::Plane>(cross(points[w] - points[v], directions[f]), points[v]);
      if (!is_new) continue;
      ++header_.connection_count;
      connection_of[{w, v}] = it->second;
      const Point span = points[w] - points[v], e = span * Wide(1 / length(span));
      const Number direction[3] = {static_cast<Number>(e.x), static_cast<Number>(e.y), static_cast<Number>(e.z)};
      std::copy_n(direction, 3, connection.edge);
      connection.end_offset[0] = static_cast<Number>(dot(e, points[v]));
      connection.end_offset[1] = static_cast<Number>(-dot(e, points[w]));
      connection.corner[0] = v;
      connection.corner[1] = w;
      const auto twin = halfedges.find({w, v});
      connection.node[1] = FDCG_NONE;
      connection.type = FDCG_BOUNDARY;
      if (twin != halfedges.end()) {
        const Wide s = dot(cross(directions[f], directions[twin->second.face]), span);
        connection.type = s > 0 ? FDCG_CONVEX : s < 0 ? FDCG_CONCAVE : FDCG_COPLANAR;
      }
      ++header_.connection_type_count[connection.type];
    }
  }

  for (std::uint32_t v = 0; v < corner_count; ++v) {
    auto& corner = corners[v];
    const Point normal = corner_normals[v] * Wide(1 / length(corner_normals[v]));
    const float rounded[3] = {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)};
    std::copy_n(rounded, 3, corner.normal);
    corner.first_fan = static_cast<std::uint32_t>(fans_.size());
    // Start anywhere, or at the half-edge without a twin; then from face to face, to the left.
    auto start = halfedges.end();
    for (auto it = halfedges.lower_bound({v, 0}); it != halfedges.end() && it->first.first == v; ++it) {
      if (start == halfedges.end()) start = it;
      if (!halfedges.contains({it->first.second, v})) {
        start = it;
        corner.flags = FDCG_CORNER_OPEN;
      }
    }
    for (auto it = start;;) {
      const std::uint32_t c = connection_of.at(it->first), end = connections[c].corner[0] == v ? 0 : 1;
      fans_.push_back(c << 1 | end);
      const auto [f, k] = it->second;
      const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
      const std::uint32_t previous = soup.corners[first + (k + n - 1) % n];
      it = halfedges.find({v, previous});
      if (it == start) break;
      if (it == halfedges.end()) {
        const std::uint32_t last = connection_of.at({v, previous});
        fans_.push_back(last << 1 | (connections[last].corner[0] == v ? 0u : 1u));
        break;
      }
    }
    corner.fan_count = static_cast<std::uint32_t>(fans_.size()) - corner.first_fan;
    header_.largest_fan = std::max(header_.largest_fan, corner.fan_count);
  }
  header_.format_version = FDCG_FORMAT_VERSION;
  header_.node_count = node_count;
  header_.corner_count = corner_count;
  header_.side_count = static_cast<std::uint32_t>(sides_.size());
  header_.fan_count = static_cast<std::uint32_t>(fans_.size());
}

// Each record's grid is as coarse as the whole object's: simple, and sound.
void PlainGraph::build_hierarchy() {
  const auto joined = [](const std::vector<NodeBox>& below, std::size_t group) {
    std::vector<NodeBox> level;
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % group == 0) {
        level.push_back(below[i]);
        continue;
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        level.back().low[axis] = std::min(level.back().low[axis], below[i].low[axis]);
        level.back().high[axis] = std::max(level.back().high[axis], below[i].high[axis]);
      }
    }
    return level;
  };
  constexpr int kCellExponent = -5;  // 255 cells from -2.5 reach to 5.4, corners to 2
  const double cell = std::ldexp(1.0, kCellExponent), unit = std::ldexp(1.0, std::ilogb(header_.extent));
  std::vector<std::vector<NodeBox>> levels = {joined(node_boxes_, FDCG_LEAF_NODES)};
  do {
    levels.push_back(joined(levels.back(), FDCG_TREE_WAYS));
  } while (levels.back().size() > 1);
  levels.pop_back();  // the whole object's: no record holds it
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    for (std::size_t i = 0; i < level->size(); i += FDCG_TREE_WAYS) {
      fdcg_box8 record{{-2.5F, -2.5F, -2.5F}, {127 + kCellExponent, 127 + kCellExponent, 127 + kCellExponent}, 0, {}, {}};
      for (std::size_t j = 0; j < FDCG_TREE_WAYS; ++j) {
        const bool is_used = i + j < level->size();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          record.low[axis][j] = is_used ? static_cast<std::uint8_t>(((*level)[i + j].low[axis] / unit + 2.5) / cell) : 255;
          record.high[axis][j] = is_used ? static_cast<std::uint8_t>(((*level)[i + j].high[axis] / unit + 2.5) / cell + 1) : 0;
        }
      }
      boxes_.push_back(record);
    }
  }
}

}  // namespace fdcg::test
