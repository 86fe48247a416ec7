/* SPDX-License-Identifier: Apache-2.0 */
/* Preloaded into the host: its CLOCK_BOOTTIME is ahead by the nanoseconds that stand in a file: this one, or the one
 * that FDCG_BOOT_CLOCK_AHEAD names. */
#pragma once

#define kClockShim "/lib/vm_clock_shim.so"
#define kClockShimFile "/tmp/boot_clock_ahead"
