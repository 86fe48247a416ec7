/* SPDX-License-Identifier: Apache-2.0 */
/* A walk over neighbours, without any planes between features (the idea of Ho, Basdogan and Srinivasan 1999): the first contact
 * is where the hand's way crosses a triangle, looked up in a grid of cells; from then on the nearest point is looked for on the
 * triangles around the last one, and theirs, as long as it comes nearer. Local: what is nearer beyond a hill is not found. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fdcg_rival.h"

#define MOST_CELLS 96 /* along the longest side */
#define NONE UINT32_MAX

typedef struct body {
  double (*points)[3];
  uint32_t (*corners)[3];
  double (*normals)[3];        /* of triangles, any length */
  uint32_t *star_first, *star; /* triangles around each point */
  uint32_t *cell_first, *cell; /* triangles in each cell */
  uint32_t point_count, triangle_count;
  double low[3], cell_m, stiffness_n_per_m;
  int64_t cells[3];
  uint64_t bytes;
  int is_started;
  uint32_t touched; /* triangle, or NONE */
  double last[3];
} body;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static void less(const double a[3], const double b[3], double d[3]) {
  for (int k = 0; k < 3; ++k)
    d[k] = a[k] - b[k];
}
static void cross(const double a[3], const double b[3], double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1], c[1] = a[2] * b[0] - a[0] * b[2], c[2] = a[0] * b[1] - a[1] * b[0];
}
static const double* corner(const body* b, uint32_t t, int k) {
  return b->points[b->corners[t][k]];
}

/* The point of the segment that is nearest to p; its squared distance. */
static double nearest_on_segment(const double p[3], const double a[3], const double c[3], double found[3]) {
  double along[3], off[3];
  less(c, a, along), less(p, a, off);
  const double square = dot(along, along), part = square > 0 ? fmin(1, fmax(0, dot(off, along) / square)) : 0;
  for (int k = 0; k < 3; ++k)
    found[k] = a[k] + part * along[k];
  less(p, found, off);
  return dot(off, off);
}

static int is_over(const body* b, uint32_t t, const double p[3]) {
  for (int k = 0; k < 3; ++k) {
    double side[3], off[3], out[3];
    less(corner(b, t, (k + 1) % 3), corner(b, t, k), side), less(p, corner(b, t, k), off);
    cross(side, b->normals[t], out);
    if (dot(out, off) > 0) return 0;
  }
  return 1;
}

static double nearest_on_triangle(const body* b, uint32_t t, const double p[3], double found[3]) {
  const double* n = b->normals[t];
  double off[3], best = INFINITY;
  less(p, corner(b, t, 0), off);
  if (dot(n, n) > 0 && is_over(b, t, p)) {
    const double height = dot(off, n) / dot(n, n);
    for (int k = 0; k < 3; ++k)
      found[k] = p[k] - height * n[k];
    return height * height * dot(n, n);
  }
  for (int k = 0; k < 3; ++k) {
    double place[3];
    const double square = nearest_on_segment(p, corner(b, t, k), corner(b, t, (k + 1) % 3), place);
    if (square < best) best = square, memcpy(found, place, sizeof place);
  }
  return best;
}

/* The part of the way a..c at which it passes the triangle from outside in; 2: it does not. */
static double crossing(const body* b, uint32_t t, const double a[3], const double c[3]) {
  double from[3], to[3], place[3];
  less(a, corner(b, t, 0), from), less(c, corner(b, t, 0), to);
  const double before = dot(from, b->normals[t]), after = dot(to, b->normals[t]);
  if (!(before >= 0 && after < 0)) return 2;
  const double part = before / (before - after);
  for (int k = 0; k < 3; ++k)
    place[k] = a[k] + part * (c[k] - a[k]);
  return is_over(b, t, place) ? part : 2;
}

/* Cells that the box between two points is in, along one side; 0: none. */
static int range(const body* b, int k, double one, double other, int64_t of[2]) {
  const double low = floor((fmin(one, other) - b->low[k]) / b->cell_m),
               high = floor((fmax(one, other) - b->low[k]) / b->cell_m);
  if (high < 0 || low >= (double)b->cells[k]) return 0;
  of[0] = low < 0 ? 0 : (int64_t)low, of[1] = high >= (double)b->cells[k] ? b->cells[k] - 1 : (int64_t)high;
  return 1;
}

