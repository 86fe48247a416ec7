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
  using Edge = fdcg_connection_geometry_f64;
  using Corner = fdcg_corner_f64;
  using Plane = fdcg_plane_f64;
};
struct TraitsF32 {
  using Number = float;
  using Node = fdcg_node_f32;
  using Edge = fdcg_connection_geometry_f32;
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

// Faces of more sides than a node may have, as fans of pieces from their first corner.
bake::PolygonSoup with_great_faces_cut(const bake::PolygonSoup& soup, std::vector<std::uint32_t>& face_of_piece) {
  constexpr std::uint32_t kMostSides = 64;
  bake::PolygonSoup cut = soup;
  cut.corners.clear();
  cut.face_first = {0};
  for (std::uint32_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
    const std::uint32_t step = n <= FDCG_MAX_SIDES ? n : kMostSides - 2;
    for (std::uint32_t from = 1; from + 1 < n; from += step) {
      cut.corners.push_back(soup.corners[first]);
      for (std::uint32_t k = from; k <= std::min(from + step, n - 1); ++k)
        cut.corners.push_back(soup.corners[first + k]);
      cut.face_first.push_back(static_cast<std::uint32_t>(cut.corners.size()));
      face_of_piece.push_back(f);
    }
  }
  return cut;
}

}  // namespace

