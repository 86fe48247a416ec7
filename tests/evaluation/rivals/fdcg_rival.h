/* SPDX-License-Identifier: Apache-2.0 */
/* What a way of computing contact gives to take part in tools/bench: a shared object with one function, fdcg_rival_get. C99 and
 * later, C++; nothing else of this project is needed. How to build and run one: docs/rivals.md. */
#ifndef FDCG_RIVAL_H
#define FDCG_RIVAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_RIVAL_ABI 1u

#if defined(_WIN32)
#define FDCG_RIVAL_EXPORT __declspec(dllexport)
#else
#define FDCG_RIVAL_EXPORT __attribute__((visibility("default")))
#endif

/* Triangles, counter-clockwise seen from outside, vertices shared by index. The arrays are there until load returns. */
typedef struct fdcg_rival_mesh {
  uint64_t point_count, triangle_count;
  const double* points_m;  /* three a point: x, y, z in metres */
  const uint32_t* corners; /* three a triangle: indices of points */
} fdcg_rival_mesh;

/* Of one tick. All numbers finite. */
typedef struct fdcg_rival_result {
  double god_object_m[3]; /* where a real hand would have stayed on the surface; the HIP where there is no contact */
  double force_n[3];      /* on the user: stiffness times (god-object - HIP); 0 where there is no contact */
  uint32_t is_in_contact; /* 0 or 1 */
  uint32_t reserved;      /* 0 */
} fdcg_rival_result;

/* All of it constant. Nothing throws. Every body is loaded once more, and several may be loaded at a time, in one thread. */
typedef struct fdcg_rival {
  uint32_t abi;          /* FDCG_RIVAL_ABI */
  uint32_t reserved;     /* 0 */
  const char* name;      /* in tables: letters, digits, _ */
  const char* family;    /* closest_point, distance_grid, proxy, or another word; not fdcg */
  const char* precision; /* of what is stored: f64, f32, ... */
  const char* version;   /* of the method and what it links, in words */

  /* Ready to be stepped, as it is just after reset; or NULL, and why, in `error`. Its time is the contender's time of baking.
   */
  void* (*load)(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]);
  void (*unload)(void* body);
  /* The next step is the first: nothing is known of ticks before. */
  void (*reset)(void* body);
  /* One tick: the hand is at hip_m. This is what is timed. */
  void (*step)(void* body, const double hip_m[3], fdcg_rival_result* result);
  /* Bytes that stepping needs, or 0: not known. */
  uint64_t (*memory)(const void* body);
  /* Coulomb's coefficients, static and dynamic, from the next reset on. NULL: it knows no friction, and is left out there. */
  void (*set_friction)(void* body, double mu_static, double mu_dynamic);
} fdcg_rival;

/* NULL where another ABI is asked for. */
FDCG_RIVAL_EXPORT const fdcg_rival* fdcg_rival_get(uint32_t abi);

#ifdef __cplusplus
}
#endif
#endif
