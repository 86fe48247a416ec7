/* SPDX-License-Identifier: Apache-2.0 */
/* Frames of a serial line by consistent overhead byte stuffing (Cheshire and Baker 1999, IEEE/ACM Trans. Networking 7(2)): a
 * frame holds no 0, and a 0 ends it, so that who comes in the middle, or loses a byte, finds the next one. C11, no heap. */
#ifndef FDCG_COBS_H
#define FDCG_COBS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The most bytes that a frame of so many takes, its 0 included. */
#define FDCG_COBS_FRAME_BYTES(bytes) ((bytes) + (bytes) / 254u + 2u)

/* Writes the frame and its 0; returns how many bytes. frame has room for FDCG_COBS_FRAME_BYTES(count). */
size_t fdcg_cobs_encode(const uint8_t* bytes, size_t count, uint8_t* frame);
/* frame: what stood before a 0. Returns how many bytes it holds, at most `most`; 0: it holds none, or is no frame, or is
 * longer. bytes may be frame itself. */
size_t fdcg_cobs_decode(const uint8_t* frame, size_t count, uint8_t* bytes, size_t most);

#ifdef __cplusplus
}
#endif

#endif
