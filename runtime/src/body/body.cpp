// SPDX-License-Identifier: Apache-2.0
// Creation, settings and queries of bodies. body_step.cpp moves them.
#include "fdcg/body.h"

#include <string.h>

#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "body/body_math.hpp"

namespace fdcg {
namespace {

constexpr double kLargestField = 1e12, kFastest = 1e6;

struct FieldRange {
  const char* name;
  double value, low, high;
  int index = -1;  // of the number in the field; -1: it has one alone
};

fdcg_status check_range(const char* of, const FieldRange& range, fdcg_error* error, const char* remedy = "") {
  if (range.value >= range.low && range.value <= range.high) return FDCG_OK;
  Message message(error, FDCG_E_ARGUMENT);
  message.say(of, range.name);
  if (range.index >= 0) message.say("[", static_cast<uint64_t>(range.index), "]");
  return message.say(" is ", range.value, ", allowed ", range.low, " to ", range.high, remedy);
}

// The triangle inequality of the moments of inertia: checked on the diagonal and, in general, by leading minors.
bool is_solid_inertia(const double (&i)[6]) {
  constexpr double kSlack = 1e-12;  // the sums of a flat body are equal, to rounding
  const double sum = i[0] + i[1] + i[2];
  for (int k = 0; k < 3; ++k) {
    if (!(i[k] > 0 && 2 * i[k] - sum <= kSlack * sum)) return false;
  }
  const Matrix m = tensor_of(i);
  return i[0] * i[1] - i[3] * i[3] > 0 && dot(m.row[0], cross(m.row[1], m.row[2])) > 0;
}

// Mass, centre and inertia.
fdcg_status check_solid(const char* of, const fdcg_body_config& config, const char* remedy, fdcg_error* error) {
  fdcg_status status = check_range(of, {"mass_kg", config.mass_kg, 1e-12, kLargestField}, error, remedy);
  for (int k = 0; k < 3 && status == FDCG_OK; ++k) {
    status = check_range(of, {"centre_m", config.centre_m[k], -kLargestField, kLargestField, k}, error, remedy);
    if (status == FDCG_OK) status = check_range(of, {"inertia_kg_m2", config.inertia_kg_m2[k], 1e-30, 1e30, k}, error, remedy);
  }
  if (status != FDCG_OK || is_solid_inertia(config.inertia_kg_m2)) return status;
  return Message(error, FDCG_E_ARGUMENT)
      .say(of, "inertia_kg_m2 is no solid's: it must be positive definite, and no axis may have more than the two others",
           remedy);
}

fdcg_status check_config(const fdcg_body_config& config, fdcg_error* error) {
  const FieldRange ranges[] = {{"reserved", double(config.reserved), 0, 0},
                               {"linear_damping_per_s", config.linear_damping_per_s, 0, kLargestField},
                               {"angular_damping_per_s", config.angular_damping_per_s, 0, kLargestField},
                               {"sleep_after_s", config.sleep_after_s, 0, kLargestField},
                               {"sleep_speed_m_per_s", config.sleep_speed_m_per_s, 0, kLargestField},
                               {"sleep_turn_rad_per_s", config.sleep_turn_rad_per_s, 0, kLargestField},
                               {"wake_m_per_s2", config.wake_m_per_s2, 0, kLargestField}};
  for (const FieldRange& range : ranges) {
    if (const fdcg_status status = check_range("config.", range, error); status != FDCG_OK) return status;
  }
  for (int k = 0; k < 3; ++k) {
    const FieldRange pull = {"gravity_m_per_s2", config.gravity_m_per_s2[k], -kFastest, kFastest, k};
    if (const fdcg_status status = check_range("config.", pull, error); status != FDCG_OK) return status;
  }
  return check_solid("config.", config, "", error);
}

double length_of(const double (&q)[4]) {
  return root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

fdcg_status check_pose(const fdcg_pose& pose, fdcg_error* error) {
  const FieldRange length = {"rotation_xyzw's length", length_of(pose.rotation_xyzw), 1 - 1e-3, 1 + 1e-3};
  if (const fdcg_status status = check_range("pose.", length, error); status != FDCG_OK) return status;
  for (int k = 0; k < 3; ++k) {
    const FieldRange at = {"translation_m", pose.translation_m[k], -kLargestField, kLargestField, k};
    if (const fdcg_status status = check_range("pose.", at, error); status != FDCG_OK) return status;
  }
  return check_range("pose.", {"scale", pose.scale, 1e-9, 1e9}, error);
}

// The least principal moment: the smallest root of the characteristic polynomial, by Newton's method from below. Convergence is
// slowest for three equal roots: the error shrinks by a third in each iteration.
double least_moment(const double (&i)[6]) {
  constexpr uint32_t kIterations = 24;
  const Matrix m = tensor_of(i);
  const double trace = i[0] + i[1] + i[2], determinant = dot(m.row[0], cross(m.row[1], m.row[2]));
  const double minors = i[0] * i[1] - i[3] * i[3] + i[0] * i[2] - i[4] * i[4] + i[1] * i[2] - i[5] * i[5];
  double moment = 0;
  for (uint32_t n = 0; n < kIterations; ++n) {
    const double value = determinant - moment * (minors - moment * (trace - moment));
    const double slope = minors - moment * (2 * trace - 3 * moment);
    if (!(value > 0 && slope > 0)) break;
    moment += value / slope;
  }
  return moment;
}

Vector spin_now(const fdcg_body& body) {
  const Vector own = rotation_of(body.rotation_xyzw).transposed_times(vec(body.angular_momentum));
  return solve(tensor_of(body.config.inertia_kg_m2), own);
}

}  // namespace
}  // namespace fdcg

using fdcg::Message;
using fdcg::Vector;

extern "C" void fdcg_body_config_init(fdcg_body_config* config, uint32_t struct_bytes) {
  fdcg_body_config defaults = {};
  defaults.mass_kg = 1;
  for (int k = 0; k < 3; ++k)
    defaults.inertia_kg_m2[k] = 0.4 * 0.1 * 0.1;
  defaults.gravity_m_per_s2[2] = -9.80665;
  defaults.sleep_after_s = 0.5;
  defaults.sleep_speed_m_per_s = 1e-5;
  defaults.sleep_turn_rad_per_s = 1e-4;
  defaults.wake_m_per_s2 = 1e-3;
  fdcg::fill_defaults(config, defaults, struct_bytes);
}

extern "C" fdcg_status fdcg_body_set_mass(fdcg_body_config* config, const fdcg_mass* mass, double density_kg_per_m3,
                                          double scale, fdcg_error* error) {
  if (config == nullptr || mass == nullptr) return Message(error, FDCG_E_ARGUMENT).text("config or mass: null pointer");
  if (const fdcg_status status = fdcg::check_range("", {"scale", scale, 1e-9, 1e9}, error); status != FDCG_OK) return status;
  if (const fdcg_status status = fdcg::check_range("", {"density_kg_per_m3", density_kg_per_m3, 0, 1e30}, error);
      status != FDCG_OK) {
    return status;
  }
  if (density_kg_per_m3 == 0 && mass->density_kg_per_m3 == 0) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("the file does not say what it weighs; give a density, or compile the mesh with --density or --mass");
  }
  const double density = density_kg_per_m3 != 0 ? density_kg_per_m3 : mass->density_kg_per_m3;
  const double cube = scale * scale * scale;
  fdcg_body_config solid = {};
  solid.mass_kg = (density_kg_per_m3 != 0 ? density * mass->volume_m3 : mass->mass_kg) * cube;
  memcpy(solid.centre_m, mass->centroid_m, sizeof solid.centre_m);
  for (int k = 0; k < 6; ++k)
    solid.inertia_kg_m2[k] = density * mass->inertia_per_density_m5[k] * cube * scale * scale;
  const fdcg_status status = fdcg::check_solid("at this density and scale the body's ", solid,
                                               "; check the density, the scale, and what mass was filled with", error);
  if (status != FDCG_OK) return status;
  config->mass_kg = solid.mass_kg;
  memcpy(config->centre_m, solid.centre_m, sizeof solid.centre_m);
  memcpy(config->inertia_kg_m2, solid.inertia_kg_m2, sizeof solid.inertia_kg_m2);
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_body_init(fdcg_body* body, const fdcg_body_config* config, const fdcg_pose* pose,
                                      fdcg_error* error) {
  if (body == nullptr || config == nullptr || pose == nullptr)
    return Message(error, FDCG_E_ARGUMENT).text("body, config or pose: null pointer");
  if (const fdcg_status status = fdcg::check_struct_bytes(config->struct_bytes, sizeof(fdcg_body_config), "config",
                                                          "; start from fdcg_make_body_config()", error);
      status != FDCG_OK) {
    return status;
  }
  fdcg_body_config room;
  const fdcg_body_config& whole = fdcg::in_full(*config, &room, fdcg_body_config_init);
  fdcg_status status = fdcg::check_config(whole, error);
  if (status == FDCG_OK) status = fdcg::check_pose(*pose, error);
  if (status != FDCG_OK) return status;
  fdcg_body made = {};
  made.config = whole;
  made.scale = pose->scale;
  const double length = fdcg::length_of(pose->rotation_xyzw);
  for (int k = 0; k < 4; ++k)
    made.rotation_xyzw[k] = pose->rotation_xyzw[k] / length;
  const Vector arm = fdcg::rotation_of(made.rotation_xyzw) * (fdcg::vec(whole.centre_m) * pose->scale);
  fdcg::put(fdcg::vec(pose->translation_m) + arm, made.centre_m);
  *body = made;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_body_set_motion(fdcg_body* body, const double velocity_m_per_s[3],
                                            const double angular_rad_per_s[3], fdcg_error* error) {
  using namespace fdcg;
  if (body == nullptr || velocity_m_per_s == nullptr || angular_rad_per_s == nullptr)
    return Message(error, FDCG_E_ARGUMENT).text("body, velocity or angular velocity: null pointer");
  for (int k = 0; k < 3; ++k) {
    const FieldRange ranges[] = {{"velocity_m_per_s", velocity_m_per_s[k], -kFastest, kFastest, k},
                                 {"angular_rad_per_s", angular_rad_per_s[k], -kFastest, kFastest, k}};
    for (const FieldRange& range : ranges) {
      if (const fdcg_status status = check_range("", range, error); status != FDCG_OK) return status;
    }
  }
  const Matrix rotation = rotation_of(body->rotation_xyzw);
  const Vector spin = rotation.transposed_times({angular_rad_per_s[0], angular_rad_per_s[1], angular_rad_per_s[2]});
  put({velocity_m_per_s[0], velocity_m_per_s[1], velocity_m_per_s[2]}, body->velocity_m_per_s);
  put(rotation * (tensor_of(body->config.inertia_kg_m2) * spin), body->angular_momentum);
  put(spin, body->spin_rad_per_s);
  body->has_given = 0;
  body->is_asleep = 0;
  body->quiet_s = 0;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_body_set_push(fdcg_body* body, const double force_n[3], const double torque_n_m[3],
                                          fdcg_error* error) {
  using namespace fdcg;
  if (body == nullptr || force_n == nullptr || torque_n_m == nullptr)
    return Message(error, FDCG_E_ARGUMENT).text("body, force or torque: null pointer");
  for (int k = 0; k < 3; ++k) {
    const FieldRange ranges[] = {{"force_n", force_n[k], -kLargestField, kLargestField, k},
                                 {"torque_n_m", torque_n_m[k], -kLargestField, kLargestField, k}};
    for (const FieldRange& range : ranges) {
      if (const fdcg_status status = check_range("", range, error); status != FDCG_OK) return status;
    }
  }
  memcpy(body->push_n, force_n, sizeof body->push_n);
  memcpy(body->push_n_m, torque_n_m, sizeof body->push_n_m);
  return FDCG_OK;
}

extern "C" fdcg_pose fdcg_body_get_pose(const fdcg_body* body) {
  fdcg_pose pose = {};
  if (body == nullptr) return pose;
  for (int k = 0; k < 4; ++k)
    pose.rotation_xyzw[k] = body->rotation_xyzw[k];
  const Vector arm = fdcg::rotation_of(body->rotation_xyzw) * (fdcg::vec(body->config.centre_m) * body->scale);
  fdcg::put(fdcg::vec(body->centre_m) - arm, pose.translation_m);
  pose.scale = body->scale;
  return pose;
}

extern "C" void fdcg_body_get_angular_velocity(const fdcg_body* body, double angular_rad_per_s[3]) {
  if (angular_rad_per_s == nullptr) return;
  Vector spin = {0, 0, 0};
  if (body != nullptr) spin = fdcg::rotation_of(body->rotation_xyzw) * fdcg::spin_now(*body);
  for (int k = 0; k < 3; ++k)
    angular_rad_per_s[k] = fdcg::component(spin, k);
}

extern "C" double fdcg_body_get_kinetic_energy_j(const fdcg_body* body) {
  if (body == nullptr) return 0;
  const Vector velocity = fdcg::vec(body->velocity_m_per_s), spin = fdcg::spin_now(*body);
  return (body->config.mass_kg * dot(velocity, velocity) + dot(spin, fdcg::tensor_of(body->config.inertia_kg_m2) * spin)) / 2;
}

extern "C" uint32_t fdcg_body_get_substeps(const fdcg_body* body, double stiffness_n_per_m, double reach_m, double tick_s) {
  if (body == nullptr) return 0;
  const double least = fdcg::least_moment(body->config.inertia_kg_m2);
  const double steps =
      tick_s * fdcg::root(stiffness_n_per_m * (1 / body->config.mass_kg + reach_m * reach_m / least));  // at 1: half of 2
  if (!(steps >= 0 && steps <= FDCG_BODY_MAX_SUBSTEPS)) return 0;
  const auto whole = static_cast<uint32_t>(steps);
  return whole < steps || whole == 0 ? whole + 1 : whole;
}
