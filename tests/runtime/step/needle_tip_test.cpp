// SPDX-License-Identifier: Apache-2.0
// Hands at points: cones, needles, crowns, rings and rows of needles of 100 to 10,000 sides, at 0.1 to 1 m/s and 1 kHz. In the
// tick in which a hand gets inside it feels a force, and no larger one than a spring as long as its way.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "hand_probe.hpp"
#include "pointed_bodies.hpp"
#include "scene_rig.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

constexpr double kSpeeds[] = {0.1, 0.3, 1};

CompileOptions exact_options(Precision precision) {
  CompileOptions options;
  options.precision = precision;
  options.coplanar.kind = fdcg::bake::Coplanar::Kind::exact;
  options.merge = false;
  options.store_planes = precision == Precision::f64;
  return options;
}

fdcg_params params_of(int i) {
  fdcg_params params = i % 2 == 0 ? contact_params(0.6, 0.42) : contact_params(0, 0);
  params.stiffness_n_per_m = 1000;
  return params;
}

void check(const HandReport& report, Precision precision) {
  CHECK(report.forceless_ticks == 0);
  CHECK(report.longest_forceless == 0);
  CHECK(report.worst_first_force <= (precision == Precision::f64 ? 1 + 1e-9 : 1.02));
}

// As a user compiles: faces merged within the numbers' quantum.
CompileOptions default_options(Precision precision) {
  CompileOptions options;
  options.precision = precision;
  return options;
}

void approach_all(const PointedBody& body, const CompileOptions& options, int ways, std::uint64_t seed) {
  const Precision precision = options.precision;
  const CompiledMesh mesh(body.soup, options);
  const ExactSolid solid(body.soup, *mesh.view().header);
  Random random(seed);
  for (const Approach approach : kApproaches) {
    for (const double speed : kSpeeds) {
      for (int i = 0; i < ways; ++i) {
        const PointedBody::Tip& tip = body.tips[random.below(static_cast<std::uint32_t>(body.tips.size()))];
        INFO(name_of(approach) << " at " << speed << " m/s, way " << i);
        check(probe_hand(mesh.view(), solid, params_of(i), hand_way(tip, approach, speed, random)), precision);
      }
    }
  }
}

// Of a rotation by `angle` about `axis`, a unit vector.
Rotation rotation_about(const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  return {Vec3{c + axis.x * axis.x * d, axis.x * axis.y * d - axis.z * s, axis.x * axis.z * d + axis.y * s},
          Vec3{axis.y * axis.x * d + axis.z * s, c + axis.y * axis.y * d, axis.y * axis.z * d - axis.x * s},
          Vec3{axis.z * axis.x * d - axis.y * s, axis.z * axis.y * d + axis.x * s, c + axis.z * axis.z * d}};
}

}  // namespace

TEST_CASE("a hand inside a point has a force in the same tick, whatever the fan") {
  for (const PointedKind kind : kPointedKinds) {
    for (const int sides : {100, 500, 2000}) {
      const PointedBody body = pointed_body(kind, sides, random_rotation(static_cast<std::uint64_t>(sides)));
      for (const Precision precision : {Precision::f64, Precision::f32}) {
        INFO(name_of(kind) << ", " << sides << " sides, " << (precision == Precision::f64 ? "f64" : "f32"));
        approach_all(body, exact_options(precision), 2, 7);
      }
    }
  }
}

TEST_CASE("the same of files compiled by default settings") {
  for (const PointedKind kind : kPointedKinds) {
    for (const int sides : {100, 2000, 5000}) {
      const PointedBody body = pointed_body(kind, sides, random_rotation(static_cast<std::uint64_t>(sides)));
      for (const Precision precision : {Precision::f64, Precision::f32}) {
        INFO(name_of(kind) << ", " << sides << " sides, " << (precision == Precision::f64 ? "f64" : "f32"));
        approach_all(body, default_options(precision), 1, 9);
      }
    }
  }
}

