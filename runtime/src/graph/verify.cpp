// SPDX-License-Identifier: Apache-2.0
// Verification of an opened graph, chunk by chunk.
#include "graph/verify.hpp"

#include "base/message.hpp"
#include "graph/checksum.hpp"
#include "graph/fan_run_section.hpp"
#include "graph/sections.hpp"
#include "shared/mass_record.hpp"

namespace fdcg {
namespace {

constexpr uint64_t kChunkBytes = 1 << 18;  // so that a chunk's bytes, summed first, are still in the cache when judged
constexpr uint64_t kMostChunks = 1 << 20;

uint32_t chunks_of(const fdcg_header& header) {
  const uint64_t chunks = header.file_bytes / kChunkBytes + 1;
  return static_cast<uint32_t>(chunks < kMostChunks ? chunks : kMostChunks);
}

void add(const fdcg_verification& part, fdcg_verification* sum) {
  sum->chunks += part.chunks;
  sum->sides += part.sides;
  sum->first_sides += part.first_sides;
  sum->busy_corners += part.busy_corners;
  sum->faces += part.faces;
  for (int type = 0; type < 4; ++type)
    sum->types[type] += part.types[type];
  for (uint32_t i = 0; i < FDCG_MOST_SECTIONS; ++i)
    sum->sums[i] += part.sums[i];
}

fdcg_status refuse_count(fdcg_error* error, const char* field, uint64_t value, const char* what) {
  return refuse_record(error, field, value, what);
}

// Whether the bytes are those that were written; and that nothing hides behind a section.
fdcg_status check_section_sums(const fdcg_header& header, const uint64_t* sums, fdcg_error* error) {
  const fdcg_section* const sections = section_table(header);
  const auto* const file = reinterpret_cast<const unsigned char*>(&header);
  for (uint32_t i = 0; i < header.section_count; ++i) {
    const uint64_t begin = sections[i].offset, bytes = section_bytes(header, i);
    if (checksum_start(bytes) + sums[i] != sections[i].checksum) {
      return Message(error, FDCG_E_CHECKSUM, begin)
          .text("section ")
          .number(sections[i].id)
          .text(": the checksum does not match; the file is damaged, compile the mesh again");
    }
    for (uint64_t at = sections[i].record_bytes * sections[i].record_count; at < bytes; ++at) {
      if (file[begin + at] != 0)
        return Message(error, FDCG_E_LAYOUT, begin + at).text("section ").number(sections[i].id).text(": padding is not zero");
    }
  }
  return FDCG_OK;
}

// What is wrong with a record may be that its bytes have changed: then that is what to say.
fdcg_status or_damaged(fdcg_status status, const fdcg_header& header, fdcg_error* error) {
  if (status == FDCG_OK) return status;
  uint64_t sums[FDCG_MOST_SECTIONS] = {};
  const auto* const file = reinterpret_cast<const unsigned char*>(&header);
  for (uint32_t i = 0; i < header.section_count; ++i) {
    const uint64_t bytes = section_bytes(header, i);
    sums[i] = checksum_of_blocks(file + section_table(header)[i].offset, bytes, 0, checksum_blocks(bytes));
  }
  fdcg_error why;
  if (check_section_sums(header, sums, &why) == FDCG_OK) return status;
  if (error != nullptr) *error = why;
  return why.status;
}

fdcg_status check_safe_sums(const fdcg_graph& graph, const fdcg_verification& sum, fdcg_error* error) {
  const fdcg_header& header = *graph.header;
  const fdcg_status status = check_section_sums(header, sum.sums, error);
  if (status != FDCG_OK) return status;
  if (sum.sides != header.side_count)
    return refuse_count(error, "header.side_count", header.side_count, "not the sum of the nodes'");
  if (sum.first_sides != header.connection_count || 2 * sum.first_sides - sum.types[FDCG_BOUNDARY] != sum.sides)
    return refuse_count(error, "header.connection_count", header.connection_count, "not the number of pairs of sides");
  for (uint32_t type = 0; type < 4; ++type) {
    if (sum.types[type] != header.connection_type_count[type])
      return refuse_count(error, "header.connection_type_count", type, "wrong");
  }
  if (sum.busy_corners != header.busy_count)
    return refuse_count(error, "header.busy_count", header.busy_count, "not the number of busy corners");
  if (header.busy_count == 0 && (header.fan_count != 0 || header.fan_box_count != 0))
    return refuse_count(error, "header.fan_count", header.fan_count, "not the sum of the corners'");
  const fdcg_status mass = verify_mass(header, error);
  return mass == FDCG_OK ? verify_fan_runs(graph, error) : mass;
}

fdcg_status check_chunk(const fdcg_graph& graph, fdcg_verify level, Chunk chunk, fdcg_verification* part, fdcg_error* error) {
  ++part->chunks;
  if (level == FDCG_VERIFY_FULL) return verify_full_chunk(graph, chunk, part, error);
  return or_damaged(verify_safe_chunk(graph, chunk, part, error), *graph.header, error);
}

fdcg_status check_sums(const fdcg_graph& graph, fdcg_verify level, const fdcg_verification& sum, fdcg_error* error) {
  return level == FDCG_VERIFY_FULL ? verify_full_sums(graph, sum, error) : check_safe_sums(graph, sum, error);
}

fdcg_status verify_level(const fdcg_graph& graph, fdcg_verify level, fdcg_error* error) {
  fdcg_verification sum = {};
  const uint32_t chunks = chunks_of(*graph.header);
  for (uint32_t i = 0; i < chunks; ++i) {
    const fdcg_status status = check_chunk(graph, level, {i, chunks}, &sum, error);
    if (status != FDCG_OK) return status;
  }
  return check_sums(graph, level, sum, error);
}

// Both levels at once, while a chunk's bytes are in the cache. Where FULL does not hold of a chunk alone it is asked again of
// all of them, when they are SAFE, and says what is wrong.
fdcg_status verify_both_levels(const fdcg_graph& graph, fdcg_error* error) {
  fdcg_verification safe = {}, full = {};
  const uint32_t chunks = chunks_of(*graph.header);
  bool is_full = true;
  for (uint32_t i = 0; i < chunks; ++i) {
    const fdcg_status status = check_chunk(graph, FDCG_VERIFY_SAFE, {i, chunks}, &safe, error);
    if (status != FDCG_OK) return status;
    is_full = is_full && is_full_alone(graph, {i, chunks}, &full);
  }
  fdcg_status status = check_sums(graph, FDCG_VERIFY_SAFE, safe, error);
  if (status != FDCG_OK) return status;
  if (!is_full) return verify_level(graph, FDCG_VERIFY_FULL, error);
  status = verify_busy_corners(graph, &full, error);
  return status == FDCG_OK ? check_sums(graph, FDCG_VERIFY_FULL, full, error) : status;
}

// What chunk and sums have in common to refuse.
fdcg_status check_arguments(const fdcg_graph* graph, fdcg_verify level, const void* parts, fdcg_error* error) {
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not opened");
  if (parts == nullptr) return refuse(error, "part: null pointer");
  if (level == FDCG_VERIFY_SAFE || level == FDCG_VERIFY_FULL) return FDCG_OK;
  return refuse(error, "level: allowed are FDCG_VERIFY_SAFE and FDCG_VERIFY_FULL");
}

}  // namespace

fdcg_status refuse_record(fdcg_error* error, const char* noun, uint64_t index, const char* what) {
  return Message(error, FDCG_E_GRAPH).text(noun).text(" ").number(index).text(": ").text(what).text("; compile the mesh again");
}

fdcg_status verify_up_to(const fdcg_graph& graph, fdcg_verify level, fdcg_error* error) {
  if (level == FDCG_VERIFY_TRUSTED) return FDCG_OK;
  return level == FDCG_VERIFY_FULL ? verify_both_levels(graph, error) : verify_level(graph, level, error);
}

}  // namespace fdcg

