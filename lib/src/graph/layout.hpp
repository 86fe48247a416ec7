// SPDX-License-Identifier: Apache-2.0
// Layout of a file: the offsets of its sections and, in section NODES, of the nodes' blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fdcg/format.h"
#include "graph/graph.hpp"

namespace fdcg::bake {

[[nodiscard]] constexpr std::uint64_t padded(std::uint64_t bytes) {
  return (bytes + FDCG_ALIGNMENT - 1) / FDCG_ALIGNMENT * FDCG_ALIGNMENT;
}

// Offset and size of each section.
class Layout {
 public:
  void add(fdcg_section_id id, std::size_t record_bytes, std::uint64_t count) {
    sections_.push_back({static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(record_bytes), 0, count, 0, 0});
  }
  void place() {
    std::uint64_t at = table_end();
    for (fdcg_section& section : sections_) {
      section.offset = at;
      at += padded(section.record_bytes * section.record_count);
    }
    bytes_ = at;
  }
  [[nodiscard]] std::uint64_t table_end() const {
    return padded(sizeof(fdcg_header) + sections_.size() * sizeof(fdcg_section));
  }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] std::vector<fdcg_section>& sections() { return sections_; }

  // The records of a section inside the file; empty where the file has none.
  template <class Record>
  [[nodiscard]] std::span<Record> records(std::span<std::byte> file, fdcg_section_id id) const {
    for (const fdcg_section& section : sections_) {
      if (section.id == static_cast<std::uint32_t>(id))
        return {reinterpret_cast<Record*>(file.data() + section.offset), section.record_count};
    }
    return {};
  }

 private:
  std::vector<fdcg_section> sections_;
  std::uint64_t bytes_ = 0;
};

// Offsets of the nodes' blocks: consecutive, of equal size where all nodes have the same number of sides; else the file has
// them, and they are kept there alone.
class Blocks {
 public:
  // The sizes depend on the sides: `node` bytes up to the sides, `real` bytes a number, `plane` bytes a stored plane or 0.
  Blocks(const Graph& graph, std::size_t node, std::size_t real, std::size_t plane)
      : graph_(graph), node_(node), real_(real), plane_(plane) {
    const std::uint32_t nodes = graph.node_count();
    const bool is_uniform =
        graph.side_count() == nodes * std::uint64_t{sides(0)} && (graph.node_of_side.empty() || has_one_size());
    if (is_uniform) {
      uniform_ = size(sides(0));
      bytes_ = nodes * std::uint64_t{uniform_};
      return;
    }
    for (std::uint32_t n = 0; n < nodes; ++n)
      bytes_ += size(sides(n));
  }
  // Writes the offsets, in numbers of `real` bytes; at() reads them there. Empty where all blocks have one size.
  void place(std::span<std::uint32_t> offsets) {
    offsets_ = offsets;
    std::uint64_t at = 0;
    for (std::uint32_t n = 0; n < offsets_.size(); ++n) {
      offsets_[n] = static_cast<std::uint32_t>(at / real_);
      at += size(sides(n));
    }
  }
  [[nodiscard]] std::uint32_t uniform_bytes() const { return uniform_; }  // 0: they differ
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t at(std::uint32_t n) const {
    return uniform_ != 0 ? n * std::uint64_t{uniform_} : offsets_[n] * std::uint64_t{real_};
  }
  [[nodiscard]] std::uint32_t sides_end(std::uint32_t sides) const {
    return static_cast<std::uint32_t>(node_ + sides * sizeof(fdcg_side));
  }
  [[nodiscard]] std::uint32_t planes_at(std::uint32_t sides) const {
    return static_cast<std::uint32_t>((sides_end(sides) + real_ - 1) / real_ * real_);
  }

 private:
  [[nodiscard]] std::uint32_t sides(std::uint32_t n) const { return graph_.first_side[n + 1] - graph_.first_side[n]; }
  [[nodiscard]] std::uint32_t size(std::uint32_t sides) const {
    return planes_at(sides) + static_cast<std::uint32_t>(sides * plane_);
  }
  [[nodiscard]] bool has_one_size() const {
    for (std::uint32_t n = 1; n < graph_.node_count(); ++n) {
      if (sides(n) != sides(0)) return false;
    }
    return true;
  }

  const Graph& graph_;
  std::size_t node_, real_, plane_;
  std::uint32_t uniform_ = 0;
  std::uint64_t bytes_ = 0;
  std::span<std::uint32_t> offsets_;  // the file's section; bytes() tells whether its numbers fit
};

}  // namespace fdcg::bake
