// SPDX-License-Identifier: Apache-2.0
// Soft fingers. Tangential stretch and twist form one vector (r, a * twist), limited by the friction circle of the load: a
// god-object with one more dimension. The step itself handles r only, so it gets the friction coefficient for which its circle
// in r agrees with the section of the larger one.
#include "fdcg/soft_finger.h"

#include "base/message.hpp"
#include "scene/finger_tick.hpp"

namespace fdcg {
namespace {

constexpr double kLeastRadius_m = 1e-9, kMostRadius_m = 1e3;
constexpr double kPadSticksAgain = 1 - 0x1p-20;  // as step/friction_terms.hpp

Turn product(const Turn& a, const Turn& b) {
  return {a.v * b.w + b.v * a.w + cross(a.v, b.v), a.w * b.w - dot(a.v, b.v)};
}
Turn reverse(const Turn& a) {
  return {a.v * -1.0, a.w};
}
Turn unit(const Turn& a) {
  const double scale = 1 / root(dot(a.v, a.v) + a.w * a.w);
  return {a.v * scale, a.w * scale};
}
// About a unit axis, by the tangent of half the angle.
Turn about(World axis, double tangent) {
  return unit({axis * tangent, 1});
}

// Of a pose's rotation matrix (Shepperd 1978): by its largest part, which is at least a half.
Turn turn_of(const Pose& pose) {
  const World &x = pose.row[0], &y = pose.row[1], &z = pose.row[2];
  const double trace = x.x + y.y + z.z;
  if (trace >= 0) return unit({{z.y - y.z, x.z - z.x, y.x - x.y}, 1 + trace});
  if (x.x >= y.y && x.x >= z.z) return unit({{1 + x.x - y.y - z.z, x.y + y.x, x.z + z.x}, z.y - y.z});
  if (y.y >= z.z) return unit({{x.y + y.x, 1 - x.x + y.y - z.z, y.z + z.y}, x.z - z.x});
  return unit({{x.z + z.x, y.z + z.y, 1 - x.x - y.y + z.z}, y.x - x.y});
}

// Of the finger against the object.
Turn relative(const SoftFinger& finger, const Object& object) {
  return unit(product(reverse(turn_of(object.now)), finger.rotation));
}

// Tangent of half the angle by which the finger is turned about the normal out of the reference.
double twist_of(const Turn& now, const Turn& reference, World normal) {
  constexpr double kHalfTurn = 1e6;  // as good as one
  const Turn off = product(now, reverse(reference));
  const double along = dot(off.v, normal), w = absolute(off.w);
  const double tangent = w * kHalfTurn > absolute(along) ? along / w : (along > 0 ? kHalfTurn : -kHalfTurn);
  return off.w < 0 ? -tangent : tangent;
}

// The reference from which `now` is turned by `tangent` about the normal.
Turn reference_for(const Turn& now, World normal, double tangent) {
  return unit(product(about(normal, -tangent), now));
}

// The normal of the object or, where it has none, the direction of the spring.
World normal_at(const Object& object, const fdcg_result& result, World gap) {
  if (object.shape_normal != nullptr || result.state == FDCG_FACE) return object_normal(object, result);
  const double length = norm(gap);
  return length > 0 ? gap * (1 / length) : World{0, 0, 0};
}

// Lengths in the world.
struct Stretch {
  double depth, tangential, twist;  // twist: radius times angle, signed

