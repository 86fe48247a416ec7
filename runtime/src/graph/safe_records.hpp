// SPDX-License-Identifier: Apache-2.0
// What SAFE asks of a chunk's records beside nodes, connections, edges and corners (verify_safe.cpp): busy corners, boxes,
// source faces, materials and normals.
#pragma once

#include <string.h>

#include "graph/box_tree.hpp"
#include "graph/connection_words.hpp"
#include "graph/implicit_tree.hpp"
#include "graph/rigid_geometry.hpp"
#include "graph/sections.hpp"
#include "graph/verify.hpp"

namespace fdcg {

// Of a box record. The sweep's rounding is bounded for boxes this near to the object; cells no smaller keep the box of a lane
// that is not used inside out.
inline constexpr float kFarthestBox = 8;
inline constexpr uint8_t kLeastCellExponent = 127 - 24, kLargestCellExponent = 127;

// Passes are functions of their own: inlined into one, they would take longer for want of registers.
template <class Real>
class SafeRecords {
 public:
  SafeRecords(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error)
      : records_(graph), header_(*graph.header), raw_(graph), chunk_(chunk), part_(part), error_(error) {
    const fdcg_section& section = *find_section(header_, FDCG_SECTION_NODES);
    node_section_bytes_ = section.record_bytes * section.record_count;
    uniform_sides_ = header_.node_bytes != 0 ? header_.side_count / header_.node_count : 0;
  }

  // All of them.
  fdcg_status other_records() {
    fdcg_status status = header_.busy_count != 0 ? busy_corners() : FDCG_OK;
    if (status == FDCG_OK && raw_.hierarchy != nullptr) status = hierarchy();
    if (status == FDCG_OK && raw_.source_map != nullptr) status = source_map();
    if (status == FDCG_OK && raw_.node_materials != nullptr) status = materials();
    if constexpr (FDCG_WITH_SHADING) {  // without it no step reads them
      if (status == FDCG_OK && raw_.normals != nullptr) status = normals();
    }
    return status;
  }

 protected:
  using Node = typename Records<Real>::Node;

  template <class Look>
  fdcg_status for_mine(uint64_t things, const char* noun, Look look) {
    return for_all(chunk_.first_of(things), chunk_.end_of(things), noun, error_, look);
  }

  // Where blocks differ: whether node n's follows the one before it, within the section; else null. Safe to ask of any node.
  const unsigned char* checked_block(uint32_t n) const {
    const uint64_t at = records_.node_offsets()[n] * uint64_t{sizeof(Real)};
    if (at > node_section_bytes_ || node_section_bytes_ - at < sizeof(Node)) return nullptr;
    return records_.nodes() + at;
  }
  [[nodiscard]] uint32_t side_count_of(uint32_t n) const {
    if (uniform_sides_ != 0) return uniform_sides_;
    const unsigned char* const block = checked_block(n);
    return block == nullptr ? 0 : reinterpret_cast<const Node*>(block)->side_count;
  }

  const GraphRecords<Real> records_;
  const fdcg_header& header_;
  const fdcg_graph& raw_;
  const Chunk chunk_;
  fdcg_verification* part_;
  fdcg_error* error_;
  uint64_t node_section_bytes_;
  uint32_t uniform_sides_;  // of every node; 0: they differ

 private:
  // Their fans and trees follow one another and fill their sections.
  [[gnu::noinline]] fdcg_status busy_corners() {
    fdcg_status status = for_mine(header_.busy_count, "busy corner", [&](uint32_t i, auto* faults) {
      const fdcg_busy_corner none = {};
      const fdcg_busy_corner &busy = raw_.busy_corners[i], &before = i > 0 ? raw_.busy_corners[i - 1] : none;
      faults->note(busy.fan_count <= FDCG_BUSY_FAN || busy.fan_count > header_.largest_fan ||
                       busy.first_fan != before.first_fan + uint64_t{before.fan_count} ||
                       busy.first_box != before.first_box + ImplicitTree(before.fan_count, FDCG_LEAF_FAN).boxes,
                   "its fan is out of range, or it has no tree in range");
      if (i + 1 < header_.busy_count) return;
      faults->note(busy.first_fan + uint64_t{busy.fan_count} != header_.fan_count, "the last fan is not in range");
      const uint64_t boxes = ImplicitTree(busy.fan_count, FDCG_LEAF_FAN).boxes;
      faults->note(busy.first_box + boxes != header_.fan_box_count, "it has no tree in range");
    });
    if (status != FDCG_OK) return status;
    status = for_mine(header_.fan_count, "fan entry", [&](uint32_t i, auto* faults) {
      faults->note(records_.fans()[i] >> 1 >= header_.connection_count, "connection out of range");
    });
    if (status != FDCG_OK) return status;
    return for_mine(header_.fan_box_count, "fan box", [&](uint32_t i, auto* faults) {
      const auto& box = records_.fan_boxes()[i];
      bool is_in_range = norm1(vec(box.centre)) <= 4;
      for (const auto& axis : box.axis)
        is_in_range = is_in_range && norm1(vec(axis)) <= 8;
      faults->note(!is_in_range, "out of range");
    });
  }

