/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The FDCG file, version 1: the Face Directed Connection Graph of Melder and Harwin (2004, section 4) as flat arrays, ready
 * to be mapped into memory and used where they lie. schemas/fdcg-v1.md tells the same story with a worked dump.
 *
 *   +--------------------+  0
 *   | fdcg_header        |  256 bytes
 *   | fdcg_section[n]    |  40 bytes each, then zeros up to a multiple of 64
 *   +--------------------+
 *   | section 0          |  every section starts at a multiple of 64 and is padded with zeros to one
 *   | ...                |
 *   +--------------------+  file_bytes
 *
 * The paper's nouns: a node is one planar convex face, a connection one edge, a corner one vertex. A side is a node's end of a
 * connection: node n owns the sides first_side .. first_side + side_count - 1 in winding order (counter-clockwise seen from
 * outside).
 *
 * One plane convention: distance(x) = normal.x + offset, positive outside, normal of unit length.
 * Frames: every coordinate in the file is local, in the units of the source file:
 *   object_m = (local + header.origin) * header.metres_per_unit.
 * Little-endian; IEEE 754; compiles as C11 and as C++.
 */
#ifndef FDCG_FORMAT_H
#define FDCG_FORMAT_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

#define FDCG_FORMAT_VERSION 1u
#define FDCG_MAGIC \
  "\x89"           \
  "FDCG\r\n\x1a" /* 8 bytes; a text-mode copy or a 7-bit channel breaks it visibly */
#define FDCG_ALIGNMENT 64u
#define FDCG_NONE 0xFFFFFFFFu        /* "no node here": the far side of an open edge; a dropped source face */
#define FDCG_LEAF_NODES 4u           /* nodes in one leaf of the hierarchy */
#define FDCG_TREE_WAYS 8u            /* boxes in one record of the hierarchy */
#define FDCG_MAX_SIDES 65535u        /* sides of one node */
#define FDCG_LEAF_FAN 8u             /* fan entries in one leaf of a corner's tree */
#define FDCG_BUSY_FAN 32u            /* a corner with more fan entries has a tree */
#define FDCG_LARGEST_EXTENT_F64 1e60 /* of an object; its inverse is the smallest */
#define FDCG_LARGEST_EXTENT_F32 1e9

