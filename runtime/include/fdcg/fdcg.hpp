// SPDX-License-Identifier: Apache-2.0
// fdcg.h with C++20 manners: ownership, values, spans. Header only; adds no state and no cost.
//
//   fdcg::Graph graph;
//   if (fdcg_error why; !graph.open_file("bunny.fdcg", &why)) return report(why.message);
//   fdcg::Contact contact;
//   fdcg_result touch = contact.step(graph, params, hip_object_m);
#pragma once

#include <cstddef>
#include <span>

#include "fdcg/fdcg.h"

namespace fdcg {

// A graph that unmaps itself. Movable; views of it (Contact::step) need it alive.
class Graph {
 public:
  Graph() = default;
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  Graph(Graph&& other) noexcept : graph_(other.graph_) { other.graph_ = {}; }
  Graph& operator=(Graph&& other) noexcept {
    if (this != &other) {
      fdcg_close(&graph_);
      graph_ = other.graph_;
      other.graph_ = {};
    }
    return *this;
  }
  ~Graph() { fdcg_close(&graph_); }

  // Replaces what was open; on failure nothing is. `why` may be null.
  [[nodiscard]] bool open_file(const char* path, fdcg_error* why, fdcg_verify verify = FDCG_VERIFY_FULL) {
    fdcg_close(&graph_);
    return fdcg_open_file(path, verify, &graph_, why) == FDCG_OK;
  }
  // The bytes must outlive the graph and start at a multiple of 8.
  [[nodiscard]] bool open_memory(std::span<const std::byte> bytes, fdcg_error* why, fdcg_verify verify = FDCG_VERIFY_FULL) {
    fdcg_close(&graph_);
    return fdcg_open_memory(bytes.data(), bytes.size(), verify, &graph_, why) == FDCG_OK;
  }

  [[nodiscard]] bool is_open() const { return graph_.header != nullptr; }
  [[nodiscard]] const fdcg_header& header() const { return *graph_.header; }
  [[nodiscard]] const fdcg_graph& c_graph() const { return graph_; }

 private:
  fdcg_graph graph_ = {};
};

// One contact point. Copyable: a copy goes its own way.
class Contact {
 public:
  // HIP in metres, in the object's frame. Noexcept, no allocation; see fdcg_step.
  fdcg_result step(const Graph& graph, const fdcg_params& params, std::span<const double, 3> hip_object_m) noexcept {
    fdcg_result result;
    fdcg_step(&graph.c_graph(), &params, &contact_, hip_object_m.data(), &result);
    return result;
  }
  // Forgets the surface: the next tick starts anew, free.
  void reset() noexcept { contact_ = {}; }
  [[nodiscard]] const fdcg_contact& c_contact() const noexcept { return contact_; }

 private:
  fdcg_contact contact_ = {};
};

}  // namespace fdcg
