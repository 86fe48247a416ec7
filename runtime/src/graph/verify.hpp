// SPDX-License-Identifier: Apache-2.0
// What verification checks beyond header and section table, in chunks: a chunk is the same share of every section, its records
// and its checksum's blocks. A chunk of one level depends on no other of that level; those of FULL need a graph that is SAFE.
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

// Of `count` things those from `first` to `end` - 1 are this chunk's.
struct Chunk {
  uint32_t index, count;

  [[nodiscard]] uint64_t first_of(uint64_t things) const { return things * index / count; }
  [[nodiscard]] uint64_t end_of(uint64_t things) const { return things * (index + uint64_t{1}) / count; }
};

// Every index, count and number that the step, scenes, bodies and deformable meshes rely on; adds to *part what all chunks
// together must come to.
fdcg_status verify_safe_chunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error);

// Loops, twins, fans, boxes within boxes: that the graph is one surface, as a compiler writes it.
fdcg_status verify_full_chunk(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part, fdcg_error* error);

// The same in two parts, so that a chunk's bytes are asked while they are in the cache: first what can be told of a chunk while
// others are not known to be SAFE, false where something is wrong or cannot be told; then, of a graph that is SAFE, its busy
// corners.
bool is_full_alone(const fdcg_graph& graph, Chunk chunk, fdcg_verification* part);
fdcg_status verify_busy_corners(const fdcg_graph& graph, fdcg_verification* all, fdcg_error* error);

fdcg_status verify_full_sums(const fdcg_graph& graph, const fdcg_verification& sum, fdcg_error* error);

// Every chunk and the sums of each level up to this one.
fdcg_status verify_up_to(const fdcg_graph& graph, fdcg_verify level, fdcg_error* error);

// A record is named where something is wrong with it: "node 7: <what>; compile the mesh again".
[[gnu::cold]] fdcg_status refuse_record(fdcg_error* error, const char* noun, uint64_t index, const char* what);

// What a look at records finds. In the fast pass whether anything is wrong, without a branch; ...
struct AnyFault {
  static constexpr bool kHasNames = false;
  uint32_t is_any = 0;
  void note(bool is_wrong, const char*) { is_any |= is_wrong; }
};
// ... and, where there is, what.
struct FirstFault {
  static constexpr bool kHasNames = true;
  const char* what = nullptr;
  void note(bool is_wrong, const char* words) {
    if (is_wrong && what == nullptr) what = words;
  }
};

// look(index, Faults*) at records first to end - 1; the first that is wrong is refused by name.
template <class Look>
[[gnu::always_inline]] inline fdcg_status for_all(uint64_t first, uint64_t end, const char* noun, fdcg_error* error,
                                                  Look look) {
  AnyFault any;
  for (uint64_t i = first; i < end; ++i)
    look(static_cast<uint32_t>(i), &any);
  if (any.is_any == 0) return FDCG_OK;
#if FDCG_WITH_MESSAGES
  for (uint64_t i = first; i < end; ++i) {
    FirstFault fault;
    look(static_cast<uint32_t>(i), &fault);
    if (fault.what != nullptr) return refuse_record(error, noun, i, fault.what);
  }
#endif
  return refuse_record(error, noun, first, "is wrong, or one after it");
}

}  // namespace fdcg