/* Lists by counting: twice over all, first the sizes, then the places. */
static int fill_cells(body* b) {
  const uint64_t count = (uint64_t)(b->cells[0] * b->cells[1] * b->cells[2]);
  b->cell_first = calloc(count + 2, sizeof *b->cell_first);
  if (b->cell_first == NULL) return 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (uint32_t t = 0; t < b->triangle_count; ++t) {
      int64_t of[3][2];
      for (int k = 0; k < 3; ++k) {
        const double p = corner(b, t, 0)[k], q = corner(b, t, 1)[k], r = corner(b, t, 2)[k];
        range(b, k, fmin(p, fmin(q, r)), fmax(p, fmax(q, r)), of[k]);
      }
      for (int64_t x = of[0][0]; x <= of[0][1]; ++x)
        for (int64_t y = of[1][0]; y <= of[1][1]; ++y)
          for (int64_t z = of[2][0]; z <= of[2][1]; ++z) {
            const uint64_t i = (uint64_t)((x * b->cells[1] + y) * b->cells[2] + z);
            if (pass == 0)
              ++b->cell_first[i + 2];
            else
              b->cell[b->cell_first[i + 1]++] = t;
          }
    }
    if (pass == 1) break;
    for (uint64_t i = 2; i < count + 2; ++i)
      b->cell_first[i] += b->cell_first[i - 1];
    b->cell = malloc((size_t)b->cell_first[count + 1] * sizeof *b->cell + 1);
    if (b->cell == NULL) return 0;
  }
  b->bytes += (count + 2 + b->cell_first[count]) * sizeof(uint32_t);
  return 1;
}

static int fill_stars(body* b) {
  b->star_first = calloc((size_t)b->point_count + 2, sizeof *b->star_first);
  b->star = malloc((size_t)b->triangle_count * 3 * sizeof *b->star);
  if (b->star_first == NULL || b->star == NULL) return 0;
  for (uint32_t t = 0; t < b->triangle_count; ++t)
    for (int k = 0; k < 3; ++k)
      ++b->star_first[b->corners[t][k] + 2];
  for (uint32_t i = 2; i < b->point_count + 2; ++i)
    b->star_first[i] += b->star_first[i - 1];
  for (uint32_t t = 0; t < b->triangle_count; ++t)
    for (int k = 0; k < 3; ++k)
      b->star[b->star_first[b->corners[t][k] + 1]++] = t;
  b->bytes += ((uint64_t)b->point_count + 2 + (uint64_t)b->triangle_count * 3) * sizeof(uint32_t);
  return 1;
}

static void unload(void* of) {
  body* b = of;
  free(b->points), free(b->corners), free(b->normals), free(b->star_first), free(b->star), free(b->cell_first), free(b->cell);
  free(b);
}

static void* load(const fdcg_rival_mesh* mesh, double stiffness_n_per_m, char error[256]) {
  body* b = calloc(1, sizeof *b);
  if (b == NULL) return strcpy(error, "no memory"), NULL;
  b->point_count = (uint32_t)mesh->point_count, b->triangle_count = (uint32_t)mesh->triangle_count;
  b->stiffness_n_per_m = stiffness_n_per_m;
  b->points = malloc(mesh->point_count * sizeof *b->points);
  b->corners = malloc(mesh->triangle_count * sizeof *b->corners);
  b->normals = malloc(mesh->triangle_count * sizeof *b->normals);
  b->bytes = mesh->point_count * sizeof *b->points + mesh->triangle_count * (sizeof *b->corners + sizeof *b->normals);
  if (b->points == NULL || b->corners == NULL || b->normals == NULL) return strcpy(error, "no memory"), unload(b), NULL;
  memcpy(b->points, mesh->points_m, mesh->point_count * sizeof *b->points);
  memcpy(b->corners, mesh->corners, mesh->triangle_count * sizeof *b->corners);
  double high[3];
  for (int k = 0; k < 3; ++k)
    b->low[k] = INFINITY, high[k] = -INFINITY;
  for (uint32_t i = 0; i < b->point_count; ++i)
    for (int k = 0; k < 3; ++k)
      b->low[k] = fmin(b->low[k], b->points[i][k]), high[k] = fmax(high[k], b->points[i][k]);
  b->cell_m = fmax(high[0] - b->low[0], fmax(high[1] - b->low[1], high[2] - b->low[2])) / MOST_CELLS;
  for (int k = 0; k < 3; ++k)
    b->cells[k] = 1 + (int64_t)((high[k] - b->low[k]) / b->cell_m);
  for (uint32_t t = 0; t < b->triangle_count; ++t) {
    double u[3], v[3];
    less(corner(b, t, 1), corner(b, t, 0), u), less(corner(b, t, 2), corner(b, t, 0), v), cross(u, v, b->normals[t]);
  }
  if (!fill_stars(b) || !fill_cells(b)) return strcpy(error, "no memory"), unload(b), NULL;
  b->touched = NONE;
  return b;
}

