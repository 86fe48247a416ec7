/* SPDX-License-Identifier: Apache-2.0 */
/* Over 400 lines: every field is documented where it is declared. */
/**
 * @file fdcg/fdcg.h
 * fdcg: feel a 3D model through a force-feedback device. The runtime on one screen.
 *
 *     fdcg_graph graph;                              a view, in your memory, of a file in yours or mapped
 *     fdcg_open_file("bunny.fdcg", FDCG_VERIFY_SAFE, &graph, &error);
 *     fdcg_params params = fdcg_make_params();       friction, stiffness, damping
 *     fdcg_contact contact = {0};                    one contact point; zero is its start
 *     each tick:
 *       fdcg_step(&graph, &params, &contact, hip_object_m, &result);   ->  result.force_n
 *     fdcg_close(&graph);
 *
 * Objects that move, and several fingers: scene.h. Bodies: body.h, pile.h. Without a mesh: surface.h. Deformable: deform.h.
 * Nearest points, rays, what a contact is on: query.h.
 *
 * fdcg_step is the friction-cone god-object algorithm of Melder and Harwin (2004) with its gaps closed. The hand's position is
 * the haptic interface point (HIP); the god-object is the point on the surface that a spring binds to it.
 *
 * **Bounds.** The step never allocates, locks, logs, throws, recurses or reads a clock, and every loop in it is bounded.
 *
 * **Frames, units, handedness.** Positions are metres in the object's frame: the mesh file's own coordinates times the unit
 * scale, no axis exchanged. Forces are newtons on the hand, in the same frame; times are seconds. Frames are right-handed:
 * faces are wound counter-clockwise seen from outside, normals point outward. "Local" is the frame of a file's records
 * (format.h).
 *
 * **Ownership.** All memory is the caller's. A graph is a view: the bytes that it points to must outlive it. Params, contacts
 * and results are plain structs, copied freely; fdcg_params.materials must outlive the params (a
 * scene copies it).
 *
 * **Threads.** A graph is only read, so any number of threads may step contacts on it at once. One contact is stepped by one
 * thread at a time. Functions without a note are safe to call from several threads on different structs.
 *
 * **Null pointers**, in all of these headers. A function that returns an fdcg_status refuses them (FDCG_E_ARGUMENT), except for
 * `error` and where it says otherwise. Of the others, those that make up a tick in contact (fdcg_step, fdcg_surface_step,
 * fdcg_surface_get_normal, fdcg_deform_step, fdcg_combine_materials) and those that read a graph's records and materials check
 * nothing; all the rest do nothing, or return zeros.
 */
#ifndef FDCG_FDCG_H
#define FDCG_FDCG_H

#include "fdcg/api.h"
#include "fdcg/format.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_VERSION_MAJOR 0        /**< of this header */
#define FDCG_VERSION_MINOR 1        /**< of this header */
#define FDCG_VERSION_PATCH 0        /**< of this header */
#define FDCG_VERSION_STRING "0.1.0" /**< of this header, as text */
/** Version of this header as one number: 10000 major + 100 minor + patch. */
#define FDCG_VERSION (FDCG_VERSION_MAJOR * 10000 + FDCG_VERSION_MINOR * 100 + FDCG_VERSION_PATCH)

/** FDCG_VERSION of the library that is linked. Structs that begin with struct_bytes may grow at their end in any version, and a
 * program built against a smaller one goes on working: what it does not know takes its default. The other structs keep their
 * layout while FDCG_VERSION_MAJOR (before 1.0: also FDCG_VERSION_MINOR) stays. */
FDCG_API uint32_t fdcg_version(void);

/* ---- errors ------------------------------------------------------------------------------------------------------------ */

