/* SPDX-License-Identifier: Apache-2.0 */
/* A rival to begin with: copy it, and put your method where `body` and `step` are. It works as it is, on convex bodies: the
 * god-object is the HIP's foot on the plane that it is the least below.
 *   cc -O3 -shared -fPIC -I tests/evaluation/rivals template.c -o template.so && tools/bench --only contenders --rival
 * ./template.so */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fdcg_rival.h"

typedef struct body {
  uint64_t count;
  double stiffness_n_per_m;
  double planes[][4]; /* outward unit normal, distance from the origin */
} body;

static void* load(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]) {
  body* b = malloc(sizeof(body) + mesh->triangle_count * sizeof b->planes[0]);
  if (b == NULL) {
    strcpy(error, "no memory");
    return NULL;
  }
  b->count = 0;
  b->stiffness_n_per_m = stiffness_n_per_m;
  for (uint64_t t = 0; t < mesh->triangle_count; ++t) {
    const double* p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = mesh->points_m + 3 * (uint64_t)mesh->corners[3 * t + (uint64_t)k];
    double u[3], v[3], length, *n = b->planes[b->count];
    for (int k = 0; k < 3; ++k)
      u[k] = p[1][k] - p[0][k], v[k] = p[2][k] - p[0][k];
    n[0] = u[1] * v[2] - u[2] * v[1], n[1] = u[2] * v[0] - u[0] * v[2], n[2] = u[0] * v[1] - u[1] * v[0];
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0)) continue; /* no plane */
    for (int k = 0; k < 3; ++k)
      n[k] /= length;
    n[3] = n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2];
    ++b->count;
  }
  return b;
}

static void reset(void* b) {
  (void)b; /* forget the last tick; this method remembers none */
}

static void step(void* of, const double hip_m[3], fdcg_rival_result* result) {
  const body* b = of;
  const double* best = NULL;
  double highest = -INFINITY;
  for (uint64_t i = 0; i < b->count; ++i) {
    const double* n = b->planes[i];
    const double height = n[0] * hip_m[0] + n[1] * hip_m[1] + n[2] * hip_m[2] - n[3];
    if (height > highest) highest = height, best = n;
  }
  const double depth = best != NULL && highest < 0 ? -highest : 0;
  for (int k = 0; k < 3; ++k) {
    const double offset = depth > 0 ? best[k] * depth : 0;
    result->god_object_m[k] = hip_m[k] + offset;
    result->force_n[k] = b->stiffness_n_per_m * offset;
  }
  result->is_in_contact = depth > 0;
  result->reserved = 0;
}

static uint64_t memory(const void* b) {
  return sizeof(body) + ((const body*)b)->count * sizeof(double[4]);
}

static const fdcg_rival rival = {FDCG_RIVAL_ABI, 0, "template", "planes", "f64", "1", load, free, reset, step, memory, NULL};

const fdcg_rival* fdcg_rival_get(uint32_t abi) {
  return abi == FDCG_RIVAL_ABI ? &rival : NULL;
}
