// SPDX-License-Identifier: Apache-2.0
// Heights that are sums of waves.
#include "effect/effect_motion.hpp"
#include "effect/waves.hpp"
#include "fdcg/relief.h"

namespace fdcg {
namespace {

constexpr double kTurnRad = 6.283185307179586476925, kFarthestTurns = 0x1p48;

// Two waves side by side.
struct TwoWaves {
  Two per_m[3], amplitude, phase;
};
inline TwoWaves two_of(const fdcg_waves& waves, uint32_t i) {
  const double(&a)[3] = waves.per_m[i], (&b)[3] = waves.per_m[i + 1];
  return {{Two{a[0], b[0]}, Two{a[1], b[1]}, Two{a[2], b[2]}},
          Two{waves.amplitude_m[i], waves.amplitude_m[i + 1]},
          Two{waves.phase_turns[i], waves.phase_turns[i + 1]}};
}
inline Two dot(const TwoWaves& waves, Along v) {
  return waves.per_m[0] * v.x + waves.per_m[1] * v.y + waves.per_m[2] * v.z;
}
inline Two without_signs(Two a) {
  return reinterpret_cast<Two>(bits_of(a) & TwoBits{INT64_MAX, INT64_MAX});
}
inline double sum_of_lanes(Two a) {
  return a[0] + a[1];
}

// A wave that passes by so many turns a tick: whole up to a quarter, gone at a half.
inline double share_of_turns(double turns) {
  constexpr double kWhole = 0.25, kGone = 0.5;
  if (turns <= kWhole) return 1;
  return turns >= kGone ? 0 : (kGone - turns) / (kGone - kWhole);
}
inline Two share_of_turns(Two turns) {
  constexpr double kGone = 0.5, kPerTurn = 4;
  const Two share = (kGone - turns) * kPerTurn, none = {0, 0}, whole = {1, 1}, some = share > none ? share : none;
  return some < whole ? some : whole;
}

double uniform(uint64_t* state) {  // -1 to 1
  constexpr double kScale = 0x1p-52;
  next_noise(state);
  return static_cast<double>((*state * 0x2545F4914F6CDD1DU) >> 11) * kScale - 1;
}

Along any_direction(uint64_t* state) {
  constexpr int kMostTries = 64;
  for (int i = 0; i < kMostTries; ++i) {
    const Along v = {uniform(state), uniform(state), uniform(state)};
    const double square = dot(v, v);
    if (square > 0.01 && square <= 1) return v * (1 / root(square));
  }
  return {0, 0, 1};
}

// x to a power of halves, 0 to 3.
double power_of(double x, double exponent) {
  double result = 1;
  for (; exponent >= 0.75; exponent -= 1)
    result *= x;
  return exponent >= 0.25 ? result * root(x) : result;
}

void set_wave(fdcg_waves* waves, Along direction, double wavelength_m, double amplitude_m, double phase_turns) {
  const uint32_t i = waves->count++;
  store(direction * (1 / wavelength_m), waves->per_m[i]);
  waves->amplitude_m[i] = amplitude_m;
  waves->phase_turns[i] = phase_turns;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_waves fdcg_make_ridges(double amplitude_m, double wavelength_m, const double direction[3]) {
  using namespace fdcg;
  fdcg_waves waves = {};
  Along along = {0, 0, 0};
  if (direction != nullptr) along = {direction[0], direction[1], direction[2]};
  const double length = norm(along);
  set_wave(&waves, length > 0 ? along * (1 / length) : Along{0, 0, 0}, wavelength_m, amplitude_m, 0);
  return waves;
}

extern "C" fdcg_waves fdcg_make_bumps(double amplitude_m, double wavelength_m) {
  using namespace fdcg;
  fdcg_waves waves = {};
  for (int k = 0; k < 3; ++k)
    set_wave(&waves, {k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0}, wavelength_m, amplitude_m / 3, 0);
  return waves;
}

extern "C" fdcg_waves fdcg_make_grain(double rms_m, double shortest_m, double longest_m, double exponent, uint32_t seed) {
  using namespace fdcg;
  fdcg_waves waves = {};
  uint64_t random = first_noise(seed);
  double step = longest_m / shortest_m;  // from a wave to the next: its 16th root
  for (int i = 0; i < 4; ++i)
    step = root(step);
  double wavelength_m = shortest_m * root(step), square = 0;
  for (uint32_t i = 0; i < FDCG_MAX_WAVES; ++i, wavelength_m *= step) {
    const Along direction = any_direction(&random);
    const double amplitude = power_of(wavelength_m / longest_m, exponent);
    square += amplitude * amplitude / 2;
    set_wave(&waves, direction, wavelength_m, amplitude, 0.5 * uniform(&random));
  }
  for (double& amplitude_m : waves.amplitude_m)
    amplitude_m *= rms_m / root(square);
  return waves;
}

extern "C" void fdcg_get_waves_bounds(const fdcg_waves* waves, double* most_m, double* curvature_per_m) {
  using namespace fdcg;
  double most = 0, curvature = 0;
  for (uint32_t i = 0; waves != nullptr && i < waves->count && i < FDCG_MAX_WAVES; ++i) {
    const Along per_m = vec(waves->per_m[i]);
    most += waves->amplitude_m[i];
    curvature += waves->amplitude_m[i] * kTurnRad * kTurnRad * dot(per_m, per_m);
  }
  if (most_m != nullptr) *most_m = most;
  if (curvature_per_m != nullptr) *curvature_per_m = curvature;
}

extern "C" void fdcg_waves_law(const fdcg_relief* relief, const fdcg_relief_place* at, double* height_m, double slope[3]) {
  using namespace fdcg;
  const fdcg_waves& waves = *static_cast<const fdcg_waves*>(relief->data);
  const Along place = vec(at->place_m), way = vec(at->way_m);
  const Two none = {0, 0};
  double height = 0;
  Along gradient = {0, 0, 0};
  const uint32_t count = waves.count < FDCG_MAX_WAVES ? waves.count : FDCG_MAX_WAVES;
  if (count > 1) {
    Two heights = none, x = none, y = none, z = none;
    for (uint32_t i = 0; i + 1 < count; i += 2) {
      const TwoWaves two = two_of(waves, i);
      const Two turns = dot(two, place) + two.phase, far = without_signs(turns);
      const Two share = far < kFarthestTurns ? share_of_turns(without_signs(dot(two, way))) : none;
      const SinesCosines wave = sines_cosines_of_turns(far < kFarthestTurns ? turns : none);
      const Two amplitude = two.amplitude * share, rise = amplitude * wave.cosine;
      heights += amplitude * wave.sine;
      x += two.per_m[0] * rise, y += two.per_m[1] * rise, z += two.per_m[2] * rise;
    }
    height = sum_of_lanes(heights);
    gradient = Along{sum_of_lanes(x), sum_of_lanes(y), sum_of_lanes(z)} * kTurnRad;
  }
  if (count % 2 != 0) {  // one is left
    const uint32_t i = count - 1;
    const Along per_m = vec(waves.per_m[i]);
    const double turns = dot(per_m, place) + waves.phase_turns[i];
    if (absolute(turns) < kFarthestTurns) {
      const SineCosine wave = sine_cosine_of_turns(turns);
      const double amplitude = waves.amplitude_m[i] * share_of_turns(absolute(dot(per_m, way)));
      height += amplitude * wave.sine;
      gradient = gradient + per_m * (amplitude * kTurnRad * wave.cosine);
    }
  }
  *height_m = height;
  slope[0] = gradient.x, slope[1] = gradient.y, slope[2] = gradient.z;
}
