// SPDX-License-Identifier: Apache-2.0
#include "graph_walker.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <sstream>

namespace fdcg::test {
namespace {

using Point = std::array<double, 3>;

Point minus(const double* a, const double* b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const double* a, const double* b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Point& a) {
  return std::sqrt(dot(a.data(), a.data()));
}

using ExactPoint = std::array<mpq_class, 3>;
ExactPoint exact(const double* p) {
  return {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
}
// The sign of the k-th component of (b - a) x (c - a).
int exact_turn(const double* a, const double* b, const double* c, int k) {
  const ExactPoint pa = exact(a), pb = exact(b), pc = exact(c);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const mpq_class value = (pb[i] - pa[i]) * (pc[j] - pa[j]) - (pb[j] - pa[j]) * (pc[i] - pa[i]);
  return sgn(value);
}
int exact_side(const double* a, const double* b, const double* c, const double* d) {
  const ExactPoint o = exact(a);
  std::array<ExactPoint, 3> m{exact(b), exact(c), exact(d)};
  for (ExactPoint& row : m) {
    for (int k = 0; k < 3; ++k)
      row[k] -= o[k];
  }
  const mpq_class value = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                          m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return sgn(value);
}

class Walker {
 public:
  explicit Walker(const WalkedGraph& g) : g_(g), eps_(g.header.real_bytes == 4 ? 0x1p-23 : 0x1p-52) {}

  std::vector<std::string> run() {
    for (const std::string& fault : g_.layout_faults)
      check(false, fault.c_str(), 0);
    counts();
    if (!defects_.empty()) return defects_;
    for (std::uint32_t n = 0; n < g_.nodes.size(); ++n)
      node(n);
    for (std::uint32_t c = 0; c < g_.connections.size(); ++c)
      connection(c);
    for (std::uint32_t c = 0; c < g_.corners.size(); ++c)
      corner(c);
    boxes();
    for (const std::uint32_t node : g_.source_map)
      check(node == FDCG_NONE || node < g_.nodes.size(), "source map: no such node", node);
    return defects_;
  }

 private:
  void check(bool holds, const char* what, std::uint64_t where) {
    constexpr std::size_t kMost = 20;
    if (holds || defects_.size() >= kMost) return;
    std::ostringstream text;
    text << what << " (" << where << ")";
    defects_.push_back(text.str());
  }

  [[nodiscard]] const double* point(std::uint32_t corner) const { return g_.corners[corner].point; }

  void counts() {
    check(g_.nodes.size() == g_.header.node_count && !g_.nodes.empty(), "node count", g_.nodes.size());
    check(g_.sides.size() == g_.header.side_count, "side count", g_.sides.size());
    check(g_.connections.size() == g_.header.connection_count, "connection count", g_.connections.size());
    check(g_.corners.size() == g_.header.corner_count, "corner count", g_.corners.size());
    check(g_.stored_fans.size() == g_.header.fan_count, "fan count", g_.stored_fans.size());
    check(g_.busy_corners.size() == g_.header.busy_count, "busy corner count", g_.busy_corners.size());
    check(g_.voronoi.empty() || g_.voronoi.size() == g_.sides.size(), "Voronoi count", g_.voronoi.size());
    std::uint32_t next_side = 0, next_fan = 0, seen_connections = 0, seen_corners = 0, largest = 0, busy = 0;
    for (const auto& n : g_.nodes) {
      check(n.first_side == next_side && n.side_count >= 3, "a node's sides follow the last one's", n.first_side);
      next_side += n.side_count;
    }
    for (const auto& c : g_.corners) {
      check(c.first_fan == next_fan && c.fan_count >= 2, "a corner's fan follows the last one's", c.first_fan);
      next_fan += c.fan_count;
      largest = std::max(largest, c.fan_count);
      check(c.is_busy == (c.fan_count > FDCG_BUSY_FAN), "a corner is busy that has many connections", c.fan_count);
      busy += c.is_busy ? 1 : 0;
    }
    check(next_side == g_.sides.size() && next_fan == g_.fans.size(), "sides and fans used up", next_side);
    check(largest == g_.header.largest_fan, "largest fan", largest);
    check(busy == g_.busy_corners.size(), "every busy record is a corner's", busy);
    for (const std::uint32_t side : g_.sides) {
      check(side >> 1 < g_.connections.size(), "a side's connection exists", side);
      if (side >> 1 >= g_.connections.size()) return;
      check(side >> 1 <= seen_connections, "connections come by first use", side >> 1);
      if (side >> 1 == seen_connections) ++seen_connections;
    }
    for (std::uint32_t s = 0; s < g_.sides.size(); ++s) {
      const std::uint32_t c = g_.corner_of_side(s);
      check(c < g_.corners.size(), "a side's corner exists", s);
      if (c >= g_.corners.size()) return;
      check(c <= seen_corners, "corners come by first use", c);
      if (c == seen_corners) ++seen_corners;
    }
    check(seen_corners == g_.corners.size() && seen_connections == g_.connections.size(), "nothing unused", seen_corners);
  }

  void node(std::uint32_t n) {
    const WalkedNode& record = g_.nodes[n];
    const double* normal = record.plane.normal;
    check(std::fabs(std::sqrt(dot(normal, normal)) - 1) <= 4 * eps_, "a node's normal has unit length", n);
    std::set<std::uint32_t> visited;
    std::vector<const double*> loop;
    for (std::uint32_t i = 0; i < record.side_count; ++i) {
      const std::uint32_t side = g_.sides[record.first_side + i], which = side & 1u;
      const WalkedConnection& c = g_.connections[side >> 1];
      check(c.node[which] == n && c.side[which] == i, "a side and its connection name each other", n);
      const std::uint32_t after = record.first_side + (i + 1) % record.side_count;
      check(c.corner[1 - which] == g_.corner_of_side(after), "a node's loop is closed", n);
      check(visited.insert(c.corner[which]).second, "a node visits a corner once", n);
      check(g_.across(record.first_side + i) != n, "a node is not its own neighbour", n);
      loop.push_back(point(c.corner[which]));
    }
    shape(n, record, loop);
  }

  void shape(std::uint32_t n, const WalkedNode& record, const std::vector<const double*>& loop) {
    const double* normal = record.plane.normal;
    int k = 0;
    for (int i = 1; i < 3; ++i) {
      if (std::fabs(normal[i]) > std::fabs(normal[k])) k = i;
    }
    const int up = normal[k] > 0 ? 1 : -1;
    const std::size_t count = loop.size();
    const bool is_exact = (record.flags & FDCG_NODE_INEXACT) == 0;
    double diameter = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double *a = loop[i], *b = loop[(i + 1) % count], *c = loop[(i + 2) % count];
      const int turn = exact_turn(a, b, c, k) * up;
      check(turn >= 0, "a node is convex", n);
      if (i == 0) check(turn > 0, "a node's first three corners make a strict left turn", n);
      diameter = std::max(diameter, length(minus(a, b)));
      const double off = std::fabs(dot(normal, a) + record.plane.offset);
      const double rounding = 4 * eps_ * (g_.header.extent + std::fabs(record.plane.offset));
      if (is_exact) {
        check(off <= rounding, "an exact node's corners lie on its plane", n);
        if (i >= 2) check(exact_side(loop[0], loop[1], loop[2], b) == 0, "an exact node's corners are exactly coplanar", n);
      } else {
        check(off <= g_.header.max_deviation + 4 * 0x1p-52 * g_.header.extent, "max_deviation covers every corner", n);
      }
    }
  }

  void connection(std::uint32_t id) {
    const WalkedConnection& c = g_.connections[id];
    const double *v0 = point(c.corner[0]), *v1 = point(c.corner[1]);
    const Point along = minus(v1, v0);
    const double size = length(along);
    for (int k = 0; k < 3 && c.length != 0; ++k)
      check(std::fabs(c.edge[k] - along[k] / size) <= 4 * eps_, "an edge vector is the unit of its corners' difference", id);
    if (c.length != 0) check(std::fabs(c.length - size) <= 4 * eps_ * size, "an edge is as long as its corners are apart", id);
    const bool is_boundary = c.node[1] == FDCG_NONE;
    check(is_boundary == (c.type == FDCG_BOUNDARY), "boundary connections have one node", id);
    check(c.type <= 3 && c.flatness <= 2, "a connection's type and flatness are known", id);
    for (std::uint32_t which = 0; which < (is_boundary ? 1u : 2u); ++which) {
      check(g_.sides[g_.nodes[c.node[which]].first_side + c.side[which]] == (id << 1 | which), "a connection finds its side",
            id);
      voronoi(id, c, which, v0, v1);
    }
    if (is_boundary) return;
    const WalkedNode &a = g_.nodes[c.node[0]], &b = g_.nodes[c.node[1]];
    if (c.type == FDCG_COPLANAR) {
      check(std::memcmp(&a.plane, &b.plane, sizeof a.plane) == 0, "coplanar nodes share one plane bit for bit", id);
    }
    if ((a.flags & FDCG_NODE_INEXACT) != 0 || (b.flags & FDCG_NODE_INEXACT) != 0 || c.type == FDCG_COPLANAR) return;
    // Of two exact nodes: a corner of b that is not on the edge, against a's plane.
    for (std::uint32_t i = 0; i < b.side_count; ++i) {
      const double* p = point(g_.corner_of_side(b.first_side + i));
      const int side = exact_side(point(g_.corner_of_side(a.first_side)), point(g_.corner_of_side(a.first_side + 1)),
                                  point(g_.corner_of_side(a.first_side + 2)), p);
      if (side == 0) continue;
      check(side == (c.type == FDCG_CONVEX ? -1 : 1), "a connection's type is the exact sign of its nodes", id);
      return;
    }
    check(false, "a connection of exactly coplanar nodes is called coplanar", id);
  }

  void voronoi(std::uint32_t id, const WalkedConnection& c, std::uint32_t which, const double* v0, const double* v1) {
    if (g_.voronoi.empty()) return;
    const WalkedNode& n = g_.nodes[c.node[which]];
    const fdcg_plane_f64& m = g_.voronoi[n.first_side + c.side[which]];
    check(std::fabs(std::sqrt(dot(m.normal, m.normal)) - 1) <= 4 * eps_, "a Voronoi normal has unit length", id);
    const Point expected = which == 0 ? cross(c.edge, n.plane.normal) : cross(n.plane.normal, c.edge);
    const bool is_exact = (n.flags & FDCG_NODE_INEXACT) == 0;
    if (is_exact) {
      for (int k = 0; k < 3; ++k)
        check(std::fabs(m.normal[k] - expected[k]) <= 16 * eps_, "a Voronoi plane is edge x normal", id);
    }
    const double tolerance = 16 * eps_ * g_.header.extent + (is_exact ? 0 : g_.header.max_deviation);
    check(std::fabs(dot(m.normal, v0) + m.offset) <= tolerance, "a Voronoi plane passes through corner 0", id);
    check(std::fabs(dot(m.normal, v1) + m.offset) <= tolerance, "a Voronoi plane passes through corner 1", id);
    for (std::uint32_t i = 0; i < n.side_count; ++i) {
      const double* p = point(g_.corner_of_side(n.first_side + i));
      // Convexity holds seen along an axis; a corner off the plane by d may stand out by 2 sqrt(2) d seen along the normal.
      check(dot(m.normal, p) + m.offset <= 4 * tolerance, "a node lies behind its Voronoi planes", id);
    }
  }

  void corner(std::uint32_t id) {
    const WalkedCorner& c = g_.corners[id];
    const bool is_open = c.is_open;
    std::set<std::uint32_t> nodes;
    for (std::uint32_t i = 0; i < c.fan_count; ++i) {
      const std::uint32_t entry = g_.fans[c.first_fan + i], end = entry & 1u;
      const WalkedConnection& connection = g_.connections[entry >> 1];
      check(connection.corner[end] == id, "a fan entry's connection ends at its corner", id);
      const bool closes = is_open && i + 1 == c.fan_count;
      const std::uint32_t node = connection.node[end];
      check((node == FDCG_NONE) == closes, "only the last connection of an open fan has no node to its left", id);
      if (i == 0) check((connection.node[1 - end] == FDCG_NONE) == is_open, "an open fan starts at its right boundary", id);
      if (node == FDCG_NONE) continue;
      check(nodes.insert(node).second, "a fan passes a node once", id);
      const std::uint32_t next_entry = g_.fans[c.first_fan + (i + 1) % c.fan_count];
      const WalkedNode& record = g_.nodes[node];
      const std::uint32_t at = connection.side[end], before = (at + record.side_count - 1) % record.side_count;
      check(g_.sides[record.first_side + before] == (next_entry ^ 1u), "a node comes in along the fan's next entry", id);
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      check(c.point[k] >= g_.header.bounds_min[k] && c.point[k] <= g_.header.bounds_max[k], "bounds hold every corner", id);
      check(std::fabs(c.point[k]) <= g_.header.extent, "extent covers every coordinate", id);
    }
    const double size =
        std::sqrt(double(c.normal[0]) * c.normal[0] + double(c.normal[1]) * c.normal[1] + double(c.normal[2]) * c.normal[2]);
    check(std::fabs(size - 1) < 1e-4 || size == 0, "a corner's normal has unit length", id);
    sides_seen_ += nodes.size();
    if (id + 1 == g_.corners.size())
      check(sides_seen_ == g_.sides.size(), "the fans hold every corner of every node", sides_seen_);
  }

  void boxes() {
    if (g_.boxes.empty()) return;
    std::vector<std::size_t> items{(g_.nodes.size() + FDCG_LEAF_NODES - 1) / FDCG_LEAF_NODES};
    while (items.size() == 1 || items.back() > 1)
      items.push_back((items.back() + 7) / 8);
    std::size_t first = g_.boxes.size();
    for (std::size_t level = 0; level + 1 < items.size(); ++level) {
      check(items[level + 1] <= first, "record count of the hierarchy", g_.boxes.size());
      if (items[level + 1] > first) return;
      const std::size_t below = first;
      first -= items[level + 1];
      for (std::size_t i = 0; i < items[level + 1]; ++i)
        record(g_.boxes[first + i], level, i, items[level], below);
    }
    check(first == 0, "record count of the hierarchy", g_.boxes.size());
  }

  void record(const fdcg_box8& boxes, std::size_t level, std::size_t i, std::size_t items, std::size_t below) {
    check(boxes.reserved == 0, "reserved byte of a box record", i);
    for (std::size_t j = 0; j < 8; ++j) {
      const std::size_t item = 8 * i + j;
      for (int k = 0; k < 3 && item >= items; ++k)
        check(boxes.low[k][j] == 255 && boxes.high[k][j] == 0, "a box that is not used is inside out", i);
      if (item >= items) continue;
      level == 0 ? leaf(boxes, j, item) : parent(boxes, j, g_.boxes[below + item]);
    }
  }

  // One bound, in the file's units.
  [[nodiscard]] double bound(const fdcg_box8& boxes, int k, std::uint8_t cells) const {
    const double unit = std::exp2(std::floor(std::log2(g_.header.extent)));
    return (boxes.origin[k] + std::exp2(boxes.exponent[k] - 127) * cells) * unit;
  }

  void leaf(const fdcg_box8& boxes, std::size_t j, std::size_t i) {
    for (std::size_t n = i * FDCG_LEAF_NODES; n < std::min(g_.nodes.size(), (i + 1) * FDCG_LEAF_NODES); ++n) {
      const double margin = (g_.nodes[n].flags & FDCG_NODE_INEXACT) != 0 ? g_.header.max_deviation : 0;
      for (std::uint32_t s = 0; s < g_.nodes[n].side_count; ++s) {
        const double* p = point(g_.corner_of_side(g_.nodes[n].first_side + s));
        for (int k = 0; k < 3; ++k) {
          check(bound(boxes, k, boxes.low[k][j]) <= p[k] - margin && bound(boxes, k, boxes.high[k][j]) >= p[k] + margin,
                "a leaf's box holds its nodes", n);
        }
      }
    }
  }

  void parent(const fdcg_box8& boxes, std::size_t j, const fdcg_box8& inner) {
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 8 && inner.low[k][i] <= inner.high[k][i]; ++i) {
        check(bound(boxes, k, boxes.low[k][j]) <= bound(inner, k, inner.low[k][i]) &&
                  bound(boxes, k, boxes.high[k][j]) >= bound(inner, k, inner.high[k][i]),
              "a box holds the boxes below it", i);
      }
    }
  }

  const WalkedGraph& g_;
  double eps_;
  std::vector<std::string> defects_;
  std::size_t sides_seen_ = 0;
};

}  // namespace

double WalkedGraph::area() const {
  double sum = 0;
  for (const WalkedNode& n : nodes) {
    const double* a = corners[corner_of_side(n.first_side)].point;
    Point area{};
    for (std::uint32_t i = 1; i + 1 < n.side_count; ++i) {
      const Point u = minus(corners[corner_of_side(n.first_side + i)].point, a);
      const Point v = minus(corners[corner_of_side(n.first_side + i + 1)].point, a);
      const Point w = cross(u.data(), v.data());
      for (int k = 0; k < 3; ++k)
        area[k] += w[k] / 2;
    }
    sum += length(area);
  }
  return sum;
}

std::vector<std::string> defects_of(const WalkedGraph& graph) {
  return Walker(graph).run();
}

std::string defects_text(const std::vector<std::byte>& bytes) {
  std::string text;
  for (const std::string& defect : defects_of(read_graph(bytes)))
    text += defect + "\n";
  return text;
}

}  // namespace fdcg::test
