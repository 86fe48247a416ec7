// SPDX-License-Identifier: Apache-2.0
// What the parts of the module share: places in and out of Python, errors, graphs with what keeps their bytes.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "fdcg/heights.h"

namespace fdcg::python {

namespace py = pybind11;

using Place = std::array<double, 3>;
// Rows of three numbers, as they lie in memory; numpy converts what is not so.
using Places = py::array_t<double, py::array::c_style | py::array::forcecast>;

// fdcg.Error, a ValueError whose text is the library's.
[[noreturn]] void raise(const std::string& message);
inline void check(fdcg_status status, const fdcg_error& error) {
  if (status != FDCG_OK) raise(error.message);
}

// A sequence of three numbers: a tuple, a list, a row of an array.
Place place_from(const py::handle& sequence, const char* name);
// Throws unless the array is of shape (n, 3); the number of rows.
py::ssize_t rows_of(const Places& places, const char* name);

// An open graph and what keeps its bytes.
class Graph {
 public:
  Graph() = default;
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  ~Graph() { fdcg_close(&view); }

  fdcg_graph view{};
  std::vector<std::byte> bytes;  // a compiled graph's
  py::object buffer;             // a caller's
};

// A relief and the heights that it is of.
struct Relief {
  Relief() = default;
  Relief(const Relief&) = delete;
  Relief& operator=(const Relief&) = delete;

  fdcg_relief relief{};
  fdcg_waves waves{};
  fdcg_heights heights{};
  std::shared_ptr<Graph> graph;  // of images
};

struct Contact {
  std::shared_ptr<Graph> graph;
  fdcg_params params;
  std::shared_ptr<Relief> relief;  // null: none
  std::vector<fdcg_effect> effects;
  fdcg_contact state{};
  fdcg_relief_state relief_state{};
  std::vector<fdcg_effect_state> effect_states;  // one an effect

  [[nodiscard]] bool is_plain() const { return relief == nullptr && effects.empty(); }
  void reset() {
    state = {};
    relief_state = {};
    effect_states.assign(effects.size(), fdcg_effect_state{});
  }
};

// A tick with relief and effects.
fdcg_result step_felt(Contact& contact, const double hip_m[3]);

void bind_mesh(py::module_& module);
void bind_graph(py::module_& module);
void bind_relief(py::module_& module);
void bind_contact(py::module_& module);
void bind_scene(py::module_& module);
void bind_grasp(py::module_& module);

}  // namespace fdcg::python