#ifdef __cplusplus
extern "C" {
#endif

/* What a section holds. A reader skips ids that it does not know; a writer never reuses one. */
enum fdcg_section_id {
  FDCG_SECTION_NODES = 1,       /* fdcg_node_f64 or _f32, node_count of them, in Hilbert order of their centres */
  FDCG_SECTION_SIDES = 2,       /* uint32_t: connection << 1 | which, side_count of them; which 0: the node is node[0] */
  FDCG_SECTION_VORONOI = 3,     /* fdcg_plane_f64 or _f32, one a side. Optional: derived from edge vector and normal */
  FDCG_SECTION_CONNECTIONS = 4, /* fdcg_connection_f64 or _f32, connection_count of them */
  FDCG_SECTION_CORNERS = 5,     /* fdcg_corner_f64 or _f32, corner_count of them */
  FDCG_SECTION_FANS = 6,        /* uint32_t: connection << 1 | end, fan_count of them; end 0: the corner is corner[0] */
  FDCG_SECTION_HIERARCHY = 7,   /* fdcg_box8: the implicit bounding-volume tree. Optional for few nodes: all are looked at */
  FDCG_SECTION_SOURCE_MAP = 8,  /* uint32_t: the node of each source face, or FDCG_NONE. Optional */
  FDCG_SECTION_INFO = 9,        /* UTF-8 JSON: source, options, verdict. Optional */
  FDCG_SECTION_FAN_BOXES = 10   /* fdcg_fan_box_f64 or _f32: the busy corners' trees. Optional where no corner is busy */
};

enum fdcg_connection_type { FDCG_CONVEX = 0, FDCG_CONCAVE = 1, FDCG_COPLANAR = 2, FDCG_BOUNDARY = 3 };

/* Why a connection has its type: the exact sign of the stored points, flat within the input's own rounding, or flat within the
 * angle that the user gave. Only nodes of one region, which share one plane bit for bit, are joined by the latter two. */
enum fdcg_flatness { FDCG_FLAT_EXACT = 0, FDCG_FLAT_QUANTUM = 1, FDCG_FLAT_ANGLE = 2 };

/* fdcg_node.flags. Set when the corners lie off the node's plane by up to header.max_deviation; clear when they are exactly
 * coplanar, and then the first three corners of the loop span the plane. */
#define FDCG_NODE_INEXACT 1u
/* fdcg_corner.flags. Set when a boundary connection ends here; then the fan is open and starts at the boundary connection
 * whose face lies to its left. */
#define FDCG_CORNER_OPEN 1u
/* The other bits of fdcg_corner.flags: 0, or 1 + the index of the root box of the corner's tree in section FAN_BOXES. */
#define FDCG_CORNER_TREE_SHIFT 1u

typedef struct fdcg_header {
  uint8_t magic[8];
  uint32_t format_version;
  uint32_t header_bytes; /* sizeof(fdcg_header) */
  uint64_t file_bytes;
  uint32_t real_bytes; /* 8: records _f64; 4: records _f32 */
  uint32_t section_count;
  uint32_t node_count;
  uint32_t side_count;
  uint32_t connection_count;
  uint32_t corner_count;
  uint32_t fan_count;
  uint32_t largest_fan;              /* connections at the busiest corner */
  double origin[3];                  /* of the local frame, source units */
  double metres_per_unit;            /* > 0 */
  double bounds_min[3];              /* of the corners, local */
  double bounds_max[3];              /* local */
  double extent;                     /* largest |coordinate| of a corner, local: scales every rounding bound */
  double max_deviation;              /* largest distance of a corner from the plane of one of its nodes, source units */
  double quantum;                    /* half the spacing of the input's numbers at the object's extent, source units */
  uint32_t connection_type_count[4]; /* by fdcg_connection_type */
  uint32_t source_vertex_count;
  uint32_t source_face_count;
  uint32_t fan_box_count;   /* in section FAN_BOXES */
  uint8_t reserved[52];     /* zero */
  uint64_t table_checksum;  /* of the section table with its padding */
  uint64_t header_checksum; /* of the bytes before this field */
} fdcg_header;

typedef struct fdcg_section {
  uint32_t id; /* fdcg_section_id; ascending in the table */
  uint32_t record_bytes;
  uint64_t offset;       /* from the start of the file; a multiple of 64 */
  uint64_t record_count; /* offset + record_bytes * record_count, padded to 64, is where the next section starts */
  uint64_t checksum;     /* fdcg_checksum of the section with its padding */
  uint64_t reserved;     /* zero */
} fdcg_section;

typedef struct fdcg_plane_f64 {
  double normal[3], offset;
} fdcg_plane_f64;
typedef struct fdcg_plane_f32 {
  float normal[3], offset;
} fdcg_plane_f32;

/* FacePlane and Connections of the paper. */
typedef struct fdcg_node_f64 {
  fdcg_plane_f64 plane;
  uint32_t first_side;
  uint16_t side_count;
  uint16_t flags;
} fdcg_node_f64;
typedef struct fdcg_node_f32 {
  fdcg_plane_f32 plane;
  uint32_t first_side;
  uint16_t side_count;
  uint16_t flags;
} fdcg_node_f32;

/* SharedVertex, Nodes, EdgeVector, ConType and EndPlane of the paper; its VoronoiPlane[k] is the plane of side
 * nodes[node[k]].first_side + side[k] in section VORONOI: m_0 = unit(e x n_0), m_1 = unit(n_1 x e),
 * offset -m.corner[0], evaluated in the file's precision on the stored numbers, so that deriving gives the bits that storing
 * does. edge = unit(corner[1] - corner[0]). node[0]'s loop runs corner[0] -> corner[1], node[1]'s the other way; node[1] is
 * FDCG_NONE on a boundary. End plane 0 has the normal -edge and passes through corner[0], end plane 1 +edge and corner[1]. */
typedef struct fdcg_connection_f64 {
  double edge[3];
  double end_offset[2];
  uint32_t corner[2];
  uint32_t node[2];
  uint16_t side[2]; /* which side of node[k] this is, counted from its first_side */
  uint8_t type;     /* fdcg_connection_type */
  uint8_t flatness; /* fdcg_flatness */
  uint16_t reserved;
} fdcg_connection_f64;
typedef struct fdcg_connection_f32 {
  float edge[3];
  float end_offset[2];
  uint32_t corner[2];
  uint32_t node[2];
  uint16_t side[2];
  uint8_t type;
  uint8_t flatness;
  uint16_t reserved;
} fdcg_connection_f32;

/* Vertex and Connections of the paper. The fan runs counter-clockwise seen from outside: the node between fan entries i and
 * i + 1 is the one whose loop leaves the corner along entry i and comes in along entry i + 1: node[end] of entry i. */
typedef struct fdcg_corner_f64 {
  double point[3];
  uint32_t first_fan;
  uint32_t fan_count;
  float normal[3]; /* angle-weighted sum of the nodes' normals, scaled to unit length: only the sign of t.normal is used */
  uint32_t flags;  /* FDCG_CORNER_OPEN and the tree */
} fdcg_corner_f64;
typedef struct fdcg_corner_f32 {
  float point[3];
  uint32_t first_fan;
  uint32_t fan_count;
  float normal[3];
  uint32_t flags;
} fdcg_corner_f32;

/* A busy corner's tree: which directions along the surface the corner offers, so that the steepest is found without looking at
 * every edge. An implicit binary tree, root first: level 0 has one box for every FDCG_LEAF_FAN consecutive fan entries.
 * The unit directions of these edges and of the faces to their left all lie in centre + sum of s_k axis[k], |s_k| <= 1. */
typedef struct fdcg_fan_box_f64 {
  double centre[3];
  double axis[3][3];
} fdcg_fan_box_f64;
typedef struct fdcg_fan_box_f32 {
  float centre[3];
  float axis[3][3];
} fdcg_fan_box_f32;

/* Eight boxes of the hierarchy, on a grid of their own: box j reaches from origin + cell * low[.][j] to origin + cell *
 * high[.][j] along each axis, with cell = 2^(exponent - 127), in tree units: the power of two at or below header.extent. Bounds
 * only ever grow outwards. The hierarchy is an implicit tree: level 0 has one record for every eight leaves, a leaf being
 * FDCG_LEAF_NODES consecutive nodes; each level above has one for every eight records below, up to a single root. Stored root
 * first, then level after level down to level 0. Boxes beyond a level's last item have low 255 and high 0. */
typedef struct fdcg_box8 {
  float origin[3];
  uint8_t exponent[3];
  uint8_t reserved; /* zero */
  uint8_t low[3][FDCG_TREE_WAYS];
  uint8_t high[3][FDCG_TREE_WAYS];
} fdcg_box8;

#ifdef __cplusplus
}
#define FDCG_STATIC_ASSERT(condition, text) static_assert(condition, text)
#else
#define FDCG_STATIC_ASSERT(condition, text) _Static_assert(condition, text)
#endif