  Stretch(World gap, World normal, double scale, double radius_m, double tangent)
      : depth(dot(gap, normal) * scale), twist(2 * tangent * radius_m) {
    tangential = norm(gap - normal * dot(gap, normal)) * scale;
  }
  [[nodiscard]] double length() const { return root(tangential * tangential + twist * twist); }
};

// The share of twist and tangential stretch that remains, 0 to 1; 1: sticks, or is on the circle.
double kept(const fdcg_params& params, const Stretch& stretch, uint32_t* is_slipping) {
  const double length = stretch.length(), circle = params.mu_dynamic * stretch.depth;
  if (*is_slipping != 0) {
    if (length <= kPadSticksAgain * circle) *is_slipping = 0;
  } else if (length > params.mu_static * stretch.depth) {
    *is_slipping = 1;
  }
  return *is_slipping != 0 && length > circle * (1 + 4 * DBL_EPSILON) ? circle / length : 1;
}

// The friction coefficient for the step: the tangential part of the circle's limit.
void share_friction(const Stretch& stretch, double share, bool is_slipping, fdcg_params* params) {
  constexpr double kNoSlip = 1 + 0x1p-16, kMostMu = 1e9;  // more than a float's rounding
  const double across = stretch.tangential / stretch.depth, turned = stretch.twist / stretch.depth;
  double mu = across * share;
  if (!is_slipping) {
    const double left2 = params->mu_static * params->mu_static - turned * turned;
    mu = larger(left2 > 0 ? root(left2) : 0, across * kNoSlip);
  } else if (share == 1) {
    mu = across * kNoSlip;
  }
  if (mu <= kMostMu) params->mu_static = params->mu_dynamic = mu;
}

// The torque of the remaining twist after the step: at most the part of the limit that the tangential force leaves.
void take_torque(const Object& object, const fdcg_params& met, const SoftFinger& finger, const Turn& now, World gap,
                 double tangent, SoftTouch* touch) {
  const Stretch stretch(gap, touch->normal, object.now.scale, finger.radius_m, tangent);
  const double mu = touch->is_slipping != 0 ? met.mu_dynamic : met.mu_static;
  const double most = mu * stretch.depth, left2 = most * most - stretch.tangential * stretch.tangential;
  const double limit = left2 > 0 ? root(left2) : 0;
  const bool is_beyond = absolute(stretch.twist) > limit * (1 + 0x1p-30);
  const double held = is_beyond ? (tangent > 0 ? limit : -limit) / (2 * finger.radius_m) : tangent;
  if (is_beyond) {
    touch->is_slipping = 1;
    touch->reference = reference_for(now, touch->normal, held);
  }
  const World axis = {dot(object.now.row[0], touch->normal), dot(object.now.row[1], touch->normal),
                      dot(object.now.row[2], touch->normal)};
  touch->torque_n_m = axis * (-2 * held * finger.radius_m * finger.radius_m * met.stiffness_n_per_m);
}

void step_soft(fdcg_scene* scene, uint32_t finger_index, uint32_t slot, fdcg_object_id id, fdcg_contact* contact, World hip,
               fdcg_result* result) {
  const Object& object = scene->objects()[id.index];
  const SoftFinger& finger = scene->soft_fingers()[finger_index];
  SoftTouch& touch = scene->soft_touches(finger_index)[slot];
  if (touch.object.index != id.index || touch.object.generation != id.generation) touch.is_on = 0;
  const bool was_on = touch.is_on != 0 && contact->state != FDCG_FREE && finger.radius_m > 0;
  const Turn now = relative(finger, object);
  const fdcg_params met = params_met(object, scene->fingers()[finger_index]);
  fdcg_params params = met;
  double tangent = 0;
  if (was_on) {
    tangent = twist_of(now, touch.reference, touch.normal);
    const Stretch stretch(touch.god_object - hip, touch.normal, object.now.scale, finger.radius_m, tangent);
    if (stretch.depth > 0 && params.friction_flags == 0) {
      const double share = kept(params, stretch, &touch.is_slipping);
      share_friction(stretch, share, touch.is_slipping != 0, &params);
      if (share < 1) {
        tangent *= share;
        touch.reference = reference_for(now, touch.normal, tangent);
      }
    }
  }
  step_object(object, &params, contact, hip, result);
  touch.torque_n_m = {0, 0, 0};
  touch.is_on = result->state != FDCG_FREE && finger.radius_m > 0 ? 1 : 0;
  if (touch.is_on == 0) return;
  const World gap = vec(result->god_object_m) - hip, normal = normal_at(object, *result, gap);
  const bool is_elsewhere = !was_on || result->state != touch.state || result->feature != touch.feature;
  touch.object = id;
  touch.god_object = vec(result->god_object_m);
  touch.normal = normal;
  touch.state = result->state;
  touch.feature = result->feature;
  if (!was_on) touch.is_slipping = 0;
  if (is_elsewhere) touch.reference = reference_for(now, normal, tangent);
  take_torque(object, met, finger, now, gap, tangent, &touch);
  if (params.friction_flags == 0) result->slipping = touch.is_slipping;
}

fdcg_status no_room(fdcg_error* error) {
  return Message(error, FDCG_E_ARGUMENT)
      .text("scene: has no room for soft fingers; set config.has_soft_fingers before fdcg_scene_create");
}

}  // namespace
}  // namespace fdcg

using namespace fdcg;

extern "C" fdcg_status fdcg_scene_set_finger_radius(fdcg_scene* scene, fdcg_finger_id id, double radius_m, fdcg_error* error) {
  if (find_finger(scene, id, error) == nullptr) return FDCG_E_ARGUMENT;
  if (scene->config.has_soft_fingers == 0) return no_room(error);
  if (radius_m != 0 && !(radius_m >= kLeastRadius_m && radius_m <= kMostRadius_m))
    return Message(error, FDCG_E_ARGUMENT).say("radius_m is ", radius_m, ", allowed 0 and 1e-9 to 1e3");
  scene->soft_fingers()[id.index].radius_m = radius_m;
  for (uint32_t s = 0; s < scene->config.touches_per_finger; ++s)
    scene->soft_touches(id.index)[s] = {};
  scene->step_soft = step_soft;
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_set_finger_rotation(fdcg_scene* scene, fdcg_finger_id id, const double rotation_xyzw[4],
                                                      fdcg_error* error) {
  if (find_finger(scene, id, error) == nullptr) return FDCG_E_ARGUMENT;
  if (scene->config.has_soft_fingers == 0) return no_room(error);
  if (rotation_xyzw == nullptr) return Message(error, FDCG_E_ARGUMENT).text("rotation_xyzw: null pointer");
  const Turn turn = {{rotation_xyzw[0], rotation_xyzw[1], rotation_xyzw[2]}, rotation_xyzw[3]};
  const double length = root(dot(turn.v, turn.v) + turn.w * turn.w);
  if (!(length >= 1 - kUnitTolerance && length <= 1 + kUnitTolerance)) {
    return Message(error, FDCG_E_ARGUMENT)
        .say("rotation_xyzw's length is ", length, ", allowed ", 1 - kUnitTolerance, " to ", 1 + kUnitTolerance);
  }
  scene->soft_fingers()[id.index].rotation = unit(turn);
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_scene_get_finger_torque(const fdcg_scene* scene, fdcg_finger_id id, double torque_n_m[3],
                                                    fdcg_error* error) {
  if (find_finger(const_cast<fdcg_scene*>(scene), id, error) == nullptr) return FDCG_E_ARGUMENT;
  if (torque_n_m == nullptr) return Message(error, FDCG_E_ARGUMENT).text("torque_n_m: null pointer");
  World sum = {0, 0, 0};
  if (scene->config.has_soft_fingers != 0) {
    for (uint32_t s = 0; s < scene->config.touches_per_finger; ++s) {
      const SoftTouch* const touch = soft_touch(*scene, id.index, s);
      if (touch != nullptr) sum = sum + touch->torque_n_m;
    }
  }
  torque_n_m[0] = sum.x, torque_n_m[1] = sum.y, torque_n_m[2] = sum.z;
  return FDCG_OK;
}
