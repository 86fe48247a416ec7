/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/heights.h
 * Images as heights: maps of the graph's file that are felt as a relief (fdcg compile --heights writes them).
 *
 *     fdcg_heights heights;
 *     fdcg_get_heights(&graph, &heights, &error);
 *     fdcg_relief relief = fdcg_make_height_relief(&heights);       then as relief.h has it
 *
 * A map holds heights over texture coordinates, which each node has as one linear function of the place. Between its texels the
 * heights are a spline of third degree: value, slope and curvature have no steps. Levels of a map hold it ever smoother: level
 * 0 is the image; level k > 0 has nothing shorter than 4 * 2^(k-1) texels of the image, and whole what is 4.7 * 2^(k-1) or
 * longer. The speed of the hand chooses: what it passes faster than half the tick rate is in no level that is read, and waves
 * of at least 5 texels are felt in full up to a tenth of the tick rate.
 *
 * **Frames, units.** Heights in metres, outward from the surface. **Ownership.** Nothing is copied: the pointers lead into the
 * file, and live as long as the graph. **Threads.** Only read. **Cost.** See fdcg_heights_law. The same bits on every
 * processor.
 */
#ifndef FDCG_HEIGHTS_H
#define FDCG_HEIGHTS_H

#include "fdcg/fdcg.h"
#include "fdcg/relief.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Section ids, continuing fdcg_visual_section_id. All three are there, or none. */
enum fdcg_heights_section_id {
  FDCG_SECTION_NODE_PLACES = 21,  /**< fdcg_node_place, one a node */
  FDCG_SECTION_HEIGHT_MAPS = 22,  /**< fdcg_height_map */
  FDCG_SECTION_HEIGHT_TEXELS = 23 /**< int16_t: each map's levels, row by row */
};

#define FDCG_MAX_HEIGHT_SIDE 16384u /**< texels along a side of a map, at most */
#define FDCG_MAX_HEIGHT_MAPS 256u   /**< of a file, at most */
#define FDCG_MAX_HEIGHT_LEVELS 16u  /**< of a map, at most */

/** What lies beyond the borders of a map. */
typedef enum fdcg_wrap {
  FDCG_WRAP_REPEAT = 0, /**< the map again */
  FDCG_WRAP_CLAMP = 1,  /**< the border's heights */
  FDCG_WRAP_MIRROR = 2  /**< the map again, turned about */
} fdcg_wrap;

/** Where a node lies on its map: image_k(x) = offset[k] + per_unit[k] . x of local coordinates x; the image is 0 to 1 along
 * both axes, the second one downwards. 48 bytes. */
typedef struct fdcg_node_place {
  double offset[2];     /**< finite, within -1e6 to 1e6 */
  float per_unit[2][3]; /**< along the face; finite, of length 1e12 at most */
  uint32_t map;         /**< entry of HEIGHT_MAPS; FDCG_NONE: the node is flat */
  uint32_t reserved;    /**< zero */
} fdcg_node_place;

/** A map: where its texels are and what they mean. 40 bytes. */
typedef struct fdcg_height_map {
  double metres_per_step; /**< of a texel's number, 1e-15 to 1 */
  uint32_t width;         /**< of level 0, texels, 1 to FDCG_MAX_HEIGHT_SIDE */
  uint32_t height;        /**< likewise */
  uint32_t level_count;   /**< 1 to FDCG_MAX_HEIGHT_LEVELS. Level k > 0 has ceil(width / 2^(k-1)) columns, rows likewise */
  uint32_t first;         /**< the first of its texels in HEIGHT_TEXELS: where those of the map before end */
  uint32_t wrap[2];       /**< fdcg_wrap along the columns and along the rows */
  uint32_t reserved[2];   /**< zero */
} fdcg_height_map;

/** The heights of a graph. */
typedef struct fdcg_heights {
  const fdcg_node_place* places; /**< node_count of them */
  const fdcg_height_map* maps;   /**< map_count of them */
  const int16_t* texels;         /**< coefficients of the splines */
  uint32_t node_count;           /**< of the graph */
  uint32_t map_count;            /**< one or more */
  double origin[3];              /**< header.origin, source units */
  double metres_per_unit;        /**< header.metres_per_unit; times the scale of an object that is felt larger */
  double most_m;                 /**< no height is larger */
  double curvature_per_m;        /**< no second derivative along the surface is larger */
} fdcg_heights;

/** Finds the heights, and checks all of them, whatever the level at which the graph was opened. Fails with FDCG_E_ABSENT where
 * the file has none, FDCG_E_GRAPH where they are wrong; *heights is then all zeros. Cost: linear in nodes and texels; call it
 * once. A program that does not call it links nothing of it. Part fdcg::effect. */
FDCG_API fdcg_status fdcg_get_heights(const fdcg_graph* graph, fdcg_heights* heights, fdcg_error* error);

/** The law of fdcg_heights: 16 texels of one level, or of two between levels. */
FDCG_API void fdcg_heights_law(const fdcg_relief* relief, const fdcg_relief_place* place, double* height_m, double slope[3]);

/** A relief of these heights, which must outlive it. Of no heights (zeros) it is one that fdcg_check_relief refuses. */
FDCG_INLINE fdcg_relief fdcg_make_height_relief(const fdcg_heights* heights) {
  fdcg_relief relief;
  fdcg_relief_init(&relief, (uint32_t)sizeof relief);
  relief.law = fdcg_heights_law;
  relief.data = heights;
  relief.most_m = heights->most_m;
  relief.curvature_per_m = heights->curvature_per_m;
  return relief;
}

FDCG_STATIC_ASSERT(sizeof(fdcg_node_place) == 48, "node place: 48 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_node_place, map) == 40, "map at 40");
FDCG_STATIC_ASSERT(sizeof(fdcg_height_map) == 40, "height map: 40 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_height_map, wrap) == 24, "wrap at 24");

#ifdef __cplusplus
}
#endif

#endif /* FDCG_HEIGHTS_H */
