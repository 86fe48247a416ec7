/* SPDX-License-Identifier: Apache-2.0 */
/* A long random life of the device-side protocol core: a hash of all that it says and gives, how often it gave force, and on
 * the board the most ticks that each call took. The same source on every processor must say the same first line. */
#include <string.h>

#include "fdcg_firmware.h"
#include "say.h"

#ifdef FDCG_ON_BOARD
static uint32_t ticks(void) {
  return board_ticks();
}
#else
static uint32_t ticks(void) {
  return 0;
}
#endif

enum { kSteps = 20000 };

static uint32_t random_state = 2463534242u;
static uint32_t random_bits(void) { /* xorshift (Marsaglia 2003) */
  random_state ^= random_state << 13;
  random_state ^= random_state >> 17;
  return random_state ^= random_state << 5;
}

static uint64_t hash = 14695981039346656037u;
static void add(const void* bytes, size_t count) { /* FNV-1a */
  for (size_t i = 0; i < count; ++i)
    hash = (hash ^ ((const uint8_t*)bytes)[i]) * 1099511628211u;
}

static void put32(uint8_t* at, uint32_t value) {
  for (int i = 0; i < 4; ++i)
    at[i] = (uint8_t)(value >> 8 * i);
}

/* Mostly good reports: of forces around the peak, of every magnitude, late, repeated, damaged. */
static size_t make_output(const fdcg_fw* fw, uint8_t* bytes) {
  const uint32_t kind = random_bits() % 32;
  bytes[0] = FDCG_FW_OUTPUT_ID;
  put32(bytes + 1, fw->echo + (kind == 0 ? random_bits() : 1));
  for (int i = 0; i < 3; ++i) {
    float force_n = (float)(int32_t)(random_bits() % 8001) * 0.001f - 4.0f;
    uint32_t bits;
    memcpy(&bits, &force_n, sizeof bits);
    put32(bytes + 5 + 4 * i, kind == 1 ? random_bits() : bits);
  }
  put32(bytes + 17, fw->sequence - (kind == 2 ? random_bits() % 40 : 0));
  bytes[21] = (uint8_t)(kind < 4 ? 0 : kind == 4 ? 2 : 1);
  const uint16_t crc = fdcg_fw_crc16(bytes, FDCG_FW_OUTPUT_BYTES - 2);
  bytes[22] = (uint8_t)crc;
  bytes[23] = (uint8_t)(crc >> 8);
  if (kind == 5) bytes[random_bits() % 24] ^= 0x10;
  return kind == 6 ? random_bits() % 24 : FDCG_FW_OUTPUT_BYTES;
}

static void longest(uint32_t* most, uint32_t before) {
  const uint32_t spent = (ticks() - before) & 0xFFFFFF;
  if (spent > *most) *most = spent;
}

int main(void) {
  const fdcg_fw_config config = {1000000, {-80, -60, -50}, {80, 60, 50}, 3.3f, 0.9f, 1000, 20, 3, FDCG_FW_CARTESIAN};
  fdcg_fw fw;
  if (!fdcg_fw_init(&fw, &config)) return 1;
  uint8_t input[FDCG_FW_INPUT_BYTES], output[FDCG_FW_OUTPUT_BYTES], feature[FDCG_FW_FEATURE_BYTES];
  uint32_t time_us = 0xFFF00000u, pushes = 0, trips = 0, most_input = 0, most_output = 0, most_force = 0;
  for (int i = 0; i < kSteps; ++i) {
    const int32_t counts[3] = {i, -i, 1000 * i};
    uint32_t before = ticks();
    fdcg_fw_make_input(&fw, time_us, counts, (uint8_t)(i & 3), input);
    longest(&most_input, before);
    add(input, sizeof input);
    const size_t count = make_output(&fw, output);
    before = ticks();
    const uint8_t verdict = (uint8_t)fdcg_fw_take_output(&fw, time_us, output, count);
    longest(&most_output, before);
    add(&verdict, 1);
    time_us += random_bits() % 64 == 0 ? 25000 : 1000;
    float force_n[3];
    before = ticks();
    fdcg_fw_force(&fw, time_us, force_n);
    longest(&most_force, before);
    add(force_n, sizeof force_n);
    const float squares = force_n[0] * force_n[0] + force_n[1] * force_n[1] + force_n[2] * force_n[2];
    if (!(squares <= 3.3f * 3.3f * (1 + 1e-6f))) return 2;
    pushes += squares > 0;
    trips += (fw.status & FDCG_FW_WATCHDOG) != 0;
  }
  fdcg_fw_feature(&fw, feature);
  add(feature, sizeof feature);
  say_hex(hash), say(" pushes "), say_number(pushes), say(" tripped "), say_number(trips), say("\n");
  say("ticks "), say_number(most_input), say(" "), say_number(most_output), say(" "), say_number(most_force), say("\n");
  return 0;
}
