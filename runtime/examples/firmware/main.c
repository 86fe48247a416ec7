/* SPDX-License-Identifier: Apache-2.0 */
/* Press and slide on a microcontroller: the graph lies in flash and is used there; nothing is allocated. */
#include "board.h"
#include "cube.h" /* made by fdcg_add_graph(... EMBED) */
#include "fdcg/fdcg.h"

static void print_number(const char* name, int32_t value) {
  char digits[12];
  char* at = digits + sizeof digits - 1;
  uint32_t rest = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
  *at = '\0';
  do {
    *--at = (char)('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (value < 0) *--at = '-';
  board_print(name);
  board_print(at);
}

int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  if (fdcg_open_trusted(cube, cube_bytes, &graph, &error) != FDCG_OK) {
    board_print(error.message);
    return 1;
  }
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact = {0};
  fdcg_result result;
  for (int tick = 0; tick < 6; ++tick) { /* a servo loop reads its device here and writes result.force_n to it */
    const double hip_m[3] = {0.004 + 0.0003 * tick, 0.005, tick == 0 ? 0.011 : 0.009};
    const uint32_t before = board_ticks();
    fdcg_step(&graph, &params, &contact, hip_m, &result);
    const uint32_t spent = (board_ticks() - before) & 0xFFFFFF;
    print_number("tick ", tick);
    print_number(": state ", (int32_t)result.state);
    print_number(", slip ", (int32_t)result.slipping);
    print_number(", force ", (int32_t)(result.force_n[0] * 1000 - 0.5));
    print_number(" 0 ", (int32_t)(result.force_n[2] * 1000 + 0.5));
    print_number(" mN, SysTick ", (int32_t)spent);
    board_print("\n");
  }
  return 0;
}
