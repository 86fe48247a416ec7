/* SPDX-License-Identifier: Apache-2.0 */
/* From reset to main on a Cortex-M4F or M7 without an operating system, and a way to talk to the debugger (semihosting). */
#include "board.h"

#include <stdint.h>

extern uint32_t data_start[], data_end[], data_in_flash[], bss_start[], bss_end[], stack_top[]; /* mps2.ld */

static long semihosting(long operation, const void* argument) {
  register long r0 __asm("r0") = operation;
  register const void* r1 __asm("r1") = argument;
  __asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

void board_print(const char* text) {
  semihosting(0x04, text); /* SYS_WRITE0 */
}

void board_exit(int status) {
  const long reason[2] = {0x20026 /* ADP_Stopped_ApplicationExit */, status};
  semihosting(0x20, reason); /* SYS_EXIT_EXTENDED */
  for (;;) {
  }
}

uint32_t board_ticks(void) {
  volatile uint32_t* const systick = (volatile uint32_t*)0xE000E010; /* control, reload, current value */
  if (systick[0] == 0) {
    systick[1] = 0xFFFFFF;
    systick[2] = 0;
    systick[0] = 5; /* runs, from the processor's clock */
  }
  return 0xFFFFFF - systick[2]; /* it counts down */
}

void reset(void);
void reset(void) {
  *(volatile uint32_t*)0xE000ED88 |= 0xFu << 20; /* CPACR: the floating-point unit on */
  __asm volatile("dsb\n\tisb");
  for (uint32_t *to = data_start, *from = data_in_flash; to < data_end;)
    *to++ = *from++;
  for (uint32_t* to = bss_start; to < bss_end;)
    *to++ = 0;
  board_exit(main());
}

static void fault(void) {
  board_print("fault\n");
  board_exit(3);
}

/* The processor reads its first stack pointer from the start of flash, then where to begin, then where faults go. */
typedef union vector {
  uint32_t* stack;
  void (*handler)(void);
} vector;
__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    {.stack = stack_top}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault}};