/** What went wrong. */
typedef enum fdcg_status {
  FDCG_OK = 0,       /**< nothing */
  FDCG_E_ARGUMENT,   /**< a null pointer, a number outside its range */
  FDCG_E_IO,         /**< the file cannot be opened, read or mapped */
  FDCG_E_ALIGNMENT,  /**< the memory does not start at a multiple of 8 */
  FDCG_E_TRUNCATED,  /**< fewer bytes than the header promises, or more */
  FDCG_E_MAGIC,      /**< not an FDCG file */
  FDCG_E_VERSION,    /**< a format version or precision that this library was not built for */
  FDCG_E_LAYOUT,     /**< header or section table contradict themselves */
  FDCG_E_CHECKSUM,   /**< bytes have changed since the file was written */
  FDCG_E_GRAPH,      /**< an index or a number inside a section is out of range */
  FDCG_E_ABSENT,     /**< the file does not hold what is asked for */
  FDCG_E_ARITHMETIC, /**< the processor or the compiler rounds otherwise than the step's promises need */
  FDCG_E_MESH,       /**< the mesh has errors, which the findings name (bake.h) */
  FDCG_E_MEMORY      /**< the allocator, or the system, has no memory left */
} fdcg_status;

/** Filled in by every function that returns an fdcg_status other than FDCG_OK. */
typedef struct fdcg_error {
  fdcg_status status; /**< as returned */
  uint64_t offset;    /**< byte in the file that the message speaks of; 0 where there is none */
  char message[240];  /**< one line, zero-terminated */
} fdcg_error;

/** What a status means, without the case at hand: static text, one line, never NULL. */
FDCG_API const char* fdcg_status_text(fdcg_status status);

/* ---- set-up ------------------------------------------------------------------------------------------------------------ */

/** How important a log line is. */
typedef enum fdcg_log_level {
  FDCG_LOG_INFO = 0, /**< a graph was opened */
  FDCG_LOG_ERROR = 1 /**< a graph was refused */
} fdcg_log_level;

/** Gets one line of text, valid during the call, for each graph that is opened or refused. Never called in the step. */
typedef void (*fdcg_log_handler)(void* context, fdcg_log_level level, const char* text);
/** Sets the log handler, which gets `context` back; NULL takes it away. Global: set it before the first graph is opened, and
 * not while other threads use the library. */
FDCG_API void fdcg_set_log_handler(fdcg_log_handler handler, void* context);

/** Called when the library finds a fault of its own. Debug builds (FDCG_WITH_ASSERTS) look for them; in others it is never
 * called. May be called in the step. If it returns, the library goes on as best it can; without a handler it traps. */
typedef void (*fdcg_assert_handler)(void* context, const char* condition, const char* file, uint32_t line);
/** Sets the assert handler, which gets `context` back; NULL takes it away. Global, as fdcg_set_log_handler. */
FDCG_API void fdcg_set_assert_handler(fdcg_assert_handler handler, void* context);

/* ---- graph ------------------------------------------------------------------------------------------------------------- */

/** How thoroughly a file is checked when it is opened.
 *
 * A host that loads files that it has not written wants SAFE: a damaged or forged file can then feel wrong, but neither crash
 * the program nor hold a tick up. FULL asks besides whether the graph is one surface, as fdcg compile writes it: for tools, and
 * where a wrong file is dearer than the time. TRUSTED is for files that are part of the program. */
typedef enum fdcg_verify {
  FDCG_VERIFY_FULL = 0,    /**< SAFE; and loops, twins, fans and boxes agree: the graph is one surface. Reads the file twice */
  FDCG_VERIFY_TRUSTED = 1, /**< header and section bounds only */
  FDCG_VERIFY_SAFE = 2     /**< checksums, and every index, count and number: after it no file whatever leads to undefined
                              behaviour or an unbounded step. Reads the file once */
} fdcg_verify;

/** A read-only view; the bytes that it points into must outlive it. Read its fields, do not write them. A copy is a view as
 * good as the first, while that is open. Opening asks first whether the processor rounds as the step's promises need: to
 * nearest, with subnormal numbers, product and sum apart (FDCG_E_ARITHMETIC, with what is otherwise in the message). */
