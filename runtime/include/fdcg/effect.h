/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/effect.h
 * Effects: forces that come on top of a contact's. Magnets, viscosity, stick-slip, vibration, noise, taps, pulses, recorded
 * textures, and one's own.
 *
 *     fdcg_effect tap = fdcg_make_tap(1.5, 300, 0.01);          1.5 N per m/s of impact, 300 Hz, gone after some 10 ms
 *     fdcg_effect_state state = {0};                            one for each effect and contact; zero is its start
 *     each tick, after fdcg_step:
 *       fdcg_get_effect_facts(&graph, &result, hip_object_m, 0, 0.001, &facts, &error);
 *       fdcg_effect_step(&tap, &facts, &state, result.force_n);                       ->  its force is added
 *
 * The step knows nothing of effects: a contact without them costs what it did and has the bits that it had. An effect has a
 * law (a function: force from facts), a condition (when, on which material, in which region), a limit of its force, and an
 * account of the energy that it may give.
 *
 * **Passive or limited.** Magnets, viscosity and stick-slip are laws that give no energy but what holding a force for a tick
 * gives: over any closed path at most K / 2 times the sum of the squared ways of the ticks, with the K of
 * fdcg_get_effect_stiffness, as of a spring of that stiffness. The others give energy of their own. The account holds for all:
 * in t seconds an effect gives at most reserve_j + power_w t, and what the last tick gives before it is counted (force_n times
 * the way of a tick). Where the account runs low, below a quarter of reserve_j, the force fades in proportion.
 *
 * **Frames, units, handedness.** SI units, in one right-handed frame in which the surface rests: the object's, with lengths of
 * the world where it is scaled. Velocities are of the hand in that frame. **Ownership.** A texture and `context` must outlive
 * the effect. **Null pointers** as fdcg.h says; fdcg_effect_step and the laws
 * check nothing. **Threads.** An effect is only read; one state is stepped by one thread at a time. **Cost.** 20 to 60 ns an
 * effect, a texture of order 20 some 150; no heap, no lock, no clock (time comes in as tick_s), bounded. The same bits on every
 * processor.
 */
#ifndef FDCG_EFFECT_H
#define FDCG_EFFECT_H

#include "fdcg/fdcg.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_TEXTURE_MAX_ORDER 32u /**< coefficients of a texture's model, at most */
#define FDCG_EFFECT_MEMORY 40u     /**< numbers that a law may keep */

/** What kind of effect it is: which fields fdcg_check_effect looks at. */
typedef enum fdcg_effect_kind {
  FDCG_EFFECT_OWN = 0,        /**< the caller's own law */
  FDCG_EFFECT_MAGNET = 1,     /**< force_n, distance_m */
  FDCG_EFFECT_VISCOSITY = 2,  /**< viscosity_n_s_per_m */
  FDCG_EFFECT_STICK_SLIP = 3, /**< stiffness_n_per_m, force_n */
  FDCG_EFFECT_VIBRATION = 4,  /**< force_n, frequency_hz */
  FDCG_EFFECT_NOISE = 5,      /**< force_n, low_hz, frequency_hz */
  FDCG_EFFECT_TAP = 6,        /**< impact_n_s_per_m, frequency_hz, decay_s */
  FDCG_EFFECT_PULSE = 7,      /**< force_n, duration_s, period_s */
  FDCG_EFFECT_TEXTURE = 8     /**< texture, mass_kg */
} fdcg_effect_kind;

/** When an effect works. */
typedef enum fdcg_effect_when {
  FDCG_WHEN_TOUCHING = 0, /**< while the contact touches */
  FDCG_WHEN_SLIPPING = 1, /**< while it slips */
  FDCG_WHEN_ALWAYS = 2,   /**< in free space too */
  FDCG_WHEN_TRIGGERED = 3 /**< from fdcg_trigger_effect on, for duration_s */
} fdcg_effect_when;

/** Where the force of vibration, noise, pulse and texture points. */
typedef enum fdcg_effect_along {
  FDCG_ALONG_NORMAL = 0, /**< the surface's normal, outward; none where nothing has been touched yet */
  FDCG_ALONG_MOTION = 1, /**< the hand's velocity along the surface; none while it rests */
  FDCG_ALONG_AXIS = 2    /**< `axis` */
} fdcg_effect_along;

/** Where an effect works, in the facts' frame. */
typedef enum fdcg_effect_region {
  FDCG_EVERYWHERE = 0, /**< without limit */
  FDCG_IN_BALL = 1,    /**< around region_m, of radius region_half_m[0] */
  FDCG_IN_BOX = 2      /**< around region_m, region_half_m to each side */
} fdcg_effect_region;

