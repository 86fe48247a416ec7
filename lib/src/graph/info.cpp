// SPDX-License-Identifier: Apache-2.0
#include "graph/info.hpp"

#include <nlohmann/json.hpp>

#include "fdcg/fdcg.h"

namespace fdcg::bake {
namespace {

using Json = nlohmann::ordered_json;

// By the values of Format, Weld::Kind and Coplanar::Kind.
constexpr const char* kFormats[] = {"off", "obj", "ply", "stl", "gltf", "drc", "dae", "3mf", "vtk", "x3d"};
constexpr const char* kWelds[] = {"exact", "none", "distance"};
constexpr const char* kCoplanars[] = {"exact", "quantum", "angle"};

Json options_json(const CompileOptions& options) {
  Json json;
  json["metres_per_unit"] = options.metres_per_unit;
  json["precision"] = options.precision == Precision::f32 ? "f32" : "f64";
  json["coplanar"] = kCoplanars[static_cast<int>(options.coplanar.kind)];
  if (options.coplanar.kind == Coplanar::Kind::angle) json["coplanar_angle_rad"] = options.coplanar.angle_rad;
  json["merge"] = options.merge && !options.triangles;
  if (options.triangles) json["triangles"] = true;
  if (options.normals != Normals::none) json["normals"] = options.normals == Normals::file ? "file" : "faces";
  if (options.normals == Normals::faces || options.visual) json["crease_rad"] = options.crease_rad;
  if (options.visual) json["visual"] = true;
  if (options.heights) json["heights"] = true;
  if (options.height_range_m != 0) json["height_range_m"] = options.height_range_m;
  json["weld"] = kWelds[static_cast<int>(options.weld.kind)];
  if (options.weld.kind == Weld::Kind::distance) json["weld_distance"] = options.weld.distance;
  json["orient"] = options.orient;
  json["planes"] = options.store_planes ? "stored" : "derived";
  json["without"] = options.without;
  json["allow"] = options.allow;
  json["self_intersections"] = options.self_intersections;
  if (options.density_kg_per_m3 != 0) json["density_kg_per_m3"] = options.density_kg_per_m3;
  if (options.mass_kg != 0) json["mass_kg"] = options.mass_kg;
  return json;
}

// Totals and measures; the lists are for reports.
Json repair_info(const RepairAccount& account) {
  Json json;
  json["level"] = level_name(account.level);
  json["found"] = account.found;
  json["actions"] = Json::array();
  for (const RepairAction& action : account.actions) {
    if (action.total == 0 && action.left == 0) continue;
    json["actions"].push_back({{"name", action.name},
                               {"total", action.total},
                               {"left", action.left},
                               {"distance", action.distance},
                               {"volume_change", action.volume_change}});
  }
  json["distance"] = account.distance;
  json["volume_before"] = account.volume_before;
  json["volume_after"] = account.volume_after;
  json["faces_before"] = account.faces_before;
  json["faces_after"] = account.faces_after;
  return json;
}

Json or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

// A shape with all that an object of a scene needs, but for its name and stiffness.
Json shape_info(const StatedShape& shape) {
  Json json{{"node", shape.node}};
  if (shape.kind.empty()) {
    json["problem"] = shape.problem;
    return json;
  }
  json["surface"] = Json::parse(surface_json(shape));
  json["pose"] = {{"rotation_xyzw", shape.rotation_xyzw}, {"translation_m", shape.translation_m}};
  json["material"] = or_null(shape.material);
  json["in_mesh"] = shape.has_faces;
  return json;
}

Json texture_info(const std::optional<HapticTexture>& texture) {
  if (!texture) return nullptr;
  return {{"mean", texture->mean}, {"least", texture->least}, {"most", texture->most}};
}

Json physics_info(const StatedPhysics& physics) {
  Json json{{"materials", Json::array()}, {"bodies", Json::array()}, {"shapes", Json::array()}};
  for (const PhysicsMaterial& m : physics.materials) {
    json["materials"].push_back({{"name", m.name},
                                 {"static_friction", m.static_friction},
                                 {"dynamic_friction", m.dynamic_friction},
                                 {"restitution", m.restitution},
                                 {"friction_combine", or_null(m.friction_combine)},
                                 {"restitution_combine", or_null(m.restitution_combine)}});
  }
  for (const PhysicsBody& b : physics.bodies) {
    json["bodies"].push_back({{"node", b.node},
                              {"mass_kg", b.mass_kg > 0 ? Json(b.mass_kg) : Json(nullptr)},
                              {"kinematic", b.is_kinematic},
                              {"centre_of_mass_m", b.centre_of_mass_m ? Json(*b.centre_of_mass_m) : Json(nullptr)}});
  }
  for (const StatedShape& shape : physics.shapes)
    json["shapes"].push_back(shape_info(shape));
  for (const HapticMaterial& m : physics.haptic_materials)
    json["haptic_materials"].push_back(
        {{"name", m.name}, {"stiffness", texture_info(m.stiffness)}, {"friction", texture_info(m.friction)}});
  return json;
}

}  // namespace

std::string info_json(const PolygonSoup& soup, std::uint32_t vertices, std::uint32_t faces, const CompileOptions& options,
                      const Compiled& compiled) {
  Json json;
  json["tool"] = "fdcg " FDCG_VERSION_STRING;
  json["source"] = {{"file_sha256", soup.sha256},
                    {"format", kFormats[static_cast<int>(soup.format)]},
                    {"vertices", vertices},
                    {"faces", faces}};
  json["options"] = options_json(options);
  const Report& report = compiled.report;
  json["verdict"] = report.passes() ? "pass" : "fail";
  json["checks"] = report.checks;
  json["allowed"] = report.allowed;
  Json issues = Json::object();
  std::map<Severity, std::uint64_t> findings;
  for (const Issue& issue : report.issues) {
    issues[issue.rule] = issue.total;
    findings[issue.severity] += issue.total;
  }
  json["issues"] = issues;
  json["errors"] = findings[Severity::error];
  json["warnings"] = findings[Severity::warning];
  json["notes"] = findings[Severity::note];
  json["components"] = report.components;
  json["kept_faces"] = report.kept_faces;
  json["flipped_faces"] = compiled.flipped_faces;
  json["split_faces"] = compiled.split_faces;
  json["merged_faces"] = compiled.merged_faces;
  if (compiled.repair) json["repair"] = repair_info(*compiled.repair);
  if (!soup.physics.is_empty()) json["physics"] = physics_info(soup.physics);
  if (!compiled.no_mass.empty()) json["no_mass"] = compiled.no_mass;
  return json.dump();
}

}  // namespace fdcg::bake
