// SPDX-License-Identifier: Apache-2.0
// A COLLADA file (1.4 and 1.5, Khronos): its elements by their ids, its units, and its meshes with every number read.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "import/scene_soup.hpp"
#include "import/xml_file.hpp"

namespace fdcg::bake::dae {

using xml::Node;

// Faces of one material whose corners count the points of one source.
struct Primitive {
  std::string material;                               // symbol; empty: none
  std::size_t source = 0;                             // in Mesh::sources
  std::vector<std::uint32_t> face_first{0}, corners;  // PolygonSoup::kInvalidVertex: no such point
  bool is_strip = false;                              // triangles with a repeated corner join strips and are no faces
};

struct Mesh {
  std::vector<PrintedPoints> sources;
  std::vector<Primitive> primitives;
};

class Document {
 public:
  explicit Document(std::string_view bytes);  // throws Refusal

  [[nodiscard]] const xml::File& file() const { return file_; }
  [[nodiscard]] Node root() const { return file_.root(); }
  [[nodiscard]] double metres_per_unit() const;
  [[nodiscard]] char up_axis() const;  // 'x', 'y', 'z'; the default of the format is y

  // What the attribute of `from` refers to ("#id"); empty: in another file. Throws Refusal where there is none or are two.
  [[nodiscard]] Node target(const Node& from, std::string_view attribute, std::string_view kind) const;
  [[nodiscard]] bool has_target(const Node& from, std::string_view attribute, std::string_view kind) const;

 private:
  struct Entry {
    Node node;
    bool is_twice = false;
  };
  xml::File file_;
  std::unordered_map<std::string, Entry> by_id_;  // "kind#id"
};

// The mesh of a <geometry>; nothing of what it draws as lines, curves or convex hulls, which `scene` counts.
Mesh read_mesh(const Document& document, const Node& geometry, SceneSoup& scene);

}  // namespace fdcg::bake::dae