FDCG_STATIC_ASSERT(sizeof(fdcg_header) == 256, "header: 256 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, origin) == 56, "header.origin at 56");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, connection_type_count) == 160, "header.connection_type_count at 160");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, table_checksum) == 240, "header.table_checksum at 240");
FDCG_STATIC_ASSERT(offsetof(fdcg_header, header_checksum) == 248, "header.header_checksum at 248");
FDCG_STATIC_ASSERT(sizeof(fdcg_section) == 40, "section entry: 40 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_plane_f64) == 32 && sizeof(fdcg_plane_f32) == 16, "plane: 32 or 16 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_node_f64) == 40 && sizeof(fdcg_node_f32) == 24, "node: 40 or 24 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_connection_f64) == 64 && sizeof(fdcg_connection_f32) == 44, "connection: 64 or 44 bytes");
FDCG_STATIC_ASSERT(offsetof(fdcg_connection_f64, corner) == 40 && offsetof(fdcg_connection_f64, type) == 60, "connection_f64");
FDCG_STATIC_ASSERT(offsetof(fdcg_connection_f32, corner) == 20 && offsetof(fdcg_connection_f32, type) == 40, "connection_f32");
FDCG_STATIC_ASSERT(sizeof(fdcg_corner_f64) == 48 && sizeof(fdcg_corner_f32) == 36, "corner: 48 or 36 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_box8) == 64, "eight boxes: 64 bytes");
FDCG_STATIC_ASSERT(sizeof(fdcg_fan_box_f64) == 96 && sizeof(fdcg_fan_box_f32) == 48, "fan box: 96 or 48 bytes");

#endif /* FDCG_FORMAT_H */