TEST_CASE("ten thousand sides: no tick's work runs out") {
  for (const PointedKind kind : {PointedKind::cone, PointedKind::needle, PointedKind::flat, PointedKind::crown}) {
    const PointedBody body = pointed_body(kind, 10'000, random_rotation(3));
    const CompiledMesh mesh(body.soup, exact_options(Precision::f64));
    const ExactSolid solid(body.soup, *mesh.view().header);
    Random random(11);
    for (const Approach approach : kApproaches) {
      INFO(name_of(kind) << ", " << name_of(approach));
      const HandReport report = probe_hand(mesh.view(), solid, params_of(0), hand_way(body.tips[0], approach, 1, random));
      check(report, Precision::f64);
      CHECK(report.carried_ticks == 0);
    }
  }
}

// contact-model BOUND-2: such a tick ends on the feature that lets go, and the next one has all its work for the sweep. Where
// something has let go before, no nearer than the tick began, it does not wait: one tick of 10^5 here.
TEST_CASE("a tick that has walked past dozens of needles does not end in the sweep of what lets go") {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const PolygonSoup strip = needle_strip(1500, 0.5, 3);
    const CompiledMesh mesh(strip, exact_options(precision));
    Random random(5);
    const fdcg_params params = contact_params(0, 0);
    fdcg_contact contact = {};
    int walked = 0, ended = 0;
    for (int i = 0; i < 20'000; ++i) {
      const double hip[] = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.3, 0.3)};
      for (int held = 0; held < 10; ++held) {
        fdcg_result result;
        fdcg_step(&mesh.view(), &params, &contact, hip, &result);
        const bool has_walked = result.transitions > 40;
        walked += has_walked;
        ended += has_walked && (result.flags & FDCG_RESULT_SWEEP_BOUND) != 0;
      }
    }
    INFO(walked << " ticks have walked, " << ended << " of them ended in a sweep");
    CHECK(walked > 1000);
    CHECK(ended <= 1);
  }
}

TEST_CASE("needles along each axis, hit tip first and sideways") {
  const double quarter = std::acos(0.0);
  const Rotation turns[] = {rotation_about({0, 0, 1}, 0),       rotation_about({1, 0, 0}, 2 * quarter),
                            rotation_about({1, 0, 0}, quarter), rotation_about({1, 0, 0}, -quarter),
                            rotation_about({0, 1, 0}, quarter), rotation_about({0, 1, 0}, -quarter)};
  for (const Rotation& turn : turns) {
    for (const PointedKind kind : {PointedKind::wall, PointedKind::needle, PointedKind::cone}) {
      INFO(name_of(kind) << " up " << rotated(turn, {0, 0, 1}).x << ' ' << rotated(turn, {0, 0, 1}).y);
      approach_all(pointed_body(kind, 200, turn), exact_options(Precision::f64), 1, 5);
    }
  }
}

// From a quarter of the body's height above the apex, over the rim, to a place below it: near the apex by the rounding of the
// body's length, which is more than its height, and from the apex itself the way would lead inside.
TEST_CASE("a way past the apex of a body thinner than the rounding of its length meets nothing, by exact signs") {
  constexpr double kHeight = 0x1p-20;
  PolygonSoup disc = cone(40);
  for (fdcg::bake::Vec3& p : disc.points)
    p.z *= kHeight / 2;
  const CompiledMesh mesh(rounded_to_float(disc), exact_options(Precision::f32));
  REQUIRE(mesh.view().header->busy_count > 0);
  REQUIRE(mesh.view().header->max_deviation == 0);
  Contact contact(mesh.view(), params_of(1));
  contact.step(0, 0, 0.75 * kHeight);
  contact.step(2, 0, -1.71875 * kHeight);
  INFO(contact.describe());
  CHECK(contact.result.transitions == 0);
  CHECK(contact.result.state == FDCG_FREE);
}

