// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/fdcg.hpp
/// fdcg.h with C++20 manners: ownership, values, spans. Header only; adds no state and no cost.
///
///     fdcg::Graph graph;
///     if (fdcg_error why; !graph.open_file("bunny.fdcg", &why)) return report(why.message);
///     fdcg::Contact contact;
///     fdcg_result touch = contact.step(graph, params, hip_object_m);
///
/// Frames, units, handedness, threads and costs are those of the C functions (fdcg.h, scene.h); a Graph owns its mapping, all
/// else is a value or a view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fdcg/scene.h"

namespace fdcg {

/// A graph that unmaps itself. Movable; views of it (Contact::step) need it alive.
class Graph {
 public:
  Graph() = default;  ///< nothing is open
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  /// Leaves `other` with nothing open.
  Graph(Graph&& other) noexcept { fdcg_move_graph(&other.graph_, &graph_, nullptr); }
  /// Closes what was open, and leaves `other` with nothing open.
  Graph& operator=(Graph&& other) noexcept {
    if (this != &other) {
      fdcg_close(&graph_);
      fdcg_move_graph(&other.graph_, &graph_, nullptr);
    }
    return *this;
  }
  /// Closes.
  ~Graph() { fdcg_close(&graph_); }

  /// Replaces what was open; on failure nothing is. `why` may be null.
  [[nodiscard]] bool open_file(const char* path, fdcg_error* why, fdcg_verify verify = FDCG_VERIFY_SAFE) {
    fdcg_close(&graph_);
    return fdcg_open_file(path, verify, &graph_, why) == FDCG_OK;
  }
  /// The bytes must outlive the graph and start at a multiple of 8.
  [[nodiscard]] bool open_memory(std::span<const std::byte> bytes, fdcg_error* why, fdcg_verify verify = FDCG_VERIFY_SAFE) {
    fdcg_close(&graph_);
    return fdcg_open_memory(bytes.data(), bytes.size(), verify, &graph_, why) == FDCG_OK;
  }

  /// Whether a graph is open; the next two need it.
  [[nodiscard]] bool is_open() const { return graph_.header != nullptr; }
  /// The file's header.
  [[nodiscard]] const fdcg_header& header() const { return *graph_.header; }
  /// For the C functions.
  [[nodiscard]] const fdcg_graph& c_graph() const { return graph_; }

 private:
  fdcg_graph graph_ = {};
};

/// One contact point. Copyable: a copy goes its own way.
class Contact {
 public:
  /// HIP in metres, in the object's frame. Noexcept, no allocation; see fdcg_step.
  fdcg_result step(const Graph& graph, const fdcg_params& params, std::span<const double, 3> hip_object_m) noexcept {
    fdcg_result result;
    fdcg_step(&graph.c_graph(), &params, &contact_, hip_object_m.data(), &result);
    return result;
  }
  /// Forgets the surface: the next tick starts anew, free.
  void reset() noexcept { contact_ = {}; }
  /// For the C functions.
  [[nodiscard]] const fdcg_contact& c_contact() const noexcept { return contact_; }

 private:
  fdcg_contact contact_ = {};
};

/// A scene in memory of the caller's (scene.h has the story): a view, copied freely; there is nothing to release. Where a
/// function returns false the scene is as it was, and *why, which may be null, says why.
class Scene {
 public:
  /// The bytes that a scene of this config takes; 0 if the config is out of range.
  [[nodiscard]] static std::size_t bytes(const fdcg_scene_config& config) {
    return static_cast<std::size_t>(fdcg_scene_bytes(&config));
  }

  Scene() = default;  ///< no scene: create() makes one
  /// Makes an empty scene in the memory: fdcg_scene_create.
  [[nodiscard]] bool create(std::span<std::byte> memory, const fdcg_scene_config& config, fdcg_error* why) {
    return fdcg_scene_create(memory.data(), memory.size(), &config, &scene_, why) == FDCG_OK;
  }

