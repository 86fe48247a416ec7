// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "shared/text.hpp"

namespace fdcg::dev {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr std::uint32_t kTouchesPerPoint = 3;  // a point in a corner of three objects

// The support point of a surface in a unit direction; of a torus, on its outside.
void farthest(const fdcg_surface& surface, const double d[3], double p[3]) {
  const double across = std::hypot(d[0], d[1]), end = d[2] > 0 ? 1 : -1, r = surface.radius_m;
  const double round[2] = {across > 0 ? d[0] / across : 1, across > 0 ? d[1] / across : 0};
  const double* const h = surface.half_m;
  const double rim = surface.kind == FDCG_SURFACE_CONE && d[2] > 0 ? surface.top_radius_m : r;
  double length = 0;
  for (int k = 0; k < 3; ++k)
    length += h[k] * h[k] * d[k] * d[k];
  length = std::sqrt(length);
  for (int k = 0; k < 3; ++k) {
    const double flat = k == 2 ? end * surface.length_m / 2 : rim * round[k];
    const double ring = k == 2 ? 0 : r * round[k];
    const double ball = r * d[k] + (k == 2 ? end * surface.length_m / 2 : 0);
    switch (surface.kind) {
      case FDCG_SURFACE_SPHERE:
      case FDCG_SURFACE_CAPSULE:
        p[k] = ball;
        break;
      case FDCG_SURFACE_TORUS:
        p[k] = ring + surface.tube_radius_m * d[k];
        break;
      case FDCG_SURFACE_BOX:
        p[k] = std::copysign(h[k], d[k]);
        break;
      case FDCG_SURFACE_ELLIPSOID:
        p[k] = h[k] * h[k] * d[k] / length;
        break;
      default:
        p[k] = flat;
    }
  }
}

// Both ends of the axis, and rings of 4, 8, ... 8, 4 points between them: at most `most`, symmetric about the axis, so that a
// ball does not roll by itself.
std::vector<double> points_of(const fdcg_surface& surface, int most) {
  std::vector<double> points_m;
  const auto add = [&](double polar, double azimuth) {
    const double d[3] = {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
    double p[3];
    farthest(surface, d, p);
    for (std::size_t at = 0; at < points_m.size(); at += 3)
      if (std::equal(p, p + 3, points_m.data() + at)) return;
    if (points_m.size() < 3 * static_cast<std::size_t>(most)) points_m.insert(points_m.end(), p, p + 3);
  };
  int rings = 2;
  while ((rings + 2) * (rings + 2) + 2 <= most)
    rings += 2;
  add(kPi, 0);
  add(0, 0);
  for (int ring = 1; ring < rings; ++ring) {
    const int count = 4 * std::min(ring, rings - ring);
    for (int i = 0; i < count; ++i)
      add(kPi * ring / rings, 2 * kPi * (i + 0.5) / count);
  }
  return points_m;
}

// From the centre of mass of a surface, which lies on its axis, to its farthest point at most.
double reach_of(const fdcg_surface& surface, double scale) {
  double half_diagonal = 0;
  for (const double half : surface.half_m)
    half_diagonal += half * half;
  return scale * (std::sqrt(half_diagonal) + std::max(surface.radius_m, surface.top_radius_m) + surface.tube_radius_m +
                  surface.length_m);
}

// From the centre of mass to the farthest corner of the bounds, world.
double reach_of(const fdcg_graph& graph, const fdcg_body_config& body, double scale) {
  const fdcg_header& header = *graph.header;
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double low = (header.bounds_min[i] + header.origin[i]) * header.metres_per_unit - body.centre_m[i];
    const double high = (header.bounds_max[i] + header.origin[i]) * header.metres_per_unit - body.centre_m[i];
    square += std::max(low * low, high * high);
  }
  return std::sqrt(square) * scale;
}

class Builder {
 public:
  Builder(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
          const std::vector<fdcg_object_id>& objects, DeviceScene* scene, DeviceSetup* setup)
      : config_(config), load_(load), graphs_(graphs), objects_(objects), scene_(*scene), setup_(*setup) {}

