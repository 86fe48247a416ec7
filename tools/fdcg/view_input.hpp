// SPDX-License-Identifier: Apache-2.0
// What an input of `fdcg view` is, by its content.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mesh_list.hpp"

namespace fdcg::tools {

enum class ViewKind { mesh, graph, log, session };

struct ViewInput {
  ViewKind kind = ViewKind::mesh;
  ListedMesh file;
  std::vector<std::byte> bytes{};  // of a graph or a log; a mesh is read by import_input, a session by its replay
  std::string error{};             // one line: why it cannot be read
};

// A graph is verified in full. What is neither a graph nor a log is a mesh, which is not read here.
ViewInput read_view_input(const ListedMesh& named);

}  // namespace fdcg::tools