  /// Adds an object: fdcg_scene_add_object.
  [[nodiscard]] bool add_object(const Graph& graph, const fdcg_params& params, const fdcg_pose& pose, fdcg_object_id* object,
                                fdcg_error* why) {
    return fdcg_scene_add_object(scene_, &graph.c_graph(), &params, &pose, object, why) == FDCG_OK;
  }
  /// Removes an object: fdcg_scene_remove_object.
  [[nodiscard]] bool remove(fdcg_object_id object, fdcg_error* why = nullptr) {
    return fdcg_scene_remove_object(scene_, object, why) == FDCG_OK;
  }
  /// Moves an object: fdcg_scene_set_pose.
  [[nodiscard]] bool set_pose(fdcg_object_id object, const fdcg_pose& pose, fdcg_error* why) {
    return fdcg_scene_set_pose(scene_, object, &pose, why) == FDCG_OK;
  }
  /// Changes an object's parameters: fdcg_scene_set_params.
  [[nodiscard]] bool set_params(fdcg_object_id object, const fdcg_params& params, fdcg_error* why) {
    return fdcg_scene_set_params(scene_, object, &params, why) == FDCG_OK;
  }
  /// Switches an object on or off: fdcg_scene_enable_object.
  [[nodiscard]] bool enable(fdcg_object_id object, bool is_enabled, fdcg_error* why = nullptr) {
    return fdcg_scene_enable_object(scene_, object, is_enabled ? 1 : 0, why) == FDCG_OK;
  }

  /// Adds a finger: fdcg_scene_add_finger.
  [[nodiscard]] bool add_finger(std::span<const double, 3> hip_world_m, fdcg_finger_id* finger, fdcg_error* why) {
    return fdcg_scene_add_finger(scene_, hip_world_m.data(), finger, why) == FDCG_OK;
  }
  /// Removes a finger: fdcg_scene_remove_finger.
  [[nodiscard]] bool remove(fdcg_finger_id finger, fdcg_error* why = nullptr) {
    return fdcg_scene_remove_finger(scene_, finger, why) == FDCG_OK;
  }
  /// Moves a finger's HIP: fdcg_scene_move_finger.
  bool move(fdcg_finger_id finger, std::span<const double, 3> hip_world_m, fdcg_error* why = nullptr) noexcept {
    return fdcg_scene_move_finger(scene_, finger, hip_world_m.data(), why) == FDCG_OK;
  }
  /// Starts a finger anew: fdcg_scene_reset_finger.
  bool reset(fdcg_finger_id finger, std::span<const double, 3> hip_world_m, fdcg_error* why = nullptr) noexcept {
    return fdcg_scene_reset_finger(scene_, finger, hip_world_m.data(), why) == FDCG_OK;
  }

  /// Says what a finger is made of (fdcg_scene_set_finger_material); null: nothing of its own.
  bool set_material(fdcg_finger_id finger, const fdcg_material* material, fdcg_error* why = nullptr) noexcept {
    return fdcg_scene_set_finger_material(scene_, finger, material, why) == FDCG_OK;
  }

  /// A tick: fdcg_scene_step.
  void step() noexcept { fdcg_scene_step(scene_); }
  /// The first half of a tick: fdcg_scene_advance.
  void advance() noexcept { fdcg_scene_advance(scene_); }
  /// The second half, for one finger: fdcg_scene_step_finger.
  bool step(fdcg_finger_id finger, fdcg_error* why = nullptr) noexcept {
    return fdcg_scene_step_finger(scene_, finger, why) == FDCG_OK;
  }

  /// What a finger felt (fdcg_scene_get_result). All zero for one that is not in the scene.
  [[nodiscard]] fdcg_finger_result result(fdcg_finger_id finger) const noexcept {
    fdcg_finger_result result = {};
    fdcg_scene_get_result(scene_, finger, &result, nullptr);
    return result;
  }
  /// The finger's touches; good until its next step.
  [[nodiscard]] std::span<const fdcg_touch> touches(fdcg_finger_id finger) const noexcept {
    const fdcg_finger_result felt = result(finger);
    return {felt.touches, felt.touch_count};
  }
  /// What the fingers do to the objects, by object index: fdcg_scene_get_reactions.
  void reactions(std::span<fdcg_reaction> sums) const noexcept {
    fdcg_scene_get_reactions(scene_, sums.data(), static_cast<std::uint32_t>(sums.size()));
  }

  /// For the C functions.
  [[nodiscard]] fdcg_scene* c_scene() const noexcept { return scene_; }

 private:
  fdcg_scene* scene_ = nullptr;
};

}  // namespace fdcg
