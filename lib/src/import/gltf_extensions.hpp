// SPDX-License-Identifier: Apache-2.0
// Extensions of glTF by name.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace fdcg::bake::gltf {

inline constexpr std::string_view kDraco = "KHR_draco_mesh_compression", kMeshopt = "EXT_meshopt_compression";

// Extensions that a file may require and that leave the triangles as they are (or that are read here).
inline bool is_harmless(std::string_view extension) {
  constexpr std::array<std::string_view, 37> kPrefixes = {kDraco,
                                                          kMeshopt,
                                                          "EXT_mesh_manifold",
                                                          "EXT_mesh_features",
                                                          "EXT_instance_features",
                                                          "KHR_physics_rigid_bodies",
                                                          "MPEG_haptic",  // and MPEG_haptic_material
                                                          "KHR_implicit_shapes",
                                                          "KHR_collision_shapes",
                                                          "KHR_rigid_bodies",
                                                          "KHR_interactivity",
                                                          "KHR_node_hoverability",
                                                          "KHR_node_selectability",
                                                          "KHR_node_visibility",
                                                          "FB_ngon_encoding",
                                                          "GODOT_single_root",
                                                          "MSFT_packing_",
                                                          "NV_materials_",
                                                          "OMI_",
                                                          "VRM",
                                                          "AGI_",
                                                          "EXT_materials_",
                                                          "EXT_image_",
                                                          "ADOBE_softbox",
                                                          "KHR_mesh_quantization",
                                                          "KHR_materials_",
                                                          "KHR_texture_",
                                                          "KHR_lights_",
                                                          "KHR_xmp",
                                                          "KHR_technique",  // _webgl, and KHR_techniques_webgl
                                                          "KHR_animation_",
                                                          "KHR_audio",
                                                          "EXT_texture_",
                                                          "EXT_lights_",
                                                          "MSFT_texture_",
                                                          "ADOBE_materials_",
                                                          "EXT_structural_metadata"};
  return std::any_of(kPrefixes.begin(), kPrefixes.end(), [extension](std::string_view p) { return extension.starts_with(p); });
}

}  // namespace fdcg::bake::gltf
