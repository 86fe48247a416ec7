// SPDX-License-Identifier: Apache-2.0
// Opening a file: mapped as it is, or copied into pages of its own.
#include "base/hooks.hpp"
#include "base/message.hpp"
#include "base/struct_bytes.hpp"
#include "graph/load.hpp"
#include "graph/map_file.hpp"

namespace fdcg {
namespace {

constexpr const char* kRemedy = "; start from fdcg_make_open_options()";

fdcg_status check_options(const fdcg_open_options& options, fdcg_error* error) {
  if (options.populate <= 1 && options.huge_pages <= 1) return FDCG_OK;
  return refuse(error, "open_options: populate and huge_pages are 0 or 1; start from fdcg_make_open_options()");
}

fdcg_status open_mapped(const char* path, const fdcg_open_options& options, fdcg_graph* graph, fdcg_error* error) {
  MappedFile file;
  fdcg_error why = {};
  fdcg_status status = map_file(path, options, &file, &why);
  if (status == FDCG_OK) {
    status = open_verified(file.data, file.bytes, static_cast<fdcg_verify>(options.verify), graph, &why);
    if (status != FDCG_OK) unmap_file(file);
  }
  if (status != FDCG_OK) {
    constexpr int kPathShown = 100;
    return Message(error, status, why.offset).quoted(path, kPathShown).text(": ").text(why.message);
  }
  graph->mapping = file.data;
  graph->mapping_bytes = file.bytes;
  graph->owner = graph;
  return status;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_open_options_init(fdcg_open_options* options, uint32_t struct_bytes) {
  const fdcg_open_options defaults = {0, FDCG_VERIFY_SAFE, 0, 0};
  fdcg::fill_defaults(options, defaults, struct_bytes);
}

extern "C" fdcg_status fdcg_open_file_with(const char* path, const fdcg_open_options* options, fdcg_graph* graph,
                                           fdcg_error* error) {
  using namespace fdcg;
  if (graph == nullptr) return refuse(error, "graph: null pointer");
  *graph = {};
  if (path == nullptr) return refuse(error, "path: null pointer");
  if (options == nullptr) return refuse(error, "options: null pointer");
  fdcg_error with_path = {};
  if (error == nullptr) error = &with_path;
  fdcg_status status = check_struct_bytes(options->struct_bytes, sizeof *options, "open_options", kRemedy, error);
  if (status != FDCG_OK) return status;
  fdcg_open_options room;
  const fdcg_open_options& whole = in_full(*options, &room, fdcg_open_options_init);
  status = check_options(whole, error);
  if (status == FDCG_OK) status = open_mapped(path, whole, graph, error);
  return told(status, *graph, *error);
}

extern "C" fdcg_status fdcg_open_file(const char* path, fdcg_verify verify, fdcg_graph* graph, fdcg_error* error) {
  fdcg_open_options options;
  fdcg_open_options_init(&options, sizeof options);
  options.verify = static_cast<uint32_t>(verify);
  return fdcg_open_file_with(path, &options, graph, error);
}

extern "C" fdcg_status fdcg_close(fdcg_graph* graph) {
  using namespace fdcg;
  if (graph == nullptr) return FDCG_OK;
  const bool is_owner = graph->owner == graph;
  const MappedFile file = {graph->mapping, graph->mapping_bytes};
  *graph = {};
  if (file.data == nullptr) return FDCG_OK;
  if (is_owner) {
    unmap_file(file);
    return FDCG_OK;
  }
  fdcg_error error;
  const fdcg_status status =
      refuse(&error, "graph: a copy was closed, the file stays mapped; close the struct that was opened");
  log(FDCG_LOG_ERROR, error.message);
  return status;
}

extern "C" fdcg_status fdcg_move_graph(fdcg_graph* from, fdcg_graph* to, fdcg_error* error) {
  using namespace fdcg;
  if (from == nullptr || to == nullptr) return refuse(error, "from or to: null pointer");
  if (from == to) return FDCG_OK;
  if (to->header != nullptr) return refuse(error, "to: a graph is open in it; close it first");
  if (from->mapping != nullptr && from->owner != from) return refuse(error, "from: a copy; move the struct that was opened");
  *to = *from;
  if (to->owner != nullptr) to->owner = to;
  *from = {};
  return FDCG_OK;
}