PlainGraph::PlainGraph(const bake::PolygonSoup& whole, bake::Precision precision, bool with_hierarchy) {
  const bake::PolygonSoup soup = with_great_faces_cut(whole, face_of_piece_);
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
  view_.node_offsets = node_offsets_.data();
  view_.connections = connections_.data();
  view_.edges = edges_.data();
  view_.corners = corners_.data();
  view_.busy_corners = busy_corners_.data();
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
  using Node = typename Traits::Node;
  using Plane = typename Traits::Plane;
  // Blocks as format.h has them: plane, counts, sides, zeros up to a multiple of the number's size, planes.
  const auto planes_at = [](std::size_t n) {
    return (offsetof(Node, sides) + n * sizeof(fdcg_side) + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number);
  };
  std::size_t block_bytes = 0;
  for (std::uint32_t f = 0; f < node_count; ++f) {
    const std::size_t n = soup.face_first[f + 1] - soup.face_first[f];
    node_offsets_.push_back(static_cast<std::uint32_t>(block_bytes / sizeof(Number)));
    block_bytes += planes_at(n) + n * sizeof(Plane);
  }
  auto* const blocks = reinterpret_cast<std::byte*>(records<Number>(nodes_, block_bytes / sizeof(Number)));
  const auto block = [&](std::uint32_t f) { return blocks + node_offsets_[f] * sizeof(Number); };
  const auto node = [&](std::uint32_t f) -> Node& { return *reinterpret_cast<Node*>(block(f)); };
  const auto side = [&](std::uint32_t f, std::uint32_t k) -> fdcg_side& {
    return reinterpret_cast<fdcg_side*>(block(f) + offsetof(Node, sides))[k];
  };
  const auto voronoi = [&](std::uint32_t f, std::uint32_t k) -> Plane& {
    return reinterpret_cast<Plane*>(block(f) + planes_at(soup.face_first[f + 1] - soup.face_first[f]))[k];
  };
  auto* corners = records<typename Traits::Corner>(corners_, corner_count);

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
    node(f).plane = rounded_plane<Plane>(sum, is_planar ? at(0) : centre);
    node(f).side_count = static_cast<std::uint16_t>(n);
    node(f).flags = is_planar ? 0 : FDCG_NODE_INEXACT;
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

  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> connection_of;  // both ways
  connections_.resize(soup.corners.size());
  auto* edges = records<typename Traits::Edge>(edges_, soup.corners.size());
  for (std::uint32_t f = 0; f < node_count; ++f) {
    const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t v = soup.corners[first + k], w = soup.corners[first + (k + 1) % n];
      const auto [it, is_new] = connection_of.try_emplace({v, w}, header_.connection_count);
      const std::size_t which = is_new ? 0 : 1;
      const auto twin = halfedges.find({w, v});
      fdcg_connection& connection = connections_[it->second];
      connection.side[which] = static_cast<std::uint8_t>(k);
      side(f, k) = {it->second << 1 | static_cast<std::uint32_t>(which), v,
                    twin == halfedges.end() ? FDCG_NONE : twin->second.face};
      voronoi(f, k) = rounded_plane<Plane>(cross(points[w] - points[v], directions[f]), points[v]);
      if (!is_new) continue;
      ++header_.connection_count;
      connection_of[{w, v}] = it->second;
      const Point span = points[w] - points[v], e = span * Wide(1 / length(span));
      const Number direction[3] = {static_cast<Number>(e.x), static_cast<Number>(e.y), static_cast<Number>(e.z)};
      std::copy_n(direction, 3, edges[it->second].direction);
      edges[it->second].length = static_cast<Number>(length(span));
      connection.node = f;
      connection.type = FDCG_BOUNDARY;
      if (twin != halfedges.end()) {
        const Wide s = dot(cross(directions[f], directions[twin->second.face]), span);
        const bool is_cut = face_of_piece_[f] == face_of_piece_[twin->second.face];
        connection.type = is_cut || s == 0 ? FDCG_COPLANAR : s > 0 ? FDCG_CONVEX : FDCG_CONCAVE;
      }
      ++header_.connection_type_count[connection.type];
    }
  }

  for (std::uint32_t v = 0; v < corner_count; ++v) {
    auto& corner = corners[v];
    const Point normal = corner_normals[v] * Wide(1 / length(corner_normals[v]));
    const double unit[3] = {static_cast<double>(normal.x), static_cast<double>(normal.y), static_cast<double>(normal.z)};
    for (int k = 0; k < 3; ++k)
      corner.normal[k] = static_cast<std::int16_t>(std::lround(FDCG_NORMAL_SCALE * unit[k]));
    const auto first_fan = static_cast<std::uint32_t>(fans_.size());
    // Start anywhere, or at the half-edge without a twin; then from face to face, to the left.
    auto start = halfedges.end();
    for (auto it = halfedges.lower_bound({v, 0}); it != halfedges.end() && it->first.first == v; ++it) {
      if (start == halfedges.end()) start = it;
      if (!halfedges.contains({it->first.second, v})) {
        start = it;
        corner.fan = FDCG_CORNER_OPEN;
      }
    }
    for (auto it = start;;) {
      fans_.push_back(side(it->second.face, it->second.side).link);
      const auto [f, k] = it->second;
      const std::uint32_t first = soup.face_first[f], n = soup.face_first[f + 1] - first;
      const std::uint32_t previous = soup.corners[first + (k + n - 1) % n];
      it = halfedges.find({v, previous});
      if (it == start) break;
      if (it == halfedges.end()) {
        fans_.push_back(side(f, (k + n - 1) % n).link ^ 1u);
        break;
      }
    }
    const std::uint32_t fan_count = static_cast<std::uint32_t>(fans_.size()) - first_fan;
    header_.largest_fan = std::max(header_.largest_fan, fan_count);
    if (fan_count > FDCG_BUSY_FAN) {  // stored, without a tree: the step looks at all of it
      corner.first = static_cast<std::uint32_t>(busy_corners_.size());
      busy_corners_.push_back({v, first_fan, fan_count, FDCG_NONE});
    } else {
      corner.first = start->second.face;
      corner.side = static_cast<std::uint8_t>(start->second.side);
      corner.fan = static_cast<std::uint8_t>(corner.fan | fan_count);
      fans_.resize(first_fan);
    }
  }
  header_.format_version = FDCG_FORMAT_VERSION;
  header_.node_count = node_count;
  header_.corner_count = corner_count;
  header_.side_count = static_cast<std::uint32_t>(soup.corners.size());
  header_.busy_count = static_cast<std::uint32_t>(busy_corners_.size());
  header_.flags = FDCG_STORED_PLANES;
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
