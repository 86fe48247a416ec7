// SPDX-License-Identifier: Apache-2.0
// Optimizations of a scene do not change results: logs of scenes full of events are the same bit for bit for every combination
// of flags. FDCG_SCENE_TICKS in the environment sets the ticks of each run.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg::test;
using fdcg::bake::CompileOptions;
using fdcg::bake::Precision;

namespace {

std::size_t ticks_of_a_run(std::size_t usual) {
  const char* const asked = std::getenv("FDCG_SCENE_TICKS");
  return asked != nullptr ? static_cast<std::size_t>(std::atoi(asked)) : usual;
}

// FNV-1a over all results of the API.
class Log {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i)
      hash_ = (hash_ ^ byte[i]) * 0x100000001B3u;
  }
  void add(const fdcg_finger_result& felt) {
    add(felt.force_n, sizeof felt.force_n);
    add(&felt.flags, sizeof felt.flags);
    add(&felt.touch_count, sizeof felt.touch_count);
    for (std::uint32_t i = 0; i < felt.touch_count; ++i) {
      fdcg_touch touch = felt.touches[i];
      touch.object.generation = 0;  // another one in each scene
      add(&touch, sizeof touch);
    }
    add(&felt.overflowed_steps, sizeof felt.overflowed_steps);
    add(&felt.non_finite_steps, sizeof felt.non_finite_steps);
  }
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

struct Play {
  std::uint32_t objects, fingers, touches_per_finger;
  double room;       // half the side of the cube in which all this happens; objects have size 1 to 3
  double speed;      // of what moves
  double moving;     // share of the objects that move
  Place offset;      // of the whole world
  bool grow;         // scales change now and then
  bool come_and_go;  // objects and fingers are removed, added, disabled, reset; HIPs are not finite
};

struct Outcome {
  std::uint64_t hash = 0, touches = 0, crowded = 0, broadphase_updates = 0, steps = 0, several = 0;
};

// One actor: where it heads and how fast.
struct Course {
  Place at, heading;
  double speed;

  void go_on(Random& random, double room, double fastest) {
    if (random.chance(0.05)) heading = direction(random);
    if (random.chance(0.05)) speed = random.chance(0.3) ? 0 : fastest * random.unit() * random.unit();
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] += heading[k] * speed;
      if (std::abs(at[k]) > room) heading[k] = at[k] > 0 ? -std::abs(heading[k]) : std::abs(heading[k]);
    }
  }
};

struct Body {
  Course course;
  fdcg_object_id id;
  fdcg_pose pose;
  bool moves;
};
struct Hand {
  Course course;
  fdcg_finger_id id;
};

class Performance {
 public:
  Performance(const Play& play, const std::vector<const fdcg_graph*>& graphs, std::uint32_t disabled_optimizations,
              std::uint64_t seed)
      : play_(play), graphs_(graphs), random_(seed), scene_(config(play, disabled_optimizations)) {
    for (std::uint32_t i = 0; i < play.objects; ++i)
      bodies_.push_back(new_body());
    for (std::uint32_t i = 0; i < play.fingers; ++i) {
      Course course = {anywhere(), direction(random_), 0.01};
      hands_.push_back({course, scene_.add(placed(course.at))});
    }
  }

  Outcome run(std::size_t ticks) {
    Outcome outcome;
    Log log;
    for (std::size_t i = 0; i < ticks; ++i) {
      for (Body& body : bodies_)
        move(body);
      for (Hand& hand : hands_)
        move(hand);
      if (play_.come_and_go && random_.chance(0.05)) change_cast();
      scene_.step();
      for (const Hand& hand : hands_) {
        const fdcg_finger_result felt = scene_.result(hand.id);
        log.add(felt);
        outcome.touches += felt.touch_count;
        outcome.several += felt.touch_count > 1;
        outcome.crowded += (felt.flags & FDCG_FINGER_CONTACT_OVERFLOW) != 0;
        ++outcome.steps;
      }
    }
    std::vector<fdcg_reaction> reactions(play_.objects);
    fdcg_scene_get_reactions(scene_.get(), reactions.data(), play_.objects);
    log.add(reactions.data(), reactions.size() * sizeof reactions[0]);
    for (const Hand& hand : hands_)
      outcome.broadphase_updates += scene_.result(hand.id).broadphase_updates;
    outcome.hash = log.hash();
    return outcome;
  }

 private:
  static fdcg_scene_config config(const Play& play, std::uint32_t disabled_optimizations) {
    fdcg_scene_config config = fdcg_make_scene_config();
    config.object_capacity = play.objects;
    config.finger_capacity = play.fingers;
    config.touches_per_finger = play.touches_per_finger;
    config.disabled_optimizations = disabled_optimizations;
    return config;
  }
  Place anywhere() {
    return {random_.uniform(-play_.room, play_.room), random_.uniform(-play_.room, play_.room),
            random_.uniform(-play_.room, play_.room)};
  }
  Place placed(const Place& at) const { return {at[0] + play_.offset[0], at[1] + play_.offset[1], at[2] + play_.offset[2]}; }

