// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "scene/scene_parser.hpp"

namespace fdcg::dev {
namespace {

constexpr double kUnitAsItIs = 1e-12;
constexpr json::Keys kSurfaceKeys = {"kind", "radius_m", "top_radius_m", "tube_radius_m", "length_m", "half_m", "hollow"};
constexpr json::Keys kPoseKeys = {"rotation_xyzw", "translation_m", "scale"};
constexpr json::Keys kMotionKeys = {"kind",
                                    "axis",
                                    "rate_hz",
                                    "amplitude_m",
                                    "mass_kg",
                                    "density_kg_per_m3",
                                    "points",
                                    "linear_damping_per_s",
                                    "notes",
                                    "angular_damping_per_s",
                                    "stiffness_n_per_m",
                                    "tension_n_per_m",
                                    "damping_n_s_per_m",
                                    "depth_m",
                                    "radius_m"};

}  // namespace

void SceneParser::read_object(const json::Value& from) {
  ObjectConfig object;
  object.name = from["name"].text(kLongestName);
  refuse_twins(from, config_.objects, object.name);
  if (from["surface"]) {
    if (from["file"]) from["file"].fail("stands beside surface; give one of them");
    read_surface(from["surface"].object(kSurfaceKeys), &object);
  } else {
    if (!from["file"]) from.fail("has neither file nor surface; give one of them");
    object.file = beside(file_name_, from["file"].text(kLongestPath));
  }
  object.pose = fdcg_make_identity_pose();
  if (from["pose"]) {
    const json::Value pose = from["pose"].object(kPoseKeys);
    if (pose["rotation_xyzw"]) read_unit(pose["rotation_xyzw"], object.pose.rotation_xyzw, 4);
    if (pose["translation_m"]) pose["translation_m"].numbers(object.pose.translation_m, 3, kLengths);
    object.pose.scale = pose["scale"].number_or(1, {1e-9, 1e9});
  }
  object.params = fdcg_make_params();
  fdcg_params& params = object.params;
  params.damping_n_s_per_m = from["damping_n_s_per_m"].number_or(params.damping_n_s_per_m, from_0(1e6, "N s/m"));
  read_friction(from, &params);
  params.edge_friction = from["edge_friction"].choice_or(0, {"wedge", "paper"}) == 0 ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER;
  if (from["motion"]) read_motion(from["motion"].object(kMotionKeys), &object.motion);
  if (from["shading"].boolean_or(false)) {
    if (object.is_surface) from["shading"].fail("is for meshes; a surface is smooth as it is");
    if (object.motion.kind == MotionKind::kSoft) from["shading"].fail("is true of a soft object, which cannot be shaded");
    params.friction_flags |= FDCG_FRICTION_SHADING;
  }
  if (from["effects"]) object.effects = read_effects(from["effects"], &object);
  if (from["relief"]) object.relief = read_relief(from["relief"], object);
  const auto moves = [](const ObjectConfig& other) { return is_moved(other.motion); };
  const auto is_body = [](const ObjectConfig& other) { return other.motion.kind == MotionKind::kBody; };
  if (moves(object) && std::count_if(config_.objects.begin(), config_.objects.end(), moves) == kMaxDriven) {
    from["motion"].fail("is one more than the " + std::to_string(kMaxDriven) + " that a scene may have; make an object fixed");
  }
  const auto is_soft = [](const ObjectConfig& other) { return other.motion.kind == MotionKind::kSoft; };
  if (is_soft(object) && object.is_surface) from["motion"].fail("is soft, which a surface cannot be; give a file");
  if (is_soft(object) && std::count_if(config_.objects.begin(), config_.objects.end(), is_soft) == kMaxSoft) {
    from["motion"].fail("is one more soft object than the " + std::to_string(kMaxSoft) + " that a scene may have");
  }
  if (is_body(object) && std::count_if(config_.objects.begin(), config_.objects.end(), is_body) == kMaxBodies) {
    from["motion"].fail("is one more body than the " + std::to_string(kMaxBodies) + " that a scene may have");
  }
  config_.objects.push_back(std::move(object));
}

void SceneParser::read_surface(const json::Value& from, ObjectConfig* object) {
  fdcg_surface& surface = object->surface;
  object->is_surface = true;
  fdcg_surface_init(&surface, sizeof surface);
  surface.kind = static_cast<std::uint32_t>(
      from["kind"].choice({"plane", "sphere", "cylinder", "capsule", "box", "cone", "torus", "ellipsoid"}));
  surface.is_hollow = from["hollow"].boolean_or(false) ? 1 : 0;
  constexpr json::NumberRange kSizes = from_0(1e9, "m");
  surface.radius_m = from["radius_m"].number_or(0, kSizes);
  surface.top_radius_m = from["top_radius_m"].number_or(0, kSizes);
  surface.tube_radius_m = from["tube_radius_m"].number_or(0, kSizes);
  surface.length_m = from["length_m"].number_or(0, kSizes);
  if (from["half_m"]) from["half_m"].numbers(surface.half_m, 3, kSizes);
  refuse_surface(from, surface);
}

// The runtime says "surface.FIELD is VALUE, allowed ...": the fields are the scene's keys.
void SceneParser::refuse_surface(const json::Value& from, const fdcg_surface& surface) {
  fdcg_error error{};
  if (fdcg_check_surface(&surface, &error) == FDCG_OK) return;
  const std::string message = error.message, start = "surface.";
  const std::size_t end = message.find(' ');
  if (message.rfind(start, 0) != 0 || end == std::string::npos) return from["kind"].fail("is refused: " + message);
  std::string field = message.substr(start.size(), end - start.size());
  if (field == "is_hollow") field = "hollow";
  const std::string key = field.substr(0, field.find('['));
  from[field].fail(from[key] ? message.substr(end + 1) : "is missing, so it" + message.substr(end));
}

void SceneParser::read_friction(const json::Value& from, fdcg_params* params) {
  params->stiffness_n_per_m = from["stiffness_n_per_m"].number_or(params->stiffness_n_per_m, from_0(1e6, "N/m"));
  params->mu_static = from["mu_static"].number_or(params->mu_static, from_0(1e6, ""));
  params->mu_dynamic = from["mu_dynamic"].number_or(params->mu_dynamic, from_0(1e6, ""));
  if (params->mu_static >= params->mu_dynamic) return;
  from["mu_static"].fail("is " + shown_number(params->mu_static) + (from["mu_static"] ? "" : " (the default)") +
                         ", below mu_dynamic, " + shown_number(params->mu_dynamic) +
                         (from["mu_dynamic"] ? "" : " (the default)") + "; it must be at least that");
}

void SceneParser::read_body(const json::Value& from, BodyConfig* body) {
  from.allow_only({"kind", "mass_kg", "density_kg_per_m3", "points", "linear_damping_per_s", "angular_damping_per_s", "notes"},
                  " of a body");
  if (from["mass_kg"]) body->mass_kg = from["mass_kg"].number(above_0(1e6, "kg"));
  if (from["density_kg_per_m3"]) body->density_kg_per_m3 = from["density_kg_per_m3"].number(above_0(1e6, "kg/m^3"));
  if (body->mass_kg > 0 && body->density_kg_per_m3 > 0)
    from["mass_kg"].fail("stands beside density_kg_per_m3; give one of them");
  body->linear_damping_per_s = from["linear_damping_per_s"].number_or(0, from_0(1000, "1/s"));
  body->angular_damping_per_s = from["angular_damping_per_s"].number_or(0, from_0(1000, "1/s"));
  body->points = static_cast<int>(from["points"].integer_or(body->points, 1, 256));
}

void SceneParser::read_soft(const json::Value& from, SoftConfig* soft) {
  from.allow_only({"kind", "stiffness_n_per_m", "tension_n_per_m", "damping_n_s_per_m", "depth_m", "radius_m", "notes"},
                  " of a soft one");
  soft->stiffness_n_per_m = from["stiffness_n_per_m"].number_or(soft->stiffness_n_per_m, {1e-6, 1e6, true, "N/m"});
  soft->tension_n_per_m = from["tension_n_per_m"].number_or(soft->tension_n_per_m, from_0(1e6, "N/m"));
  soft->damping_n_s_per_m = from["damping_n_s_per_m"].number_or(soft->damping_n_s_per_m, {1e-6, 1e6, true, "N s/m"});
  soft->depth_m = from["depth_m"].number_or(soft->depth_m, {1e-6, 1e3, true, "m"});
  if (from["radius_m"]) soft->radius_m = from["radius_m"].number(from_0(1e3, "m"));
}

void SceneParser::read_ground(const json::Value& from) {
  GroundConfig& ground = config_.ground;
  ground.is_there = true;
  if (from["normal"]) read_unit(from["normal"], ground.normal, 3);
  ground.offset_m = from["offset_m"].number_or(0, kLengths);
  read_friction(from, &ground.params);
}

// With scenes of their own two devices would each lift another cube, and each dent another sheet.
void SceneParser::read_shared(const json::Value& scene) {
  const auto has = [&](MotionKind kind) {
    return std::any_of(config_.objects.begin(), config_.objects.end(),
                       [&](const ObjectConfig& object) { return object.motion.kind == kind; });
  };
  const bool has_body = has(MotionKind::kBody);
  const bool is_shared = scene["shared"].boolean_or(has_body || (options_.shares_soft && has(MotionKind::kSoft)));
  config_.is_shared = is_shared && config_.devices.size() > 1;
  if (is_shared || config_.devices.size() <= 1 || !has_body) return;
  scene["shared"].fail("is false for " + std::to_string(config_.devices.size()) +
                       " devices, and an object is a body: each would move another; leave it out, or set it to true");
}

void SceneParser::read_motion(const json::Value& from, Motion* motion) {
  motion->kind = static_cast<MotionKind>(from["kind"].choice({"fixed", "spin", "swing", "driven", "body", "soft"}));
  if (motion->kind == MotionKind::kBody) return read_body(from, &motion->body);
  if (motion->kind == MotionKind::kSoft) return read_soft(from, &motion->soft);
  const bool is_spin = motion->kind == MotionKind::kSpin, is_swing = motion->kind == MotionKind::kSwing;
  if (is_spin) from.allow_only({"kind", "axis", "rate_hz"}, " of a spin");
  if (is_swing) from.allow_only({"kind", "axis", "rate_hz", "amplitude_m"}, " of a swing");
  if (!is_spin && !is_swing) return from.allow_only({"kind"}, " of a motion that is neither spin nor swing");
  from["axis"].numbers(motion->axis, 3, {-1e6, 1e6});
  const double length = norm(motion->axis, 3);
  if (!(length > 1e-6)) from["axis"].fail("has length " + shown_number(length) + "; give a direction");
  // one that is of length 1 stays as it is, so that it reads back the same
  for (double& x : motion->axis)
    x = std::fabs(length - 1) <= kUnitAsItIs ? x : x / length;
  motion->rate_hz = from["rate_hz"].number({-100, 100, true, "Hz"});
  if (is_swing) motion->amplitude_m = from["amplitude_m"].number(from_0(1e6, "m"));
}

}  // namespace fdcg::dev
