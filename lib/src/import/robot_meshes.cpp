// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <system_error>
#include <tuple>

#include "base/file_bytes.hpp"
#include "fdcg/robot.hpp"
#include "import/soup_reader.hpp"
#include "import/xml_file.hpp"

namespace fdcg::bake {
namespace {

namespace fs = std::filesystem;
using xml::Node;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// The name in a package.xml; empty: there is none.
std::string package_name(const fs::path& folder) {
  const fs::path path = folder / "package.xml";
  if (!is_file(path)) return {};
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return {};
  try {
    const xml::File description(file->bytes());
    return xml::child(description.root(), "name").child_value();
  } catch (const xml::Refusal&) {
    return {};
  }
}

class RobotReader {
 public:
  RobotReader(const fs::path& path, std::string_view bytes) : file_(bytes) {
    std::error_code ignored;
    folder_ = path.parent_path();
    absolute_ = fs::absolute(path, ignored).lexically_normal().parent_path();
  }

  std::vector<NamedMesh> read() {
    visit(file_.root(), {}, 0);
    return std::move(meshes_);
  }

 private:
  void visit(const Node& node, const std::string& link, int depth) {
    if (depth > xml::kMaxDepth) file_.fail(node, "nests more than " + std::to_string(xml::kMaxDepth) + " deep");
    for (Node below = xml::first_element(node); below; below = xml::next_element(below)) {
      const std::string_view kind = xml::name_of(below);
      if (kind == "mesh" && xml::name_of(node) == "geometry") {
        add(below, link);
      } else {
        visit(below, kind == "link" ? readable_name(xml::attribute(below, "name")) : link, depth + 1);
      }
    }
  }

  // URDF has attributes, SDF elements.
  void add(const Node& node, const std::string& link) {
    const Node uri = xml::child(node, "uri"), scale = xml::child(node, "scale");
    NamedMesh mesh;
    mesh.link = link;
    const std::string name = uri ? uri.child_value() : std::string(xml::attribute(node, "filename"));
    const std::string factors = scale ? scale.child_value() : std::string(xml::attribute(node, "scale"));
    if (name.empty()) file_.fail(node, "of link '" + link + "' names no file");
    mesh.scale = scale_of(node, factors);
    resolve(name, mesh);
    if (known_.emplace(mesh.file.string(), mesh.scale.x, mesh.scale.y, mesh.scale.z).second) meshes_.push_back(std::move(mesh));
  }

  [[nodiscard]] Vec3 scale_of(const Node& node, const std::string& text) const {
    if (text.empty()) return {1, 1, 1};
    TextScanner scan(text, {});
    std::array<double, 3> factors{};
    std::size_t count = 0;
    bool is_sound = true;
    for (; scan.find_token() && is_sound; ++count) {
      double value = 0;
      is_sound = scan.read_real(value) && std::isfinite(value) && value != 0;
      if (count < factors.size()) factors[count] = value;
    }
    if (!is_sound || (count != 3 && count != 1))
      file_.fail(node, "has the scale '" + readable_name(text) + "'; it must be three finite numbers, none of them 0");
    if (count == 1) return {factors[0], factors[0], factors[0]};
    return {factors[0], factors[1], factors[2]};
  }

  // ---- where a name leads

  void resolve(const std::string& name, NamedMesh& mesh) const {
    mesh.file = name;
    if (name.find("${") != std::string::npos || name.find("$(") != std::string::npos) {
      mesh.problem = "is an expression of xacro; expand the description with xacro first";
      return;
    }
    const std::size_t scheme = name.find("://");
    const std::string rest = scheme == std::string::npos ? name : name.substr(scheme + 3);
    const std::string kind = scheme == std::string::npos ? "" : name.substr(0, scheme);
    if (kind.empty() || kind == "file") {
      const fs::path found = fs::path(rest).is_absolute() ? fs::path(rest) : folder_ / rest;
      if (is_file(found)) {
        mesh.file = found;
      } else {
        mesh.problem = "is named by the description, and there is no such file; put it there";
      }
    } else if (kind == "package" || kind == "model") {
      resolve_package(rest, mesh);
    } else {
      mesh.problem = "stands on a server; fetch it, and name the file";
    }
  }

  void resolve_package(const std::string& rest, NamedMesh& mesh) const {
    const std::size_t slash = rest.find('/');
    const std::string package = rest.substr(0, slash);
    const fs::path inner = slash == std::string::npos ? fs::path() : fs::path(rest.substr(slash + 1));
    fs::path shown = folder_.empty() ? fs::path(".") : folder_;
    for (fs::path folder = absolute_;; folder = folder.parent_path(), shown /= "..") {
      const bool is_package = folder.filename() == package || package_name(folder) == package;
      for (const fs::path& candidate : {shown / package / inner, is_package ? shown / inner : fs::path()}) {
        if (candidate.empty() || !is_file(candidate)) continue;
        mesh.file = candidate.lexically_normal();
        return;
      }
      if (folder == folder.parent_path()) break;
    }
    mesh.problem =
        "is in the package '" + readable_name(package) + "', which is not found in the description's folder and those above it";
  }

  xml::File file_;
  fs::path folder_, absolute_;  // of the description: as given, and from the root on
  std::vector<NamedMesh> meshes_;
  std::set<std::tuple<std::string, double, double, double>> known_;
};

}  // namespace

bool is_robot(std::string_view bytes) {
  const std::string root = xml_root_name(bytes);
  return root == "robot" || root == "sdf";
}

Result<std::vector<NamedMesh>> meshes_of_robot(const fs::path& path) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return file.error();
  try {
    return RobotReader(path, file->bytes()).read();
  } catch (const xml::Refusal& refusal) {
    return refuse(path.string(), refusal.message);
  } catch (const std::bad_alloc&) {
    return refuse(path.string(), "needs more memory than there is; cut the description into parts");
  }
}

void scale_soup(PolygonSoup& soup, const Vec3& scale) {
  if (scale == Vec3{1, 1, 1}) return;
  double largest = 0;
  for (Vec3& p : soup.points) {
    p = {p.x * scale.x, p.y * scale.y, p.z * scale.z};
    for (const double c : {p.x, p.y, p.z}) {
      if (std::isfinite(c)) largest = std::max(largest, std::fabs(c));
    }
  }
  // The cofactors of the scale, and outwards again where it mirrors.
  const double outward = (scale.x < 0) != ((scale.y < 0) != (scale.z < 0)) ? -1 : 1;
  for (Vec3& n : soup.corner_normals)
    n = {outward * n.x * scale.y * scale.z, outward * n.y * scale.z * scale.x, outward * n.z * scale.x * scale.y};
  const double most = std::max({std::fabs(scale.x), std::fabs(scale.y), std::fabs(scale.z)});
  soup.absolute_quantum = soup.absolute_quantum * most + 0x1p-53 * largest;
  if (outward > 0) return;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const auto first = soup.corners.begin() + soup.face_first[f], last = soup.corners.begin() + soup.face_first[f + 1];
    if (first == last) continue;
    std::reverse(first + 1, last);
    if (soup.corner_normals.empty()) continue;
    const auto normals = soup.corner_normals.begin() + soup.face_first[f];
    std::reverse(normals + 1, normals + (last - first));
  }
}

}  // namespace fdcg::bake