  [[gnu::noinline]] fdcg_status hierarchy() {
    return for_mine(BoxTree(header_.node_count).records, "box record", [&](uint32_t i, auto* faults) {
      const fdcg_box8& boxes = raw_.hierarchy[i];
      bool is_in_range = boxes.reserved == 0;
      for (int axis = 0; axis < 3; ++axis) {
        is_in_range = is_in_range && absolute(boxes.origin[axis]) <= kFarthestBox &&
                      boxes.exponent[axis] >= kLeastCellExponent && boxes.exponent[axis] <= kLargestCellExponent;
      }
      faults->note(!is_in_range, "origin, exponent or reserved byte out of range");
    });
  }

  [[gnu::noinline]] fdcg_status source_map() {
    const uint64_t first = chunk_.first_of(header_.source_face_count), end = chunk_.end_of(header_.source_face_count);
    uint64_t judged = first;
#if FDCG_HAS_VECTORS
    using Numbers = uint32_t __attribute__((vector_size(16)));
    constexpr uint64_t kNumbers = sizeof(Numbers) / sizeof(uint32_t);
    const Numbers most = Numbers{} + header_.node_count;
    Numbers wrong = {};
    for (; judged + kNumbers <= end; judged += kNumbers) {
      Numbers numbers;
      memcpy(&numbers, raw_.source_map + judged, sizeof numbers);
      wrong |= reinterpret_cast<Numbers>(numbers + 1 > most);
    }
    if (any_of(reinterpret_cast<Words>(wrong)) != 0) judged = first;
#endif
    return for_all(judged, end, "source face", error_, [&](uint32_t f, auto* faults) {
      faults->note(raw_.source_map[f] + 1 > header_.node_count, "node out of range");  // FDCG_NONE + 1 is 0
    });
  }

  [[gnu::noinline]] fdcg_status materials() {
    const fdcg_status status = for_mine(raw_.material_count, "material", [&](uint32_t i, auto* faults) {
      const char(&name)[FDCG_MATERIAL_NAME_BYTES] = raw_.materials[i].name;
      bool is_over = false, is_name = name[0] != '\0' && name[FDCG_MATERIAL_NAME_BYTES - 1] == '\0';
      for (const char c : name) {
        is_over = is_over || c == '\0';
        is_name = is_name && (!is_over || c == '\0');
      }
      faults->note(!is_name, "its name does not end in its record, or is empty");
    });
    if (status != FDCG_OK) return status;
    return for_mine(header_.node_count, "node", [&](uint32_t n, auto* faults) {
      const uint16_t material = raw_.node_materials[n];
      faults->note((material >= raw_.material_count) & (material != FDCG_NO_MATERIAL), "material out of range");
    });
  }

  [[gnu::noinline]] fdcg_status normals() {
    return for_mine(header_.node_count, "node", [&](uint32_t n, auto* faults) {
      uint32_t is_flat = 1;
      for (const auto& code : raw_.normals[n].corner) {
        const uint32_t flat_numbers = (code[0] == FDCG_FLAT_NORMAL) + (code[1] == FDCG_FLAT_NORMAL);
        faults->note(flat_numbers == 1, "a corner's normal is half a code");
        is_flat &= flat_numbers == 2;
      }
      faults->note((is_flat == 0) & (side_count_of(n) != 3), "has normals at its corners, and more than three of them");
    });
  }
};

}  // namespace fdcg
