/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/format.h
 * The FDCG file, version 1: the Face Directed Connection Graph of Melder and Harwin (2004, section 4) as flat arrays, ready
 * to be mapped into memory and used where they lie. schemas/fdcg-v1.md tells the same story with a worked dump.
 *
 *     +--------------------+  0
 *     | fdcg_header        |  256 bytes
 *     | fdcg_section[n]    |  40 bytes each, then zeros up to a multiple of 64
 *     +--------------------+
 *     | section 0          |  every section starts at a multiple of 64 and is padded with zeros to one
 *     | ...                |
 *     +--------------------+  file_bytes
 *
 * **Words.** The records have the 2004 paper's nouns: a *node* is one planar convex face, a *connection* one edge, a *corner*
 * one vertex. The rest of the API says face, edge and vertex for what a contact is on. A side is a node's end of a connection;
 * a node has its sides in winding order (counter-clockwise seen from outside), side k from its corner to that of side k + 1.
 *
 * What a step reads together lies together. All that the rule of a face asks for is in the node's own block: its plane, its
 * sides, the planes through them, and where to go from there. So a god-object that arrives on a face can call its neighbours'
 * blocks, edges and corners into the cache at once, each known from this block alone.
 *
 * **Planes**: distance(x) = normal.x + offset, positive outside, normal of unit length.
 *
 * **Frames, units, handedness.** Every coordinate in the file is local, right-handed, in the units of the source file:
 * object_m = (local + header.origin) * header.metres_per_unit.
 *
 * **Ownership and threads.** These are layouts of bytes that are only read, by any number of threads. Little-endian; IEEE 754;
 * compiles as C11 and as C++.
 */
#ifndef FDCG_FORMAT_H
#define FDCG_FORMAT_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

#define FDCG_FORMAT_VERSION 1u /**< of this header; a reader refuses others */
#define FDCG_MAGIC \
  "\x89"           \
  "FDCG\r\n\x1a"                     /**< 8 bytes; a text-mode copy or a 7-bit channel breaks it visibly */
#define FDCG_ALIGNMENT 64u           /**< of sections, in bytes */
#define FDCG_NONE 0xFFFFFFFFu        /**< "no node here": the far side of an open edge; a dropped source face */
#define FDCG_NO_MATERIAL 0xFFFFu     /**< a node without a material */
#define FDCG_MATERIAL_NAME_BYTES 64u /**< room for a material's name */
#define FDCG_LEAF_NODES 4u           /**< nodes in one leaf of the hierarchy */
#define FDCG_TREE_WAYS 8u            /**< boxes in one record of the hierarchy */
#define FDCG_MOST_SECTIONS 64u       /**< entries of the section table */
#define FDCG_MAX_SIDES 255u          /**< sides of one node; fdcg compile cuts larger faces into nodes of at most 16 */
#define FDCG_LEAF_FAN 8u             /**< fan entries in one leaf of a corner's tree */
#define FDCG_BUSY_FAN 32u            /**< a corner with more fan entries is busy: it has its fan stored, and a tree */
#define FDCG_LARGEST_EXTENT_F64 1e60 /**< of an object; its inverse is the smallest */
#define FDCG_LARGEST_EXTENT_F32 1e9  /**< the same of files of 32-bit numbers */

