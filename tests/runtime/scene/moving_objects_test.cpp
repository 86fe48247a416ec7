// SPDX-License-Identifier: Apache-2.0
// Objects that move, turn and grow, against fingers that are still or move. FDCG_SCENE_TICKS in the environment sets the ticks
// of each run.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

int ticks_of_a_run(int usual) {
  const char* const asked = std::getenv("FDCG_SCENE_TICKS");
  return asked != nullptr ? std::atoi(asked) : usual;
}

// ---- by hand
// -----------------------------------------------------------------------------------------------------------------

// The same contact without a scene: the formulas of scene.h, fdcg_step in every tick.
struct ByHand {
  fdcg_contact contact = {};
  fdcg_result result = {};
  double force[3] = {}, god_object[3] = {};

  void step(const fdcg_graph& graph, const fdcg_params& params, const fdcg_pose& pose, const Place& hip) {
    const double length =
        std::sqrt(pose.rotation_xyzw[0] * pose.rotation_xyzw[0] + pose.rotation_xyzw[1] * pose.rotation_xyzw[1] +
                  pose.rotation_xyzw[2] * pose.rotation_xyzw[2] + pose.rotation_xyzw[3] * pose.rotation_xyzw[3]);
    const double x = pose.rotation_xyzw[0] / length, y = pose.rotation_xyzw[1] / length, z = pose.rotation_xyzw[2] / length,
                 w = pose.rotation_xyzw[3] / length;
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    double t[3], local[3];
    for (int k = 0; k < 3; ++k)
      t[k] = hip[k] - pose.translation_m[k];
    for (int k = 0; k < 3; ++k)
      local[k] = (r[0][k] * t[0] + r[1][k] * t[1] + r[2][k] * t[2]) / pose.scale;
    fdcg_step(&graph, &params, &contact, local, &result);
    for (int k = 0; k < 3; ++k) {
      const double *f = result.force_n, *g = result.god_object_m;
      force[k] = (r[k][0] * f[0] + r[k][1] * f[1] + r[k][2] * f[2]) * pose.scale;
      god_object[k] = (r[k][0] * g[0] + r[k][1] * g[1] + r[k][2] * g[2]) * pose.scale + pose.translation_m[k];
    }
  }
};

// ---- how things move
// ---------------------------------------------------------------------------------------------------------

// Speeds in sizes a tick, the size being the bounding sphere's diameter.
struct Motion {
  const char* name;
  double speed;         // of the object's middle
  double acceleration;  // of the same, a tick
  double turn_rad;      // a tick
  double growth;        // of the scale, a tick, as a share
  double hand;          // speed of the HIP
};

constexpr Motion kMotions[] = {{"object still, hand slow", 0, 0, 0, 0, 0.01},
                               {"object slow, hand still", 0.01, 0, 0, 0, 0},
                               {"object one size a tick, hand still", 1, 0, 0, 0, 0},
                               {"object turns, hand still", 0, 0, 0.05, 0, 0},
                               {"object turns fast, hand still", 0, 0, 1, 0, 0},
                               {"object moves and turns, hand still", 0.3, 0, 0.2, 0, 0},
                               {"object accelerates", 0.001, 0.02, 0.02, 0, 0},
                               {"object and hand move", 0.1, 0, 0.1, 0, 0.1},
                               {"both fast", 1, 0, 0.5, 0, 1},
                               {"object breathes", 0, 0, 0.01, 0.05, 0},
                               {"everything", 0.1, 0.01, 0.1, 0.05, 0.1}};

// An object that wanders about a place and a hand that wanders about the same place: they meet again and again.
class Encounter {
 public:
  Encounter(const Motion& motion, double size, std::uint64_t seed)
      : motion_(motion), size_(size), random_(seed), axis_(direction(random_)), heading_(direction(random_)) {
    // the still hand is beside the object, at any place that the object may pass over
    hip = {0.9 * size, 0.07 * size, -0.03 * size};
  }

  void tick() {
    if (random_.chance(0.1)) axis_ = direction(random_);
    const double away = std::hypot(pose.translation_m[0], pose.translation_m[1], pose.translation_m[2]);
    if (random_.chance(0.1) || away > 1.5 * size_) {
      // mostly towards the hand, so that it is met
      const Place aim = {hip[0] + random_.uniform(-0.3, 0.3) * size_ - pose.translation_m[0],
                         hip[1] + random_.uniform(-0.3, 0.3) * size_ - pose.translation_m[1],
                         hip[2] + random_.uniform(-0.3, 0.3) * size_ - pose.translation_m[2]};
      const double length = std::hypot(aim[0], aim[1], aim[2]) + 1e-300;
      heading_ = {aim[0] / length, aim[1] / length, aim[2] / length};
      speed_ = motion_.speed * random_.unit();
    }
    speed_ = std::min(speed_ + motion_.acceleration * random_.unit(), 1.0);
    if (motion_.speed > 0 || motion_.acceleration > 0) {
      for (int k = 0; k < 3; ++k)
        pose.translation_m[k] += speed_ * size_ * heading_[static_cast<std::size_t>(k)];
    }
    if (motion_.turn_rad > 0) pose = turned(pose, axis_, motion_.turn_rad * random_.unit());
    if (motion_.growth > 0) {
      pose.scale *= 1 + motion_.growth * random_.uniform(-1, 1);
      pose.scale = std::min(2.0, std::max(0.5, pose.scale));
    }
    if (motion_.hand > 0) {
      const Place d = direction(random_);
      const double step = motion_.hand * size_ * random_.unit();
      for (std::size_t k = 0; k < 3; ++k)
        hip[k] += step * d[k] - 0.02 * (hip[k] - pose.translation_m[k]);
    }
  }

