/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime for JavaScript: one graph, one contact on it with a relief and effects, and looks at the graph's records.
 * JavaScript reads and writes the module's memory at the addresses that these functions return. Every struct is the C API's own
 * (fdcg.h); layouts that JavaScript relies on are asserted below. A page that needs several graphs makes several instances of
 * the module. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "fdcg/effect.h"
#include "fdcg/fdcg.h"
#include "fdcg/heights.h"
#include "fdcg/relief.h"
#include "fdcg/visual.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

_Static_assert(offsetof(fdcg_result, god_object_m) == 24 && offsetof(fdcg_result, state) == 48 && sizeof(fdcg_result) == 72,
               "result: 6 doubles, then state, feature, slipping, transitions, flags");
_Static_assert(offsetof(fdcg_node_info, side_count) == 32 && sizeof(fdcg_node_info) == 40, "node: 4 doubles, 2 words");
_Static_assert(offsetof(fdcg_side_info, connection) == 32 && sizeof(fdcg_side_info) == 48, "side: 4 doubles, 4 words");
_Static_assert(offsetof(fdcg_connection_info, corner) == 32 && sizeof(fdcg_connection_info) == 64, "edge: 4 doubles, 8 words");
_Static_assert(offsetof(fdcg_corner_info, fan_count) == 48 && sizeof(fdcg_corner_info) == 56, "corner: 6 doubles, 2 words");

_Static_assert(offsetof(fdcg_visual, vertex_count) == 16 && sizeof(fdcg_visual) == 64,
               "visual: 4 addresses, 4 words, 4 doubles");

enum { kMostFan = 4096, kMostSweeps = 100000, kMostMaterials = 64, kEffects = FDCG_EFFECT_PULSE };

/* What a relief's heights are. */
enum { kNoRelief = 0, kRidges = 1, kBumps = 2, kGrain = 3, kImage = 4 };

/* A relief, with what its law reads. */
typedef struct {
  fdcg_relief relief;
  fdcg_waves waves;
  int is_on;
} Relief;

/* An effect of each kind that has no data of its own: entry `kind - 1`. */
typedef struct {
  fdcg_effect effect;
  int is_on;
} Effect;