typedef struct fdcg_graph {
  const fdcg_header* header;             /**< the file's; NULL: nothing is open */
  const void* nodes;                     /**< blocks of fdcg_node_f64 or _f32, by header->real_bytes */
  const uint32_t* node_offsets;          /**< NULL: every block has header->node_bytes */
  const fdcg_connection* connections;    /**< header->connection_count entries */
  const void* edges;                     /**< fdcg_connection_geometry_f64 or _f32. NULL: derived in the step */
  const void* corners;                   /**< fdcg_corner_f64 or _f32, header->corner_count entries */
  const fdcg_busy_corner* busy_corners;  /**< NULL, and so are the next two: no corner is busy */
  const uint32_t* fans;                  /**< the busy corners' fans, header->fan_count entries */
  const void* fan_boxes;                 /**< fdcg_fan_box_f64 or _f32, header->fan_box_count entries */
  const fdcg_box8* hierarchy;            /**< NULL: the free-space sweep looks at every node */
  const uint32_t* source_map;            /**< NULL: not in the file; else header->source_face_count entries */
  const char* info;                      /**< JSON, not zero-terminated; NULL: not in the file */
  uint64_t info_bytes;                   /**< length of `info` */
  void* mapping;                         /**< what fdcg_close unmaps; NULL for fdcg_open_memory */
  uint64_t mapping_bytes;                /**< length of the mapping */
  const uint16_t* node_materials;        /**< NULL: not in the file; else header->node_count entries */
  const fdcg_material_record* materials; /**< NULL: none; else material_count entries */
  uint32_t material_count;               /**< entries of `materials` */
  uint32_t fan_run_count;                /**< entries of `fan_runs` */
  const fdcg_fan_run* fan_runs;          /**< NULL: not in the file */
  const fdcg_node_normals* normals;      /**< NULL: not in the file; else header->node_count entries */
  const struct fdcg_graph* owner;        /**< of a mapping: the struct that was opened, and alone unmaps it */
} fdcg_graph;

/** Views `bytes` bytes at `data` (a multiple of 8) as a graph. Nothing is copied. On failure *graph is zeroed.
 * Cost: SAFE reads every byte once, FULL twice; TRUSTED touches the header and the section table only. `error` may be NULL. */
FDCG_API fdcg_status fdcg_open_memory(const void* data, uint64_t bytes, fdcg_verify verify, fdcg_graph* graph,
                                      fdcg_error* error);

/** fdcg_open_memory with FDCG_VERIFY_TRUSTED, for small programs: one that opens graphs by this function alone links nothing
 * of verification. */
FDCG_API fdcg_status fdcg_open_trusted(const void* data, uint64_t bytes, fdcg_graph* graph, fdcg_error* error);

/** The same for a file, mapped read-only. Undo with fdcg_close. FDCG_E_IO in a library built without files (FDCG_WITH_FILES).
 */
FDCG_API fdcg_status fdcg_open_file(const char* path, fdcg_verify verify, fdcg_graph* graph, fdcg_error* error);

/** How fdcg_open_file_with opens a file. Make it by fdcg_make_open_options, then change fields.
 *
 * A page of a file that is only mapped is brought in where a tick first touches it, which takes microseconds, and from a disk
 * milliseconds. Verification touches all pages; a trusted opening does not. */
typedef struct fdcg_open_options {
  uint32_t struct_bytes; /**< the caller's sizeof(fdcg_open_options); fdcg_make_open_options sets it */
  uint32_t verify;       /**< fdcg_verify; FDCG_VERIFY_SAFE */
  uint32_t populate;     /**< 1: every page is mapped before the call returns (Linux: MAP_POPULATE). 0 */
  uint32_t huge_pages; /**< 1: not mapped but read into memory of the program's own, in huge pages (Linux: MADV_HUGEPAGE) where
                          the system has them; fewer misses of the processor's page table, for large graphs. Takes the file's
                          size in memory for each program that opens it, and populates. 0 */
} fdcg_open_options;

/** Sets the first `struct_bytes` bytes of *options: FDCG_VERIFY_SAFE, not populated, no huge pages. */
FDCG_API void fdcg_open_options_init(fdcg_open_options* options, uint32_t struct_bytes);
/** The default options of fdcg_open_options_init. */
FDCG_INLINE fdcg_open_options fdcg_make_open_options(void) {
  fdcg_open_options options;
  fdcg_open_options_init(&options, (uint32_t)sizeof options);
  return options;
}

/** fdcg_open_file with options. */
FDCG_API fdcg_status fdcg_open_file_with(const char* path, const fdcg_open_options* options, fdcg_graph* graph,
                                         fdcg_error* error);