  Place hip;
  fdcg_pose pose = posed({0, 0, 0});

 private:
  const Motion& motion_;
  double size_;
  Random random_;
  Place axis_, heading_;
  double speed_ = 0;
};

std::vector<fdcg::bake::PolygonSoup> bodies() {
  return {cube(), thin_plate(0.001), ico_sphere(2), l_prism(), torus(24, 12), star_sphere(2, 0.3, 5), cone(30)};
}

double size_of(const fdcg_graph& graph) {
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double side = (graph.header->bounds_max[k] - graph.header->bounds_min[k]) * graph.header->metres_per_unit;
    square += side * side;
  }
  return std::sqrt(square);
}

bool same_bits(const double (&a)[3], const double (&b)[3]) {
  for (int k = 0; k < 3; ++k) {
    const double x = a[k] + 0.0, y = b[k] + 0.0;  // -0 is 0
    if (std::memcmp(&x, &y, sizeof x) != 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a scene gives the bits of contacts stepped by hand") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    for (const auto& body : bodies()) {
      CompileOptions options;
      options.precision = precision;
      const CompiledMesh mesh(body, options);
      const double size = size_of(mesh.view());
      std::uint64_t touched = 0, ticks = 0;
      for (const Motion& motion : kMotions) {
        if (motion.turn_rad > 0.3) continue;  // by hand the straight way may cut through what the arc passes by
        INFO(body.name << ", " << motion.name << ", precision " << static_cast<int>(precision));
        fdcg_params params = contact_params(0.5, 0.3);
        params.damping_n_s_per_m = 0.5;
        Encounter encounter(motion, size, 11);
        SceneRig scene(fdcg_make_scene_config());
        const fdcg_object_id object = scene.add(mesh.view(), params, encounter.pose);
        const fdcg_finger_id finger = scene.add(encounter.hip);
        ByHand hand;
        for (int i = 0; i < ticks_of_a_run(3000); ++i) {
          if (i > 0) encounter.tick();
          scene.pose(object, encounter.pose);
          scene.move(finger, encounter.hip);
          scene.step();
          hand.step(mesh.view(), params, encounter.pose, encounter.hip);
          const fdcg_finger_result felt = scene.result(finger);
          CAPTURE(i);
          REQUIRE(same_bits(felt.force_n, hand.force));
          const bool is_carried_over = (hand.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0;
          REQUIRE(felt.touch_count == (hand.result.state != FDCG_FREE || is_carried_over ? 1 : 0));
          REQUIRE(((felt.flags & FDCG_FINGER_BOUNDED) != 0) ==
                  ((hand.result.flags & ~std::uint32_t{FDCG_RESULT_NON_FINITE}) != 0));
          ++ticks;
          if (felt.touch_count == 0) continue;
          ++touched;
          REQUIRE(same_bits(felt.touches[0].god_object_m, hand.god_object));
          REQUIRE(felt.touches[0].state == hand.result.state);
          REQUIRE(felt.touches[0].feature == hand.result.feature);
          REQUIRE(felt.touches[0].slipping == hand.result.slipping);
        }
      }
      CHECK(touched > ticks / 100);
    }
  }
}

TEST_CASE("nothing falls through") {
  for (const auto& body : bodies()) {
    const CompiledMesh mesh(body);
    const double size = size_of(mesh.view());
    for (const double scale : {1.0, 0.01, 50.0}) {
      std::uint64_t inside = 0, touched = 0, carried_over = 0, ticks = 0;
      for (const Motion& motion : kMotions) {
        INFO(body.name << " times " << scale << ", " << motion.name);
        Encounter encounter(motion, size * scale, 23);
        encounter.pose.scale = scale;
        if (motion.growth > 0 && scale != 1) continue;
        SceneRig scene(fdcg_make_scene_config());
        const fdcg_object_id object = scene.add(mesh.view(), contact_params(0.3, 0.2), encounter.pose);
        const fdcg_finger_id finger = scene.add(encounter.hip);
        for (int i = 0; i < ticks_of_a_run(600); ++i) {
          if (i > 0) encounter.tick();
          scene.pose(object, encounter.pose);
          scene.move(finger, encounter.hip);
          scene.step();
          const fdcg_finger_result felt = scene.result(finger);
          ++ticks;
          touched += felt.touch_count;
          carried_over += felt.touch_count > 0 && felt.touches[0].state == FDCG_FREE;
          ByHand where;  // only for its way into the object's frame
          where.step(mesh.view(), contact_params(0, 0), encounter.pose, encounter.hip);
          const Hip local = {where.contact.hip[0] + mesh.view().header->origin[0],
                             where.contact.hip[1] + mesh.view().header->origin[1],
                             where.contact.hip[2] + mesh.view().header->origin[2]};
          if (winding_number(body, local) < 0.5) continue;
          ++inside;
          if (felt.touch_count > 0) continue;
          CAPTURE(i, local[0], local[1], local[2]);
          CHECK(distance(local, closest_point(body, local)) < 1e-12 * size);  // on the surface within rounding
        }
      }
      INFO(body.name << ": inside " << inside << ", touched " << touched << ", carried over " << carried_over << " of "
                     << ticks);
      CHECK(carried_over < ticks / 50);
      CHECK(touched > ticks / 100);
      CHECK(inside > 0);
    }
  }
}
