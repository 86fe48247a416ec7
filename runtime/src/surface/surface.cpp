// SPDX-License-Identifier: Apache-2.0
// What a surface may be, and what its solid weighs. surface_step.cpp steps on it.
#include "fdcg/surface.h"

#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "shared/vec.hpp"

namespace fdcg {
namespace {

constexpr double kLeast_m = 1e-9, kLargest_m = 1e9, kLeastSizeShare = 1e-4, kPi = 3.141592653589793;

enum Field : uint32_t { kRadius = 1, kTop = 2, kTube = 4, kLength = 8, kHalf = 16 };

uint32_t fields_of(uint32_t kind) {
  static const uint32_t kFields[] = {
      0, kRadius, kRadius | kLength, kRadius | kLength, kHalf, kRadius | kTop | kLength, kRadius | kTube, kHalf};
  return kFields[kind];
}

struct Size {
  const char* name;
  double value, high;
  bool may_be_0;
};

Message& say(Message& message, const Size& size, double low) {
  message.text("surface.").text(size.name).text(" is ").real(size.value);
  return message.text(size.may_be_0 ? ", allowed 0 and " : ", allowed ").real(low).text(" to ").real(size.high);
}

fdcg_status refuse_field(const char* field, uint32_t value, const char* allowed, fdcg_error* error) {
  return Message(error, FDCG_E_ARGUMENT).text(field).text(" is ").number(value).text(allowed);
}

constexpr uint32_t kSizes = 7;

// Each by itself first: what is compared then is finite.
fdcg_status check_sizes(const fdcg_surface& s, fdcg_error* error) {
  const bool is_cone = s.kind == FDCG_SURFACE_CONE;  // one end may be an apex
  const Size sizes[kSizes] = {{"radius_m", s.radius_m, kLargest_m, is_cone && s.top_radius_m != 0},
                              {"top_radius_m", s.top_radius_m, kLargest_m, is_cone && s.radius_m != 0},
                              {"tube_radius_m", s.tube_radius_m, s.radius_m * (1 - kLeastSizeShare), false},
                              {"length_m", s.length_m, kLargest_m, s.kind == FDCG_SURFACE_CAPSULE},
                              {"half_m[0]", s.half_m[0], kLargest_m, false},
                              {"half_m[1]", s.half_m[1], kLargest_m, false},
                              {"half_m[2]", s.half_m[2], kLargest_m, false}};
  const Size* largest = sizes;
  for (uint32_t i = 0; i < kSizes; ++i) {
    const Size& size = sizes[i];
    const bool has = (fields_of(s.kind) >> (i < 4 ? i : 4) & 1) != 0;
    if (has ? (size.value >= kLeast_m && size.value <= size.high) || (size.may_be_0 && size.value == 0) : size.value == 0) {
      if (size.value > largest->value) largest = &size;
      continue;
    }
    Message message(error, FDCG_E_ARGUMENT);
    if (has)
      return say(message, size, kLeast_m)
          .text(is_cone && i < 2 && size.value == 0 ? " (one end may be a point, not both)" : "");
    message.text("surface.").text(size.name).text(" is ").real(size.value);
    return message.text(", allowed 0; a surface of this kind has none");
  }
  for (const Size& size : sizes) {
    if (size.value == 0 || size.value >= kLeastSizeShare * largest->value) continue;
    Message message(error, FDCG_E_ARGUMENT);
    say(message, size, kLeastSizeShare * largest->value).text(" (at least 1e-4 of the largest, ").text(largest->name);
    return message.text(", ").real(largest->value).text(")");
  }
  return FDCG_OK;
}

// Axial and radial moments of a body of revolution, per density: about its centroid.
void set_mass(double volume, double centre_z, double across, double along, fdcg_mass* mass) {
  mass->volume_m3 = volume;
  mass->centroid_m[2] = centre_z;
  mass->inertia_per_density_m5[0] = mass->inertia_per_density_m5[1] = across;
  mass->inertia_per_density_m5[2] = along;
}

// a to b along z: each integral over the height of a polynomial in the radius, which goes from a to b on a line.
void cone_mass(double a, double b, double length, fdcg_mass* mass) {
  const double volume = kPi * length / 3 * (a * a + a * b + b * b);
  const double first = kPi * length * length / 12 * (b * b - a * a);                                 // about the middle
  const double second = kPi * length * length * length / 120 * (4 * a * a + 2 * a * b + 4 * b * b);  // about the middle
  const double fourth = kPi * length / 5 * (a * a * a * a + a * a * a * b + a * a * b * b + a * b * b * b + b * b * b * b);
  const double centre = first / volume;
  set_mass(volume, centre, fourth / 4 + second - first * centre, fourth / 2, mass);
}

void capsule_mass(double r, double length, fdcg_mass* mass) {
  const double half = length / 2, r2 = r * r;
  const double side = kPi * r2 * length, caps = 4.0 / 3 * kPi * r2 * r;
  // A half ball's centroid is 3/8 r from its flat; its second moment along z about that flat is 1/5 r^2 of its volume.
  const double across = side * (r2 / 4 + length * length / 12) + caps * (r2 / 5 + r2 / 5 + half * half + 0.75 * r * half);
  set_mass(side + caps, 0, across, side * r2 / 2 + caps * 0.4 * r2, mass);
}

void torus_mass(double ring, double tube, fdcg_mass* mass) {
  const double volume = 2 * kPi * kPi * ring * tube * tube, ring2 = ring * ring, tube2 = tube * tube;
  set_mass(volume, 0, volume * (ring2 / 2 + 0.625 * tube2), volume * (ring2 + 0.75 * tube2), mass);
}

// `share`: of the squares of the half axes, 1/3 in a box and 1/5 in an ellipsoid.
void half_axes_mass(const double (&half)[3], double volume, double share, fdcg_mass* mass) {
  const double square[3] = {half[0] * half[0], half[1] * half[1], half[2] * half[2]};
  mass->volume_m3 = volume;
  for (int k = 0; k < 3; ++k)
    mass->inertia_per_density_m5[k] = volume * share * (square[(k + 1) % 3] + square[(k + 2) % 3]);
}

}  // namespace
}  // namespace fdcg

