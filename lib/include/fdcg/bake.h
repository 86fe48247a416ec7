/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/bake.h
 * The compiler without files, for C and other languages: points and faces in, bytes of a graph out. On one screen:
 *
 *     fdcg_bake_options options = fdcg_make_bake_options();              metres, 64-bit numbers, faces merged
 *     options.allocate = my_allocate;                                    where the bytes go; NULL: aligned_alloc
 *     fdcg_finding findings[16];
 *     fdcg_baked baked = fdcg_make_baked();
 *     status = fdcg_bake(points, point_count, corners, NULL, face_count, &options, findings, 16, &baked, &error);
 *     FDCG_OK:      fdcg_open_memory(baked.bytes, baked.byte_count, FDCG_VERIFY_TRUSTED, &graph, &error)
 *     FDCG_E_MESH:  findings[0 .. baked.finding_count) say what is wrong, and where
 *
 * A library of its own, fdcg::bake_c: it links GMP and MPFR, and none of the readers of mesh files. The same mesh gives the
 * same bytes as fdcg compile, but for the section that names the file.
 *
 * **Frames, units, handedness.** Points in units of the caller's; faces are counter-clockwise seen from outside.
 * **Ownership.** Nothing is kept. The bytes are the caller's; those that the library allocated itself are given back with
 * fdcg_baked_free. **Threads.** Calls are independent; one call uses `threads` threads. Nothing is thrown out of it.
 */
#ifndef FDCG_BAKE_H
#define FDCG_BAKE_H

#include "fdcg/fdcg.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Gives memory for a graph: `bytes` bytes at a multiple of 64; NULL: there is none. `context` is that of the options. */
typedef void* (*fdcg_allocate)(void* context, uint64_t bytes);

/** How a mesh is compiled, as the options of fdcg compile. Make it by fdcg_make_bake_options, then change fields. */
typedef struct fdcg_bake_options {
  uint32_t struct_bytes;       /**< the caller's sizeof(fdcg_bake_options); fdcg_make_bake_options sets it */
  uint32_t real_bytes;         /**< of the graph's numbers: 8 or 4 */
  double metres_per_unit;      /**< of the points */
  double density_kg_per_m3;    /**< 0: not known */
  double quantum;              /**< points are known to within this, in their units, of which 1/1000 of the
                                    largest coordinate counts at most; 0: to the last bit */
  uint32_t merges;             /**< 1: coplanar faces become one node; 0 */
  uint32_t triangles;          /**< 1: every node is one triangle, for deform.h; 0 */
  uint32_t orients;            /**< 1: makes the winding consistent and outward first; 0 */
  uint32_t self_intersections; /**< 1: looks for them too; 0 */
  uint32_t threads;            /**< 0: as many as there are cores */
  uint32_t reserved;           /**< 0 */
  fdcg_allocate allocate;      /**< where the bytes go; NULL: to be given back with fdcg_baked_free */
  void* context;               /**< for `allocate` */
} fdcg_bake_options;
/** Sets the first `struct_bytes` bytes of *options: 64-bit numbers, metres, merged, as many threads as cores. */
FDCG_API void fdcg_bake_options_init(fdcg_bake_options* options, uint32_t struct_bytes);
/** The default options of fdcg_bake_options_init. */
FDCG_INLINE fdcg_bake_options fdcg_make_bake_options(void) {
  fdcg_bake_options options;
  fdcg_bake_options_init(&options, (uint32_t)sizeof options);
  return options;
}

/** How bad a finding is. */
typedef enum fdcg_severity {
  FDCG_NOTE = 0,    /**< good to know */
  FDCG_WARNING = 1, /**< compiles, and may feel wrong */
  FDCG_ERROR = 2    /**< does not compile */
} fdcg_severity;

/** Everything found under one rule (schemas/rules.md). */
typedef struct fdcg_finding {
  char rule[32];         /**< its name, zero-terminated */
  uint32_t severity;     /**< fdcg_severity */
  uint32_t first_face;   /**< the first face concerned; FDCG_NONE: no face is */
  uint32_t first_vertex; /**< the first point concerned; FDCG_NONE: none is */
  uint32_t reserved;     /**< 0 */
  uint64_t total;        /**< how many there are */
  char message[200];     /**< one line, zero-terminated */
} fdcg_finding;

/** What came of a mesh. Make it by fdcg_make_baked: it may grow. */
typedef struct fdcg_baked {
  uint32_t struct_bytes;  /**< the caller's sizeof(fdcg_baked); fdcg_make_baked sets it */
  uint32_t finding_count; /**< that there are; the caller's array has the first of them, errors first */
  void* bytes;            /**< the graph; NULL where there is none */
  uint64_t byte_count;    /**< its length */
  uint64_t merged_faces;  /**< that share their node with others */
  uint64_t split_faces;   /**< that became several nodes */
  uint64_t flipped_faces; /**< that were turned */
} fdcg_baked;
/** Sets the first `struct_bytes` bytes of *baked: nothing. */
FDCG_API void fdcg_baked_init(fdcg_baked* baked, uint32_t struct_bytes);
/** Nothing yet: of fdcg_baked_init. */
FDCG_INLINE fdcg_baked fdcg_make_baked(void) {
  fdcg_baked baked;
  fdcg_baked_init(&baked, (uint32_t)sizeof baked);
  return baked;
}

/** Compiles a mesh. `points`: 3 point_count numbers. Face f has sides[f] corners (`sides` NULL: 3 each), which stand one face
 * behind the other in `corners`, by the points' numbers. `findings`: room for `finding_capacity`, may be NULL with 0.
 * FDCG_E_MESH: the mesh has errors, and there are no bytes. FDCG_E_ARGUMENT: the options contradict one another, the density is
 * given of a mesh that encloses nothing, or the mesh outgrows the format. FDCG_E_MEMORY: there is none left. `error` may be
 * NULL. */
FDCG_API fdcg_status fdcg_bake(const double* points, uint64_t point_count, const uint32_t* corners, const uint32_t* sides,
                               uint64_t face_count, const fdcg_bake_options* options, fdcg_finding* findings,
                               uint32_t finding_capacity, fdcg_baked* baked, fdcg_error* error);

/** Gives back bytes that were allocated by the library itself, and zeroes *baked but for its size. */
FDCG_API void fdcg_baked_free(fdcg_baked* baked);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_BAKE_H */