/** A texture: autoregressive models over speed and force (Culbertson, Unwin and Kuchenbecker 2014, "Modeling and rendering
 * realistic textures from unconstrained tool-surface interactions", IEEE Trans. Haptics 7(3)). At each speed and force of a
 * grid, y[i] = e[i] - a1 y[i-1] - ... - ap y[i-p] is an acceleration in m/s^2, of white noise e. Between the grid's points the
 * reflection coefficients, so that every model in between is stable, and the deviation of e are interpolated; below the first
 * speed or force the deviation falls to 0 in proportion, beyond the last it stays. All arrays are the caller's. */
typedef struct fdcg_texture {
  double rate_hz;                   /**< for which the models were made; may differ from the servo's, up to 16 times of it */
  uint32_t order;                   /**< p, 1 to FDCG_TEXTURE_MAX_ORDER */
  uint32_t speed_count;             /**< at least 1 */
  uint32_t force_count;             /**< at least 1 */
  uint32_t reserved;                /**< 0 */
  const double* speed_m_per_s;      /**< ascending, above 0 */
  const double* force_n;            /**< ascending, above 0 */
  const double* reflection;         /**< [speed][force][order], each within -1 to 1 (fdcg_get_reflection) */
  const double* deviation_m_per_s2; /**< [speed][force]: of e, the root of its variance */
} fdcg_texture;

/** Turns the coefficients a1 to ap of a model (polynomial 1 + a1 z^-1 + ..., as lpc and arcov write it without its 1) into
 * reflection coefficients. FDCG_E_ARGUMENT where the model is not stable or not finite. */
FDCG_API fdcg_status fdcg_get_reflection(const double* coefficients, uint32_t order, double* reflection, fdcg_error* error);

/** What is so about a contact in a tick. */
typedef struct fdcg_effect_facts {
  double tick_s;        /**< since the tick before, > 0 */
  double hip_m[3];      /**< the hand */
  double surface_m[3];  /**< god-object, or in free space the nearest place of the surface; read where has_surface is 1 */
  double normal[3];     /**< unit, outward, there */
  double spring_n[3];   /**< the step's force on the hand */
  uint32_t is_touching; /**< 1: in contact */
  uint32_t is_slipping; /**< 1: dynamic friction holds */
  uint32_t has_surface; /**< 1: surface_m and normal are known */
  uint32_t material;    /**< of the face, or FDCG_NONE */
  uint32_t node;     /**< the face, or one beside the edge or vertex; FDCG_NONE: none is known, as of a surface without mesh */
  uint32_t reserved; /**< 0 */
} fdcg_effect_facts;

/** What an effect keeps from tick to tick. Zero is its start; copy it freely, read it, do not write it. A law of one's own
 * may keep numbers in `memory`. */
typedef struct fdcg_effect_state {
  uint32_t has_started;              /**< 0 before the first tick */
  uint32_t is_active;                /**< its condition held in this tick */
  uint32_t has_begun;                /**< 1: its condition holds, and did not in the tick before */
  uint32_t is_triggered;             /**< fdcg_trigger_effect */
  double hip_m[3];                   /**< of the last tick */
  double way_m[3];                   /**< from the tick before to that */
  double velocity_m_per_s[3];        /**< smoothed by smoothing_s */
  double force_n[3];                 /**< what it gave in the last tick */
  double normal[3];                  /**< the last that was known; 0: none yet */
  double time_s;                     /**< since it began */
  double level;                      /**< 0 to 1: how far it is faded in (ramp_s) */
  double credit_j;                   /**< what it may still give */
  double given_j;                    /**< what it has given to the hand in all; below 0: taken from it */
  double memory[FDCG_EFFECT_MEMORY]; /**< the law's own */
  uint64_t random;                   /**< the law's own: of its noise */
} fdcg_effect_state;

struct fdcg_effect;
/** A law: what force an effect has now. Pure but for *state, whose memory and random are its own. force_n comes in as zeros;
 * what comes out is scaled by `level`, limited to force_n and by the account. It is called in the step of the effect while it
 * is active, or fades out: it must not allocate, lock, wait or read a clock, and must be as bounded as the step is. What is not
 * finite counts as no force. */
typedef void (*fdcg_effect_handler)(const struct fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                    double force_n[3]);