/** Unmaps what fdcg_open_file mapped and zeroes the view. Harmless on a zeroed or memory graph, and on NULL. A copy of a view
 * that owns a mapping is zeroed and refused (FDCG_E_ARGUMENT): the graph stays open in the struct that it was opened in, or
 * moved to. */
FDCG_API fdcg_status fdcg_close(fdcg_graph* graph);

/** Moves a graph into another struct, which must have none open and closes it from then on; *from is zeroed. FDCG_E_ARGUMENT
 * for a copy. Contacts, scenes and views go on as they were. */
FDCG_API fdcg_status fdcg_move_graph(fdcg_graph* from, fdcg_graph* to, fdcg_error* error);

/** Touches every page of an open graph, so that no tick waits for one that is not mapped yet: for graphs in the caller's memory
 * (a mapping of its own, or memory just filled by another process), and for files that were opened without `populate`. Cost:
 * linear in the file; not for the servo thread. */
FDCG_API void fdcg_warm(const fdcg_graph* graph);

/* ---- verification in chunks -------------------------------------------------------------------------------------------- */

/** What some chunks of one level have come to, in the caller's memory: zero to begin with, one for each thread. Not for the
 * caller to read. */
typedef struct fdcg_verification {
  uint64_t chunks;                   /**< how many */
  uint64_t sides;                    /**< of their nodes */
  uint64_t first_sides;              /**< along which a connection runs */
  uint64_t faces;                    /**< around their corners */
  uint64_t busy_corners;             /**< of their corners */
  uint64_t types[4];                 /**< of their connections, by fdcg_connection_type */
  uint64_t sums[FDCG_MOST_SECTIONS]; /**< checksums of their blocks, by the section's place in the table */
} fdcg_verification;

/** How many chunks an open graph is verified in: at least 1, some 256 kB of the file each. */
FDCG_API uint32_t fdcg_verify_chunk_count(const fdcg_graph* graph);

/** Verifies one chunk of a graph that was opened as trusted, and adds what it comes to to *part. Chunks of one level may be
 * done in any order, by several threads, each with a part of its own. SAFE is all chunks at FDCG_VERIFY_SAFE and then
 * fdcg_verify_sum of the parts; FULL is, once that has passed, the same again at FDCG_VERIFY_FULL. The graph must not be used
 * before. */
FDCG_API fdcg_status fdcg_verify_chunk(const fdcg_graph* graph, fdcg_verify level, uint32_t chunk, fdcg_verification* part,
                                       fdcg_error* error);

/** Whether the parts of all chunks, `count` of them, together are a graph's: checksums, sums of counts. FDCG_E_ARGUMENT where
 * they are not of as many chunks as the graph has. */
FDCG_API fdcg_status fdcg_verify_sum(const fdcg_graph* graph, fdcg_verify level, const fdcg_verification* parts, uint32_t count,
                                     fdcg_error* error);

/* ---- records of a graph ------------------------------------------------------------------------------------------------ */

/** A face of the graph, in double precision whatever the file's. The four structs like it are for looking at a graph; the step
 * does not use them. What the file leaves out is derived. */
typedef struct fdcg_node_info {
  double normal[3];    /**< unit, outward, local frame (format.h) */
  double offset;       /**< distance(x) = normal.x + offset, positive outside */
  uint32_t side_count; /**< at least 3 */
  uint32_t flags;      /**< FDCG_NODE_INEXACT */
} fdcg_node_info;
/** Reads a node. `node` must be below header->node_count; nothing is checked, here and in the next four. */
FDCG_API fdcg_node_info fdcg_get_node(const fdcg_graph* graph, uint32_t node);

/** A side of a node: its end of a connection. */
typedef struct fdcg_side_info {
  double voronoi_normal[3]; /**< of the plane through the side's edge, pointing out of the face */
  double voronoi_offset;    /**< of that plane */
  uint32_t connection;      /**< along the side */
  uint32_t which;           /**< 0: the connection runs along the side, 1: against it */
  uint32_t corner;          /**< at which the side starts */
  uint32_t across;          /**< node, or FDCG_NONE */
} fdcg_side_info;
/** Reads a side of a node; `side` below the node's side_count. */
FDCG_API fdcg_side_info fdcg_get_side(const fdcg_graph* graph, uint32_t node, uint32_t side);