using fdcg::Message;

extern "C" fdcg_status fdcg_check_surface(const fdcg_surface* surface, fdcg_error* error) {
  if (surface == nullptr) return Message(error, FDCG_E_ARGUMENT).text("surface: null pointer");
  if (const fdcg_status status = fdcg::check_struct_bytes(surface->struct_bytes, sizeof(fdcg_surface), "surface",
                                                          "; start from fdcg_make_sphere() or the like", error);
      status != FDCG_OK) {
    return status;
  }
  fdcg_surface room;
  const fdcg_surface& whole = fdcg::in_full(*surface, &room, fdcg_surface_init);
  if (whole.kind > FDCG_SURFACE_ELLIPSOID)
    return fdcg::refuse_field("surface.kind", whole.kind, ", allowed are the values of fdcg_surface_kind: 0 to 7", error);
  const bool is_plane = whole.kind == FDCG_SURFACE_PLANE;
  if (whole.is_hollow > (is_plane ? 0u : 1u)) {
    return fdcg::refuse_field("surface.is_hollow", whole.is_hollow,
                              is_plane ? ", allowed 0: turn the plane round by its pose" : ", allowed 0 and 1", error);
  }
  if (whole.reserved != 0) return fdcg::refuse_field("surface.reserved", whole.reserved, ", allowed 0", error);
  return fdcg::check_sizes(whole, error);
}

extern "C" fdcg_status fdcg_surface_get_mass(const fdcg_surface* surface, fdcg_mass* mass, fdcg_error* error) {
  using namespace fdcg;
  if (mass == nullptr) return Message(error, FDCG_E_ARGUMENT).text("mass: null pointer");
  *mass = {};
  if (const fdcg_status status = fdcg_check_surface(surface, error); status != FDCG_OK) return status;
  fdcg_surface room;
  const fdcg_surface& s = in_full(*surface, &room, fdcg_surface_init);
  if (s.kind == FDCG_SURFACE_PLANE || s.is_hollow != 0) {
    return Message(error, FDCG_E_ABSENT)
        .text(s.is_hollow != 0 ? "a hollow surface is a cavity in endless material: it has no mass"
                               : "a plane has no end: it has no mass");
  }
  const double cube = s.half_m[0] * s.half_m[1] * s.half_m[2];
  switch (s.kind) {
    case FDCG_SURFACE_SPHERE:
      capsule_mass(s.radius_m, 0, mass);
      break;
    case FDCG_SURFACE_CYLINDER:
      cone_mass(s.radius_m, s.radius_m, s.length_m, mass);
      break;
    case FDCG_SURFACE_CAPSULE:
      capsule_mass(s.radius_m, s.length_m, mass);
      break;
    case FDCG_SURFACE_CONE:
      cone_mass(s.radius_m, s.top_radius_m, s.length_m, mass);
      break;
    case FDCG_SURFACE_TORUS:
      torus_mass(s.radius_m, s.tube_radius_m, mass);
      break;
    case FDCG_SURFACE_BOX:
      half_axes_mass(s.half_m, 8 * cube, 1.0 / 3, mass);
      break;
    default:
      half_axes_mass(s.half_m, 4.0 / 3 * kPi * cube, 0.2, mass);
  }
  return FDCG_OK;
}
