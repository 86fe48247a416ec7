/* SPDX-License-Identifier: Apache-2.0 */
#include "fdcg_cobs.h"

#define FULL 0xFFu /* a block of 254 bytes that no 0 follows */

size_t fdcg_cobs_encode(const uint8_t* bytes, size_t count, uint8_t* frame) {
  size_t at = 1, code_at = 0; /* of the block that is being written: how far it is to the next 0 */
  uint8_t code = 1;
  for (size_t i = 0; i < count; ++i) {
    if (code == FULL) {
      frame[code_at] = code;
      code_at = at++;
      code = 1;
    }
    if (bytes[i] == 0) {
      frame[code_at] = code;
      code_at = at++;
      code = 1;
    } else {
      frame[at++] = bytes[i];
      ++code;
    }
  }
  frame[code_at] = code;
  frame[at++] = 0;
  return at;
}

size_t fdcg_cobs_decode(const uint8_t* frame, size_t count, uint8_t* bytes, size_t most) {
  size_t at = 0, decoded = 0;
  while (at < count) {
    const uint8_t code = frame[at++];
    if (code == 0 || at + code - 1u > count || decoded + code - 1u > most) return 0;
    for (uint8_t i = 1; i < code; ++i) {
      if (frame[at] == 0) return 0;
      bytes[decoded++] = frame[at++];
    }
    if (code != FULL && at < count) {
      if (decoded == most) return 0;
      bytes[decoded++] = 0;
    }
  }
  return decoded;
}
