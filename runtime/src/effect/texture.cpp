// SPDX-License-Identifier: Apache-2.0
// A recorded texture: noise through an all-pole lattice, whose reflection coefficients stay within -1 to 1 wherever they are
// interpolated. memory[0] to [order - 1]: the lattice; then the last two samples and the time since the last, in samples.
#include "base/message.hpp"
#include "effect/effect_motion.hpp"
#include "effect/waves.hpp"

namespace fdcg {
namespace {

constexpr int kMostSamples = 16;  // of a tick

// Where a value lies between the points of an axis: index of the lower one, share of the upper one, and how much of the first
// is left below it.
struct AxisPlace {
  uint32_t low, high;
  double share, fade;
};
AxisPlace place_on(const double* axis, uint32_t count, double value) {
  if (value <= axis[0]) return {0, 0, 0, larger(value, 0) / axis[0]};
  uint32_t high = 1;
  while (high < count && value > axis[high])
    ++high;
  if (high == count) return {count - 1, count - 1, 0, 1};
  return {high - 1, high, (value - axis[high - 1]) / (axis[high] - axis[high - 1]), 1};
}

struct TextureModel {
  double reflection[FDCG_TEXTURE_MAX_ORDER];
  double deviation;
};

void blend(const fdcg_texture& texture, const AxisPlace& speed, const AxisPlace& force, TextureModel* model) {
  const uint32_t columns = texture.force_count, order = texture.order;
  const uint32_t cells[4] = {speed.low * columns + force.low, speed.low * columns + force.high,
                             speed.high * columns + force.low, speed.high * columns + force.high};
  const double weights[4] = {(1 - speed.share) * (1 - force.share), (1 - speed.share) * force.share,
                             speed.share * (1 - force.share), speed.share * force.share};
  model->deviation = 0;
  for (uint32_t i = 0; i < order; ++i)
    model->reflection[i] = 0;
  for (int c = 0; c < 4; ++c) {
    model->deviation += weights[c] * texture.deviation_m_per_s2[cells[c]];
    const double* const from = texture.reflection + uint64_t{cells[c]} * order;
    for (uint32_t i = 0; i < order; ++i)
      model->reflection[i] += weights[c] * from[i];
  }
  model->deviation *= speed.fade * force.fade;
}

double next_sample(const TextureModel& model, uint32_t order, double* lattice, uint64_t* random) {
  double forward = model.deviation * next_noise(random);
  for (uint32_t m = order; m-- > 0;) {
    forward -= model.reflection[m] * lattice[m];
    if (m + 1 < order) lattice[m + 1] = model.reflection[m] * forward + lattice[m];
  }
  lattice[0] = forward;
  return forward;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_texture_law(const fdcg_effect* effect, const fdcg_effect_facts* facts, fdcg_effect_state* state,
                                 double force_n[3]) {
  using namespace fdcg;
  const fdcg_texture& texture = *effect->texture;
  double *const before = state->memory + FDCG_TEXTURE_MAX_ORDER, *const last = before + 1, *const since = before + 2;
  if (state->random == 0) state->random = first_noise(effect->seed);
  const double speed = norm(along_surface(vec(state->velocity_m_per_s), *state));
  const double load = dot(vec(facts->spring_n), vec(state->normal));
  TextureModel model;
  blend(texture, place_on(texture.speed_m_per_s, texture.speed_count, speed),
        place_on(texture.force_n, texture.force_count, load), &model);
  *since += texture.rate_hz * facts->tick_s;
  for (int i = 0; i < kMostSamples && *since >= 1; ++i) {
    *before = *last;
    *last = next_sample(model, texture.order, state->memory, &state->random);
    *since -= 1;
  }
  *since = smaller(*since, 1);
  const double acceleration = *before + (*last - *before) * *since;
  const Along force = direction_of(*effect, *state) * (effect->mass_kg * acceleration);
  force_n[0] = force.x, force_n[1] = force.y, force_n[2] = force.z;
}

// The step-down recursion, from the last coefficient on.
extern "C" fdcg_status fdcg_get_reflection(const double* coefficients, uint32_t order, double* reflection, fdcg_error* error) {
  using namespace fdcg;
  if (coefficients == nullptr || reflection == nullptr) return refuse(error, "coefficients or reflection: null pointer");
  if (order < 1 || order > FDCG_TEXTURE_MAX_ORDER) return refuse(error, "order", order, 1, FDCG_TEXTURE_MAX_ORDER);
  double a[FDCG_TEXTURE_MAX_ORDER], next[FDCG_TEXTURE_MAX_ORDER];
  for (uint32_t i = 0; i < order; ++i)
    a[i] = coefficients[i];
  for (uint32_t m = order; m-- > 0;) {
    const double k = a[m];
    if (!(k > -1 && k < 1)) {
      return Message(error, FDCG_E_ARGUMENT)
          .say("coefficients: the model is not stable, its reflection coefficient ", m + 1, " is ", k,
               ", allowed are values between -1 and 1");
    }
    reflection[m] = k;
    for (uint32_t i = 0; i < m; ++i)
      next[i] = (a[i] - k * a[m - 1 - i]) / (1 - k * k);
    for (uint32_t i = 0; i < m; ++i)
      a[i] = next[i];
  }
  return FDCG_OK;
}
