// SPDX-License-Identifier: Apache-2.0
#include "mesh_list.hpp"

#include <fstream>
#include <set>
#include <tuple>

#include "../common/terminal.hpp"
#include "fdcg/robot.hpp"
#include "mesh_options.hpp"
#include "shared/text.hpp"

namespace fdcg::tools {
namespace {

// Names of meshes in formats that are not read, in lower case.
const std::vector<std::string>& other_endings() {
  static const std::vector<std::string> kEndings{
      ".3ds", ".3dm", ".abc", ".amf",    ".blend", ".c4d",  ".fbx", ".iges", ".igs",  ".ifc",  ".jt",  ".lwo", ".ma", ".max",
      ".mb",  ".msh", ".prt", ".sldprt", ".stp",   ".step", ".usd", ".usda", ".usdc", ".usdz", ".vtu", ".wrl", ".x"};
  return kEndings;
}

bool is_robot_file(const std::string& path) {
  constexpr std::size_t kLooked = 65'536;
  const bool has_name = path.ends_with(".urdf") || path.ends_with(".sdf") || path.ends_with(".xml") ||
                        path.ends_with(".xacro") || path.ends_with(".world");
  if (!has_name) return false;
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kLooked, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bake::is_robot(bytes);
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 10;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kShown; ++i)
    text += (i == 0 ? "" : ", ") + printable(names[i]);
  return names.size() > kShown ? text + " and " + grouped(names.size() - kShown) + " more" : text;
}

std::string counted(std::size_t count, const char* singular) {
  return grouped(count) + " " + singular + (count == 1 ? "" : "s");
}

class Lister {
 public:
  MeshList list(const std::vector<std::string>& arguments) {
    std::vector<std::string> skipped;
    for (const NamedFile& file : expand_paths(arguments, mesh_endings(), other_endings(), &skipped)) {
      if (file.problem.empty() && is_robot_file(file.path)) {
        add_robot(file.path);
      } else {
        add(file, {1, 1, 1}, {});
      }
    }
    if (!skipped.empty()) {
      list_.notes.push_back("skipped " + counted(skipped.size(), "mesh file") +
                            " of formats that are not read: " + joined(skipped) + "; name one to learn how to convert it");
    }
    return std::move(list_);
  }

 private:
  void add(const NamedFile& file, const bake::Vec3& scale, const std::string& robot) {
    if (known_.emplace(file.path, scale.x, scale.y, scale.z).second) list_.meshes.push_back({file, scale, robot});
  }

  void add_robot(const std::string& path) {
    const auto meshes = bake::meshes_of_robot(path);
    if (!meshes) {
      const std::string& message = meshes.error().message;
      const std::string start = path + ": ";
      return add({path, message.starts_with(start) ? message.substr(start.size()) : message}, {1, 1, 1}, path);
    }
    if (meshes->empty()) return add({path, "is a robot's description and names no mesh; name a mesh file"}, {1, 1, 1}, path);
    std::size_t scaled = 0;
    for (const bake::NamedMesh& mesh : *meshes) {
      const bool is_scaled = mesh.scale != bake::Vec3{1, 1, 1};
      scaled += is_scaled ? 1 : 0;
      add({mesh.file.string(), mesh.problem.empty() ? "" : mesh.problem + " (" + path + ", link '" + mesh.link + "')"},
          mesh.scale, path);
    }
    list_.notes.push_back(path + ": names " + grouped(meshes->size()) + (meshes->size() == 1 ? " mesh" : " meshes") +
                          (scaled == 0 ? "" : ", " + grouped(scaled) + " of them with a scale, which is applied"));
  }

  MeshList list_;
  std::set<std::tuple<std::string, double, double, double>> known_;
};

}  // namespace

MeshList list_meshes(const std::vector<std::string>& arguments) {
  return Lister().list(arguments);
}

}  // namespace fdcg::tools
