// SPDX-License-Identifier: Apache-2.0
// The reading half of graph_walker.hpp: bytes into records, by format.h alone.
#include <algorithm>
#include <cstring>
#include <string>

#include "graph_walker.hpp"

namespace fdcg::test {
namespace {

template <class Stored, class Wide, class Widen>
std::vector<Wide> records(const std::vector<std::byte>& bytes, std::uint32_t id, Widen widen) {
  fdcg_header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::vector<Wide> out;
  for (std::uint32_t s = 0; s < header.section_count; ++s) {
    fdcg_section section;
    std::memcpy(&section, bytes.data() + sizeof header + s * sizeof section, sizeof section);
    if (section.id != id || section.record_bytes != sizeof(Stored)) continue;
    out.reserve(section.record_count);
    for (std::uint64_t i = 0; i < section.record_count; ++i) {
      Stored record;
      std::memcpy(&record, bytes.data() + section.offset + i * sizeof record, sizeof record);
      out.push_back(widen(record));
    }
  }
  return out;
}

fdcg_plane_f64 widen_plane(const auto& p) {
  return {{p.normal[0], p.normal[1], p.normal[2]}, p.offset};
}

// Plane, counts, sides, padding, planes: block after block, each found where the one before it ends.
template <class Real, class Plane>
void read_nodes(const std::vector<std::byte>& bytes, const fdcg_section& section, WalkedGraph& g) {
  const std::byte* const blocks = bytes.data() + section.offset;
  g.node_bytes = section.record_bytes * section.record_count;
  const auto offsets =
      records<std::uint32_t, std::uint32_t>(bytes, FDCG_SECTION_NODE_OFFSETS, [](std::uint32_t x) { return x; });
  std::size_t at = 0;
  const auto read = [&](auto& value) {
    if (at + sizeof value <= g.node_bytes) std::memcpy(&value, blocks + at, sizeof value);
    at += sizeof value;
  };
  for (std::uint32_t n = 0; n < g.header.node_count && at < g.node_bytes; ++n) {
    const std::size_t start = at;
    if (!offsets.empty() && offsets[n] * sizeof(Real) != at)
      g.layout_faults.push_back("a node's offset is not where its block is");
    Plane plane{};
    std::uint16_t count = 0, flags = 0;
    read(plane), read(count), read(flags);
    g.nodes.push_back({widen_plane(plane), static_cast<std::uint32_t>(g.sides.size()), count, flags});
    for (int k = 0; k < count; ++k) {
      std::uint32_t link = 0, corner = 0, across = 0;
      read(link), read(corner), read(across);
      g.sides.push_back(link), g.side_corner.push_back(corner), g.side_across.push_back(across);
    }
    for (; at % sizeof(Real) != 0; ++at) {
      if (at < g.node_bytes && blocks[at] != std::byte{0}) g.layout_faults.push_back("padding in a block is not zero");
    }
    for (int k = 0; k < count && (g.header.flags & FDCG_STORED_PLANES) != 0; ++k) {
      Plane m{};
      read(m);
      g.voronoi.push_back(widen_plane(m));
    }
    if (g.header.node_bytes != 0 && at - start != g.header.node_bytes)
      g.layout_faults.push_back("a block is not of the header's size");
  }
  if (at != g.node_bytes) g.layout_faults.push_back("the blocks do not fill their section");
}

// The side that comes before side k in its node's loop.
std::uint32_t previous_side(const WalkedGraph& g, std::uint32_t n, std::uint32_t k) {
  return g.nodes[n].first_side + (k + g.nodes[n].side_count - 1) % g.nodes[n].side_count;
}

// Walks the fan from where the corner says it starts, as far as the file lets it.
template <class Corner>
void read_corner(const Corner& c, std::uint32_t v, WalkedGraph& g) {
  WalkedCorner out{{c.point[0], c.point[1], c.point[2]}, {}, static_cast<std::uint32_t>(g.fans.size()), 0, false, false};
  for (int k = 0; k < 3; ++k)
    out.normal[k] = c.normal[k] / static_cast<double>(FDCG_NORMAL_SCALE);
  out.is_open = (c.fan & FDCG_CORNER_OPEN) != 0;
  const std::uint32_t said = c.fan & ~FDCG_CORNER_OPEN;
  out.is_busy = said == 0;
  const auto fault = [&](const char* what) { g.layout_faults.push_back("corner " + std::to_string(v) + ": " + what); };
  if (out.is_busy) {
    if (c.first >= g.busy_corners.size()) return fault("no such busy corner");
    const fdcg_busy_corner& busy = g.busy_corners[c.first];
    if (busy.corner != v || busy.fan_count <= FDCG_BUSY_FAN || busy.first_fan + busy.fan_count > g.stored_fans.size())
      return fault("busy fan out of range");
    g.fans.insert(g.fans.end(), g.stored_fans.begin() + busy.first_fan,
                  g.stored_fans.begin() + busy.first_fan + busy.fan_count);
    out.fan_count = busy.fan_count;
  } else {
    std::uint32_t n = c.first, k = c.side;
    for (std::uint32_t i = 0; i < said; ++i) {
      if (n >= g.nodes.size() || k >= g.nodes[n].side_count) return fault("fan leads nowhere");
      g.fans.push_back(g.sides[g.nodes[n].first_side + k]);
      const std::uint32_t incoming = previous_side(g, n, k), link = g.sides[incoming];
      n = g.side_across[incoming];
      if (n == FDCG_NONE) {
        g.fans.push_back(link ^ 1u);
        break;
      }
      if (link >> 1 >= g.connections.size()) return fault("fan leads nowhere");
      k = g.connections[link >> 1].side[1 - (link & 1u)];
    }
    out.fan_count = static_cast<std::uint32_t>(g.fans.size()) - out.first_fan;
    if (out.fan_count != said) fault("fan has not as many entries as it says");
    if (n != FDCG_NONE && (n != c.first || k != c.side)) fault("fan does not come back to its start");
  }
  g.corners.push_back(out);
}

template <class Real, class Plane, class Edge, class Corner>
void read_records(const std::vector<std::byte>& bytes, WalkedGraph& g) {
  for (std::uint32_t s = 0; s < g.header.section_count; ++s) {
    fdcg_section section;
    std::memcpy(&section, bytes.data() + sizeof g.header + s * sizeof section, sizeof section);
    if (section.id == FDCG_SECTION_NODES) read_nodes<Real, Plane>(bytes, section, g);
  }
  g.connections = records<fdcg_connection, WalkedConnection>(bytes, FDCG_SECTION_CONNECTIONS, [&](const fdcg_connection& c) {
    WalkedConnection out{{}, 0, {FDCG_NONE, FDCG_NONE}, {c.node, FDCG_NONE}, {c.side[0], c.side[1]}, c.type, c.flatness};
    if (c.node >= g.nodes.size() || c.side[0] >= g.nodes[c.node].side_count) return out;
    const WalkedNode& node = g.nodes[c.node];
    out.node[1] = g.side_across[node.first_side + c.side[0]];
    out.corner[0] = g.side_corner[node.first_side + c.side[0]];
    out.corner[1] = g.side_corner[node.first_side + (c.side[0] + 1u) % node.side_count];
    return out;
  });
  const auto edges = records<Edge, fdcg_connection_geometry_f64>(bytes, FDCG_SECTION_EDGES, [](const Edge& e) {
    return fdcg_connection_geometry_f64{{e.direction[0], e.direction[1], e.direction[2]}, e.length};
  });
  if (!edges.empty() && edges.size() != g.connections.size()) g.layout_faults.push_back("edge count");
  for (std::size_t c = 0; c < std::min(edges.size(), g.connections.size()); ++c) {
    std::copy_n(edges[c].direction, 3, g.connections[c].edge);
    g.connections[c].length = edges[c].length;
  }
  g.busy_corners =
      records<fdcg_busy_corner, fdcg_busy_corner>(bytes, FDCG_SECTION_BUSY_CORNERS, [](const auto& b) { return b; });
  g.stored_fans = records<std::uint32_t, std::uint32_t>(bytes, FDCG_SECTION_FANS, [](std::uint32_t x) { return x; });
  std::vector<Corner> corners = records<Corner, Corner>(bytes, FDCG_SECTION_CORNERS, [](const Corner& c) { return c; });
  for (std::uint32_t v = 0; v < corners.size(); ++v)
    read_corner(corners[v], v, g);
}

}  // namespace

WalkedGraph read_graph(const std::vector<std::byte>& bytes) {
  WalkedGraph g;
  if (bytes.size() < sizeof g.header) return g;
  std::memcpy(&g.header, bytes.data(), sizeof g.header);
  if (g.header.real_bytes == 4) {
    read_records<float, fdcg_plane_f32, fdcg_connection_geometry_f32, fdcg_corner_f32>(bytes, g);
  } else {
    read_records<double, fdcg_plane_f64, fdcg_connection_geometry_f64, fdcg_corner_f64>(bytes, g);
  }
  const auto number = [](std::uint32_t x) { return x; };
  g.source_map = records<std::uint32_t, std::uint32_t>(bytes, FDCG_SECTION_SOURCE_MAP, number);
  g.boxes = records<fdcg_box8, fdcg_box8>(bytes, FDCG_SECTION_HIERARCHY, [](const fdcg_box8& b) { return b; });
  const auto text = records<char, char>(bytes, FDCG_SECTION_INFO, [](char c) { return c; });
  g.info.assign(text.begin(), text.end());
  return g;
}

}  // namespace fdcg::test
