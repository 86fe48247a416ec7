// SPDX-License-Identifier: Apache-2.0
// Verification of an opened graph, chunk by chunk.
#include "graph/verify.hpp"

#include "base/message.hpp"

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

fdcg_status check_chunk(const fdcg_graph& graph, fdcg_verify level, Chunk chunk, fdcg_verification* part, fdcg_error* error) {
  ++part->chunks;
  return level == FDCG_VERIFY_FULL ? verify_full_chunk(graph, chunk, part, error)
                                   : verify_safe_chunk(graph, chunk, part, error);
}

fdcg_status check_sums(const fdcg_graph& graph, fdcg_verify level, const fdcg_verification& sum, fdcg_error* error) {
  return level == FDCG_VERIFY_FULL ? verify_full_sums(graph, sum, error) : verify_safe_sums(graph, sum, error);
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

// What chunk and sums have in common to refuse.
fdcg_status check_arguments(const fdcg_graph* graph, fdcg_verify level, const void* parts, fdcg_error* error) {
  if (graph == nullptr || graph->header == nullptr) return refuse(error, "graph: null pointer, or not opened");
  if (parts == nullptr) return refuse(error, "part: null pointer");
  if (level == FDCG_VERIFY_SAFE || level == FDCG_VERIFY_FULL) return FDCG_OK;
  return refuse(error, "level: allowed are FDCG_VERIFY_SAFE and FDCG_VERIFY_FULL");
}

}  // namespace

fdcg_status verify_up_to(const fdcg_graph& graph, fdcg_verify level, fdcg_error* error) {
  if (level == FDCG_VERIFY_TRUSTED) return FDCG_OK;
  const fdcg_status status = verify_level(graph, FDCG_VERIFY_SAFE, error);
  return status == FDCG_OK && level == FDCG_VERIFY_FULL ? verify_level(graph, level, error) : status;
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
