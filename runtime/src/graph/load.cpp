// SPDX-License-Identifier: Apache-2.0
// Opening a trusted file: its header and section table. A program that opens no other links nothing of verification.
#include <string.h>

#include "base/arithmetic.hpp"
#include "base/config.hpp"
#include "base/hooks.hpp"
#include "base/message.hpp"
#include "fdcg/fdcg.h"
#include "graph/box_tree.hpp"
#include "graph/checksum.hpp"
#include "graph/load.hpp"
#include "graph/record_types.hpp"
#include "graph/sections.hpp"

namespace fdcg {
namespace {

// Without a hierarchy the free-space sweep tests every node, and its work must stay bounded.
constexpr uint32_t kMaxNodesWithoutHierarchy = 4096;

// With more, connection << 1 would not fit into 32 bits.
constexpr uint32_t kMaxConnections = 0x7FFFFFFFu;

size_t padded(size_t bytes) {
  return (bytes + FDCG_ALIGNMENT - 1) / FDCG_ALIGNMENT * FDCG_ALIGNMENT;
}

static_assert(FDCG_MOST_SECTIONS * sizeof(fdcg_section) + FDCG_ALIGNMENT <= kChecksumBlock);
size_t table_bytes(const fdcg_header& header) {
  return header.section_count * sizeof(fdcg_section);
}

bool in_range(double value, double low, double high) {
  return value >= low && value <= high;
}

// Beyond this, products of three coordinates would leave the range of a double (f64) or a float (f32); below its inverse the
// squares of what rounding leaves of them would be lost.
double largest_extent(const fdcg_header& header) {
  return header.real_bytes == 8 ? FDCG_LARGEST_EXTENT_F64 : FDCG_LARGEST_EXTENT_F32;
}

fdcg_status check_header(const void* data, uint64_t bytes, fdcg_error* error) {
  if (bytes < sizeof(fdcg_header)) {
    return Message(error, FDCG_E_TRUNCATED, bytes)
        .say("the file has ", bytes, " bytes, an FDCG header alone has 256; it is truncated or not an FDCG file");
  }
  const auto& header = *static_cast<const fdcg_header*>(data);
  uint64_t magic, expected;  // as words: one comparison, where memcmp is a function of the C library
  memcpy(&magic, header.magic, sizeof magic);
  memcpy(&expected, FDCG_MAGIC, sizeof expected);
  if (magic != expected) {
    return Message(error, FDCG_E_MAGIC)
        .text("the first 8 bytes are not those of an FDCG file; compile the mesh with fdcg compile");
  }
  if (header.format_version != FDCG_FORMAT_VERSION) {
    return Message(error, FDCG_E_VERSION, offsetof(fdcg_header, format_version))
        .say("format version ", header.format_version, ", this library reads version ", FDCG_FORMAT_VERSION,
             "; compile the mesh again or update the library");
  }
  if (header.header_checksum != small_checksum(&header, offsetof(fdcg_header, header_checksum))) {
    return Message(error, FDCG_E_CHECKSUM, offsetof(fdcg_header, header_checksum))
        .text("the header's checksum does not match; the file is damaged, compile the mesh again");
  }
  constexpr bool kFits = sizeof(size_t) == sizeof(uint64_t);
  if (header.file_bytes != bytes || (!kFits && bytes > SIZE_MAX - FDCG_ALIGNMENT)) {  // no memory is as large
    return Message(error, FDCG_E_TRUNCATED, bytes)
        .say("the header promises ", header.file_bytes, " bytes, there are ", bytes, "; copy the file again");
  }
  return FDCG_OK;
}

// Whether every node's block can have the size that the header gives: 0, or that of a node of so many sides.
bool is_node_size(const fdcg_header& header) {
  if (header.node_bytes == 0) return true;
  const bool has_planes = (header.flags & FDCG_STORED_PLANES) != 0;
  for (uint32_t sides = 3; sides <= FDCG_MAX_SIDES; ++sides) {
    const uint32_t bytes =
        header.real_bytes == 8 ? node_bytes<double>(sides, has_planes) : node_bytes<float>(sides, has_planes);
    if (bytes == header.node_bytes) return header.side_count == header.node_count * uint64_t{sides};
  }
  return false;
}

fdcg_status check_header_values(const fdcg_header& header, fdcg_error* error) {
  const auto refuse = [&](const char* field, uint64_t value) -> fdcg_status {
    return Message(error, FDCG_E_LAYOUT).say("header.", field, " is ", value, ", which no writer produces");
  };
  if (header.header_bytes != sizeof(fdcg_header)) return refuse("header_bytes", header.header_bytes);
  if (header.real_bytes != 4 && header.real_bytes != 8) return refuse("real_bytes", header.real_bytes);
  if (header.section_count > FDCG_MOST_SECTIONS) return refuse("section_count", header.section_count);
  if (header.node_count == 0) return refuse("node_count", header.node_count);
  if ((header.flags & ~FDCG_STORED_PLANES) != 0) return refuse("flags", header.flags);
  if (!is_node_size(header)) return refuse("node_bytes", header.node_bytes);
  if (header.connection_count > kMaxConnections) return refuse("connection_count", header.connection_count);
  if (!has_precision(header.real_bytes)) {
    return Message(error, FDCG_E_VERSION, offsetof(fdcg_header, real_bytes))
        .text(FDCG_WITH_F32
                  ? "the file holds 64-bit numbers, this library was built for 32-bit ones alone; compile the mesh with "
                    "--precision f32, or the library with FDCG_WITH_F64"
                  : "the file holds 32-bit numbers, this library was built for 64-bit ones alone; compile the mesh "
                    "with --precision f64, or the library with FDCG_WITH_F32");
  }
  if (!FDCG_WITH_BUSY_CORNERS && header.busy_count != 0) {
    return Message(error, FDCG_E_VERSION, offsetof(fdcg_header, busy_count))
        .say(header.busy_count, " corners have more than ", FDCG_BUSY_FAN,
             " edges, this library was built without them; divide the faces there, or build it with FDCG_WITH_BUSY_CORNERS");
  }
  if (!FDCG_WITH_INEXACT_NODES && header.max_deviation > 0) {
    return Message(error, FDCG_E_VERSION, offsetof(fdcg_header, max_deviation))
        .say("merged faces lie up to ", header.max_deviation,
             " off their corners, this library was built without such; compile the mesh with --coplanar exact, or the library "
             "with FDCG_WITH_INEXACT_NODES");
  }
  if (!FDCG_WITH_DERIVED_PLANES && (header.flags & FDCG_STORED_PLANES) == 0) {
    return Message(error, FDCG_E_VERSION, offsetof(fdcg_header, flags))
        .text(
            "the planes of the faces' sides are to be derived, this library was built without that; compile the mesh with "
            "--planes stored, or the library with FDCG_WITH_DERIVED_PLANES");
  }
  const double largest = largest_extent(header);
  if (!in_range(header.extent, 1 / largest, largest)) {
    return Message(error, FDCG_E_LAYOUT, offsetof(fdcg_header, extent))
        .say("header.extent is ", header.extent, ", allowed ", 1 / largest, " to ", largest,
             header.real_bytes == 8 ? "; scale the mesh" : "; scale the mesh or compile it as f64");
  }
  for (int k = 0; k < 3; ++k) {
    if (!in_range(header.bounds_min[k], -largest, largest) || !in_range(header.bounds_max[k], header.bounds_min[k], largest) ||
        !in_range(header.origin[k], -1e100, 1e100)) {
      return Message(error, FDCG_E_LAYOUT).text("header: bounds or origin are not finite or too large");
    }
  }
  if (!in_range(header.metres_per_unit, 1e-30, 1e30) || !in_range(header.max_deviation, 0, largest) ||
      !in_range(header.quantum, 0, largest)) {
    return Message(error, FDCG_E_LAYOUT).text("header: metres_per_unit, max_deviation or quantum is out of range");
  }
  return FDCG_OK;
}

enum class Presence : uint8_t { required, optional, of_mixed_nodes, of_busy_corners };

constexpr uint16_t kNowhere = 0xFFFF;

struct SectionRule {
  uint8_t id;
  uint8_t record_f64, record_f32;  // bytes; 0: see record_bytes
  Presence presence;
  uint16_t count;    // field of the header that says how many records; kNowhere: see expected_records
  uint16_t pointer;  // field of fdcg_graph that leads to them; kNowhere: none
};
#define COUNT(field) offsetof(fdcg_header, field)
#define POINTER(field) offsetof(fdcg_graph, field)
constexpr SectionRule kSectionRules[] = {
    {FDCG_SECTION_NODES, 0, 0, Presence::required, kNowhere, POINTER(nodes)},
    {FDCG_SECTION_NODE_OFFSETS, 4, 4, Presence::of_mixed_nodes, COUNT(node_count), POINTER(node_offsets)},
    {FDCG_SECTION_EDGES, sizeof(fdcg_connection_geometry_f64), sizeof(fdcg_connection_geometry_f32),
     FDCG_WITH_DERIVED_PLANES ? Presence::optional : Presence::required, COUNT(connection_count), POINTER(edges)},
    {FDCG_SECTION_CONNECTIONS, sizeof(fdcg_connection), sizeof(fdcg_connection), Presence::required, COUNT(connection_count),
     POINTER(connections)},
    {FDCG_SECTION_CORNERS, sizeof(fdcg_corner_f64), sizeof(fdcg_corner_f32), Presence::required, COUNT(corner_count),
     POINTER(corners)},
    {FDCG_SECTION_FANS, 4, 4, Presence::of_busy_corners, COUNT(fan_count), POINTER(fans)},
    {FDCG_SECTION_HIERARCHY, sizeof(fdcg_box8), sizeof(fdcg_box8), Presence::optional, kNowhere, POINTER(hierarchy)},
    {FDCG_SECTION_SOURCE_MAP, 4, 4, Presence::optional, COUNT(source_face_count), POINTER(source_map)},
    {FDCG_SECTION_INFO, 1, 1, Presence::optional, kNowhere, POINTER(info)},
    {FDCG_SECTION_FAN_BOXES, sizeof(fdcg_fan_box_f64), sizeof(fdcg_fan_box_f32), Presence::of_busy_corners,
     COUNT(fan_box_count), POINTER(fan_boxes)},
    {FDCG_SECTION_BUSY_CORNERS, sizeof(fdcg_busy_corner), sizeof(fdcg_busy_corner), Presence::of_busy_corners,
     COUNT(busy_count), POINTER(busy_corners)},
    {FDCG_SECTION_MASS, sizeof(fdcg_mass_record), sizeof(fdcg_mass_record), Presence::optional, kNowhere, kNowhere},
    {FDCG_SECTION_MATERIALS, sizeof(uint16_t), sizeof(uint16_t), Presence::optional, COUNT(node_count),
     POINTER(node_materials)},
    {FDCG_SECTION_MATERIAL_NAMES, sizeof(fdcg_material_record), sizeof(fdcg_material_record), Presence::optional, kNowhere,
     POINTER(materials)},
    {FDCG_SECTION_FAN_RUNS, sizeof(fdcg_fan_run), sizeof(fdcg_fan_run), Presence::optional, kNowhere, POINTER(fan_runs)},
    {FDCG_SECTION_NODE_NORMALS, sizeof(fdcg_node_normals), sizeof(fdcg_node_normals), Presence::optional, COUNT(node_count),
     POINTER(normals)},
};
#undef COUNT
#undef POINTER

uint32_t record_bytes(const SectionRule& rule, const fdcg_header& header) {
  if (rule.id == FDCG_SECTION_NODES) return header.node_bytes != 0 ? header.node_bytes : header.real_bytes;
  return header.real_bytes == 8 ? rule.record_f64 : rule.record_f32;
}

size_t expected_records(const SectionRule& rule, const fdcg_header& header, size_t found) {
  if (rule.count != kNowhere) {
    uint32_t count;
    memcpy(&count, reinterpret_cast<const unsigned char*>(&header) + rule.count, sizeof count);
    return count;
  }
  if (rule.id == FDCG_SECTION_HIERARCHY) return BoxTree(header.node_count).records;
  if (rule.id == FDCG_SECTION_MASS) return 1;
  if (rule.id == FDCG_SECTION_MATERIAL_NAMES && found > FDCG_NO_MATERIAL) return FDCG_NO_MATERIAL;
  if (rule.id == FDCG_SECTION_FAN_RUNS && found > header.busy_count) return header.busy_count;
  return rule.id == FDCG_SECTION_NODES && header.node_bytes != 0 ? header.node_count : found;
}

// The sections follow one another without gaps, each padded to 64 bytes, up to the end of the file.
fdcg_status check_sections(const fdcg_section* sections, const fdcg_header& header, fdcg_error* error) {
  const auto end = static_cast<size_t>(header.file_bytes);  // it is in memory: open_trusted
  size_t at = padded(sizeof(fdcg_header) + table_bytes(header));
  for (uint32_t i = 0; i < header.section_count; ++i) {
    const fdcg_section& section = sections[i];
    const auto refuse = [&](const char* what) -> fdcg_status {
      return Message(error, FDCG_E_LAYOUT, sizeof(fdcg_header) + i * sizeof(fdcg_section))
          .say("section ", section.id, ": ", what);
    };
    if (i > 0 && section.id <= sections[i - 1].id) return refuse("ids do not ascend");
    if (section.offset != at) return refuse("does not start where the one before it ends");
    if (section.reserved != 0) return refuse("reserved field is not zero");
    const auto count = static_cast<size_t>(section.record_count);
    size_t bytes;  // by a product: small processors have no 64-bit division
    if (section.record_bytes == 0 || count != section.record_count ||
        __builtin_mul_overflow(section.record_bytes, count, &bytes) || bytes > end - at) {
      return refuse("reaches beyond the end of the file");
    }
    at += padded(bytes);
    if (at > end) return refuse("reaches beyond the end of the file");
    for (const SectionRule& rule : kSectionRules) {
      if (rule.id != section.id) continue;
      if (section.record_bytes != record_bytes(rule, header))
        return refuse("has records of a wrong size, as early drafts of the format had; compile the mesh again");
      if (count != expected_records(rule, header, count)) return refuse("has a wrong number of records");
    }
  }
  if (at != end) {
    return Message(error, FDCG_E_LAYOUT, at).say("the last section ends at ", at, ", the file at ", header.file_bytes);
  }
  return FDCG_OK;
}

fdcg_status check_table(const void* data, const fdcg_header& header, fdcg_error* error) {
  const size_t end = padded(sizeof(fdcg_header) + table_bytes(header));
  if (end > header.file_bytes)
    return Message(error, FDCG_E_LAYOUT).text("the section table reaches beyond the end of the file");
  const auto* table = static_cast<const unsigned char*>(data) + sizeof(fdcg_header);
  if (header.table_checksum != small_checksum(table, static_cast<uint32_t>(end - sizeof(fdcg_header)))) {
    return Message(error, FDCG_E_CHECKSUM, sizeof(fdcg_header))
        .text("the section table's checksum does not match; the file is damaged, compile the mesh again");
  }
  return check_sections(reinterpret_cast<const fdcg_section*>(table), header, error);
}

void view(const void* data, const fdcg_header& header, fdcg_graph* graph) {
  graph->header = &header;
  for (const SectionRule& rule : kSectionRules) {
    const fdcg_section* const found = find_section(header, rule.id);
    if (found == nullptr) continue;
    const unsigned char* const records = static_cast<const unsigned char*>(data) + found->offset;
    if (rule.pointer != kNowhere) memcpy(reinterpret_cast<unsigned char*>(graph) + rule.pointer, &records, sizeof records);
    const auto count = static_cast<uint32_t>(found->record_count);
    if (rule.id == FDCG_SECTION_MATERIAL_NAMES) graph->material_count = count;
    if (rule.id == FDCG_SECTION_FAN_RUNS) graph->fan_run_count = count;
    if (rule.id == FDCG_SECTION_INFO) graph->info_bytes = found->record_count;
  }
}

bool is_needed(Presence presence, const fdcg_header& header) {
  return presence == Presence::required || (presence == Presence::of_mixed_nodes && header.node_bytes == 0) ||
         (presence == Presence::of_busy_corners && header.busy_count != 0);
}

fdcg_status check_presence(const fdcg_header& header, fdcg_error* error) {
  for (const SectionRule& rule : kSectionRules) {
    const bool is_present = find_section(header, rule.id) != nullptr;
    if (!is_present && is_needed(rule.presence, header)) {
      return Message(error, FDCG_E_LAYOUT).say("section ", rule.id, " is missing, and this graph needs it");
    }
    if (is_present && rule.presence != Presence::optional && !is_needed(rule.presence, header)) {
      return Message(error, FDCG_E_LAYOUT).say("section ", rule.id, " contradicts the header, which has no use for it");
    }
  }
  if ((find_section(header, FDCG_SECTION_MATERIALS) == nullptr) !=
      (find_section(header, FDCG_SECTION_MATERIAL_NAMES) == nullptr)) {
    return Message(error, FDCG_E_LAYOUT).text("sections 13 and 14 (materials and their names) go together, one is missing");
  }
  if (header.node_count > kMaxNodesWithoutHierarchy && find_section(header, FDCG_SECTION_HIERARCHY) == nullptr) {
    return Message(error, FDCG_E_LAYOUT)
        .say("no hierarchy: only graphs of up to ", kMaxNodesWithoutHierarchy, " nodes may leave it out, this one has ",
             header.node_count, "; compile the mesh without --without hierarchy");
  }
  return FDCG_OK;
}

}  // namespace

fdcg_status open_trusted(const void* data, uint64_t bytes, fdcg_graph* graph, fdcg_error* error) {
  if (data == nullptr) return Message(error, FDCG_E_ARGUMENT).text("data: null pointer");
  if (reinterpret_cast<uintptr_t>(data) % alignof(fdcg_header) != 0) {
    return Message(error, FDCG_E_ALIGNMENT)
        .text("the memory must start at a multiple of 8 bytes; align the buffer (64 is best)");
  }
  fdcg_status status = check_arithmetic(error);
  if (status == FDCG_OK) status = check_header(data, bytes, error);
  if (status != FDCG_OK) return status;
  const auto& header = *static_cast<const fdcg_header*>(data);
  status = check_header_values(header, error);
  if (status == FDCG_OK) status = check_table(data, header, error);
  if (status == FDCG_OK) status = check_presence(header, error);
  if (status == FDCG_OK) view(data, header, graph);
  return status;
}

fdcg_status told(fdcg_status status, const fdcg_graph& graph, const fdcg_error& error) {
  if (status != FDCG_OK) {
    log(FDCG_LOG_ERROR, error.message);
    return status;
  }
  fdcg_error line;
  Message(&line, FDCG_OK).say("opened a graph of ", graph.header->node_count, " nodes");
  log(FDCG_LOG_INFO, line.message);
  return status;
}

}  // namespace fdcg

extern "C" fdcg_status fdcg_open_trusted(const void* data, uint64_t bytes, fdcg_graph* graph, fdcg_error* error) {
  if (graph == nullptr) return fdcg::refuse(error, "graph: null pointer");
  *graph = {};
  fdcg_error why = {};
  if (error == nullptr) error = &why;
  return fdcg::told(fdcg::open_trusted(data, bytes, graph, error), *graph, *error);
}
