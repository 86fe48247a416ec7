// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/physics.hpp
/// What a mesh file states of friction, mass, and shapes without a mesh (glTF: KHR_physics_rigid_bodies, KHR_implicit_shapes).
///
/// **Frames, units.** SI units; the frame of the soup that the file gives.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fdcg::bake {

/// How a surface is in contact. A file that leaves a value out has the format's default, which stands here.
struct PhysicsMaterial {
  std::string name;                 ///< as in the file, else by number: "physicsMaterials[2]"
  double static_friction = 0.6;     ///< of 0 or more
  double dynamic_friction = 0.6;    ///< of 0 or more
  double restitution = 0;           ///< of 0 to 1
  std::string friction_combine;     ///< average, minimum, maximum or multiply: with the other surface's; empty: not stated
  std::string restitution_combine;  ///< likewise
};

/// What a texture of MPEG_haptic_material holds over the faces that have it: shares of its full scale, 0 to 1. The extension
/// states no unit.
struct HapticTexture {
  double mean = 0;   ///< by area
  double least = 0;  ///< of 16 places a triangle
  double most = 0;   ///< likewise
};

/// A material of MPEG_haptic_material (ISO/IEC 23090-14), which is experimental.
struct HapticMaterial {
  std::string name;                        ///< as in the file, else by number: "haptic materials[2]"
  std::optional<HapticTexture> stiffness;  ///< none: no texture of values, or no face has it
  std::optional<HapticTexture> friction;   ///< likewise
};

/// A thing that moves as one.
struct PhysicsBody {
  std::string node;                                       ///< of the file
  double mass_kg = 0;                                     ///< 0: not stated
  bool is_kinematic = false;                              ///< its motion is given, whatever its mass
  std::optional<std::array<double, 3>> centre_of_mass_m;  ///< in the frame of its node; none: not stated
};

/// A shape by formula, as an object of a scene of fdcg-servo has it (docs/surfaces.md).
struct StatedShape {
  std::string node;         ///< of the file
  std::string kind;         ///< plane, sphere, cylinder, capsule, box, cone, ellipsoid; empty: none of them, see `problem`
  std::string problem;      ///< why not, one line
  double radius_m = 0;      ///< as the kind says; others are 0, here and below
  double top_radius_m = 0;  ///< cone
  double length_m = 0;      ///< cylinder, capsule, cone
  std::array<double, 3> half_m{};                      ///< box, ellipsoid
  std::array<double, 4> rotation_xyzw = {0, 0, 0, 1};  ///< of its pose
  std::array<double, 3> translation_m{};               ///< of its pose
  std::string material;                                ///< of a PhysicsMaterial; empty: none
  bool has_faces = false;                              ///< it stands in the soup
};

/// All of it; empty where the file states none.
struct StatedPhysics {
  std::vector<PhysicsMaterial> materials;        ///< in the file's order
  std::vector<PhysicsBody> bodies;               ///< in the order of their nodes
  std::vector<StatedShape> shapes;               ///< in the order of their nodes
  std::vector<HapticMaterial> haptic_materials;  ///< in the file's order, where ImportOptions::haptic_materials asked for them
  /// There is nothing.
  [[nodiscard]] bool is_empty() const {
    return materials.empty() && bodies.empty() && shapes.empty() && haptic_materials.empty();
  }
};

/// A shape as the value of "surface" in a scene file, JSON on one line: {"kind":"sphere","radius_m":0.05}. Its kind is not
/// empty.
std::string surface_json(const StatedShape& shape);

}  // namespace fdcg::bake