static void reset(void* of) {
  body* b = of;
  b->is_started = 0, b->touched = NONE;
}

/* Slab by slab along x the cells that the way is in there. */
static uint32_t first_crossed(const body* b, const double from[3], const double to[3]) {
  const double rounding = 1e-9, way = to[0] - from[0];
  int64_t slabs[2];
  uint32_t found = NONE;
  double first = 2;
  if (!range(b, 0, from[0], to[0], slabs)) return NONE;
  for (int64_t x = slabs[0]; x <= slabs[1]; ++x) {
    double part[2] = {0, 1};
    int64_t of[3][2];
    int is_there = 1;
    for (int end = 0; end < 2 && way != 0; ++end) {
      const double side = b->low[0] + (double)(way > 0 ? x + end : x + 1 - end) * b->cell_m;
      part[end] = fmin(1, fmax(0, (side - from[0]) / way + (end ? rounding : -rounding)));
    }
    for (int k = 1; k < 3; ++k)
      is_there = is_there && range(b, k, from[k] + part[0] * (to[k] - from[k]), from[k] + part[1] * (to[k] - from[k]), of[k]);
    if (!is_there) continue;
    for (int64_t y = of[1][0]; y <= of[1][1]; ++y)
      for (int64_t z = of[2][0]; z <= of[2][1]; ++z) {
        const uint64_t i = (uint64_t)((x * b->cells[1] + y) * b->cells[2] + z);
        for (uint32_t at = b->cell_first[i]; at < b->cell_first[i + 1]; ++at) {
          const double met = crossing(b, b->cell[at], from, to);
          if (met < first) first = met, found = b->cell[at];
        }
      }
  }
  return found;
}

/* From b->touched on to the triangle with the nearest point; whether the HIP is inside of it, by that one of the triangles of
 * the point whose plane it is farthest from. */
static int walk(body* b, const double hip[3], double nearest[3]) {
  double best = nearest_on_triangle(b, b->touched, hip, nearest);
  for (int is_nearer = 1; is_nearer;) {
    const uint32_t around = b->touched;
    is_nearer = 0;
    for (int k = 0; k < 3; ++k) {
      const uint32_t point = b->corners[around][k];
      for (uint32_t at = b->star_first[point]; at < b->star_first[point + 1]; ++at) {
        double place[3];
        const double square = nearest_on_triangle(b, b->star[at], hip, place);
        if (square < best) best = square, b->touched = b->star[at], memcpy(nearest, place, sizeof place), is_nearer = 1;
      }
    }
  }
  double off[3], farthest = 0, height = 0;
  less(hip, nearest, off);
  for (int k = 0; k < 3; ++k) {
    const uint32_t point = b->corners[b->touched][k];
    for (uint32_t at = b->star_first[point]; at < b->star_first[point + 1]; ++at) {
      const double* n = b->normals[b->star[at]];
      double place[3];
      if (nearest_on_triangle(b, b->star[at], hip, place) > best * (1 + 1e-9)) continue;
      const double along = dot(off, n) / sqrt(dot(n, n));
      if (fabs(along) > farthest) farthest = fabs(along), height = along;
    }
  }
  return height < 0;
}

static void step(void* of, const double hip_m[3], fdcg_rival_result* result) {
  body* b = of;
  double nearest[3];
  if (b->touched == NONE && b->is_started) b->touched = first_crossed(b, b->last, hip_m);
  if (b->touched != NONE && !walk(b, hip_m, nearest)) b->touched = NONE;
  const int is_inside = b->touched != NONE;
  for (int k = 0; k < 3; ++k) {
    const double offset = is_inside ? nearest[k] - hip_m[k] : 0;
    result->god_object_m[k] = hip_m[k] + offset;
    result->force_n[k] = b->stiffness_n_per_m * offset;
    b->last[k] = hip_m[k];
  }
  b->is_started = 1;
  result->is_in_contact = (uint32_t)is_inside;
  result->reserved = 0;
}

static uint64_t memory(const void* of) {
  return ((const body*)of)->bytes;
}

static const fdcg_rival rival = {FDCG_RIVAL_ABI, 0,   "neighbour_walk", "local_search", "f64", "1", load, unload, reset, step,
                                 memory,         NULL};

const fdcg_rival* fdcg_rival_get(uint32_t abi) {
  return abi == FDCG_RIVAL_ABI ? &rival : NULL;
}