  std::string build() {
    int points = 0;
    for (const ObjectConfig& object : config_.objects)
      points += is_body(object) ? object.motion.body.points : 0;
    if (points == 0) return {};
    if (!make_pile(static_cast<std::uint32_t>(points))) return config_.scene_file + ": its bodies: " + error_.message;
    for (std::size_t i = 0; i < config_.objects.size(); ++i) {
      if (config_.objects[i].motion.kind == MotionKind::kSoft) continue;  // bodies do not collide with it
      const std::string problem = is_body(config_.objects[i]) ? add_body(i) : add_fixed(i);
      if (!problem.empty()) return place_of(config_, i) + problem;
    }
    hand_over();
    return set_steps();
  }

 private:
  static bool is_body(const ObjectConfig& object) { return object.motion.kind == MotionKind::kBody; }
  bool make_pile(std::uint32_t points);
  std::string weigh(std::size_t index, fdcg_body_config* body);
  std::string add_body(std::size_t index);
  bool add_points(std::size_t index);
  std::string add_fixed(std::size_t index);
  void hand_over();
  std::string set_steps();

  const HostConfig& config_;
  const SceneLoad load_;
  const SceneGraphs& graphs_;
  const std::vector<fdcg_object_id>& objects_;
  DeviceScene& scene_;
  DeviceSetup& setup_;
  fdcg_pile* pile_ = nullptr;
  std::uint32_t substeps_ = 1;
  fdcg_error error_{};
};

bool Builder::make_pile(std::uint32_t points) {
  fdcg_pile_config capacities = fdcg_make_pile_config();
  capacities.object_capacity = static_cast<std::uint32_t>(objects_.size());
  capacities.point_capacity = points;
  capacities.touch_capacity = kTouchesPerPoint * points;
  const std::uint64_t bytes = fdcg_pile_bytes(&capacities);
  scene_.pile_memory.assign(static_cast<std::size_t>(bytes / sizeof(std::uint64_t) + 1), 0);
  if (fdcg_pile_create(scene_.pile_memory.data(), bytes, &capacities, &pile_, &error_) != FDCG_OK) return false;
  const GroundConfig& ground = config_.ground;
  return !ground.is_there || fdcg_pile_set_ground(pile_, ground.normal, ground.offset_m, &ground.params, &error_) == FDCG_OK;
}

// Mass, centre and inertia as the scene or the graph's file says.
std::string Builder::weigh(std::size_t index, fdcg_body_config* body) {
  const ObjectConfig& object = config_.objects[index];
  fdcg_mass mass{};
  const fdcg_status status = object.is_surface ? fdcg_surface_get_mass(&object.surface, &mass, &error_)
                                               : fdcg_get_mass(&graphs_.of_object(index), &mass, &error_);
  if (status != FDCG_OK) return error_.message;
  const double scale = object.pose.scale;
  double density = object.motion.body.density_kg_per_m3;
  if (object.motion.body.mass_kg > 0) density = object.motion.body.mass_kg / (mass.volume_m3 * scale * scale * scale);
  if (density == 0 && mass.density_kg_per_m3 == 0) {
    return "nothing says what it weighs; give \"motion\" a \"mass_kg\" or a \"density_kg_per_m3\"";
  }
  return fdcg_body_set_mass(body, &mass, density, scale, &error_) == FDCG_OK ? std::string() : error_.message;
}

bool Builder::add_points(std::size_t index) {
  const ObjectConfig& object = config_.objects[index];
  const int most = object.motion.body.points;
  std::vector<double> points_m(3 * static_cast<std::size_t>(most));
  auto count = static_cast<std::uint32_t>(most);
  if (object.is_surface) {
    points_m = points_of(object.surface, most);
    count = static_cast<std::uint32_t>(points_m.size() / 3);
  } else if (fdcg_pick_points(&graphs_.of_object(index), reinterpret_cast<double(*)[3]>(points_m.data()), count, &count,
                              &error_) != FDCG_OK) {
    return false;
  }
  const auto points = reinterpret_cast<const double(*)[3]>(points_m.data());
  return fdcg_pile_add(pile_, setup_.scene, objects_[index], points, count, &error_) == FDCG_OK;
}

std::string Builder::add_body(std::size_t index) {
  const ObjectConfig& object = config_.objects[index];
  const BodyConfig& from = object.motion.body;
  fdcg_body_config config = fdcg_make_body_config();
  if (std::string problem = weigh(index, &config); !problem.empty()) return problem;
  std::copy_n(config_.gravity_m_per_s2, 3, config.gravity_m_per_s2);
  config.linear_damping_per_s = from.linear_damping_per_s;
  config.angular_damping_per_s = from.angular_damping_per_s;
  fdcg_scene_body body{};
  body.object = objects_[index];
  if (fdcg_body_init(&body.body, &config, &object.pose, &error_) != FDCG_OK) return error_.message;
  if (!add_points(index)) return error_.message;
  // All contacts may press on it at once. The pile holds its own springs within bounds.
  const double stiffness_n_per_m = object.params.stiffness_n_per_m * load_.contact_count;
  const double tick_s = 1 / load_.fastest_hz;
  const double far_m = object.is_surface ? reach_of(object.surface, object.pose.scale)
                                         : reach_of(graphs_.of_object(index), config, object.pose.scale);
  // A pad's spring against turning has its stiffness times its radius squared.
  const double arm_m = std::hypot(far_m, load_.pad_m);
  const std::uint32_t substeps = fdcg_body_get_substeps(&body.body, stiffness_n_per_m, arm_m, tick_s);
  if (substeps == 0) {
    return "with " + shown_number(config.mass_kg) + " kg it is too light for " + std::to_string(load_.contact_count) +
           (load_.contact_count == 1 ? " contact of " : " contacts of ") + shown_number(object.params.stiffness_n_per_m) +
           " N/m each: it would need more than " + std::to_string(FDCG_BODY_MAX_SUBSTEPS) +
           " steps a tick; make it heavier, or softer (stiffness_n_per_m)";
  }
  substeps_ = std::max(substeps_, substeps);
  scene_.bodies.push_back(body);
  return {};
}

std::string Builder::add_fixed(std::size_t index) {
  const fdcg_status status = fdcg_pile_add(pile_, setup_.scene, objects_[index], nullptr, 0, &error_);
  return status == FDCG_OK ? std::string() : error_.message;
}

void Builder::hand_over() {
  scene_.reactions.resize(objects_.size());
  setup_.bodies = scene_.bodies.data();
  setup_.body_count = static_cast<std::uint32_t>(scene_.bodies.size());
  setup_.substeps = substeps_;
  setup_.pile = pile_;
  setup_.reactions = scene_.reactions.data();
  setup_.reaction_count = static_cast<std::uint32_t>(objects_.size());
}

// Damping depends on the time between two steps, here a substep.
std::string Builder::set_steps() {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    fdcg_params params = config_.objects[i].params;
    params.tick_s = 1 / load_.fastest_hz / substeps_;
    if (fdcg_scene_set_params(setup_.scene, objects_[i], &params, &error_) != FDCG_OK) {
      return place_of(config_, i) + error_.message;
    }
  }
  return {};
}

}  // namespace

std::string place_of(const HostConfig& config, std::size_t object) {
  return config.scene_file + ": objects[" + std::to_string(object) + "] '" + config.objects[object].name + "': ";
}

std::string build_bodies(const HostConfig& config, const SceneLoad& load, const SceneGraphs& graphs,
                         const std::vector<fdcg_object_id>& objects, DeviceScene* scene, DeviceSetup* setup) {
  return Builder(config, load, graphs, objects, scene, setup).build();
}

}  // namespace fdcg::dev