/** An effect. Make it by one of the makers below, then change fields, then fdcg_check_effect. */
typedef struct fdcg_effect {
  uint32_t struct_bytes;       /**< the caller's sizeof(fdcg_effect); the makers set it */
  uint32_t kind;               /**< fdcg_effect_kind */
  uint32_t is_off;             /**< 1: it does nothing */
  uint32_t when;               /**< fdcg_effect_when */
  uint32_t along;              /**< fdcg_effect_along */
  uint32_t material;           /**< works on this material alone; FDCG_NONE: on all */
  uint32_t region;             /**< fdcg_effect_region */
  uint32_t seed;               /**< of noise and texture */
  fdcg_effect_handler law;     /**< force from facts */
  void* context;               /**< for a law of one's own */
  const fdcg_texture* texture; /**< of a texture; else NULL */
  double region_m[3];          /**< the region's centre */
  double region_half_m[3];     /**< half its size */
  double axis[3];              /**< unit, of FDCG_ALONG_AXIS */
  double force_n;              /**< the most that it gives; of vibration and pulse the amplitude */
  double distance_m;           /**< magnet: as far as it reaches */
  double viscosity_n_s_per_m;  /**< viscosity */
  double stiffness_n_per_m;    /**< stick-slip */
  double frequency_hz;         /**< vibration and tap: the tone; noise: the upper end of its band */
  double low_hz;               /**< noise: the lower end; 0: none */
  double impact_n_s_per_m;     /**< tap: amplitude per speed of impact */
  double decay_s;              /**< tap: after so long a 1/e of it is left */
  double duration_s;           /**< pulse */
  double period_s;             /**< pulse: it comes again after so long; 0: once */
  double mass_kg;              /**< texture: force per acceleration */
  double smoothing_s;          /**< of the velocity: time constant; 0: that of the last tick */
  double ramp_s;               /**< to fade in and out; 0: at once */
  double reserve_j;            /**< it may give so much, and again what it has taken */
  double power_w;              /**< and so much more, in the long run */
} fdcg_effect;

/** Sets the first `struct_bytes` bytes of *effect: no law, when touching, everywhere on every material, along the normal, at
 * most 1 N; reserve 1 mJ, power 0. What the makers below start from. */
FDCG_API void fdcg_effect_init(fdcg_effect* effect, uint32_t struct_bytes);

/** Laws, each in an object of its own: a program links those that it makes. */
FDCG_API void fdcg_magnet_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                              double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_viscosity_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                 double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_stick_slip_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                  double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_vibration_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                 double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_noise_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                             double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_tap_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                           double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_pulse_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                             double force_n[3]);
/** Likewise. */
FDCG_API void fdcg_texture_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                               double force_n[3]);

/** Draws the hand to the surface from as far as distance_m: F = force_n 27/4 s (1 - s)^2 towards it, s the distance over
 * distance_m: most at a third of it, and none on the surface. Reserve: twice the depth of its well, 9/8 force_n distance_m;
 * power 10 mW. */
FDCG_INLINE fdcg_effect fdcg_make_magnet(double force_n, double distance_m) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_MAGNET;
  effect.law = fdcg_magnet_law;
  effect.when = FDCG_WHEN_ALWAYS;
  effect.force_n = force_n;
  effect.distance_m = distance_m;
  effect.reserve_j = 1.125 * force_n * distance_m;
  effect.power_w = 0.01;
  return effect;
}
/** A force against the velocity, b v: along the surface while touching (when), in all directions with FDCG_WHEN_ALWAYS. At
 * most 5 N. */
FDCG_INLINE fdcg_effect fdcg_make_viscosity(double viscosity_n_s_per_m) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_VISCOSITY;
  effect.law = fdcg_viscosity_law;
  effect.viscosity_n_s_per_m = viscosity_n_s_per_m;
  effect.force_n = 5;
  return effect;
}
/** A spring along the surface (in all directions with FDCG_WHEN_ALWAYS) to where the hand stuck; beyond force_n it lets go, and
 * sticks anew where the hand is. Reserve: twice what it stores, force_n^2 / stiffness. */
FDCG_INLINE fdcg_effect fdcg_make_stick_slip(double stiffness_n_per_m, double force_n) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_STICK_SLIP;
  effect.law = fdcg_stick_slip_law;
  effect.stiffness_n_per_m = stiffness_n_per_m;
  effect.force_n = force_n;
  effect.reserve_j = stiffness_n_per_m > 0 ? force_n * force_n / stiffness_n_per_m : 0;
  return effect;
}
/** A tone: force_n sin(2 pi frequency_hz t). Silent from half the tick rate on. Power 100 mW, ramp 5 ms. */
FDCG_INLINE fdcg_effect fdcg_make_vibration(double force_n, double frequency_hz) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_VIBRATION;
  effect.law = fdcg_vibration_law;
  effect.force_n = force_n;
  effect.frequency_hz = frequency_hz;
  effect.power_w = 0.1;
  effect.ramp_s = 0.005;
  return effect;
}
/** Noise with a root mean square of a third of force_n, between two frequencies (6 dB an octave beyond them). Power 100 mW,
 * ramp 5 ms. */