/** An edge of the graph. */
typedef struct fdcg_connection_info {
  double direction[3]; /**< unit, from corner[0] to corner[1] */
  double length;       /**< from corner[0] to corner[1] */
  uint32_t corner[2];  /**< its ends */
  uint32_t node[2];    /**< node[1] is FDCG_NONE on a boundary */
  uint32_t side[2];    /**< of each node */
  uint32_t type;       /**< fdcg_connection_type */
  uint32_t flatness;   /**< fdcg_flatness */
} fdcg_connection_info;
/** Reads a connection; its number below header->connection_count. */
FDCG_API fdcg_connection_info fdcg_get_connection(const fdcg_graph* graph, uint32_t connection);

/** A vertex of the graph. */
typedef struct fdcg_corner_info {
  double point[3];    /**< local frame */
  double normal[3];   /**< outward, unit length to about 1e-4 */
  uint32_t fan_count; /**< connections that end here */
  uint32_t is_open;   /**< a boundary connection ends here */
} fdcg_corner_info;
/** Reads a corner; its number below header->corner_count. */
FDCG_API fdcg_corner_info fdcg_get_corner(const fdcg_graph* graph, uint32_t corner);

/** The normals that shading interpolates over a node (fdcg_friction_flag): three vectors of unit length, outward, at the
 * corners where its sides 0, 1 and 2 start. Returns 0, and the node's own normal three times, where the node is flat or the
 * file has no such section. */
FDCG_API uint32_t fdcg_get_node_normals(const fdcg_graph* graph, uint32_t node, double normals[9]);

/** Lists the corner's connections, counter-clockwise seen from outside, each as connection << 1 | end (end 0: its corner[0] is
 * this corner). Writes at most `capacity` of them and returns their number. Cost: linear in that. */
FDCG_API uint32_t fdcg_get_fan(const fdcg_graph* graph, uint32_t corner, uint32_t* entries, uint32_t capacity);

/** Mass properties of the solid that the mesh encloses, all of one density (fdcg compile --density or --mass; a caller may set
 * its own). */
typedef struct fdcg_mass {
  double volume_m3;                 /**< > 0 */
  double centroid_m[3];             /**< object's frame */
  double inertia_per_density_m5[6]; /**< tensor about the centroid, axes of the object's frame: xx, yy, zz, xy, xz, yz, where xy
                                       is minus the integral of x y; times a density: kg m^2 */
  double density_kg_per_m3;         /**< 0: the file does not say, nor does it say the mass */
  double mass_kg;                   /**< 0: likewise */
} fdcg_mass;

/** Reads the mass properties. FDCG_E_ABSENT where the file holds none: an open mesh, one that is inside out, or --without mass.
 * FDCG_E_GRAPH where its numbers cannot be: a damaged file that was opened as trusted. On failure *mass is zeroed. Cost: a look
 * at the section table. */
FDCG_API fdcg_status fdcg_get_mass(const fdcg_graph* graph, fdcg_mass* mass, fdcg_error* error);

/** The material of a node (below header->node_count), by number. Materials are those of the mesh file (OBJ usemtl, glTF
 * material). FDCG_NONE: its faces have none, or the file has no materials. */
FDCG_API uint32_t fdcg_get_node_material(const fdcg_graph* graph, uint32_t node);
/** The name that the mesh file gives a material; lives as long as the graph. NULL: there is no such material. */
FDCG_API const char* fdcg_get_material_name(const fdcg_graph* graph, uint32_t material);
/** The number of a material, by name. FDCG_NONE: there is none. Cost: linear in the materials. */
FDCG_API uint32_t fdcg_find_material(const fdcg_graph* graph, const char* name);

/** The checksum of the format: `bytes` bytes at `data`. Any change of one byte changes it (schemas/fdcg-v1.md). */
FDCG_API uint64_t fdcg_checksum(const void* data, uint64_t bytes);

/* ---- step -------------------------------------------------------------------------------------------------------------- */

/** What a contact is on. `feature` beside it is the number of the face (node), edge (connection) or vertex (corner). */
typedef enum fdcg_state {
  FDCG_FREE = 0,  /**< in free space: no force */
  FDCG_FACE = 1,  /**< on a face: a node of the graph */
  FDCG_EDGE = 2,  /**< on an edge: a connection */
  FDCG_VERTEX = 3 /**< at a vertex: a corner */
} fdcg_state;

