/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/relief.h
 * Heights on a surface that are felt and not in its mesh: ridges, bumps, grain with a given spectrum, images, one's own.
 *
 *     fdcg_waves waves = fdcg_make_ridges(0.0001, 0.001, axis);   0.1 mm high, 1 mm apart
 *     fdcg_relief relief = fdcg_make_relief(&waves);
 *     fdcg_relief_state state = {0};                              one for each contact; zero is its start
 *     each tick:
 *       fdcg_relief_move(&relief, &state, hip_object_m, 0.001, moved_m);
 *       fdcg_step(&graph, &params, &contact, moved_m, &result);
 *       fdcg_get_effect_facts(&graph, &result, moved_m, 0, 0.001, &facts, &error);
 *       fdcg_relief_turn(&relief, &state, &facts, result.force_n);          ->  the force, changed in place
 *
 * **How.** What rises under the hand by h is as if the hand were deeper by h. So the step gets the hand moved by -h along the
 * surface's normal n, and works on the flat surface as ever: friction, sticking and slipping go by the load there, which is
 * more before a bump and less behind it. Its force F' comes back through the transposed derivative of that move,
 *
 *     F = F' - (n . F') grad h
 *
 * so it leans as the flank of the bump does. Where the hand touches, the heights grow in smoothly: fully felt from eight times
 * the largest height down, not at all on the surface itself, so that contact begins and ends as on the flat surface.
 *
 * **Passive.** The move is a map of space, so the force's work on the hand is the step's work on the moved hand: what the step
 * cannot give, the relief cannot. What is left are terms of second order in the way of a tick (the force is held meanwhile; as
 * of a spring of fdcg_get_relief_stiffness) and jumps where the normal changes from face to face. An account limits both: in t
 * seconds at most reserve_j + power_w t, beside what a tick gives before it is counted. Where it runs low the heights fade.
 *
 * **Band.** What passes under the hand faster than a quarter of the tick rate fades, and from half of it on nothing is left:
 * no alias is felt at any speed.
 *
 * **Frames, units, handedness.** As in effect.h: SI units in the frame of the surface. **Ownership.** The relief's data must
 * outlive it. **Null pointers** as fdcg.h says; fdcg_relief_move, fdcg_relief_turn and the laws check nothing. **Threads.** A
 * relief is only read; one state is stepped by one thread at a time. **Cost.** 20 ns, and 20 more for one wave, 8 each for
 * many; no heap, no lock, no clock. The same bits on every processor.
 */
#ifndef FDCG_RELIEF_H
#define FDCG_RELIEF_H

#include "fdcg/effect.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_MAX_WAVES 16u /**< of one relief, at most */

struct fdcg_relief;
/** Where a law is asked for a height. */
typedef struct fdcg_relief_place {
  double place_m[3]; /**< on the surface, under the hand */
  double way_m[3];   /**< the hand's in this tick, along the surface */
  uint32_t node;     /**< of the graph: what it touched in the last tick, or FDCG_NONE */
  uint32_t reserved; /**< 0 */
} fdcg_relief_place;

/** Heights from places: the height (m), and its gradient in space, of which what lies along the surface counts. What has more
 * than half a period in way_m must be left out, and what has more than a quarter faded. Pure, bounded, without heap. */
typedef void (*fdcg_relief_handler)(const struct fdcg_relief* relief, const fdcg_relief_place* place, double* height_m,
                                    double slope[3]);

/** Some waves of heights in space: the sum of amplitude_m sin(2 pi (per_m . x + phase_turns)). On a surface they are felt as
 * they cut through it. */
typedef struct fdcg_waves {
  uint32_t count;                     /**< 1 to FDCG_MAX_WAVES */
  uint32_t reserved;                  /**< 0 */
  double per_m[FDCG_MAX_WAVES][3];    /**< of each its direction, with a length of one over its wavelength */
  double amplitude_m[FDCG_MAX_WAVES]; /**< of each, >= 0 */
  double phase_turns[FDCG_MAX_WAVES]; /**< of each, -1 to 1 */
} fdcg_waves;

/** Ridges across a direction: one wave. The direction is made unit; zeros give zeros. */
FDCG_API fdcg_waves fdcg_make_ridges(double amplitude_m, double wavelength_m, const double direction[3]);
/** Bumps: a wave along each axis of the frame, of a third of the amplitude each. */
FDCG_API fdcg_waves fdcg_make_bumps(double amplitude_m, double wavelength_m);
/** Grain: 16 waves in random directions, of wavelengths spread evenly (in their logarithms) between two, with amplitudes as the
 * wavelength to the power `exponent` (0 to 3, by halves; 1 for a surface as rough at every scale), and a root mean square
 * height of rms_m. */
