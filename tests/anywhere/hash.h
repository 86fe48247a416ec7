/* SPDX-License-Identifier: Apache-2.0 */
/* A hash of numbers, and random numbers: the same everywhere. */
#ifndef FDCG_TEST_HASH_H
#define FDCG_TEST_HASH_H

#include <stdint.h>
#include <string.h>

typedef struct {
  uint64_t value; /* FNV-1a over 64-bit words, with a rotation, so that each bit reaches every other */
} hash_t;

static inline void absorb(hash_t* hash, uint64_t word) {
  hash->value = (hash->value ^ word) * 0x100000001B3u;
  hash->value = hash->value << 29 | hash->value >> 35;
}

static inline void absorb_real(hash_t* hash, double x) {
  uint64_t word;
  memcpy(&word, &x, sizeof word);
  absorb(hash, word);
}

static inline uint64_t random_bits(uint64_t* state) { /* xorshift64 */
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return *state;
}

static inline double uniform(uint64_t* state) {
  return (double)(random_bits(state) >> 11) * 0x1p-53;
}

#endif
