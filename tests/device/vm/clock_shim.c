/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE
#include "clock_shim.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

static int (*real)(clockid_t, struct timespec*);
static const volatile int64_t* ahead_ns;

__attribute__((constructor)) static void begin(void) {
  *(void**)&real = dlsym(RTLD_NEXT, "clock_gettime");
  const char* const named = getenv("FDCG_BOOT_CLOCK_AHEAD");
  const int file = open(named != NULL ? named : kClockShimFile, O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  void* const mapped = mmap(NULL, sizeof *ahead_ns, PROT_READ, MAP_SHARED, file, 0);
  if (mapped != MAP_FAILED) ahead_ns = (const volatile int64_t*)mapped;
  close(file);
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  const int failed = real(clock, time);
  if (failed || clock != CLOCK_BOOTTIME || ahead_ns == NULL) return failed;
  const int64_t sum_ns = time->tv_nsec + *ahead_ns;
  time->tv_sec += sum_ns / 1000000000;
  time->tv_nsec = sum_ns % 1000000000;
  return 0;
}
