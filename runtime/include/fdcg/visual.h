/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/visual.h
 * The mesh that one sees, out of the same file as the graph that one feels: triangles with normals, texture coordinates,
 * colours and materials, in arrays that a renderer takes as they are (fdcg compile --visual writes them).
 *
 * Vertex i below header.corner_count is at corner i of the graph: a mesh that is deformed moves it along. Where normals,
 * texture coordinates or colours differ around a corner, further vertices follow, each with its corner's number. Triangles are
 * the mesh file's own, whatever the compiler merged; those of one material follow one another.
 *
 * **Frames and units.** Positions are local like all coordinates of the file (format.h): object_m = (position + origin) *
 * metres_per_unit, one matrix for a renderer. Right-handed; triangles are counter-clockwise seen from outside.
 * **Ownership.** Nothing is copied: the pointers lead into the file, and live as long as the graph.
 */
#ifndef FDCG_VISUAL_H
#define FDCG_VISUAL_H

#include "fdcg/fdcg.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Section ids, continuing fdcg_section_id. All four are there, or none. */
enum fdcg_visual_section_id {
  FDCG_SECTION_VISUAL_VERTICES = 17, /**< fdcg_visual_vertex */
  FDCG_SECTION_VISUAL_INDICES = 18,  /**< uint32_t, three a triangle */
  FDCG_SECTION_VISUAL_NODES = 19,    /**< uint32_t, one a triangle: the node that is felt there, or FDCG_NONE */
  FDCG_SECTION_VISUAL_MATERIALS = 20 /**< fdcg_visual_material */
};

#define FDCG_VISUAL_UV 1u      /**< fdcg_visual_material.flags: its vertices have texture coordinates; else they are 0 */
#define FDCG_VISUAL_COLOURS 2u /**< its vertices have colours of their own; else they are white */

/** A vertex, as a renderer takes it: 40 bytes, attributes at 0, 16, 24 and 32. */
typedef struct fdcg_visual_vertex {
  float position[3];  /**< local */
  uint32_t corner;    /**< of the graph, or FDCG_NONE: in the middle of a merged face */
  int16_t normal[4];  /**< FDCG_NORMAL_SCALE times the unit normal; 0 */
  float uv[2];        /**< texture coordinates, v downwards from the image's first row; finite */
  uint16_t colour[4]; /**< red, green, blue, opacity: 65535 is 1; linear */
} fdcg_visual_vertex;

/** A material and its triangles. */
typedef struct fdcg_visual_material {
  char name[FDCG_MATERIAL_NAME_BYTES]; /**< as the mesh file has it, as in MATERIAL_NAMES; empty: of no name */
  float base_colour[4];                /**< red, green, blue, opacity, 0 to 1, linear; times the vertices' */
  uint32_t first_index;                /**< where its triangles begin in the indices */
  uint32_t index_count;                /**< three a triangle */
  uint32_t flags;                      /**< FDCG_VISUAL_UV, FDCG_VISUAL_COLOURS */
  uint32_t reserved;                   /**< zero */
} fdcg_visual_material;

/** The mesh that one sees. */
typedef struct fdcg_visual {
  const fdcg_visual_vertex* vertices;    /**< vertex_count of them */
  const uint32_t* indices;               /**< index_count of them, each below vertex_count */
  const uint32_t* nodes;                 /**< index_count / 3 of them */
  const fdcg_visual_material* materials; /**< one or more; their runs follow one another and fill the indices */
  uint32_t vertex_count;                 /**< header.corner_count or more */
  uint32_t index_count;                  /**< a multiple of 3 */
  uint32_t material_count;               /**< entries of `materials` */
  uint32_t reserved;                     /**< zero */
  double origin[3];                      /**< header.origin, source units */
  double metres_per_unit;                /**< header.metres_per_unit */
} fdcg_visual;

/** Finds the mesh that one sees, and checks all of it: every index, number, name and run, whatever the level at which the graph
 * was opened. Fails with FDCG_E_ABSENT where the file has none, FDCG_E_GRAPH where it is wrong; *visual is then all zeros.
 * Cost: linear in the mesh; call it once. A program that does not call it links nothing of it. Part fdcg::query. */
FDCG_API fdcg_status fdcg_get_visual(const fdcg_graph* graph, fdcg_visual* visual, fdcg_error* error);

FDCG_STATIC_ASSERT(sizeof(fdcg_visual_vertex) == 40, "visual vertex: 40 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_visual_vertex, normal) == 16, "normal at 16");
FDCG_STATIC_ASSERT(offsetof(fdcg_visual_vertex, uv) == 24, "texture coordinates at 24");
FDCG_STATIC_ASSERT(offsetof(fdcg_visual_vertex, colour) == 32, "colour at 32");
FDCG_STATIC_ASSERT(sizeof(fdcg_visual_material) == 96, "visual material: 96 bytes");

#ifdef __cplusplus
}
#endif

#endif
