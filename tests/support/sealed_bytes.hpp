// SPDX-License-Identifier: Apache-2.0
// FDCG bytes in memory with the alignment of a mapped file, and recomputed checksums for damaged ones, so that a test reaches
// the checks after the checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "fdcg/fdcg.h"
#include "fdcg/heights.h"
#include "fdcg/visual.h"

namespace fdcg::test {

class AlignedBytes {
 public:
  explicit AlignedBytes(std::span<const std::byte> bytes) : words_(bytes.size() / 8 + 1), bytes_(bytes.size()) {
    if (!bytes.empty()) std::memcpy(words_.data(), bytes.data(), bytes.size());
  }
  [[nodiscard]] unsigned char* data() { return reinterpret_cast<unsigned char*>(words_.data()); }
  [[nodiscard]] std::uint64_t size() const { return bytes_; }
  [[nodiscard]] fdcg_header& header() { return *reinterpret_cast<fdcg_header*>(words_.data()); }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t bytes_;
};

// Recomputes every checksum that the header and the section table still lead to.
inline void seal(AlignedBytes& file) {
  if (file.size() < sizeof(fdcg_header)) return;
  fdcg_header& header = file.header();
  const std::uint64_t table_end = (sizeof(fdcg_header) + header.section_count * sizeof(fdcg_section) + 63) / 64 * 64;
  if (header.section_count <= 64 && table_end <= file.size()) {
    auto* sections = reinterpret_cast<fdcg_section*>(file.data() + sizeof(fdcg_header));
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
      const std::uint64_t end = i + 1 < header.section_count ? sections[i + 1].offset : file.size();
      if (sections[i].offset > end || end > file.size()) continue;
      sections[i].checksum = fdcg_checksum(file.data() + sections[i].offset, end - sections[i].offset);
    }
    header.table_checksum = fdcg_checksum(file.data() + sizeof(fdcg_header), table_end - sizeof(fdcg_header));
  }
  header.header_checksum = fdcg_checksum(&header, offsetof(fdcg_header, header_checksum));
}

// Steps a contact back and forth through the whole object and beyond: whatever the file says, nothing undefined may happen.
inline void touch_everywhere(const fdcg_graph& graph, std::uint32_t steps) {
  const fdcg_header& header = *graph.header;
  fdcg_params params = fdcg_make_params();
  const fdcg_material materials[2] = {{0.9, 0.5, 400}, {0.1, 0.1, 3000}};
  params.materials = materials;
  params.material_count = 2;
  fdcg_contact contact = {};
  fdcg_result result;
  std::uint64_t random = 88172645463325252u;
  for (std::uint32_t i = 0; i < steps; ++i) {
    double hip[3];
    for (int k = 0; k < 3; ++k) {
      random ^= random << 13, random ^= random >> 7, random ^= random << 17;
      const double share = static_cast<double>(random >> 11) * 0x1p-53 * 1.5 - 0.25;
      const double local = header.bounds_min[k] + share * (header.bounds_max[k] - header.bounds_min[k]);
      hip[k] = (local + header.origin[k]) * header.metres_per_unit;
    }
    params.mu_static = params.mu_dynamic = i % 3 == 0 ? 0 : 0.4;
    params.edge_friction = i % 2;
    params.friction_flags = i / 16 % 2 == 0 ? 0 : FDCG_FRICTION_ALL;
    fdcg_step(&graph, &params, &contact, hip, &result);
  }
}

// Reads all that a renderer would: what was found right leads nowhere else.
inline void look_at_visual(const fdcg_graph& graph) {
  fdcg_visual visual;
  if (fdcg_get_visual(&graph, &visual, nullptr) != FDCG_OK) return;
  std::uint64_t end = 0;
  double sum = 0;
  for (std::uint32_t m = 0; m < visual.material_count; ++m) {
    const fdcg_visual_material& material = visual.materials[m];
    end += std::strlen(material.name) < sizeof material.name ? material.index_count : 0;
    for (std::uint32_t i = 0; i < material.index_count; ++i) {
      const fdcg_visual_vertex& vertex = visual.vertices[visual.indices[material.first_index + i]];
      sum += double{vertex.position[0]} + vertex.uv[1];
      if (vertex.corner != FDCG_NONE) sum += fdcg_get_corner(&graph, vertex.corner).point[0];
    }
  }
  for (std::uint32_t t = 0; t < visual.index_count / 3; ++t)
    if (visual.nodes[t] != FDCG_NONE) sum += fdcg_get_node(&graph, visual.nodes[t]).offset;
  if (end != visual.index_count || !(sum * 0 == 0)) std::abort();
}

// Asks for heights on every node, at every speed and far away: what was found right leads nowhere else.
inline void look_at_heights(const fdcg_graph& graph) {
  fdcg_heights heights;
  if (fdcg_get_heights(&graph, &heights, nullptr) != FDCG_OK) return;
  const fdcg_relief relief = fdcg_make_height_relief(&heights);
  for (std::uint32_t n = 0; n <= heights.node_count; ++n) {
    double scale = graph.header->extent * graph.header->metres_per_unit;
    for (int i = 0; i < 8; ++i, scale *= i % 2 == 0 ? 1e-3 : 1e7) {
      const fdcg_relief_place place = {{scale, -0.7 * scale, 0.3 * scale}, {1e-6 * scale, -1e-7 * scale, 0}, n, 0};
      double height_m = 0, slope[3];
      fdcg_heights_law(&relief, &place, &height_m, slope);
      if (!(height_m <= 1.000001 * relief.most_m && height_m >= -1.000001 * relief.most_m)) std::abort();
    }
  }
}

// Any bytes through open and step: first as they are, then with magic, version, size and checksums made to fit, so that the
// checks behind them are reached. Whatever is SAFE is walked on; what is FULL is SAFE. How often of the two times it opened.
inline int open_and_touch(std::span<const std::byte> bytes, std::uint32_t steps) {
  AlignedBytes file(bytes);
  int opened = 0;
  for (int pass = 0; pass < 2; ++pass) {
    fdcg_graph graph;
    fdcg_error error;
    const bool is_full = fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK;
    if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK) {
      ++opened;
      touch_everywhere(graph, steps);
      look_at_visual(graph);
      look_at_heights(graph);
    } else if (is_full) {
      std::abort();
    }
    if (file.size() >= sizeof(fdcg_header)) {
      std::memcpy(file.header().magic, FDCG_MAGIC, 8);
      file.header().format_version = FDCG_FORMAT_VERSION;
      file.header().file_bytes = file.size();
    }
    seal(file);
  }
  return opened;
}

}  // namespace fdcg::test