FDCG_INLINE fdcg_effect fdcg_make_noise(double force_n, double low_hz, double high_hz) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_NOISE;
  effect.law = fdcg_noise_law;
  effect.force_n = force_n;
  effect.low_hz = low_hz;
  effect.frequency_hz = high_hz;
  effect.power_w = 0.1;
  effect.ramp_s = 0.005;
  return effect;
}
/** At first contact A v exp(-t / decay_s) sin(2 pi frequency_hz t) along the normal, v the speed of impact (Okamura, Cutkosky
 * and Dennerlein 2001, IEEE/ASME T. Mechatronics 6(3)): what the material struck sounds like to the hand. At most 3 N; reserve
 * 5 mJ, power 10 mW. */
FDCG_INLINE fdcg_effect fdcg_make_tap(double impact_n_s_per_m, double frequency_hz, double decay_s) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_TAP;
  effect.law = fdcg_tap_law;
  effect.impact_n_s_per_m = impact_n_s_per_m;
  effect.frequency_hz = frequency_hz;
  effect.decay_s = decay_s;
  effect.force_n = 3;
  effect.reserve_j = 0.005;
  effect.power_w = 0.01;
  return effect;
}
/** Half a wave, force_n sin(pi t / duration_s), when it begins, and every period_s. Reserve 5 mJ, power 100 mW. */
FDCG_INLINE fdcg_effect fdcg_make_pulse(double force_n, double duration_s, double period_s) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_PULSE;
  effect.law = fdcg_pulse_law;
  effect.force_n = force_n;
  effect.duration_s = duration_s;
  effect.period_s = period_s;
  effect.reserve_j = 0.005;
  effect.power_w = 0.1;
  return effect;
}
/** A recorded texture, while slipping, by the speed along the surface and the load on it. mass_kg: of what carries the
 * vibration, pen and hand's skin, some 0.05. At most 1 N; velocity smoothed over 10 ms, power 100 mW, ramp 5 ms. */
FDCG_INLINE fdcg_effect fdcg_make_texture(const fdcg_texture* texture, double mass_kg) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.kind = FDCG_EFFECT_TEXTURE;
  effect.law = fdcg_texture_law;
  effect.when = FDCG_WHEN_SLIPPING;
  effect.texture = texture;
  effect.mass_kg = mass_kg;
  effect.smoothing_s = 0.01;
  effect.power_w = 0.1;
  effect.ramp_s = 0.005;
  return effect;
}
/** A law of one's own, which gets effect->context. Limited to force_n, reserve 1 mJ, power 10 mW. */
FDCG_INLINE fdcg_effect fdcg_make_own_effect(fdcg_effect_handler law, void* context, double force_n) {
  fdcg_effect effect;
  fdcg_effect_init(&effect, (uint32_t)sizeof effect);
  effect.law = law;
  effect.context = context;
  effect.force_n = force_n;
  effect.power_w = 0.01;
  return effect;
}

/** Checks every field that the kind has, at ticks of tick_s. FDCG_E_ARGUMENT, with the field, its value and its limit in the
 * message, unless all are in range. The step of an effect does not check. Cost: a texture's numbers. */
FDCG_API fdcg_status fdcg_check_effect(const fdcg_effect* effect, double tick_s, fdcg_error* error);

/** The stiffness of the spring that, held for ticks of tick_s, gives as much energy as the effect can by being held: 27/4
 * force_n / distance_m of a magnet, 2 viscosity / tick_s, stick-slip's own; 0 of the others. What a device renders without
 * shaking as a spring, it renders as an effect. */
FDCG_API double fdcg_get_effect_stiffness(const fdcg_effect* effect, double tick_s);

/** Fills the facts of a contact on a graph: result and hip of fdcg_step. In free space surface and normal are those of the
 * nearest place within reach_m, which a magnet needs; 0: not asked (query.h has the cost of asking). FDCG_E_ARGUMENT as
 * fdcg_get_contact_info and fdcg_find_nearest. */
FDCG_API fdcg_status fdcg_get_effect_facts(const fdcg_graph* graph, const fdcg_result* result, const double hip_object_m[3],
                                           double reach_m, double tick_s, fdcg_effect_facts* facts, fdcg_error* error);

/** A tick of an effect on a contact: adds its force to force_n. No pointer may be NULL. Facts that are not finite, or a tick_s
 * that is not above 0, give no force, and the state begins anew after them. */
FDCG_API void fdcg_effect_step(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                               double force_n[3]);

/** Lets an effect with FDCG_WHEN_TRIGGERED begin with the next tick. */
FDCG_API void fdcg_trigger_effect(fdcg_effect_state* state);

#ifdef __cplusplus
}
#endif

#endif /* FDCG_EFFECT_H */