#ifdef __cplusplus
extern "C" {
#endif

/** What a section holds. A reader skips ids that it does not know; a writer never reuses one. */
enum fdcg_section_id {
  FDCG_SECTION_NODES = 1,        /**< node blocks, node_count of them: in the order of HIERARCHY's boxes, then
                                    FAN_RUNS */
  FDCG_SECTION_NODE_OFFSETS = 2, /**< uint32_t: where each node's block starts, in units of real_bytes. Absent where all blocks
                                    are of one size, header.node_bytes */
  FDCG_SECTION_EDGES = 3, /**< fdcg_connection_geometry_f64 or _f32, one a connection. Optional: derived from the corners */
  FDCG_SECTION_CONNECTIONS = 4, /**< fdcg_connection, connection_count of them, by first use */
  FDCG_SECTION_CORNERS = 5,     /**< fdcg_corner_f64 or _f32, corner_count of them, by first use */
  FDCG_SECTION_FANS = 6,        /**< uint32_t: connection << 1 | end, the busy corners' fans, fan_count entries in all */
  FDCG_SECTION_HIERARCHY = 7,   /**< fdcg_box8: the implicit bounding-volume tree. Optional for few nodes: all are looked at */
  FDCG_SECTION_SOURCE_MAP = 8,  /**< uint32_t: the node of each source face, or FDCG_NONE. Optional */
  FDCG_SECTION_INFO = 9,        /**< UTF-8 JSON: source, options, verdict. Optional */
  FDCG_SECTION_FAN_BOXES = 10,  /**< fdcg_fan_box_f64 or _f32: the busy corners' trees */
  FDCG_SECTION_BUSY_CORNERS = 11, /**< fdcg_busy_corner, busy_count of them. FANS, FAN_BOXES and it are absent where none is */
  FDCG_SECTION_MASS = 12,         /**< fdcg_mass_record, one. Optional: of closed meshes that enclose a solid */
  FDCG_SECTION_MATERIALS = 13,    /**< uint16_t: the material of each node, or FDCG_NO_MATERIAL. Optional, with the next */
  FDCG_SECTION_MATERIAL_NAMES = 14, /**< fdcg_material_record, one a material */
  FDCG_SECTION_FAN_RUNS = 15,       /**< fdcg_fan_run: which nodes stand together because they share a busy corner. Optional */
  FDCG_SECTION_NODE_NORMALS = 16    /**< fdcg_node_normals, one a node: the surface that shading feels. Optional */
};

/** How the faces of a connection meet. */
enum fdcg_connection_type {
  FDCG_CONVEX = 0,   /**< the solid bulges */
  FDCG_CONCAVE = 1,  /**< a groove */
  FDCG_COPLANAR = 2, /**< flat */
  FDCG_BOUNDARY = 3  /**< one face only */
};

/** Why a connection has its type. Only nodes of one region, which share one plane bit for bit, are joined by the latter two. */
enum fdcg_flatness {
  FDCG_FLAT_EXACT = 0,   /**< the exact sign of the stored points */
  FDCG_FLAT_QUANTUM = 1, /**< flat within the input's own rounding */
  FDCG_FLAT_ANGLE = 2    /**< flat within the angle that the user gave */
};

/** header.flags. Set: every node's block holds the Voronoi planes of its sides; clear: they are derived in the step. */
#define FDCG_STORED_PLANES 1u
/** fdcg_node.flags. Set when the corners lie off the node's plane by up to header.max_deviation; clear when they are exactly
 * coplanar, and then the first three corners of the loop span the plane. */
#define FDCG_NODE_INEXACT 1u
/** fdcg_corner.fan. Set when a boundary connection ends here; then the fan is open and starts at the boundary connection whose
 * face lies to its left. The other bits: how many entries the fan has, or 0 at a busy corner. */
#define FDCG_CORNER_OPEN 0x80u
/** fdcg_corner.normal is this many times the unit vector. */
#define FDCG_NORMAL_SCALE 32767

/** The first 256 bytes of a file. */
typedef struct fdcg_header {
  uint8_t magic[8];                  /**< FDCG_MAGIC */
  uint32_t format_version;           /**< FDCG_FORMAT_VERSION */
  uint32_t header_bytes;             /**< sizeof(fdcg_header) */
  uint64_t file_bytes;               /**< of the whole file */
  uint32_t real_bytes;               /**< 8: records _f64; 4: records _f32 */
  uint32_t section_count;            /**< entries of the section table */
  uint32_t node_count;               /**< faces of the graph */
  uint32_t side_count;               /**< of all nodes together */
  uint32_t connection_count;         /**< edges */
  uint32_t corner_count;             /**< vertices */
  uint32_t fan_count;                /**< in section FANS */
  uint32_t largest_fan;              /**< connections at the busiest corner */
  double origin[3];                  /**< of the local frame, source units */
  double metres_per_unit;            /**< > 0 */
  double bounds_min[3];              /**< of the corners, local */
  double bounds_max[3];              /**< local */
  double extent;                     /**< largest |coordinate| of a corner, local: scales every rounding bound */
  double max_deviation;              /**< largest distance of a corner from the plane of one of its nodes, source units */
  double quantum;                    /**< half the spacing of the input's numbers at the object's extent, source units */
  uint32_t connection_type_count[4]; /**< by fdcg_connection_type */
  uint32_t source_vertex_count;      /**< of the mesh file */
  uint32_t source_face_count;        /**< of the mesh file */
  uint32_t fan_box_count;            /**< in section FAN_BOXES */
  uint32_t busy_count;               /**< in section BUSY_CORNERS */
  uint32_t node_bytes;               /**< size of every node's block; 0: they differ, see NODE_OFFSETS */
  uint32_t flags;                    /**< FDCG_STORED_PLANES */
  uint8_t reserved[40];              /**< zero */
  uint64_t table_checksum;           /**< of the section table with its padding */
  uint64_t header_checksum;          /**< of the bytes before this field */
} fdcg_header;

/** An entry of the section table. */
typedef struct fdcg_section {
  uint32_t id;           /**< fdcg_section_id; ascending in the table */
  uint32_t record_bytes; /**< of one record */
  uint64_t offset;       /**< from the start of the file; a multiple of 64 */
  uint64_t record_count; /**< offset + record_bytes * record_count, padded to 64, is where the next section starts */
  uint64_t checksum;     /**< fdcg_checksum of the section with its padding */
  uint64_t reserved;     /**< zero */
} fdcg_section;

/** A plane, in 64-bit numbers. */
typedef struct fdcg_plane_f64 {
  double normal[3]; /**< unit */
  double offset;    /**< distance(x) = normal.x + offset, positive outside */
} fdcg_plane_f64;
/** A plane, in 32-bit numbers. */
typedef struct fdcg_plane_f32 {
  float normal[3]; /**< unit */
  float offset;    /**< distance(x) = normal.x + offset, positive outside */
} fdcg_plane_f32;

/** One side of a node. */
typedef struct fdcg_side {
  uint32_t link;   /**< connection << 1 | which; which 0: the connection runs along this side, 1: against it */
  uint32_t corner; /**< at which the side starts */
  uint32_t across; /**< the node beyond it, or FDCG_NONE */
} fdcg_side;

/** FacePlane and Connections of the paper, with their VoronoiPlanes. A node's block: plane, side_count, flags; its sides, three
 * or more; zeros up to a multiple of real_bytes; and, where planes are stored, one Voronoi plane for each side, through its
 * edge and pointing out of the face: m_0 = unit(e x n) for which 0, m_1 = unit(n x e) for which 1, offset -m.v0, where e is the
 * connection's edge vector, v0 its corner 0; evaluated in the file's precision on the stored numbers, so that deriving gives
 * the bits that storing does. */
typedef struct fdcg_node_f64 {
  fdcg_plane_f64 plane; /**< of the face */
  uint16_t side_count;  /**< 3 or more */
  uint16_t flags;       /**< FDCG_NODE_INEXACT */
  fdcg_side sides[3];   /**< the first three */
} fdcg_node_f64;
/** fdcg_node_f64 in 32-bit numbers. */
typedef struct fdcg_node_f32 {
  fdcg_plane_f32 plane; /**< of the face */
  uint16_t side_count;  /**< 3 or more */
  uint16_t flags;       /**< FDCG_NODE_INEXACT */
  fdcg_side sides[3];   /**< the first three */
} fdcg_node_f32;

/** Nodes and ConType of the paper; its SharedVertex and second node are in the block of the first: corner 0 is that of
 * sides[side[0]], corner 1 that of the side after it, node 1 lies across (FDCG_NONE on a boundary). node 0's loop runs from
 * corner 0 to corner 1, node 1's the other way. */
typedef struct fdcg_connection {
  uint32_t node;    /**< node 0; node 1 has a higher number */
  uint8_t side[2];  /**< which side of node k this is; side[1] is 0 on a boundary */
  uint8_t type;     /**< fdcg_connection_type */
  uint8_t flatness; /**< fdcg_flatness */
} fdcg_connection;

/** EdgeVector and EndPlanes of the paper: d = corner 1 - corner 0, length = sqrt(d.d), direction = d / length, each operation
 * rounded once in the file's precision (where d.d is below FDCG_TINY_SQUARE, d is scaled first: schemas/fdcg-v1.md). The end
 * planes have the normals -direction at corner 0 and +direction at corner 1, `length` apart. */
typedef struct fdcg_connection_geometry_f64 {
  double direction[3]; /**< unit, from corner 0 to corner 1 */
  double length;       /**< from corner 0 to corner 1 */
} fdcg_connection_geometry_f64;
/** fdcg_connection_geometry_f64 in 32-bit numbers. */
typedef struct fdcg_connection_geometry_f32 {
  float direction[3]; /**< unit, from corner 0 to corner 1 */
  float length;       /**< from corner 0 to corner 1 */
} fdcg_connection_geometry_f32;
#define FDCG_TINY_SQUARE_F64 1e-280 /**< d is multiplied by 2^700 */
#define FDCG_TINY_SQUARE_F32 1e-30  /**< d is multiplied by 2^100 */

/** Vertex and Connections of the paper. The fan holds the corner's connections counter-clockwise seen from outside: the node
 * between entries i and i + 1 is the one whose loop leaves the corner along entry i and comes in along entry i + 1. An ordinary
 * corner's fan is walked: from the side that leaves, to the one before it in its node's loop, to the node across that. */
typedef struct fdcg_corner_f64 {
  double point[3];   /**< where it is */
  uint32_t first;    /**< the node whose side starts the fan; at a busy corner its record in section BUSY_CORNERS */
  int16_t normal[3]; /**< angle-weighted sum of the nodes' normals, scaled to unit length: only the sign of t.normal is used */
  uint8_t side;      /**< which side of that node; 0 at a busy corner */
  uint8_t fan;       /**< entries, at most FDCG_BUSY_FAN, or 0: busy; and FDCG_CORNER_OPEN */
  uint32_t reserved; /**< zero */
} fdcg_corner_f64;
/** fdcg_corner_f64 in 32-bit numbers. */
typedef struct fdcg_corner_f32 {
  float point[3];    /**< where it is */
  uint32_t first;    /**< as in fdcg_corner_f64, here and below */
  int16_t normal[3]; /**< outward, FDCG_NORMAL_SCALE times the unit vector */
  uint8_t side;      /**< which side of node `first` */
  uint8_t fan;       /**< entries, or 0: busy; and FDCG_CORNER_OPEN */
} fdcg_corner_f32;

/** A corner with more than FDCG_BUSY_FAN fan entries. */
typedef struct fdcg_busy_corner {
  uint32_t corner;    /**< its number */
  uint32_t first_fan; /**< its entries in section FANS: end 0 where the connection's corner 0 is this corner */
  uint32_t fan_count; /**< its entries */
  uint32_t first_box; /**< the root of its tree in section FAN_BOXES */
} fdcg_busy_corner;

/** A busy corner's tree: which directions along the surface the corner offers, so that the steepest is found without looking at
 * every edge. An implicit binary tree, root first: level 0 has one box for every FDCG_LEAF_FAN consecutive fan entries.
 * The unit directions of these edges and of the faces to their left all lie in centre + sum of s_k axis[k], |s_k| <= 1. */
typedef struct fdcg_fan_box_f64 {
  double centre[3];  /**< of the box */
  double axis[3][3]; /**< its half axes */
} fdcg_fan_box_f64;
/** fdcg_fan_box_f64 in 32-bit numbers. */
typedef struct fdcg_fan_box_f32 {
  float centre[3];  /**< of the box */
  float axis[3][3]; /**< its half axes */
} fdcg_fan_box_f32;

/** Consecutive nodes that share a busy corner: a sweep asks the corner's tree which of them its way may meet, since their boxes
 * in the hierarchy all hold the corner. */
typedef struct fdcg_fan_run {
  uint32_t first_node; /**< above the run before it */
  uint32_t node_count; /**< at least 1; each of them has the corner */
  uint32_t busy;       /**< the corner's record in section BUSY_CORNERS */
  uint32_t flags;      /**< FDCG_RUN_INEXACT */
} fdcg_fan_run;
/** fdcg_fan_run.flags. Set where a node at the corner, or one across a concave side of such a node, is inexact. */
#define FDCG_RUN_INEXACT 1u

/** The normals of a smooth surface at a node's corners, in the order of its sides. A node of more than three sides is flat: all
 * its codes are FDCG_FLAT_NORMAL. Two nodes that agree along the edge between them are smooth there; else it is a crease. */
typedef struct fdcg_node_normals {
  uint16_t corner[3][2]; /**< octahedral code (schemas/fdcg-v1.md), or FDCG_FLAT_NORMAL twice: the node's own normal */
} fdcg_node_normals;
/** fdcg_node_normals.corner, in both numbers. */
#define FDCG_FLAT_NORMAL 0xffffu

/** Eight boxes of the hierarchy, on a grid of their own: box j reaches from origin + cell * low[.][j] to origin + cell *
 * high[.][j] along each axis, with cell = 2^(exponent - 127), in tree units: the power of two at or below header.extent. Bounds
 * only ever grow outwards. The hierarchy is an implicit tree: level 0 has one record for every eight leaves, a leaf being
 * FDCG_LEAF_NODES consecutive nodes; each level above has one for every eight records below, up to a single root. Stored root
 * first, then level after level down to level 0. Boxes beyond a level's last item have low 255 and high 0. */
typedef struct fdcg_box8 {
  float origin[3];                 /**< of the grid */
  uint8_t exponent[3];             /**< of the cell's size, biased by 127 */
  uint8_t reserved;                /**< zero */
  uint8_t low[3][FDCG_TREE_WAYS];  /**< lower bounds, in cells */
  uint8_t high[3][FDCG_TREE_WAYS]; /**< upper bounds, in cells */
} fdcg_box8;

/** The solid that the mesh encloses, all of one density: of the mesh as it was before faces were merged, its coordinates
 * rounded to the file's precision. Each number is the exact one, rounded once. Doubles in every file. */
typedef struct fdcg_mass_record {
  double volume;            /**< source units cubed, > 0 */
  double centroid[3];       /**< local */
  double inertia[6];        /**< tensor about the centroid at density 1, source units to the fifth: xx, yy, zz, xy, xz, yz;
                               xy is minus the integral of x y */
  double density_kg_per_m3; /**< 0, and so is the next: not known */
  double mass_kg;           /**< density times volume, to rounding: one of them was given */
  double deviation; /**< largest distance of a source corner from the plane of a node that took its face in, or of one left out
                       from the edge that passes it by, source units */
} fdcg_mass_record;

/** A material of the mesh file: UTF-8, zero-terminated and filled up with zeros. Names are compared by all their bytes: of
 * one that is too long the first 54 stand here, '~', and eight hex digits of its checksum. */
typedef struct fdcg_material_record {
  char name[FDCG_MATERIAL_NAME_BYTES]; /**< zero-terminated, zero-filled */
} fdcg_material_record;

#ifdef __cplusplus
}
#define FDCG_STATIC_ASSERT(condition, text) static_assert(condition, text)
#else
#define FDCG_STATIC_ASSERT(condition, text) _Static_assert(condition, text)
#endif

