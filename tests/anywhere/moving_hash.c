/* SPDX-License-Identifier: Apache-2.0 */
/* What step_hash.c leaves out: deformable meshes whose vertices move under a contact, bodies that fingers push, and effects on
 * a contact. Prints one hash of each for each precision. C11 without stdio and heap. */
#include "graphs.h" /* `static const struct { const char* name; const unsigned char* bytes; uint64_t size; } graphs[]` */

#include "fdcg/body.h"
#include "fdcg/deform.h"
#include "fdcg/relief.h"
#include "hash.h"
#include "say.h"

enum { kDeformTicks = 4000, kBodyTicks = 4000, kMemoryBytes = 1 << 21, kMoved = 3 };

static uint64_t memory[kMemoryBytes / 8];

static double size_of(const fdcg_header* header) { /* metres */
  double size = 0;
  for (int k = 0; k < 3; ++k) {
    const double side = (header->bounds_max[k] - header->bounds_min[k]) * header->metres_per_unit;
    if (side > size) size = side;
  }
  return size;
}

static double centre_of(const fdcg_header* header, int axis) { /* metres */
  return ((header->bounds_min[axis] + header->bounds_max[axis]) * 0.5 + header->origin[axis]) * header->metres_per_unit;
}

static void absorb_result(hash_t* hash, const fdcg_result* result) {
  for (int k = 0; k < 3; ++k) {
    absorb_real(hash, result->god_object_m[k]);
    absorb_real(hash, result->force_n[k]);
  }
  absorb(hash, result->state | (uint64_t)result->flags << 8 | (uint64_t)result->feature << 32);
}

/* Corners wander about where they were, and the hand about the middle. Returns the ticks in contact; below 0: it went wrong. */
static int32_t deform_one(const fdcg_graph* graph, hash_t* hash) {
  fdcg_error error;
  fdcg_deform* deform;
  const fdcg_deform_config config = fdcg_make_deform_config();
  if (fdcg_deform_create(memory, sizeof memory, graph, &config, &deform, &error) != FDCG_OK) return -1;
  const double size = size_of(graph->header);
  uint64_t random = 88172645463325252u;
  int32_t in_contact = 0;
  fdcg_params params = fdcg_make_params();
  fdcg_deform_contact contact;
  fdcg_result result;
  double hip[3] = {0, 0, 0};
  memset(&contact, 0, sizeof contact);
  for (int32_t tick = 0; tick < kDeformTicks; ++tick) {
    for (int i = 0; i < kMoved; ++i) {
      const uint32_t corner = (uint32_t)(random_bits(&random) % graph->header->corner_count);
      double place[3];
      if (fdcg_deform_place(deform, corner, place, &error) != FDCG_OK) return -1;
      for (int k = 0; k < 3; ++k)
        place[k] += (uniform(&random) - 0.5) * 0.01 * size;
      if (fdcg_deform_move(deform, corner, place, &error) != FDCG_OK) return -1;
    }
    for (int k = 0; k < 3; ++k) {
      const double wide = tick % 500 == 0 ? 1.2 : 0.01;
      const double about = tick % 500 == 0 ? centre_of(graph->header, k) : hip[k];
      hip[k] = about + (uniform(&random) - 0.5) * wide * size;
    }
    fdcg_deform_step(deform, &params, &contact, hip, &result);
    absorb_result(hash, &result);
    in_contact += result.state != FDCG_FREE;
  }
  return in_contact;
}

/* Two fingers push a body about; nothing else holds it. */
static int32_t push_body(const fdcg_graph* graph, hash_t* hash) {
  fdcg_error error;
  fdcg_scene* scene;
  fdcg_scene_config config = fdcg_make_scene_config();
  fdcg_scene_body body;
  fdcg_reaction reactions[1];
  fdcg_finger_id fingers[2];
  fdcg_pose pose = fdcg_make_identity_pose();
  fdcg_params params = fdcg_make_params();
  fdcg_body_config weight = fdcg_make_body_config();
  const double size = size_of(graph->header);
  double hip[2][3];
  uint64_t random = 88172645463325252u;
  int32_t touches = 0;
  config.object_capacity = 1;
  config.finger_capacity = 2;
  params.stiffness_n_per_m = 200;
  pose.scale = 1 / size;
  for (int k = 0; k < 3; ++k) {
    weight.gravity_m_per_s2[k] = 0;
    weight.centre_m[k] = centre_of(graph->header, k);
    pose.translation_m[k] = -centre_of(graph->header, k) * pose.scale;
  }
  weight.linear_damping_per_s = weight.angular_damping_per_s = 2;
  if (fdcg_scene_create(memory, sizeof memory, &config, &scene, &error) != FDCG_OK) return -1;
  if (fdcg_scene_add_object(scene, graph, &params, &pose, &body.object, &error) != FDCG_OK) return -1;
  if (fdcg_body_init(&body.body, &weight, &pose, &error) != FDCG_OK) return -1;
  for (int f = 0; f < 2; ++f) {
    for (int k = 0; k < 3; ++k)
      hip[f][k] = k == f ? 2 : 0;
    if (fdcg_scene_add_finger(scene, hip[f], &fingers[f], &error) != FDCG_OK) return -1;
  }
  for (int32_t tick = 0; tick < kBodyTicks; ++tick) {
    for (int f = 0; f < 2; ++f) {
      for (int k = 0; k < 3; ++k) /* towards the body, then shaken */
        hip[f][k] +=
            (body.body.centre_m[k] - hip[f][k]) * (tick % 800 < 400 ? 0.004 : -0.004) + (uniform(&random) - 0.5) * 0.01;
      if (fdcg_scene_move_finger(scene, fingers[f], hip[f], &error) != FDCG_OK) return -1;
    }
    if (fdcg_scene_step_bodies(scene, &body, 1, 4, 0.001, reactions, 1, &error) != FDCG_OK) return -1;
    for (int f = 0; f < 2; ++f) {
      fdcg_finger_result felt;
      if (fdcg_scene_get_result(scene, fingers[f], &felt, &error) != FDCG_OK) return -1;
      for (int k = 0; k < 3; ++k)
        absorb_real(hash, felt.force_n[k]);
      touches += felt.touch_count != 0;
    }
    for (int k = 0; k < 3; ++k) {
      absorb_real(hash, body.body.centre_m[k]);
      absorb_real(hash, body.body.angular_momentum[k]);
    }
  }
  return touches;
}

