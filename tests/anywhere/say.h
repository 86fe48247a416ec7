/* SPDX-License-Identifier: Apache-2.0 */
/* Text and numbers out, with or without an operating system (FDCG_ON_BOARD: through the firmware example's debugger link). */
#ifndef SAY_H
#define SAY_H

#include <stdint.h>

#ifdef FDCG_ON_BOARD
#include "board.h"
static inline void say(const char* text) {
  board_print(text);
}
#else
#include <stdio.h>
static inline void say(const char* text) {
  fputs(text, stdout);
}
#endif

static inline void say_number(uint32_t value) {
  char digits[11];
  char* at = digits + sizeof digits - 1;
  *at = '\0';
  do {
    *--at = (char)('0' + value % 10);
    value /= 10;
  } while (value != 0);
  say(at);
}

static inline void say_hex(uint64_t value) {
  char digits[17];
  for (int i = 0; i < 16; ++i)
    digits[i] = "0123456789abcdef"[value >> (60 - 4 * i) & 15];
  digits[16] = '\0';
  say(digits);
}

#endif
