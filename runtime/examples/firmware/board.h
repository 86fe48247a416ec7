/* SPDX-License-Identifier: Apache-2.0 */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

int main(void); /* startup.c calls it */
void board_print(const char* text);
void board_exit(int status);
uint32_t board_ticks(void); /* of a 24-bit counter that SysTick drives; starts it */

#endif
