// SPDX-License-Identifier: Apache-2.0
#include "view_input.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "fdcg/fdcg.h"
#include "page/page_writer.hpp"

namespace fdcg::tools {
namespace {

constexpr std::string_view kLogStart = "t,hip_x,hip_y,hip_z,go_x";  // of the header that fdcg-servo replay writes

std::vector<std::byte> read_all(std::ifstream& file) {
  file.seekg(0, std::ios::end);
  std::vector<std::byte> bytes(static_cast<std::size_t>(file.tellg()));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

}  // namespace

ViewInput read_view_input(const ListedMesh& named) {
  ViewInput input;
  input.file = named;
  const std::string& path = named.path;
  if (!named.problem.empty()) return input;
  if (path == "-") return input;
  std::ifstream file(path, std::ios::binary);
  char start[kLogStart.size()] = {};
  if (!file.read(start, sizeof start)) return input;  // import_input says what is wrong with it
  if (std::memcmp(start, FDCG_MAGIC, 8) == 0) input.kind = ViewKind::graph;
  if (std::string_view(start, sizeof start) == kLogStart) input.kind = ViewKind::log;
  if (page::is_session_log(path)) input.kind = ViewKind::session;
  if (input.kind == ViewKind::mesh || input.kind == ViewKind::session) return input;
  input.bytes = read_all(file);
  if (!file) {
    input.error = path + ": cannot be read to its end";
  } else if (input.kind == ViewKind::graph) {
    fdcg_graph graph{};
    fdcg_error error{};
    if (fdcg_open_memory(input.bytes.data(), input.bytes.size(), FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK)
      input.error = path + ": " + error.message;
  }
  return input;
}

}  // namespace fdcg::tools