static fdcg_graph graph;
static fdcg_contact contact;
static fdcg_params params;
static fdcg_material materials[kMostMaterials], wanted_materials[kMostMaterials];
static fdcg_result result;
static fdcg_error error;
static fdcg_visual visual;
static fdcg_heights heights;
static Relief relief, wanted_relief;
static fdcg_relief_state relief_state;
static Effect effects[kEffects], wanted_effects[kEffects];
static fdcg_effect_state effect_states[kEffects];
static int has_effects;
static double hip[3];
static union {
  fdcg_node_info node;
  fdcg_side_info side;
  fdcg_connection_info connection;
  fdcg_corner_info corner;
  uint32_t fan[kMostFan];
  double normals[9];
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

/* The contact is that of a hand that has touched nothing yet; relief and effects begin anew. */
void EXPORT(fdcg_web_reset)(void) {
  memset(&contact, 0, sizeof contact);
  memset(&result, 0, sizeof result);
  memset(&relief_state, 0, sizeof relief_state);
  memset(effect_states, 0, sizeof effect_states);
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
  memset(&relief, 0, sizeof relief);
  memset(&wanted_relief, 0, sizeof wanted_relief);
  memset(effects, 0, sizeof effects);
  memset(wanted_effects, 0, sizeof wanted_effects);
  has_effects = 0;
  memset(&heights, 0, sizeof heights);
  if (status == FDCG_OK) fdcg_get_heights(&graph, &heights, NULL); /* none: zeros */
  fdcg_web_reset();
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

/* 1: some node has normals at its corners, for shading. */
uint32_t EXPORT(fdcg_web_has_normals)(void) {
  for (uint32_t node = 0; graph.normals != NULL && node < graph.header->node_count; ++node)
    if (graph.normals[node].corner[0][0] != FDCG_FLAT_NORMAL) return 1;
  return 0;
}

/* 1: the file has images of heights, for a relief. */
uint32_t EXPORT(fdcg_web_has_heights)(void) {
  return heights.map_count > 0;
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

/* Heights that are felt, from the next fdcg_web_set_params on. a, b, c: of ridges (across x) and bumps their height and
 * wavelength, of grain its root mean square height and its shortest and longest wavelength, metres; of the file's images
 * nothing. */
void EXPORT(fdcg_web_set_relief)(uint32_t kind, double a, double b, double c) {
  static const double across[3] = {1, 0, 0};
  memset(&wanted_relief, 0, sizeof wanted_relief);
  wanted_relief.is_on = kind != kNoRelief;
  if (kind == kImage) wanted_relief.relief = fdcg_make_height_relief(&heights);
  if (kind == kRidges) wanted_relief.waves = fdcg_make_ridges(a, b, across);
  if (kind == kBumps) wanted_relief.waves = fdcg_make_bumps(a, b);
  if (kind == kGrain) wanted_relief.waves = fdcg_make_grain(a, b, c, 1, 0);
  if (kind != kImage && wanted_relief.is_on) wanted_relief.relief = fdcg_make_relief(&wanted_relief.waves);
}

static fdcg_effect make_effect(uint32_t kind, double a, double b, double c) {
  switch (kind) {
    case FDCG_EFFECT_MAGNET:
      return fdcg_make_magnet(a, b);
    case FDCG_EFFECT_VISCOSITY:
      return fdcg_make_viscosity(a);
    case FDCG_EFFECT_STICK_SLIP:
      return fdcg_make_stick_slip(a, b);
    case FDCG_EFFECT_VIBRATION:
      return fdcg_make_vibration(a, b);
    case FDCG_EFFECT_NOISE:
      return fdcg_make_noise(a, b, c);
    case FDCG_EFFECT_TAP:
      return fdcg_make_tap(a, b, c);
    default:
      return fdcg_make_pulse(a, b, c);
  }
}

/* An effect of a kind (fdcg_effect_kind, FDCG_EFFECT_MAGNET to FDCG_EFFECT_PULSE), on or off, from the next fdcg_web_set_params
 * on; a, b, c: what its maker takes, in that order. */
void EXPORT(fdcg_web_set_effect)(uint32_t kind, uint32_t is_on, double a, double b, double c) {
  if (kind < FDCG_EFFECT_MAGNET || kind > kEffects) return;
  Effect* const wanted = &wanted_effects[kind - 1];
  memset(wanted, 0, sizeof *wanted);
  if (is_on) wanted->effect = make_effect(kind, a, b, c);
  wanted->is_on = is_on != 0;
}

static fdcg_status check_wanted(const fdcg_params* wanted) {
  fdcg_status status = fdcg_check_params(wanted, &error);
  if (status == FDCG_OK && wanted_relief.is_on) status = fdcg_check_relief(&wanted_relief.relief, &error);
  for (int i = 0; i < kEffects && status == FDCG_OK; ++i)
    if (wanted_effects[i].is_on) status = fdcg_check_effect(&wanted_effects[i].effect, wanted->tick_s, &error);
  return status;
}

/* What was off begins anew. */
static void take_wanted(void) {
  if (!relief.is_on) memset(&relief_state, 0, sizeof relief_state);
  relief = wanted_relief;
  if (relief.relief.data == &wanted_relief.waves) relief.relief.data = &relief.waves;
  has_effects = 0;
  for (int i = 0; i < kEffects; ++i) {
    has_effects |= wanted_effects[i].is_on;
    if (!effects[i].is_on) memset(&effect_states[i], 0, sizeof effect_states[i]);
  }
  memcpy(effects, wanted_effects, sizeof effects);
  memcpy(materials, wanted_materials, sizeof materials);
}

static void forget_wanted(void) {
  wanted_relief = relief;
  if (wanted_relief.relief.data == &relief.waves) wanted_relief.relief.data = &wanted_relief.waves;
  memcpy(wanted_effects, effects, sizeof effects);
  memcpy(wanted_materials, materials, sizeof materials);
}

/* FDCG_OK, or what the checks of params, relief and effects have against them: then all old ones stay, and fdcg_web_message
 * says why. Of the last four those count whose flag is among friction_flags. */
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
  const fdcg_status status = check_wanted(&wanted);
  if (status != FDCG_OK) {
    forget_wanted();
    return (uint32_t)status;
  }
  take_wanted();
  params = wanted;
  params.materials = materials;
  return (uint32_t)status;
}

/* A tick on the relief. flat_n: the step's force, before the heights turned it. */
static void step_on_relief(const double* at, fdcg_result* felt, double* flat_n) {
  const int is_on = relief.is_on && isfinite(at[0]) && isfinite(at[1]) && isfinite(at[2]);
  double moved_m[3];
  fdcg_effect_facts facts;
  if (is_on) fdcg_relief_move(&relief.relief, &relief_state, at, params.tick_s, moved_m);
  fdcg_step(&graph, &params, &contact, is_on ? moved_m : at, felt);
  memcpy(flat_n, felt->force_n, 3 * sizeof *flat_n);
  if (is_on && fdcg_get_effect_facts(&graph, felt, moved_m, 0, params.tick_s, &facts, NULL) == FDCG_OK)
    fdcg_relief_turn(&relief.relief, &relief_state, &facts, felt->force_n);
}

/* What the effects add; `flat` is the step's result. */
static void add_effects(const double* at, const fdcg_result* flat, double* force_n) {
  fdcg_effect_facts facts = {0};
  double own_n[3] = {0, 0, 0};
  const Effect* const magnet = &effects[FDCG_EFFECT_MAGNET - 1];
  const double reach_m = magnet->is_on ? magnet->effect.distance_m : 0;
  if (fdcg_get_effect_facts(&graph, flat, at, reach_m, params.tick_s, &facts, NULL) != FDCG_OK) facts.tick_s = 0; /* no force */
  for (int i = 0; i < kEffects; ++i)
    if (effects[i].is_on) fdcg_effect_step(&effects[i].effect, &facts, &effect_states[i], own_n);
  for (int k = 0; k < 3; ++k)
    force_n[k] += own_n[k];
}

/* As fdcg-servo replay has it, bit for bit. */
static void step(const double* at, fdcg_result* felt) {
  double flat_n[3];
  step_on_relief(at, felt, flat_n);
  if (!has_effects) return;
  fdcg_result flat = *felt;
  memcpy(flat.force_n, flat_n, sizeof flat_n);
  add_effects(at, &flat, felt->force_n);
}

void EXPORT(fdcg_web_step)(void) {
  step(hip, &result);
}

/* Steps through `count` positions at `hips` (three doubles each) and writes as many results. */
void EXPORT(fdcg_web_run)(const double* hips, fdcg_result* results, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i)
    step(hips + 3 * (size_t)i, results + i);
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

/* Nine doubles: the normals that shading interpolates over a node, at the corners where its sides 0, 1 and 2 start. */
const double* EXPORT(fdcg_web_node_normals)(uint32_t node) {
  if (graph.header == NULL || node >= graph.header->node_count) return NULL;
  fdcg_get_node_normals(&graph, node, record.normals);
  return record.normals;
}

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