  Body new_body() {
    Body body;
    body.course = {anywhere(), direction(random_), play_.speed * random_.unit()};
    body.moves = random_.chance(play_.moving);
    const bool is_plain = random_.chance(0.3);
    body.pose = is_plain ? posed(placed(body.course.at))
                         : posed(placed(body.course.at), direction(random_), random_.uniform(-3, 3), random_.uniform(0.5, 1.5));
    fdcg_params params = contact_params(random_.uniform(0.3, 0.8), random_.uniform(0, 0.3));
    if (random_.chance(0.5)) params.damping_n_s_per_m = 1;
    body.id = scene_.add(*graphs_[random_.below(static_cast<std::uint32_t>(graphs_.size()))], params, body.pose);
    return body;
  }
  void move(Body& body) {
    if (!body.moves) return;
    body.course.go_on(random_, play_.room, play_.speed);
    const Place at = placed(body.course.at);
    for (std::size_t k = 0; k < 3; ++k)
      body.pose.translation_m[k] = at[k];
    body.pose = turned(body.pose, body.course.heading, random_.chance(0.02) ? 1.5 : 0.2 * body.course.speed);
    if (play_.grow && random_.chance(0.01)) body.pose.scale = random_.uniform(0.5, 1.5);
    scene_.pose(body.id, body.pose);
  }
  void move(Hand& hand) {
    hand.course.go_on(random_, play_.room, play_.speed);
    if (random_.chance(0.002)) hand.course.at = anywhere();  // across everything in one tick
    if (random_.chance(0.1)) {                               // towards some object, and there to and fro
      const Place& aim = bodies_[hand.course.speed > 0.1 ? random_.below(play_.objects) : 0].course.at;
      const Place way = {aim[0] - hand.course.at[0], aim[1] - hand.course.at[1], aim[2] - hand.course.at[2]};
      const double length = std::hypot(way[0], way[1], way[2]) + 1e-9;
      hand.course.heading = {way[0] / length, way[1] / length, way[2] / length};
      hand.course.speed = std::max(hand.course.speed, 0.01);
    }
    Place hip = placed(hand.course.at);
    if (play_.come_and_go && random_.chance(0.01)) {
      const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300};
      hip[random_.below(3)] = bad[random_.below(3)];
    }
    scene_.move(hand.id, hip);
  }
  void change_cast() {
    Body& body = bodies_[random_.below(play_.objects)];
    Hand& hand = hands_[random_.below(play_.fingers)];
    const Place hip = placed(hand.course.at);
    switch (random_.below(6)) {
      case 0:
        fdcg_scene_remove_object(scene_.get(), body.id, nullptr);
        body = new_body();
        break;
      case 1:
        fdcg_scene_enable_object(scene_.get(), body.id, 0, nullptr);
        break;
      case 2:
        for (const Body& other : bodies_)
          fdcg_scene_enable_object(scene_.get(), other.id, 1, nullptr);
        break;
      case 3:
        fdcg_scene_reset_finger(scene_.get(), hand.id, hip.data(), nullptr);
        break;
      case 4:
        fdcg_scene_remove_finger(scene_.get(), hand.id, nullptr);
        hand.id = scene_.add(hip);
        break;
      default:
        fdcg_scene_step(scene_.get());  // a tick in which nothing moves
    }
  }

  const Play& play_;
  const std::vector<const fdcg_graph*>& graphs_;
  Random random_;
  SceneRig scene_;
  std::vector<Body> bodies_;
  std::vector<Hand> hands_;
};

}  // namespace

TEST_CASE("every combination of optimizations gives the same forces") {
  const Place here = {0, 0, 0};
  const Play plays[] = {
      {1, 1, 4, 3, 0.2, 0, here, false, false},                    // one finger, one still object
      {1, 2, 1, 4, 0.3, 1, here, true, false},                     // fast
      {40, 3, 4, 6, 0.02, 0.2, here, false, false},                // a tray
      {40, 3, 2, 2, 0.1, 0.5, here, true, true},                   // crowded
      {150, 8, 8, 9, 0.3, 1, here, true, true},                    // more than one run of the scan
      {20, 2, 4, 4, 0.1, 0.5, {1e6, -2e6, 3e5}, false, true},      // far from the world's origin
      {20, 2, 4, 4, 0.1, 0.5, {1e11, 1e11, 1e11}, false, false}};  // ... where rounding is 1e-5 of the objects
  std::vector<std::unique_ptr<CompiledMesh>> meshes;
  std::vector<const fdcg_graph*> graphs;
  for (const auto& soup : {cube(), thin_plate(0.01), ico_sphere(2), l_prism(), torus(24, 12)}) {
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      CompileOptions options;
      options.precision = precision;
      meshes.push_back(std::make_unique<CompiledMesh>(soup, options));
      graphs.push_back(&meshes.back()->view());
    }
  }
  std::uint64_t crowded = 0, several = 0;
  int number = 0;
  for (const Play& play : plays) {
    const std::size_t ticks = ticks_of_a_run(play.objects > 100 ? 300 : 1500);
    const std::uint64_t seed = 41 + static_cast<std::uint64_t>(number);
    const Outcome all = Performance(play, graphs, 0, seed).run(ticks);
    INFO("play " << number++ << ", seed " << seed << ": " << all.touches << " touches, " << all.crowded << " crowded, "
                 << all.broadphase_updates << " broadphase updates in " << all.steps << " steps");
    CHECK(all.touches > all.steps / 100);
    CHECK(all.broadphase_updates < all.steps);
    crowded += all.crowded;
    several += all.several;
    for (std::uint32_t disabled = 1; disabled <= FDCG_OPT_ALL; ++disabled) {
      const Outcome some = Performance(play, graphs, disabled, seed).run(ticks);
      CAPTURE(disabled);
      CHECK(some.hash == all.hash);
      if ((disabled & FDCG_OPT_OUT_OF_REACH) != 0) CHECK(some.broadphase_updates > all.broadphase_updates);
    }
  }
  CHECK(crowded > 0);
  CHECK(several > 0);
}