FDCG_STATIC_ASSERT(sizeof(fdcg_header) == 256, "header: 256 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, origin) == 56, "header.origin at 56");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, connection_type_count) == 160, "header.connection_type_count at 160");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, flags) == 196, "header.flags at 196");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, table_checksum) == 240, "header.table_checksum at 240");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, header_checksum) == 248, "header.header_checksum at 248");
FDCG_STATIC_ASSERT(sizeof(fdcg_section) == 40, "section entry: 40 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_plane_f64) == 32 && sizeof(fdcg_plane_f32) == 16, "plane: 32 or 16 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_side) == 12 && sizeof(fdcg_connection) == 8, "side: 12 bytes, connection: 8");
FDCG_STATIC_ASSERT(sizeof(fdcg_node_f64) == 72 && sizeof(fdcg_node_f32) == 56, "node of three sides: 72 or 56 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_node_f64, sides) == 36 && offsetof(fdcg_node_f32, sides) == 20, "node.sides at 36 or 20");
FDCG_STATIC_ASSERT(sizeof(fdcg_connection_geometry_f64) == 32 && sizeof(fdcg_connection_geometry_f32) == 16,
                   "edge: 32 or 16 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_corner_f64) == 40 && sizeof(fdcg_corner_f32) == 24, "corner: 40 or 24 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_corner_f64, first) == 24 && offsetof(fdcg_corner_f64, fan) == 35, "corner_f64");
FDCG_STATIC_ASSERT(offsetof(fdcg_corner_f32, first) == 12 && offsetof(fdcg_corner_f32, fan) == 23, "corner_f32");
FDCG_STATIC_ASSERT(sizeof(fdcg_busy_corner) == 16, "busy corner: 16 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_fan_run) == 16, "fan run: 16 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_node_normals) == 12, "normals of a node: 12 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_box8) == 64, "eight boxes: 64 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_mass_record) == 104, "mass: 104 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_material_record) == 64, "material: 64 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_fan_box_f64) == 96 && sizeof(fdcg_fan_box_f32) == 48, "fan box: 96 or 48 bytes");

#endif /* FDCG_FORMAT_H */