FDCG_API fdcg_waves fdcg_make_grain(double rms_m, double shortest_m, double longest_m, double exponent, uint32_t seed);

/** A relief. Make it by one of the makers below, then change fields, then fdcg_check_relief. */
typedef struct fdcg_relief {
  uint32_t struct_bytes;   /**< the caller's sizeof(fdcg_relief); the makers set it */
  uint32_t is_off;         /**< 1: it does nothing */
  uint32_t material;       /**< on this material alone; FDCG_NONE: on all */
  uint32_t reserved;       /**< 0 */
  fdcg_relief_handler law; /**< heights from places */
  const void* data;        /**< of the law: its waves; one's own */
  double most_m;           /**< no height is larger; fully felt from eight times as deep on */
  double curvature_per_m;  /**< no second derivative of the heights is larger */
  double reserve_j;        /**< it may give so much, and again what it has taken */
  double power_w;          /**< and so much more, in the long run */
} fdcg_relief;

/** Sets the first `struct_bytes` bytes of *relief: no law, on every material; reserve 2 mJ, power 20 mW. */
FDCG_API void fdcg_relief_init(fdcg_relief* relief, uint32_t struct_bytes);
/** The law of fdcg_waves. */
FDCG_API void fdcg_waves_law(const fdcg_relief* relief, const fdcg_relief_place* place, double* height_m, double slope[3]);
/** The sums of the waves' amplitudes and second derivatives: for most_m and curvature_per_m. */
FDCG_API void fdcg_get_waves_bounds(const fdcg_waves* waves, double* most_m, double* curvature_per_m);
/** A relief of waves, which must outlive it. */
FDCG_INLINE fdcg_relief fdcg_make_relief(const fdcg_waves* waves) {
  fdcg_relief relief;
  fdcg_relief_init(&relief, (uint32_t)sizeof relief);
  relief.law = fdcg_waves_law;
  relief.data = waves;
  fdcg_get_waves_bounds(waves, &relief.most_m, &relief.curvature_per_m);
  return relief;
}

/** Checks every field; of waves (law fdcg_waves_law) each number too. FDCG_E_ARGUMENT, with the field, its value and its limit
 * in the message, unless all are in range. The step of a relief does not check. */
FDCG_API fdcg_status fdcg_check_relief(const fdcg_relief* relief, fdcg_error* error);

/** The stiffness along the surface that a load feels on the relief: load_n curvature_per_m. A device must render it beside the
 * material's. */
FDCG_API double fdcg_get_relief_stiffness(const fdcg_relief* relief, double load_n);

/** What a relief keeps from tick to tick. Zero is its start; copy it freely, read it, do not write it. */
typedef struct fdcg_relief_state {
  uint32_t has_started; /**< 0 before the first tick */
  uint32_t has_surface; /**< 1: it touched in the last tick */
  uint32_t node;        /**< what it touched then */
  uint32_t reserved;    /**< 0 */
  double hip_m[3];      /**< the hand, of the last tick */
  double moved_m[3];    /**< where the step was told that it is */
  double surface_m[3];  /**< the god-object then */
  double normal[3];     /**< and the normal there */
  double slope[3];      /**< of the heights, along the surface and along the normal, as they are felt */
  double force_n[3];    /**< on the hand */
  double flat_n[3];     /**< the step's */
  double height_m;      /**< felt: what the hand is moved by */
  double credit_j;      /**< what it may still give */
  double given_j;       /**< what it has given in all, beyond the step; below 0: taken */
} fdcg_relief_state;

/** First half of a tick: where the step is to be told that the hand is. A hip that is not finite is handed on as it is. */
FDCG_API void fdcg_relief_move(const fdcg_relief* relief, fdcg_relief_state* state, const double hip_m[3], double tick_s,
                               double moved_m[3]);
/** Second half: turns the step's force in place. `facts` are of the step's result (fdcg_get_effect_facts): whether it touches,
 * where, on which normal and material. */
FDCG_API void fdcg_relief_turn(const fdcg_relief* relief, fdcg_relief_state* state, const fdcg_effect_facts* facts,
                               double force_n[3]);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_RELIEF_H */
