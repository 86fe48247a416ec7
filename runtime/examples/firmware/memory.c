/* SPDX-License-Identifier: Apache-2.0 */
/* memcpy and memset of 90 bytes in all, where newlib's take 470: by words where all is aligned, as it is in the runtime. */
#include <stddef.h>
#include <stdint.h>

/* No calls of themselves, which GCC makes of such loops; and kept for the calls that it adds when it links. */
#define ITSELF __attribute__((used, optimize("no-tree-loop-distribute-patterns")))
typedef uint32_t __attribute__((may_alias)) word;

void* memcpy(void* restrict to, const void* restrict from, size_t bytes);
ITSELF void* memcpy(void* restrict to, const void* restrict from, size_t bytes) {
  size_t i = 0;
  if ((((uintptr_t)to | (uintptr_t)from | bytes) & 3) == 0) {
    for (; i < bytes; i += 4)
      *(word*)((char*)to + i) = *(const word*)((const char*)from + i);
  }
  for (; i < bytes; ++i)
    ((char*)to)[i] = ((const char*)from)[i];
  return to;
}

void* memset(void* to, int value, size_t bytes);
ITSELF void* memset(void* to, int value, size_t bytes) {
  size_t i = 0;
  if ((((uintptr_t)to | bytes) & 3) == 0) {
    const word four = (uint8_t)value * 0x01010101u;
    for (; i < bytes; i += 4)
      *(word*)((char*)to + i) = four;
  }
  for (; i < bytes; ++i)
    ((char*)to)[i] = (char)value;
  return to;
}
