/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime for JavaScript: one graph, one contact on it, and looks at the graph's records. JavaScript reads and writes the
 * module's memory at the addresses that these functions return. Every struct is the C API's own (fdcg.h); layouts that
 * JavaScript relies on are asserted below. A page that needs several graphs makes several instances of the module. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "fdcg/fdcg.h"
#include "fdcg/visual.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

_Static_assert(offsetof(fdcg_result, god_object_m) == 24 && offsetof(fdcg_result, state) == 48 && sizeof(fdcg_result) == 72,
               "result: 6 doubles, then state, feature, slipping, transitions, flags");
_Static_assert(offsetof(fdcg_node_info, side_count) == 32 && sizeof(fdcg_node_info) == 40, "node: 4 doubles, 2 words");
_Static_assert(offsetof(fdcg_side_info, connection) == 32 && sizeof(fdcg_side_info) == 48, "side: 4 doubles, 4 words");
_Static_assert(offsetof(fdcg_connection_info, corner) == 32 && sizeof(fdcg_connection_info) == 64, "edge: 4 doubles, 8 words");
_Static_assert(offsetof(fdcg_corner_info, fan_count) == 48 && sizeof(fdcg_corner_info) == 56, "corner: 6 doubles, 2 words");

_Static_assert(offsetof(fdcg_visual, vertex_count) == 16 && sizeof(fdcg_visual) == 64, "visual: 4 addresses, 4 words, 4 doubles");

enum { kMostFan = 4096, kMostSweeps = 100000, kMostMaterials = 64 };

static fdcg_graph graph;
static fdcg_contact contact;
static fdcg_params params;
static fdcg_material materials[kMostMaterials], wanted_materials[kMostMaterials];
static fdcg_result result;
static fdcg_error error;
static fdcg_visual visual;
static double hip[3];
static union {
  fdcg_node_info node;
  fdcg_side_info side;
  fdcg_connection_info connection;
  fdcg_corner_info corner;
  uint32_t fan[kMostFan];
} record;

/* ---- memory ------------------------------------------------------------------------------------------------------------- */

/* Room for a file, at a multiple of 64; 0: there is none. */
void* EXPORT(fdcg_web_allocate)(uint32_t bytes) {
  return aligned_alloc(64, ((size_t)bytes + 63) & ~(size_t)63);
}

/* Gives it back. */
void EXPORT(fdcg_web_release)(void* room) {
  free(room);
}

/* ---- graph -------------------------------------------------------------------------------------------------------------- */

static uint32_t material_count(void) {
  return graph.material_count < kMostMaterials ? graph.material_count : kMostMaterials;
}

/* Verifies the file in full and makes it the graph; the contact starts anew. An fdcg_status. */
uint32_t EXPORT(fdcg_web_open)(const void* data, uint32_t bytes) {
  const fdcg_status status = fdcg_open_memory(data, bytes, FDCG_VERIFY_FULL, &graph, &error);
  params = fdcg_make_params();
  params.materials = materials;
  params.material_count = material_count();
  for (int i = 0; i < kMostMaterials; ++i)
    materials[i] = (fdcg_material){params.mu_static, params.mu_dynamic, params.stiffness_n_per_m};
  memcpy(wanted_materials, materials, sizeof materials);
  memset(&contact, 0, sizeof contact);
  memset(&result, 0, sizeof result);
  return (uint32_t)status;
}

/* Of the last function that failed: zero-terminated. */
const char* EXPORT(fdcg_web_message)(void) {
  return error.message;
}

/* NULL: nothing is open. */
const fdcg_header* EXPORT(fdcg_web_header)(void) {
  return graph.header;
}

const uint32_t* EXPORT(fdcg_web_source_map)(void) {
  return graph.source_map;
}

/* The mesh for the eye; NULL: the file has none, or it is damaged. */
const fdcg_visual* EXPORT(fdcg_web_visual)(void) {
  return fdcg_get_visual(&graph, &visual, &error) == FDCG_OK ? &visual : NULL;
}

/* ---- contact ------------------------------------------------------------------------------------------------------------ */

/* Written before a step: metres, object's frame. */
double* EXPORT(fdcg_web_hip)(void) {
  return hip;
}

const fdcg_result* EXPORT(fdcg_web_result)(void) {
  return &result;
}

/* What a material feels like, from the next fdcg_web_set_params on; numbers beyond the first kMostMaterials are passed by. */
void EXPORT(fdcg_web_set_material)(uint32_t material, double mu_static, double mu_dynamic, double stiffness_n_per_m) {
  if (material < kMostMaterials) wanted_materials[material] = (fdcg_material){mu_static, mu_dynamic, stiffness_n_per_m};
}

/* FDCG_OK, or what fdcg_check_params has against them: then the old ones stay, and fdcg_web_message says why. Of the last four
 * those count whose flag is among friction_flags. */
