// SPDX-License-Identifier: Apache-2.0
// Scenes full of events, for tests that compare what is felt in them bit for bit: objects and fingers that wander, meet, come
// and go. FDCG_SCENE_TICKS in the environment sets the ticks of each run.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "fdcg/scene_state.h"
#include "meshes.hpp"
#include "scene_rig.hpp"

namespace fdcg::test {

inline std::size_t ticks_of_a_run(std::size_t usual) {
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
  const fdcg_graph* graph;
  fdcg_pose pose;
  bool moves;
};
struct Hand {
  Course course;
  fdcg_finger_id id;
};

inline std::vector<std::uint64_t> saved_state(const fdcg_scene* scene) {
  std::vector<std::uint64_t> state(fdcg_scene_state_bytes(scene) / 8);
  fdcg_error error;
  if (fdcg_scene_save(scene, state.data(), state.size() * 8, &error) != FDCG_OK) throw std::runtime_error(error.message);
  return state;
}

class Performance {
 public:
  Performance(const Play& play, const std::vector<const fdcg_graph*>& graphs, std::uint32_t disabled_optimizations,
              std::uint64_t seed)
      : play_(play),
        graphs_(graphs),
        random_(seed),
        config_(config(play, disabled_optimizations)),
        scene_(std::make_unique<SceneRig>(config_)) {
    for (std::uint32_t i = 0; i < play.objects; ++i)
      bodies_.push_back(new_body());
    for (std::uint32_t i = 0; i < play.fingers; ++i) {
      Course course = {anywhere(), direction(random_), 0.01};
      hands_.push_back({course, scene_->add(placed(course.at))});
    }
  }

  // `move_every` ticks it all goes on in another scene, from the state of the one before; 0: never.
  Outcome run(std::size_t ticks, std::size_t move_every = 0) {
    Outcome outcome;
    Log log;
    for (std::size_t i = 0; i < ticks; ++i) {
      if (move_every != 0 && i % move_every == move_every - 1) move_to_another_scene();
      for (Body& body : bodies_)
        move(body);
      for (Hand& hand : hands_)
        move(hand);
      if (play_.come_and_go && random_.chance(0.05)) change_cast();
      scene_->step();
      for (const Hand& hand : hands_) {
        const fdcg_finger_result felt = scene_->result(hand.id);
        log.add(felt);
        outcome.touches += felt.touch_count;
        outcome.several += felt.touch_count > 1;
        outcome.crowded += (felt.flags & FDCG_FINGER_CONTACT_OVERFLOW) != 0;
        ++outcome.steps;
      }
    }
    std::vector<fdcg_reaction> reactions(play_.objects);
    fdcg_scene_get_reactions(scene_->get(), reactions.data(), play_.objects);
    log.add(reactions.data(), reactions.size() * sizeof reactions[0]);
    for (const Hand& hand : hands_)
      outcome.broadphase_updates += scene_->result(hand.id).broadphase_updates;
    outcome.hash = log.hash();
    return outcome;
  }

  [[nodiscard]] SceneRig& scene() { return *scene_; }
  // Objects with other parameters and poses, in the places of this one's, and no fingers.
  [[nodiscard]] std::unique_ptr<SceneRig> another_scene() const {
    auto other = std::make_unique<SceneRig>(config_);
    std::vector<const Body*> by_place(bodies_.size());
    for (const Body& body : bodies_)
      by_place[body.id.index] = &body;
    for (const Body* const body : by_place)
      other->add(*body->graph, contact_params(0.1, 0.1), posed({0, 0, 0}));
    return other;
  }

 private:
  void move_to_another_scene() {
    const std::vector<std::uint64_t> state = saved_state(scene_->get());
    std::unique_ptr<SceneRig> other = another_scene();
    fdcg_error error;
    error.message[0] = '\0';
    if (fdcg_scene_restore(other->get(), state.data(), state.size() * 8, &error) != FDCG_OK)
      throw std::runtime_error(error.message);
    scene_ = std::move(other);
  }
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
    body.graph = graphs_[random_.below(static_cast<std::uint32_t>(graphs_.size()))];
    body.id = scene_->add(*body.graph, params, body.pose);
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
    scene_->pose(body.id, body.pose);
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
    scene_->move(hand.id, hip);
  }
  void change_cast() {
    Body& body = bodies_[random_.below(play_.objects)];
    Hand& hand = hands_[random_.below(play_.fingers)];
    const Place hip = placed(hand.course.at);
    switch (random_.below(6)) {
      case 0:
        fdcg_scene_remove_object(scene_->get(), body.id, nullptr);
        body = new_body();
        break;
      case 1:
        fdcg_scene_enable_object(scene_->get(), body.id, 0, nullptr);
        break;
      case 2:
        for (const Body& other : bodies_)
          fdcg_scene_enable_object(scene_->get(), other.id, 1, nullptr);
        break;
      case 3:
        fdcg_scene_reset_finger(scene_->get(), hand.id, hip.data(), nullptr);
        break;
      case 4:
        fdcg_scene_remove_finger(scene_->get(), hand.id, nullptr);
        hand.id = scene_->add(hip);
        break;
      default:
        fdcg_scene_step(scene_->get());  // a tick in which nothing moves
    }
  }

  const Play& play_;
  const std::vector<const fdcg_graph*>& graphs_;
  Random random_;
  fdcg_scene_config config_;
  std::unique_ptr<SceneRig> scene_;
  std::vector<Body> bodies_;
  std::vector<Hand> hands_;
};

// Some bodies in both precisions.
class PlayMeshes {
 public:
  PlayMeshes() {
    for (const auto& soup : {cube(), thin_plate(0.01), ico_sphere(2), l_prism(), torus(24, 12)}) {
      for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
        bake::CompileOptions options;
        options.precision = precision;
        meshes_.push_back(std::make_unique<CompiledMesh>(soup, options));
        graphs.push_back(&meshes_.back()->view());
      }
    }
  }
  std::vector<const fdcg_graph*> graphs;

 private:
  std::vector<std::unique_ptr<CompiledMesh>> meshes_;
};

}  // namespace fdcg::test
