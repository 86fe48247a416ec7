// SPDX-License-Identifier: Apache-2.0
// Mass properties of a surface's solid.
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "surface/surface_kinds.hpp"

namespace fdcg {
namespace {

constexpr double kPi = 3.141592653589793;

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

extern "C" fdcg_status fdcg_surface_get_mass(const fdcg_surface* surface, fdcg_mass* mass, fdcg_error* error) {
  using namespace fdcg;
  if (mass == nullptr) return Message(error, FDCG_E_ARGUMENT).text("mass: null pointer");
  *mass = {};
  if (const fdcg_status status = fdcg_check_surface(surface, error); status != FDCG_OK) return status;
  fdcg_surface room;
  const fdcg_surface& s = in_full(*surface, &room, clear_surface);
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