/** How friction in a groove (on a concave edge) is computed (contact-model EDGE-4). */
typedef enum fdcg_edge_friction {
  FDCG_EDGE_WEDGE = 0, /**< by the sum of both faces' normal loads, at most 1,024 times the paper's */
  FDCG_EDGE_PAPER = 1  /**< by the distance from the edge, as in the 2004 paper */
} fdcg_edge_friction;

/** What the step does not do where it cannot matter. Forces and god-objects are the same bit for bit with all of it, but where
 * a tick without the clear ball runs out of work for its sweep (FDCG_RESULT_SWEEP_BOUND) and carries it over. */
typedef enum fdcg_step_optimization {
  FDCG_STEP_OPT_CLEAR_BALL = 1, /**< in free space: no sweep inside a ball that no face touches */
  FDCG_STEP_OPT_HOP = 2,        /**< in contact: slides over plain edges, and along them, without the rules' loop */
  FDCG_STEP_OPT_ALL = 3         /**< every one */
} fdcg_step_optimization;

/** Friction beyond two coefficients and one stiffness: which of the fields of fdcg_params below count. 0: none, at no cost.
 *
 * All of it is for graphs. A surface (surface.h) has the two coefficients and the stiffness alone, combined with a finger's in
 * a scene.
 *
 * **The curve** (Melder 2004, figure 1). While the god-object slips, its friction cone has the coefficient
 *
 *     mu(v) = mu_dynamic + (mu_static - mu_dynamic) / (1 + (v / stribeck_m_per_s)^2) + viscous_s_per_m v
 *
 * where v is its displacement in the tick over tick_s, in metres of the object a second (in a scene: of the world). The step
 * solves for mu and v together.
 *
 * - *Stribeck*: mu(0) is mu_static, so that mu has no jump. Without it mu falls from mu_static to mu_dynamic where slip begins.
 * - *Lag*: mu follows a speed that comes after v by friction_lag_s (first order), so that static friction comes back only some
 *   time after a slide.
 * - *Presliding*: a contact that sticks yields along the surface like a spring of presliding_n_per_m in series with the
 *   stiffness, and comes back. The god-object that is reported moves, by at most mu_static load / presliding_n_per_m, about the
 *   remembered place, which at rest does not move. It may then stand beyond the rim of its face by as much, but not behind a
 *   concave edge.
 *
 * All this holds on faces and, by the load that edge_friction says, on edges. At a vertex the god-object rests only where the
 * surface alone holds it, and otherwise slides on along a face or an edge.
 *
 * A curve that falls steeply has several solutions: sticking and slipping at once. It has one, continuous in all inputs, and a
 * slide at steady speed settles on it, while
 *
 *     (0.65 (mu_static - mu_dynamic) / stribeck_m_per_s - viscous_s_per_m) depth_m <= friction_lag_s + tick_s / 4
 *
 * (0.65 is 3 sqrt(3) / 8; with presliding the depth counts 1 + stiffness / presliding_n_per_m times). fdcg_check_params
 * requires this at unique_solution_depth_m. Deeper, stribeck_m_per_s grows with the depth, so that it holds at any depth;
 * likewise where a finger's material makes the curve steeper. The default numbers satisfy it with FDCG_FRICTION_LAG; without
 * that flag raise stribeck_m_per_s. Friction is passive whatever the numbers: a slip only ever takes the god-object nearer to
 * the HIP.
 *
 * **Materials**: `materials` says what a face's material (fdcg_get_node_material) is like, in place of mu_static, mu_dynamic
 * and stiffness_n_per_m, which hold for faces without one and for materials beyond the table. On a concave edge each face's
 * coefficient counts by the load that it bears, and the softer face's stiffness holds; at a vertex those of the feature before.
 * A stiffness that rose under a pressed contact would push the hand. So it falls at once, and rises only by as much as sliding
 * dissipates meanwhile, the sampling's term k |dx|^2 / 2 included. A new contact starts with its own.
 *
 * **Finger**: what touches, combined with what is touched (fdcg_combine_materials).
 *
 * **Shading** (Melder and Harwin 2005): on a node with normals at its corners (fdcg compile --normals) the friction cone stands
 * along the normal that is interpolated at the god-object, so that facets are not felt. Without such normals, and on surfaces
 * and deformable meshes, the flag does nothing. No more energy is given back than was put in: docs/shading.md. */
