// SPDX-License-Identifier: Apache-2.0
// The model parts of a 3MF package (3MF Consortium, core 1.3 with the production extension), and their meshes with every number
// read.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/scene_soup.hpp"
#include "import/xml_file.hpp"
#include "import/zip_file.hpp"

namespace fdcg::bake::threemf {

using xml::Node;

// The properties that triangles may refer to.
struct Group {
  std::uint64_t count = 0;
  std::vector<std::string> materials;  // of <basematerials>; empty: colours, textures and others
};

// One .model file of the package.
struct Part {
  Part(std::string name_in_package, std::string unpacked);

  std::string name;   // in the package; of the root: empty
  std::string bytes;  // outlive the tree
  xml::File file;
  std::map<std::string_view, Node> objects;  // by id
  std::map<std::string_view, Group> groups;  // likewise
};

struct Mesh {
  PrintedPoints points;
  std::vector<std::uint32_t> corners;    // three a triangle; PolygonSoup::kInvalidVertex: no such vertex
  std::vector<std::uint32_t> materials;  // of each triangle, in `names`; 0: none
  std::vector<std::string> names{""};
};

class Package {
 public:
  explicit Package(std::string_view bytes);  // throws Refusal

  [[nodiscard]] Part& root() { return *root_; }
  // "/3D/a.model"; each is read once.
  Part& part(std::string_view path, const Part& from, const Node& reference);
  [[nodiscard]] std::size_t unpacked_bytes() const { return unpacked_; }

  [[nodiscard]] double metres_per_unit() const;  // of the root

 private:
  [[nodiscard]] std::string root_name();
  std::unique_ptr<Part> open(const std::string& name, bool is_root);

  ZipFile zip_;
  std::unique_ptr<Part> root_;
  std::map<std::string, std::unique_ptr<Part>, std::less<>> parts_;
  std::size_t unpacked_ = 0;
};

// Of an <object> that has a <mesh>.
Mesh read_mesh(const Part& part, const Node& object, SceneSoup& scene);

// The object of this id. Throws Refusal where there is none.
Node object_of(const Part& part, const Part& from, const Node& reference);

// Twelve numbers; none: identity.
Matrix transform_of(const Part& part, const Node& node);

}  // namespace fdcg::bake::threemf
