/* SPDX-License-Identifier: Apache-2.0 */
/* Counts the board's ticks a step while a hand slides over each graph at its own speed: a thousandth of the object a tick. Run
 * with a processor that takes the same time for every instruction (QEMU -icount), this counts instructions. */
#include "graphs.h"

#include <stdint.h>
#include <string.h>

#include "board.h"
#include "fdcg/fdcg.h"
#include "say.h"

enum { kTicks = 3000, kSides = 6 };

static uint32_t spent[kTicks];

static void sort(uint32_t* values, int count) { /* insertion: a few thousand, nearly sorted groups */
  for (int i = 1; i < count; ++i) {
    const uint32_t value = values[i];
    int at = i;
    for (; at > 0 && values[at - 1] > value; --at)
      values[at] = values[at - 1];
    values[at] = value;
  }
}

/* Along a closed way of six straight pieces just inside the bounds, in all three directions. */
static void way(const fdcg_header* header, int tick, double hip_m[3]) {
  static const double corners[kSides][3] = {{0.35, 0.35, -0.35},  {0.35, -0.35, -0.35}, {0.35, -0.35, 0.35},
                                            {-0.35, -0.35, 0.35}, {-0.35, 0.35, 0.35},  {-0.35, 0.35, -0.35}};
  const int piece = tick / (kTicks / kSides);
  const double part = (double)(tick % (kTicks / kSides)) / (kTicks / kSides);
  for (int k = 0; k < 3; ++k) {
    const double size = header->bounds_max[k] - header->bounds_min[k];
    const double at = corners[piece][k] + (corners[(piece + 1) % kSides][k] - corners[piece][k]) * part;
    hip_m[k] =
        ((header->bounds_min[k] + header->bounds_max[k]) * 0.5 + at * size + header->origin[k]) * header->metres_per_unit;
  }
}

int main(void) {
  for (uint32_t i = 0; i < sizeof graphs / sizeof graphs[0]; ++i) {
    fdcg_graph graph;
    fdcg_error why;
    const fdcg_status status = fdcg_open_memory(graphs[i].bytes, graphs[i].size, FDCG_VERIFY_FULL, &graph, &why);
    if (status == FDCG_E_VERSION) continue; /* the other precision */
    if (status != FDCG_OK) {
      say(why.message), say("\n");
      return 1;
    }
    const fdcg_params params = fdcg_make_params();
    fdcg_contact contact;
    memset(&contact, 0, sizeof contact);
    int count = 0;
    fdcg_result result;
    double hip_m[3];
    for (int k = 0; k < 3; ++k)
      hip_m[k] = 4 * graph.header->bounds_max[k] * graph.header->metres_per_unit;
    fdcg_step(&graph, &params, &contact, hip_m, &result); /* from outside: the hand comes in through the surface */
    for (int tick = 0; tick < kTicks; ++tick) {
      way(graph.header, tick, hip_m);
      const uint32_t before = board_ticks();
      fdcg_step(&graph, &params, &contact, hip_m, &result);
      const uint32_t after = board_ticks();
      if (result.state != FDCG_FREE) spent[count++] = (after - before) & 0xFFFFFF;
    }
    if (count == 0) continue; /* a flat patch has no inside */
    sort(spent, count);
    say(graphs[i].name), say(" "), say_number((uint32_t)count), say(" "), say_number(spent[count / 2]), say(" ");
    say_number(spent[count * 99 / 100]), say(" "), say_number(spent[count - 1]), say("\n");
  }
  return 0;
}