uint32_t EXPORT(fdcg_web_set_params)(double mu_static, double mu_dynamic, double stiffness_n_per_m, double damping_n_s_per_m,
                                     uint32_t friction_flags, double stribeck_m_per_s, double viscous_s_per_m,
                                     double presliding_n_per_m, double friction_lag_s) {
  fdcg_params wanted = params;
  wanted.mu_static = mu_static;
  wanted.mu_dynamic = mu_dynamic;
  wanted.stiffness_n_per_m = stiffness_n_per_m;
  wanted.damping_n_s_per_m = damping_n_s_per_m;
  wanted.friction_flags = friction_flags;
  if (friction_flags & FDCG_FRICTION_STRIBECK) wanted.stribeck_m_per_s = stribeck_m_per_s;
  if (friction_flags & FDCG_FRICTION_VISCOUS) wanted.viscous_s_per_m = viscous_s_per_m;
  if (friction_flags & FDCG_FRICTION_PRESLIDING) wanted.presliding_n_per_m = presliding_n_per_m;
  if (friction_flags & FDCG_FRICTION_LAG) wanted.friction_lag_s = friction_lag_s;
  wanted.materials = wanted_materials;
  const fdcg_status status = fdcg_check_params(&wanted, &error);
  if (status != FDCG_OK) {
    memcpy(wanted_materials, materials, sizeof materials);
    return (uint32_t)status;
  }
  memcpy(materials, wanted_materials, sizeof materials);
  params = wanted;
  params.materials = materials;
  return (uint32_t)status;
}

/* The contact is that of a hand that has touched nothing yet. */
void EXPORT(fdcg_web_reset)(void) {
  memset(&contact, 0, sizeof contact);
  memset(&result, 0, sizeof result);
}

void EXPORT(fdcg_web_step)(void) {
  fdcg_step(&graph, &params, &contact, hip, &result);
}

/* Steps through `count` positions at `hips` (three doubles each) and writes as many results. */
void EXPORT(fdcg_web_run)(const double* hips, fdcg_result* results, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i)
    fdcg_step(&graph, &params, &contact, hips + 3 * (size_t)i, results + i);
}

/* Where the segment meets the surface first from outside: a contact of its own goes along it, and sticks where it arrives. The
 * result has state FDCG_FREE where nothing is met. The contact of the steps stays as it is. */
const fdcg_result* EXPORT(fdcg_web_cast)(double from_x, double from_y, double from_z, double to_x, double to_y, double to_z) {
  static fdcg_result met;
  const double from[3] = {from_x, from_y, from_z}, to[3] = {to_x, to_y, to_z};
  fdcg_params sticky = fdcg_make_params();
  sticky.mu_static = sticky.mu_dynamic = 1e9;
  fdcg_contact ray;
  memset(&ray, 0, sizeof ray);
  fdcg_step(&graph, &sticky, &ray, from, &met);
  for (uint32_t i = 0; i < kMostSweeps; ++i) {
    fdcg_step(&graph, &sticky, &ray, to, &met);
    if ((met.flags & FDCG_RESULT_SWEEP_BOUND) == 0) break;
  }
  return &met;
}

/* ---- records ------------------------------------------------------------------------------------------------------------ */
/* Each returns the record, valid until the next call, or NULL where there is no such number. */

const fdcg_node_info* EXPORT(fdcg_web_node)(uint32_t node) {
  if (graph.header == NULL || node >= graph.header->node_count) return NULL;
  record.node = fdcg_get_node(&graph, node);
  return &record.node;
}

const fdcg_side_info* EXPORT(fdcg_web_side)(uint32_t node, uint32_t side) {
  if (graph.header == NULL || node >= graph.header->node_count) return NULL;
  if (side >= fdcg_get_node(&graph, node).side_count) return NULL;
  record.side = fdcg_get_side(&graph, node, side);
  return &record.side;
}

const fdcg_connection_info* EXPORT(fdcg_web_connection)(uint32_t connection) {
  if (graph.header == NULL || connection >= graph.header->connection_count) return NULL;
  record.connection = fdcg_get_connection(&graph, connection);
  return &record.connection;
}

const fdcg_corner_info* EXPORT(fdcg_web_corner)(uint32_t corner) {
  if (graph.header == NULL || corner >= graph.header->corner_count) return NULL;
  record.corner = fdcg_get_corner(&graph, corner);
  return &record.corner;
}

/* Words: connection << 1 | end; fdcg_corner_info.fan_count says how many, of which the first kMostFan are here. */
const uint32_t* EXPORT(fdcg_web_fan)(uint32_t corner) {
  if (graph.header == NULL || corner >= graph.header->corner_count) return NULL;
  fdcg_get_fan(&graph, corner, record.fan, kMostFan);
  return record.fan;
}

/* How many materials the graph has, of which the first kMostMaterials can be set; and the name of one. */
uint32_t EXPORT(fdcg_web_material_count)(void) {
  return graph.header == NULL ? 0 : material_count();
}
const char* EXPORT(fdcg_web_material_name)(uint32_t material) {
  return fdcg_get_material_name(&graph, material);
}

/* NULL: it has none. */
const char* EXPORT(fdcg_web_node_material)(uint32_t node) {
  if (graph.header == NULL || node >= graph.header->node_count) return NULL;
  return fdcg_get_material_name(&graph, fdcg_get_node_material(&graph, node));
}
