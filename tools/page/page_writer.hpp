// SPDX-License-Identifier: Apache-2.0
// Writes one self-contained HTML page: the viewer, and the items that it shows. Items are written as they come, so that few are
// in memory at once. What names and texts of meshes hold cannot leave its place: it stands in the page compressed, as base64.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"
#include "mesh_arrays.hpp"

namespace fdcg::dev {
struct ViewedScene;
}

namespace fdcg::page {

class WorldFrames;

// Why this program has no viewer to write pages with; empty: it has one.
std::string viewer_missing();

// By its first bytes; false where it cannot be read.
bool is_session_log(const std::string& path);

// What of a mesh is shown beside its faces.
struct MeshDetails {
  const bake::Report* report = nullptr;      // never null; its elements are listed in full
  std::span<const std::byte> graph{};        // to touch it; empty: the page says why not
  std::string no_graph{};                    // that reason
  std::string compile_options{};             // with which `fdcg compile` makes these bytes
  const bake::Repaired* repaired = nullptr;  // shown beside it
};

class PageWriter {
 public:
  using Write = std::function<void(std::string_view)>;
  // `write` gets pieces of any length, and must live as long; `name` is the page's title. viewer_missing() is empty.
  PageWriter(Write write, std::string_view name);

  void add_mesh(const bake::PolygonSoup& soup, const MeshDetails& details);
  // A file that gave no mesh: its report says why.
  void add_report(const bake::Report& report);
  // An FDCG file; `log`: a replay's CSV that was made on it, or empty.
  void add_graph(std::string_view name, std::span<const std::byte> file, std::string_view log_name = {},
                 std::string_view log = {});
  // A replay's log whose graph is not at hand.
  void add_log(std::string_view name, std::string_view log);
  // The log of a session (fdcg-servo run), replayed; graph_folder: where its graphs are now; empty: where they were, or beside
  // the log. Empty, or why it cannot be shown: then nothing has been written.
  std::string add_session(const std::string& path, const std::string& graph_folder);
  void finish();

 private:
  std::size_t add_blob(const std::string& encoded);
  nlohmann::ordered_json add_array(const PackedArray& array);
  nlohmann::ordered_json add_geometry(const bake::PolygonSoup& soup);
  nlohmann::ordered_json add_log_text(std::string_view name, std::string_view log);
  nlohmann::ordered_json add_graph_file(const std::string& path);
  nlohmann::ordered_json session_objects(const dev::ViewedScene& scene, nlohmann::ordered_json* graphs);
  nlohmann::ordered_json add_world(const dev::ViewedScene& scene, const WorldFrames& frames);
  void add_item(const nlohmann::ordered_json& item);

  Write write_;
  std::size_t blobs_ = 0;
};

}  // namespace fdcg::page
