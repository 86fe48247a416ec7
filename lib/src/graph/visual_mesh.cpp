// SPDX-License-Identifier: Apache-2.0
#include "graph/visual_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "base/vec3.hpp"
#include "graph/corner_normals.hpp"
#include "graph/face_materials.hpp"
#include "graph/source_corners.hpp"

namespace fdcg::bake {
namespace {

constexpr double kOpaque = 65535;

std::uint16_t share16(float share) {
  return static_cast<std::uint16_t>(std::lround(kOpaque * std::clamp(static_cast<double>(share), 0.0, 1.0)));
}

void set_point(fdcg_visual_vertex& vertex, const Vec3& point, const Vec3& normal) {
  for (int k = 0; k < 3; ++k) {
    vertex.position[k] = static_cast<float>(component(point, k));
    vertex.normal[k] = static_cast<std::int16_t>(std::lround(FDCG_NORMAL_SCALE * component(normal, k)));
  }
  std::fill(std::begin(vertex.colour), std::end(vertex.colour), std::uint16_t{0xFFFF});
}

fdcg_visual_material look_record(const LookMaterial& look) {
  fdcg_visual_material record{};
  std::memcpy(record.name, material_record(look.name).name, sizeof record.name);
  for (std::size_t k = 0; k < look.base_colour.size(); ++k)
    record.base_colour[k] = look.base_colour[k] > 0 ? std::min(look.base_colour[k], 1.0f) : 0;
  return record;
}

// What the soup's appearance says of a corner; the flags of fdcg_visual_material that come of it.
std::uint32_t paint(const Appearance& look, std::uint32_t corner, fdcg_visual_vertex& vertex) {
  std::uint32_t flags = 0;
  if (corner == kNone) return flags;
  if (!look.uv.empty() && std::isfinite(look.uv[corner][0]) && std::isfinite(look.uv[corner][1])) {
    vertex.uv[0] = look.uv[corner][0] + 0.0f;  // no -0: equal places are equal bytes
    vertex.uv[1] = look.uv[corner][1] + 0.0f;
    flags |= FDCG_VISUAL_UV;
  }
  if (!look.colours.empty()) {
    for (std::size_t k = 0; k < 4; ++k)
      vertex.colour[k] = share16(look.colours[corner][k]);
    flags |= FDCG_VISUAL_COLOURS;
  }
  return flags;
}

// Vertices by the number of the mesh's vertex, each with those that differ from it.
class Sharer {
 public:
  Sharer(const Graph& graph, std::size_t vertices)
      : graph_(graph), first_(vertices, kNone), next_(graph.corner_count(), kNone), made_(graph.corner_count()) {
    for (std::uint32_t c = 0; c < graph.corner_count(); ++c) {  // for a corner that no triangle has
      set_point(made_[c], graph.points[c], {0, 0, 1});
      made_[c].corner = c;
    }
  }

  std::uint32_t number_of(fdcg_visual_vertex vertex) {
    const std::uint32_t v = vertex.corner;
    vertex.corner = graph_.corner_of_vertex[v];
    std::uint32_t* link = &first_[v];
    for (; *link != kNone; link = &next_[*link])
      if (std::memcmp(&made_[*link], &vertex, sizeof vertex) == 0) return *link;
    if (first_[v] == kNone && vertex.corner != kNone) {
      made_[vertex.corner] = vertex;
      return *link = vertex.corner;
    }
    const auto number = static_cast<std::uint32_t>(made_.size());
    *link = number;
    made_.push_back(vertex);
    next_.push_back(kNone);
    return number;
  }
  std::vector<fdcg_visual_vertex> take() { return std::move(made_); }

 private:
  const Graph& graph_;
  std::vector<std::uint32_t> first_, next_;
  std::vector<fdcg_visual_vertex> made_;
};

}  // namespace

VisualMesh draw_triangles(const PolygonSoup& soup, const std::vector<std::uint32_t>& source_face, const Triangulation& cut,
                          const CompileOptions& options) {
  const Appearance& look = soup.appearance;
  const std::vector<Vec3> normals = smooth_normals(soup, source_face, cut, options);
  const SourceCorners corners(soup, source_face, cut);
  VisualMesh visual;
  for (const LookMaterial& material : look.materials)
    visual.materials.push_back(look_record(material));
  visual.materials.push_back(look_record({}));
  visual.material.resize(cut.mesh.face_count());
  visual.vertices.resize(normals.size());
  for (std::uint32_t t = 0; t < visual.material.size(); ++t) {
    const std::uint32_t face = corners.face_of(t);
    const bool has = face != kNone && face < look.face_material.size() && look.face_material[face] < look.materials.size();
    visual.material[t] = has ? look.face_material[face] : static_cast<std::uint16_t>(look.materials.size());
    for (std::uint32_t slot = 3 * t; slot < 3 * t + 3; ++slot) {
      fdcg_visual_vertex& vertex = visual.vertices[slot];
      const VertexId v = cut.mesh.corners[slot];
      set_point(vertex, cut.mesh.points[+v], normals[slot]);
      vertex.corner = +v;
      visual.materials[visual.material[t]].flags |= paint(look, corners.at(slot), vertex);
    }
  }
  return visual;
}

void share_vertices(VisualMesh& visual, const Graph& graph, const std::vector<std::uint32_t>& face_of_triangle) {
  const auto node_of = [&](std::uint32_t t) {
    const std::uint32_t face = face_of_triangle.empty() ? t : face_of_triangle[t];
    return face == kNone ? kNone : graph.node_of_face[face];
  };
  std::vector<std::uint32_t> order(visual.material.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (visual.material[a] != visual.material[b]) return visual.material[a] < visual.material[b];
    const std::uint32_t node_a = node_of(a), node_b = node_of(b);
    return node_a != node_b ? node_a < node_b : a < b;
  });
  Sharer sharer(graph, graph.corner_of_vertex.size());
  visual.indices.reserve(3 * order.size());
  for (const std::uint32_t t : order) {
    visual.nodes.push_back(node_of(t));
    visual.materials[visual.material[t]].index_count += 3;
    for (std::uint32_t slot = 3 * t; slot < 3 * t + 3; ++slot)
      visual.indices.push_back(sharer.number_of(visual.vertices[slot]));
  }
  visual.vertices = sharer.take();
  std::uint32_t first = 0;
  std::erase_if(visual.materials, [](const fdcg_visual_material& m) { return m.index_count == 0; });
  for (fdcg_visual_material& material : visual.materials) {
    material.first_index = first;
    first += material.index_count;
  }
  visual.material = {};
}

}  // namespace fdcg::bake
