// SPDX-License-Identifier: Apache-2.0
// Which reliefs are taken.
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "effect/effect_motion.hpp"
#include "fdcg/relief.h"

namespace fdcg {
namespace {

constexpr double kLeastOfRelief = 1e-9, kMostOfRelief = 1e9;

fdcg_status check_number(const char* field, double value, double low, double high, fdcg_error* error) {
  return value >= low && value <= high ? FDCG_OK : refuse(error, field, value, low, high);
}

fdcg_status check_wave(const fdcg_waves& waves, uint32_t i, fdcg_error* error) {
  fdcg_status status = check_number("waves.amplitude_m", waves.amplitude_m[i], 0, kMostOfRelief, error);
  if (status == FDCG_OK) status = check_number("waves.phase_turns", waves.phase_turns[i], -1, 1, error);
  if (status == FDCG_OK)
    status = check_number("waves.per_m's length", norm(vec(waves.per_m[i])), kLeastOfRelief, kMostOfRelief, error);
  return status;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_check_relief(const fdcg_relief* relief, fdcg_error* error) {
  using namespace fdcg;
  if (relief == nullptr) return refuse(error, "relief: null pointer");
  if (relief->struct_bytes != sizeof *relief)
    return check_struct_bytes(0, sizeof *relief, "relief", "; start from fdcg_make_relief()", error);
  if (relief->law == nullptr) return refuse(error, "relief.law: null pointer; start from fdcg_make_relief()");
  fdcg_status status = check_number("relief.is_off", relief->is_off, 0, 1, error);
  if (status == FDCG_OK) status = check_number("relief.most_m", relief->most_m, kLeastOfRelief, kMostOfRelief, error);
  if (status == FDCG_OK) status = check_number("relief.curvature_per_m", relief->curvature_per_m, 0, kMostOfRelief, error);
  if (status == FDCG_OK) status = check_number("relief.reserve_j", relief->reserve_j, kLeastOfRelief, kMostOfRelief, error);
  if (status == FDCG_OK) status = check_number("relief.power_w", relief->power_w, 0, kMostOfRelief, error);
  if (status != FDCG_OK || relief->law != fdcg_waves_law) return status;
  if (relief->data == nullptr) return refuse(error, "relief.data: null pointer");
  const fdcg_waves& waves = *static_cast<const fdcg_waves*>(relief->data);
  status = check_number("waves.count", waves.count, 1, FDCG_MAX_WAVES, error);
  for (uint32_t i = 0; status == FDCG_OK && i < waves.count; ++i)
    status = check_wave(waves, i, error);
  return status;
}

extern "C" double fdcg_get_relief_stiffness(const fdcg_relief* relief, double load_n) {
  return relief == nullptr ? 0 : load_n * relief->curvature_per_m;
}
