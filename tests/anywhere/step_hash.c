/* SPDX-License-Identifier: Apache-2.0 */
/* Steps contacts over every graph that is linked in, alone and as objects of a scene, and prints, for each precision, one hash
 * of all that they felt: the same on every machine, from every compiler, at every optimisation level. C11 without stdio and
 * heap, so that a microcontroller runs the same program. The graphs are constant arrays (graphs.h, made by the build) and are
 * used where they lie. */
#include "graphs.h" /* `static const struct { const char* name; const unsigned char* bytes; uint64_t size; } graphs[]` */

#include <stdint.h>
#include <string.h>

#include "fdcg/scene.h"
#include "hash.h"
#include "say.h"

enum { kTicks = 14400, kTicksOfAWay = 400 };

typedef struct {
  double centre[3], size[3]; /* of the object, metres */
  uint64_t random;
  double hip[3];
  double from[3]; /* where the god-object was when this way began */
  double aim[3];
} hand_t;

/* A corner (all coordinates at a bound), the middle of a bounding edge or face, or anywhere: by the random bits. */
static void choose_aim(hand_t* hand) {
  for (int k = 0; k < 3; ++k) {
    static const double places[4] = {-0.5, 0.5, 0, 0.2};
    const uint64_t bits = random_bits(&hand->random);
    const double place = bits % 5 == 4 ? uniform(&hand->random) - 0.5 : places[bits % 4];
    hand->aim[k] = hand->centre[k] + place * hand->size[k];
  }
}

/* Each way of kTicksOfAWay ticks goes in a manner of its own. */
static void move_hand(hand_t* hand, int32_t tick, const fdcg_result* last) {
  const int32_t way = tick / kTicksOfAWay, at = tick % kTicksOfAWay;
  if (at == 0) {
    choose_aim(hand);
    memcpy(hand->from, last->god_object_m, sizeof hand->from);
  }
  for (int k = 0; k < 3; ++k) {
    const double size = hand->size[k], r = uniform(&hand->random);
    switch (way % 6) {
      case 0: /* a jump into or beside the object, then a random walk */
        if (at % 100 == 0) hand->hip[k] = hand->centre[k] + (1.3 * r - 0.65) * size;
        hand->hip[k] += (r - 0.5) * 0.02 * size;
        break;
      case 1: /* straight at a corner, an edge or a face, and through */
        hand->hip[k] = hand->centre[k] + (hand->aim[k] - hand->centre[k]) * (1.5 - at * (2.0 / kTicksOfAWay));
        break;
      case 2: /* exactly on the god-object, then tremor about it */
        hand->hip[k] = at == 0 ? hand->from[k] : hand->hip[k] + (r - 0.5) * 1e-4 * size;
        break;
      case 3: /* teleports across the whole object */
        if (at % 3 == 0) hand->hip[k] = hand->centre[k] + (1.6 * r - 0.8) * size;
        break;
      case 4: /* a slow slide with friction under the surface */
        if (at == 0) hand->hip[k] = hand->aim[k];
        hand->hip[k] += (hand->centre[k] - hand->aim[k]) * 0.001 + (k == way % 3 ? 0.002 * size : 0);
        break;
      default: /* quantised by an encoder of 256 counts, held for eight ticks */
        if (at == 0) hand->hip[k] = hand->aim[k];
        if (at % 8 == 0) hand->hip[k] += ((double)(int32_t)(3 * r) - 1) * (size / 256);
    }
  }
}

static void vary(fdcg_params* params, int32_t way, int is_shaded) {
  params->mu_static = way % 4 * 0.3;
  params->mu_dynamic = params->mu_static * 0.7;
  params->edge_friction = way / 4 % 2 == 0 ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER;
  params->damping_n_s_per_m = way / 8 % 2;
  params->friction_flags =
      way / 6 % 3 == 2 ? (uint32_t)way % 16 : 0; /* all four terms of the friction curve, in all combinations */
  if (is_shaded) params->friction_flags |= FDCG_FRICTION_SHADING;
}

static void step_through(const fdcg_graph* graph, hash_t* hash, uint32_t ticks_in_state[4]) {
  const fdcg_header* header = graph->header;
  hand_t hand;
  memset(&hand, 0, sizeof hand);
  hand.random = 88172645463325252u;
  for (int k = 0; k < 3; ++k) {
    hand.size[k] = (header->bounds_max[k] - header->bounds_min[k]) * header->metres_per_unit;
    hand.centre[k] = ((header->bounds_min[k] + header->bounds_max[k]) * 0.5 + header->origin[k]) * header->metres_per_unit;
    if (!(hand.size[k] > 0)) hand.size[k] = 0.1 * header->extent * header->metres_per_unit; /* a flat patch */
  }
  fdcg_params params = fdcg_make_params();
  fdcg_contact contact;
  fdcg_result result;
  memset(&contact, 0, sizeof contact);
  memset(&result, 0, sizeof result);
  for (int32_t tick = 0; tick < kTicks; ++tick) {
    vary(&params, tick / kTicksOfAWay, graph->normals != 0);
    move_hand(&hand, tick, &result);
    fdcg_step(graph, &params, &contact, hand.hip, &result);
    for (int k = 0; k < 3; ++k) {
      absorb_real(hash, result.god_object_m[k]);
      absorb_real(hash, result.force_n[k]);
    }
    absorb(hash, result.state | (uint64_t)result.slipping << 8 | (uint64_t)result.flags << 16 | (uint64_t)result.feature << 32);
    absorb(hash, result.transitions);
    ++ticks_in_state[result.state & 3];
  }
}

#include "scene_walk.h"

/* Both precisions, where the library has them: a library of one refuses the other's graphs, and only those. */
int main(void) {
  static const char* const names[2] = {"f32", "f64"};
  for (uint32_t p = 0; p < 2; ++p) {
    static fdcg_graph of_scene[kSceneObjects];
    hash_t hash = {0xCBF29CE484222325u};
    uint32_t ticks_in_state[4] = {0, 0, 0, 0}, opened = 0, refused = 0;
    for (uint32_t i = 0; i < sizeof graphs / sizeof graphs[0]; ++i) {
      fdcg_header header;
      memcpy(&header, graphs[i].bytes, sizeof header);
      if (header.real_bytes != 4 * (p + 1)) continue;
      fdcg_graph graph;
      fdcg_error error;
      const fdcg_status status = fdcg_open_memory(graphs[i].bytes, graphs[i].size, FDCG_VERIFY_FULL, &graph, &error);
      if (status == FDCG_E_VERSION && ++refused > 0) continue;
      if (status != FDCG_OK) {
        say(graphs[i].name), say(": "), say(error.message), say("\n");
        return 1;
      }
      /* by pointer, never copied */
      if ((const unsigned char*)graph.header != graphs[i].bytes) return 2;
      step_through(&graph, &hash, ticks_in_state);
      if (opened < kSceneObjects) of_scene[opened] = graph;
      ++opened;
    }
    if (opened == 0 && refused > 0) continue; /* the library leaves this precision out */
    if (opened == 0 || refused > 0) return 3;
    const int failed = step_through_scene(of_scene, opened < kSceneObjects ? opened : kSceneObjects, &hash);
    if (failed != 0) return failed;
    say(names[p]), say(" "), say_hex(hash.value), say(" graphs "), say_number(opened), say(" free,face,edge,vertex");
    for (int k = 0; k < 4; ++k)
      say(" "), say_number(ticks_in_state[k]);
    say("\n");
  }
  return 0;
}