/* Every law, and a relief, on a hand that wanders about the surface. Returns the ticks in contact. */
static int32_t feel_effects(const fdcg_graph* graph, hash_t* hash) {
  static const double speed[2] = {0.05, 0.2}, force[1] = {0.5}, reflection[4] = {-0.5, 0.4, -0.2, 0.3}, deviation[2] = {2, 8};
  static fdcg_effect_state states[8];
  fdcg_texture texture = {1000, 2, 2, 1, 0, NULL, NULL, NULL, NULL};
  fdcg_error error;
  fdcg_contact contact;
  fdcg_result result;
  fdcg_effect_facts facts;
  fdcg_relief_state relieved = {0};
  const fdcg_params params = fdcg_make_params();
  const double size = size_of(graph->header);
  double hip[3] = {0, 0, 0};
  uint64_t random = 88172645463325252u;
  int32_t in_contact = 0;
  texture.speed_m_per_s = speed, texture.force_n = force, texture.reflection = reflection,
  texture.deviation_m_per_s2 = deviation;
  const fdcg_effect effects[8] = {fdcg_make_magnet(2, 0.1 * size),  fdcg_make_viscosity(1),
                                  fdcg_make_stick_slip(300, 0.5),   fdcg_make_vibration(1, 137),
                                  fdcg_make_noise(1, 50, 300),      fdcg_make_tap(1, 200, 0.01),
                                  fdcg_make_pulse(1, 0.02, 0.0375), fdcg_make_texture(&texture, 0.05)};
  const fdcg_waves waves = fdcg_make_grain(0.001 * size, 0.01 * size, 0.1 * size, 1.5, 5);
  const fdcg_relief relief = fdcg_make_relief(&waves);
  memset(states, 0, sizeof states);
  memset(&contact, 0, sizeof contact);
  for (int32_t tick = 0; tick < kDeformTicks; ++tick) {
    double felt[3] = {0, 0, 0}, moved[3];
    for (int k = 0; k < 3; ++k) {
      const double wide = tick % 500 == 0 ? 1.2 : 0.01;
      const double about = tick % 500 == 0 ? centre_of(graph->header, k) : hip[k];
      hip[k] = about + (uniform(&random) - 0.5) * wide * size;
    }
    fdcg_relief_move(&relief, &relieved, hip, params.tick_s, moved);
    fdcg_step(graph, &params, &contact, moved, &result);
    if (fdcg_get_effect_facts(graph, &result, hip, 0.1 * size, params.tick_s, &facts, &error) != FDCG_OK) return -1;
    fdcg_relief_turn(&relief, &relieved, &facts, result.force_n);
    for (int k = 0; k < 3; ++k)
      absorb_real(hash, result.force_n[k]);
    for (int i = 0; i < 8; ++i)
      fdcg_effect_step(&effects[i], &facts, &states[i], felt);
    for (int k = 0; k < 3; ++k)
      absorb_real(hash, felt[k]);
    in_contact += result.state != FDCG_FREE;
  }
  return in_contact;
}

int main(void) {
  static const char* const names[2] = {"f32", "f64"};
  for (uint32_t p = 0; p < 2; ++p) {
    hash_t deformed = {0xCBF29CE484222325u}, pushed = {0xCBF29CE484222325u}, effects = {0xCBF29CE484222325u};
    int32_t in_contact = 0, touches = 0, felt = 0;
    uint32_t sheets = 0;
    for (uint32_t i = 0; i < sizeof graphs / sizeof graphs[0]; ++i) {
      fdcg_graph graph;
      fdcg_error error;
      fdcg_header header;
      memcpy(&header, graphs[i].bytes, sizeof header);
      if (header.real_bytes != 4 * (p + 1)) continue;
      if (fdcg_open_memory(graphs[i].bytes, graphs[i].size, FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) return 1;
      const uint64_t needed = fdcg_deform_bytes(&graph);
      if (needed != 0 && needed + 64 <= sizeof memory) {
        const int32_t found = deform_one(&graph, &deformed);
        if (found < 0) return 2;
        in_contact += found;
        ++sheets;
      }
      const int32_t found = push_body(&graph, &pushed);
      if (found < 0) return 3;
      touches += found;
      const int32_t effective = feel_effects(&graph, &effects);
      if (effective < 0) return 5;
      felt += effective;
    }
    if (in_contact < 500 || touches < 500 || felt < 500) return 4; /* else the hashes say little */
    say(names[p]), say(" deform "), say_hex(deformed.value), say(" of "), say_number(sheets);
    say(", body "), say_hex(pushed.value), say(", effects "), say_hex(effects.value), say("\n");
  }
  return 0;
}