typedef enum fdcg_friction_flag {
  FDCG_FRICTION_STRIBECK = 1,   /**< stribeck_m_per_s */
  FDCG_FRICTION_VISCOUS = 2,    /**< viscous_s_per_m */
  FDCG_FRICTION_PRESLIDING = 4, /**< presliding_n_per_m */
  FDCG_FRICTION_LAG = 8,        /**< friction_lag_s */
  FDCG_FRICTION_MATERIALS = 16, /**< materials, material_count */
  FDCG_FRICTION_FINGER = 32,    /**< finger */
  FDCG_FRICTION_SHADING = 64,   /**< the graph's node normals: force shading */
  FDCG_FRICTION_ALL = 127       /**< every one */
} fdcg_friction_flag;

/** What a material feels like. */
typedef struct fdcg_material {
  double mu_static;         /**< >= mu_dynamic */
  double mu_dynamic;        /**< >= 0 */
  double stiffness_n_per_m; /**< >= 0 */
} fdcg_material;

/** Combines two materials in contact: coefficients by their geometric mean (so that a frictionless one stays so, equal ones
 * stay as they are, and mu_static >= mu_dynamic), stiffness as of two springs in series. */
FDCG_API fdcg_material fdcg_combine_materials(const fdcg_material* surface, const fdcg_material* finger);

/** What a contact feels like. Make it by fdcg_make_params, then change fields, then fdcg_check_params. */
typedef struct fdcg_params {
  uint32_t struct_bytes;           /**< the caller's sizeof(fdcg_params); fdcg_make_params sets it */
  uint32_t edge_friction;          /**< fdcg_edge_friction */
  double mu_static;                /**< >= mu_dynamic */
  double mu_dynamic;               /**< >= 0 */
  double stiffness_n_per_m;        /**< >= 0 */
  double damping_n_s_per_m;        /**< >= 0; acts along the spring's direction and never pulls. 0: off */
  double tick_s;                   /**< time between ticks; read only where damping or a flag of the curve is on */
  uint32_t disabled_optimizations; /**< fdcg_step_optimization bits that are off. 0: all are on */
  uint32_t friction_flags;         /**< fdcg_friction_flag: which of the following count. 0: none */
  double stribeck_m_per_s;         /**< > 0: the speed at which half of the fall from mu_static to mu_dynamic is done */
  double viscous_s_per_m;          /**< >= 0 */
  double presliding_n_per_m;       /**< > 0 */
  double friction_lag_s;           /**< >= 0 */
  double unique_solution_depth_m;  /**< > 0: to this depth the curve is as written (fdcg_friction_flag) */
  fdcg_material finger;            /**< its stiffness > 0 */
  const fdcg_material* materials;  /**< by number; must outlive the params. NULL where there are none */
  uint32_t material_count;         /**< entries of `materials` */
  uint32_t reserved[sizeof(void*) == 8 ? 1 : 2]; /**< 0 */
} fdcg_params;

/** Sets the first `struct_bytes` bytes of *params: mu 0.6 static, 0.4 dynamic, 1,000 N/m, no damping, 1 kHz, wedge, no friction
 * flags; for those: Stribeck 0.05 m/s, viscous 0.1 s/m, presliding 100,000 N/m, lag 0.03 s, depth 0.01 m, a finger of mu 1 and
 * 10,000 N/m, no materials. */
FDCG_API void fdcg_params_init(fdcg_params* params, uint32_t struct_bytes);
/** The default parameters of fdcg_params_init. */
FDCG_INLINE fdcg_params fdcg_make_params(void) {
  fdcg_params params;
  fdcg_params_init(&params, (uint32_t)sizeof params);
  return params;
}

/** Checks every field. FDCG_E_ARGUMENT, with the field, its value and its limit in the message, unless all are in range. Call
 * this whenever the parameters change. The step itself looks at struct_bytes, and where a contact begins at the coefficients,
 * stiffness and damping (FDCG_RESULT_BAD_PARAMS); the rest it does not check. */