TEST_CASE("an object that comes at a still hand, tip first, is felt in the tick in which it has the hand inside") {
  const PointedBody body = pointed_body(PointedKind::cone, 1000, random_rotation(9));
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const CompiledMesh mesh(body.soup, exact_options(precision));
    const ExactSolid solid(body.soup, *mesh.view().header);
    const double rounding = precision == Precision::f64 ? 1e-12 : 1e-6;
    Random random(13);
    int inside = 0;
    for (const double speed : kSpeeds) {
      SceneRig scene(fdcg_make_scene_config());
      const Place hand = {0.3, -0.2, 0.1};
      const Vec3 axis = random.direction();
      const std::vector<Hip> way = hand_way(body.tips[0], Approach::along_axis, speed, random);
      fdcg_object_id object = {};
      fdcg_finger_id finger = {};
      for (std::size_t i = 0; i < way.size(); ++i) {
        // Where the hand is at way[i] in the object's frame, which turns a little in each tick.
        const double angle = 0.3 + 1e-3 * static_cast<double>(i);
        const Vec3 at = rotated(rotation_about(axis, angle), vec_of(way[i]));
        const fdcg_pose pose = posed({hand[0] - at.x, hand[1] - at.y, hand[2] - at.z}, {axis.x, axis.y, axis.z}, angle);
        if (i == 0) {
          object = scene.add(mesh.view(), params_of(1), pose);
          finger = scene.add(hand);
        }
        scene.pose(object, pose);
        scene.step();
        const fdcg_finger_result felt = scene.result(finger);
        const double* origin = mesh.view().header->origin;
        const Hip local = {way[i][0] - origin[0], way[i][1] - origin[1], way[i][2] - origin[2]};
        if (solid.where(local) != ExactSolid::Where::inside || solid.distance_to_surface(local) < rounding) continue;
        ++inside;
        INFO("at " << speed << " m/s, tick " << i);
        CHECK(norm({felt.force_n[0], felt.force_n[1], felt.force_n[2]}) > 0);
      }
    }
    CHECK(inside > 50);
  }
}

TEST_CASE("faces of a busy corner stand together in the file, and nothing else is moved") {
  const auto body = pointed_body(PointedKind::ring, 200, random_rotation(1));
  const CompiledMesh mesh(body.soup, exact_options(Precision::f64));
  const fdcg_graph& graph = mesh.view();
  REQUIRE(graph.fan_run_count == 2 * body.tips.size());  // of each needle its tip, and its floor's
  std::uint32_t end = graph.fan_runs[0].first_node;
  for (std::uint32_t i = 0; i < graph.fan_run_count; ++i) {
    CHECK(graph.fan_runs[i].first_node == end);
    end += graph.fan_runs[i].node_count;
    CHECK(graph.fan_runs[i].flags == 0);
  }
  CHECK(end == graph.header->node_count);
  const CompiledMesh round(ico_sphere(3));
  CHECK(round.view().fan_run_count == 0);
  CHECK(round.view().fan_runs == nullptr);
}

TEST_CASE("a file with fan runs out of range is refused by name") {
  const auto compiled = fdcg::bake::compile(cone(100), {});
  REQUIRE(compiled);
  struct Damage {
    std::size_t byte;
    unsigned char value;
  };
  for (const Damage& damage : {Damage{0, 1}, Damage{3, 0x7F}, Damage{4, 0}, Damage{7, 0x7F}, Damage{8, 200}, Damage{12, 2}}) {
    AlignedBytes file(compiled->bytes);
    auto* const sections = reinterpret_cast<fdcg_section*>(file.data() + sizeof(fdcg_header));
    for (std::uint32_t i = 0; i < file.header().section_count; ++i) {
      if (sections[i].id == FDCG_SECTION_FAN_RUNS) file.data()[sections[i].offset + damage.byte] = damage.value;
    }
    seal(file);
    fdcg_graph graph;
    fdcg_error error = {};
    INFO("byte " << damage.byte);
    CHECK(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_GRAPH);
    CHECK_THAT(error.message, Catch::Matchers::ContainsSubstring("fan run 0"));
  }
}
