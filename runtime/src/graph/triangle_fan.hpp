// SPDX-License-Identifier: Apache-2.0
// Walks around ordinary corners of a graph of triangles in blocks of one size, as the step will go: from side to side, by
// nodes that need not be SAFE yet. Two at once: a step waits for its node, and those of two corners do not wait for one
// another.
#pragma once

#include "fdcg/format.h"

namespace fdcg {

struct TriangleSides {
  const unsigned char* first;
  size_t block_bytes;
  uint32_t count;  // of triangles

  const fdcg_side* of(uint32_t n) const { return reinterpret_cast<const fdcg_side*>(first + n * block_bytes); }
};
struct TriangleFan {
  const fdcg_side *first, *incoming;
  uint32_t corner, node;
  uint32_t between;  // how many sides it crosses before the one that leads back to the first or is the border
  bool is_open;
};
inline constexpr uint32_t kFans = 2;

// Across the incoming side; null: its twin is not one.
[[gnu::always_inline]] inline const fdcg_side* cross_incoming(TriangleFan* fan, TriangleSides triangles) {
  const uint32_t across = fan->incoming->across, link = fan->incoming->link ^ 1;
  if (across >= triangles.count) return nullptr;  // nowhere, or of damaged bytes
  const fdcg_side* const sides = triangles.of(across);
  const uint32_t is1 = uint32_t{sides[1].link == link}, is2 = uint32_t{sides[2].link == link};
  const fdcg_side* const twin = sides + is1 + 2 * is2;
  if (twin->link != link || twin->across != fan->node || twin->corner != fan->corner) return nullptr;
  fan->node = across;
  fan->incoming = sides + (2 - 2 * is1 - is2);
  return twin;
}
[[gnu::always_inline]] inline bool passes(TriangleFan* fan, TriangleSides triangles) {
  const fdcg_side* const twin = cross_incoming(fan, triangles);
  return twin != nullptr && twin != fan->first;
}

// From the step after this one on.
[[gnu::always_inline]] inline bool is_sound_fan(TriangleFan fan, uint32_t step, TriangleSides triangles) {
  for (; step < fan.between; ++step) {
    if (!passes(&fan, triangles)) return false;
  }
  return fan.is_open ? fan.incoming->across == FDCG_NONE : cross_incoming(&fan, triangles) == fan.first;
}

[[gnu::always_inline]] inline bool are_sound_together(const TriangleFan (&all)[kFans], TriangleSides triangles) {
  TriangleFan a = all[0], b = all[1];
  const uint32_t together = a.between < b.between ? a.between : b.between;
  for (uint32_t i = 0; i < together; ++i) {
    if (!passes(&a, triangles) || !passes(&b, triangles)) return false;
  }
  return is_sound_fan(a, together, triangles) && is_sound_fan(b, together, triangles);
}

}  // namespace fdcg