FDCG_API fdcg_status fdcg_check_params(const fdcg_params* params, fdcg_error* error);

/** Bytes of a contact that are the step's own. */
#define FDCG_CONTACT_INTERNAL_BYTES 216

/** One contact point on one graph. All zero: not yet started. Keep it from tick to tick; copy it freely. Read its fields, do
 * not write them. Positions are local to the graph (format.h), so that no digits are lost far from the world's origin. */
typedef struct fdcg_contact {
  double god_object[3]; /**< without presliding's displacement. In free space: the HIP, or while a sweep is carried over the
                           point where it started */
  double hip[3];        /**< of the last tick with a finite HIP */
  uint32_t started;     /**< 0 before the first tick */
  uint32_t state;       /**< fdcg_state */
  uint32_t feature;     /**< node, connection or corner, by state; FDCG_NONE in free space */
  uint32_t slipping;    /**< 1: dynamic friction holds */
  uint64_t non_finite_ticks;                      /**< ticks whose HIP was no usable number */
  uint64_t transition_bound_ticks;                /**< ticks that carried work over because of FDCG_RULE_WORK */
  uint64_t sweep_bound_ticks;                     /**< ... because of FDCG_SWEEP_WORK */
  uint8_t internals[FDCG_CONTACT_INTERNAL_BYTES]; /**< what else the step keeps from tick to tick; its layout may change */
} fdcg_contact;

/** What was special about a tick. */
typedef enum fdcg_result_flag {
  FDCG_RESULT_NON_FINITE = 1,       /**< HIP was NaN, infinite or absurdly far away: nothing moved, no force */
  FDCG_RESULT_TRANSITION_BOUND = 2, /**< work is carried over; the god-object is valid and goes on next tick */
  FDCG_RESULT_SWEEP_BOUND = 4,      /**< a sweep is carried over: free, no force; it goes on next tick */
  FDCG_RESULT_OTHER_CONTACT = 8,    /**< refused: the contact is on another graph or kind of surface; start from one of zeros */
  FDCG_RESULT_BAD_PARAMS = 16,      /**< refused: params of zeros, of another size, or out of range where the contact began */
  FDCG_RESULT_NOT_OPEN = 32,        /**< refused: nothing is open in the graph */
  FDCG_RESULT_REFUSED = 56          /**< any of these three: nothing moved, no force */
} fdcg_result_flag;

/** What the hand should feel, and where the god-object is. */
typedef struct fdcg_result {
  double force_n[3];      /**< on the user's hand */
  double god_object_m[3]; /**< object's frame */
  uint32_t state;         /**< fdcg_state */
  uint32_t feature;       /**< FDCG_NONE in free space */
  uint32_t slipping;      /**< 1: dynamic friction holds */
  uint32_t transitions;   /**< changes of state in this tick, free included */
  uint32_t flags;         /**< fdcg_result_flag */
  uint32_t reserved;      /**< 0 */
} fdcg_result;

/** Moves the contact to the HIP of this tick, in metres in the object's frame, and computes what the hand should feel. Reads
 * the graph and the params, writes the contact and the result; no pointer may be NULL. An unusable HIP gives no force and
 * FDCG_RESULT_NON_FINITE.
 *
 * Work: a god-object that stays on its face takes some 400 instructions, a face crossed some 780, whatever the mesh; with the
 * friction curve some 1,500, presliding 1,900; shading some 1,100, with friction 1,500. Two budgets (src/base/work.hpp:
 * FDCG_RULE_WORK for the surface, FDCG_SWEEP_WORK for free space; set when the library is compiled) together let a tick run to
 * some 75,000 instructions, 5 us at 3 GHz; what is left is carried to the next tick, with a valid god-object. A budget is
 * compared between pieces of work, of which the largest is a face that the path meets within rounding: an exact sign for each
 * of its sides, of which fdcg compile gives a face at most 16. The dearest tick that a search over 23 awkward bodies has found
 * takes 11 us (tests/bench/worst_case.cpp), all but a few under 5. */
FDCG_API void fdcg_step(const fdcg_graph* graph, const fdcg_params* params, fdcg_contact* contact, const double hip_object_m[3],
                        fdcg_result* result);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_FDCG_H */