extern "C" uint32_t fdcg_verify_chunk_count(const fdcg_graph* graph) {
  return graph == nullptr || graph->header == nullptr ? 0 : fdcg::chunks_of(*graph->header);
}

extern "C" fdcg_status fdcg_verify_chunk(const fdcg_graph* graph, fdcg_verify level, uint32_t chunk, fdcg_verification* part,
                                         fdcg_error* error) {
  using namespace fdcg;
  const fdcg_status status = check_arguments(graph, level, part, error);
  if (status != FDCG_OK) return status;
  const uint32_t chunks = chunks_of(*graph->header);
  if (chunk >= chunks)
    return Message(error, FDCG_E_ARGUMENT).text("chunk is ").number(chunk).text(", allowed 0 to ").number(chunks - 1);
  return check_chunk(*graph, level, {chunk, chunks}, part, error);
}

extern "C" fdcg_status fdcg_verify_sum(const fdcg_graph* graph, fdcg_verify level, const fdcg_verification* parts,
                                       uint32_t count, fdcg_error* error) {
  using namespace fdcg;
  const fdcg_status status = check_arguments(graph, level, parts, error);
  if (status != FDCG_OK) return status;
  fdcg_verification sum = {};
  for (uint32_t i = 0; i < count; ++i)
    add(parts[i], &sum);
  if (sum.chunks != chunks_of(*graph->header)) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("the parts are of ")
        .number(sum.chunks)
        .text(" chunks, this graph has ")
        .number(chunks_of(*graph->header));
  }
  return check_sums(*graph, level, sum, error);
}
