// SPDX-License-Identifier: Apache-2.0
// The offline pipeline: the sequence of its stages.
#include "fdcg/bake.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "bake_core.hpp"
#include "base/large_pages.hpp"
#include "base/parallel.hpp"
#include "base/quantised.hpp"
#include "base/quantum.hpp"
#include "base/release.hpp"
#include "base/vec3.hpp"
#include "fdcg/format.h"
#include "graph/classify.hpp"
#include "graph/corner_normals.hpp"
#include "graph/face_materials.hpp"
#include "graph/graph.hpp"
#include "graph/height_sections.hpp"
#include "graph/info.hpp"
#include "graph/merge.hpp"
#include "graph/node_places.hpp"
#include "graph/regions.hpp"
#include "graph/serialise.hpp"
#include "graph/triangulate.hpp"
#include "graph/weigh.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"
#include "validate/validate.hpp"

namespace fdcg::bake {
namespace {

std::string format_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

// The contradiction in the options; empty if there is none.
std::string check_options(const CompileOptions& options) {
  constexpr double kLargestScale = 1e30;  // accepted by the runtime
  if (!(options.metres_per_unit >= 1 / kLargestScale && options.metres_per_unit <= kLargestScale))
    return "the scale is " + format_number(options.metres_per_unit) + " metres per unit; it must be 1e-30 to 1e30";
  if (options.coplanar.kind == Coplanar::Kind::angle &&
      !(options.coplanar.angle_rad >= 0 && options.coplanar.angle_rad < std::numbers::pi / 2))
    return "the coplanar angle is " + format_number(options.coplanar.angle_rad) + " rad; it must be at least 0 and below pi/2";
  if (options.weld.kind == Weld::Kind::distance && !(options.weld.distance >= 0 && std::isfinite(options.weld.distance)))
    return "the weld distance is " + format_number(options.weld.distance) + "; it must be at least 0 and finite";
  if (!(options.crease_rad >= 0 && options.crease_rad <= std::numbers::pi))
    return "the crease angle is " + format_number(options.crease_rad) + " rad; it must be 0 to pi";
  constexpr std::array<std::string_view, 6> kOptional{"hierarchy", "source-map", "info", "mass", "materials", "normals"};
  for (const std::string& section : options.without) {
    if (std::find(kOptional.begin(), kOptional.end(), section) == kOptional.end())
      return "the section '" + section + "' cannot be left out; hierarchy, source-map, info, mass, materials and normals can";
  }
  return check_mass_options(options);
}

// The quantum of one coordinate at the object's extent, for the header.
double header_quantum(const PolygonSoup& soup, const Mesh& mesh) {
  double extent = 0;
  for (const Vec3& point : mesh.points)
    extent = std::max(extent, largest_component(point + mesh.origin));
  return std::max(soup.relative_quantum * extent, soup.absolute_quantum);
}

// The node of each face of the soup: by way of the mesh, the triangles it was cut into, and the polygons they were merged into.
std::vector<std::uint32_t> trace_sources(std::size_t source_faces, const std::vector<std::uint32_t>& source_face,
                                         const std::vector<std::uint32_t>& polygon,
                                         std::vector<std::uint32_t> face_of_triangle) {
  if (source_face.empty() && polygon.empty()) return face_of_triangle;
  std::vector<std::uint32_t> face_of_source(source_faces, kNone);
  const std::size_t mesh_faces = source_face.empty() ? source_faces : source_face.size();
  const std::size_t triangles = polygon.empty() ? std::max(mesh_faces, face_of_triangle.size()) : polygon.size();
  for (std::size_t i = triangles; i-- > 0;) {  // downwards: a polygon is where its first triangle is
    const auto triangle = static_cast<std::uint32_t>(i);
    const std::uint32_t mesh_face = polygon.empty() ? triangle : polygon[triangle];
    const std::uint32_t source = source_face.empty() ? mesh_face : source_face[mesh_face];
    face_of_source[source] = face_of_triangle.empty() ? triangle : face_of_triangle[triangle];
  }
  return face_of_source;
}

// Of each source face, or kNone, from what trace_sources gives.
std::vector<std::uint32_t> nodes_of_sources(std::vector<std::uint32_t> face_of_source,
                                            const std::vector<std::uint32_t>& node_of_face) {
  if (face_of_source.empty()) return node_of_face;
  for (std::uint32_t& face : face_of_source) {
    if (face != kNone) face = node_of_face[face];
  }
  return face_of_source;
}

std::uint64_t count_sharing(const std::vector<std::uint32_t>& face_of_source, std::size_t faces) {
  std::vector<std::uint32_t> count(faces, 0);
  for (const std::uint32_t face : face_of_source) {
    if (face != kNone) ++count[face];
  }
  std::uint64_t sharing = 0;
  for (const std::uint32_t n : count)
    sharing += n > 1 ? n : 0;
  return sharing;
}

// Polygons that cannot become one node: not convex, too many sides, or not planar.
std::uint64_t count_split(const Triangulation& cut, const Regions& regions) {
  std::vector<std::uint8_t> is_whole = cut.is_whole;
  for (std::uint32_t t = 1; t < cut.polygon.size(); ++t) {
    const bool is_apart = regions.of(FaceId{t}) == kNone || regions.of(FaceId{t}) != regions.of(FaceId{t - 1});
    if (cut.polygon[t] == cut.polygon[t - 1] && is_apart) is_whole[cut.polygon[t]] = 0;
  }
  return static_cast<std::uint64_t>(std::count(is_whole.begin(), is_whole.end(), 0));
}

SerialiseInput serialise_input(const PolygonSoup& soup, const Mesh& mesh, const CompileOptions& options, unsigned jobs) {
  SerialiseInput input;
  input.origin = mesh.origin;
  input.metres_per_unit = options.metres_per_unit;
  input.quantum = header_quantum(soup, mesh);
  input.source_vertex_count = static_cast<std::uint32_t>(soup.points.size());
  input.source_face_count = static_cast<std::uint32_t>(soup.face_count());
  input.precision = options.precision;
  input.with_planes = options.store_planes;
  input.with_hierarchy = !options.without.contains("hierarchy");
  input.with_source_map = !options.without.contains("source-map");
  input.jobs = jobs;
  return input;
}

// Why the format cannot represent the object; empty if it can.
std::string out_of_range(const Graph& graph, const SerialiseInput& input) {
  const bool is_f32 = input.precision == Precision::f32;
  const double largest = is_f32 ? FDCG_LARGEST_EXTENT_F32 : FDCG_LARGEST_EXTENT_F64;
  constexpr double kLargestOrigin = 1e100;  // accepted by the runtime
  constexpr double kLargestSeen = 1e38;     // a float
  double extent = 0;
  for (const Vec3& point : graph.points)
    extent = std::max(extent, largest_component(point));
  if (!(extent >= 1 / largest && extent <= largest && input.quantum <= largest)) {
    return "the object reaches " + format_number(extent) + " from its middle, in coordinates known to within " +
           format_number(input.quantum) + "; the format holds " + format_number(1 / largest) + " to " + format_number(largest) +
           ": scale the mesh" + (is_f32 ? ", or compile it with --precision f64" : "");
  }
  if (!input.visual.is_empty() && extent > kLargestSeen) {
    return "the object reaches " + format_number(extent) + " from its middle; the mesh for the eye, in floats, holds up to " +
           format_number(kLargestSeen) + ": scale the mesh, or leave out --visual";
  }
  if (!(largest_component(input.origin) <= kLargestOrigin)) {
    return "the object lies " + format_number(largest_component(input.origin)) + " from the origin, the format holds up to " +
           format_number(kLargestOrigin) + ": move the mesh";
  }
  return {};
}

// Memory for the result, in large pages where available.
std::span<std::byte> allocate_in(std::vector<std::byte>& bytes, std::size_t count) {
  bytes.reserve(count);
  prefer_large_pages(bytes.data(), count);
  bytes.resize(count);
  return bytes;
}

void free_geometry(PolygonSoup& soup) {
  release(soup.points);
  release(soup.corners);
  if (soup.materials.empty()) release(soup.face_first);
}

// The bytes of a file from a mesh that has passed the checks. `spare` as compile_by has it.
Result<std::span<std::byte>> build(const PolygonSoup& soup, Mesh mesh, Topology topology, const CompileOptions& options,
                                   unsigned jobs, Compiled& compiled, PolygonSoup* spare) {
  SerialiseInput input = serialise_input(soup, mesh, options, jobs);
  if (spare != nullptr && options.normals != Normals::file && !options.visual && !options.heights) free_geometry(*spare);
  const Quantum quantum = quantum_of(soup, mesh, options.precision);
  const std::vector<std::uint32_t> source_face = mesh.source_face;
  Triangulation cut = triangulate(std::move(mesh), std::move(topology));
  if (!cut.uncuttable.empty()) {  // not found by self-crossing-face
    return Failure{4, soup.name + ": no cut was found for polygon " + std::to_string(cut.uncuttable[0]) +
                          ", which does not cross itself; triangulate it, and please report this fault"};
  }
  Merged faces;
  faces.edges = classify_edges(cut.mesh, cut.topology, quantum, options.coplanar, jobs);
  faces.regions = find_regions(cut.mesh, cut.topology, faces.edges, {options.coplanar, quantum, options.precision});
  compiled.split_faces = count_split(cut, faces.regions);
  release(cut.is_whole);
  CornerNormals normals;
  if (!options.without.contains("normals")) normals = find_corner_normals(soup, source_face, cut, options);
  compiled.shaded_faces = normals.shaded;
  compiled.unusable_normals = normals.unusable;
  if (options.visual) input.visual = draw_triangles(soup, source_face, cut, options);
  const bool has_materials = !soup.materials.empty() && !options.without.contains("materials");
  if (has_materials) split_by_material(soup, source_face, cut, faces.regions);
  split_by_normals(normals, faces.regions);
  NodePlaces places;
  if (options.heights) places = find_node_places(soup, source_face, cut, faces.regions);
  auto mass = weigh(cut.mesh, cut.topology, faces.regions, options, jobs, compiled);
  if (!mass) return mass.error();
  input.mass = *mass;
  const std::vector<VertexId> corners = normals.shaded > 0 ? cut.mesh.corners : std::vector<VertexId>{};
  if (faces.regions.list.empty()) {
    faces.mesh = std::move(cut.mesh);
    faces.topology = std::move(cut.topology);
  } else {
    const bool keeps_polygons = !cut.polygon.empty() && !options.triangles;
    const MergeOptions how{options.merge && !options.triangles, options.coplanar, quantum,
                           keeps_polygons ? &cut.polygon : nullptr, jobs};
    faces = merge_regions(std::move(cut.mesh), std::move(cut.topology), std::move(faces.edges), std::move(faces.regions), how);
    if (input.mass) input.mass->deviation = std::max(input.mass->deviation, faces.removed_distance);
  }
  input.normals_of_face = normals_of_faces(normals, corners, faces);
  if (options.heights) {
    auto heights = make_height_sections(soup, places_of_faces(places, faces), options, jobs);
    if (!heights) return heights.error();
    input.heights = std::move(*heights);
  }
  const std::vector<std::uint32_t> seen_faces = options.visual ? faces.face_of_triangle : std::vector<std::uint32_t>{};
  std::vector<std::uint32_t> face_of_source =
      trace_sources(input.source_face_count, source_face, cut.polygon, std::move(faces.face_of_triangle));
  compiled.merged_faces = count_sharing(face_of_source, faces.mesh.face_count());
  if (has_materials) {
    input.materials = soup.materials;
    input.material_of_face = material_of_faces(soup, faces, face_of_source);
  }
  if (!options.without.contains("info"))
    input.info = info_json(soup, input.source_vertex_count, input.source_face_count, options, compiled);
  Graph graph = order_graph(std::move(faces.mesh), std::move(faces.topology), std::move(faces.edges), std::move(faces.regions),
                            jobs, options.visual);
  if (std::string reason = out_of_range(graph, input); !reason.empty()) return Failure{3, soup.name + ": " + reason};
  if (options.visual) share_vertices(input.visual, graph, seen_faces);
  if (input.with_source_map) input.node_of_source = nodes_of_sources(std::move(face_of_source), graph.node_of_face);
  if (!has_materials && input.normals_of_face.empty() && input.heights.is_empty()) release(graph.node_of_face);
  if (options.allocate) return serialise(graph, input, options.allocate);
  return serialise(graph, input, [&](std::size_t count) { return allocate_in(compiled.bytes, count); });
}

CheckOptions check_options_of(const CompileOptions& options, unsigned jobs) {
  CheckOptions how;
  how.allow = options.allow;
  if (!options.self_intersections) how.severities["self-intersection"] = std::nullopt;
  how.max_elements = options.max_elements;
  how.precision = options.precision;
  how.jobs = jobs;
  return how;
}

}  // namespace

// A closed mesh has half as many connections as sides, and some six fan entries to a corner.
std::size_t likely_file_bytes(const PolygonSoup& soup, const CompileOptions& options) {
  const bool is_f32 = options.precision == Precision::f32;
  const std::size_t node = is_f32 ? offsetof(fdcg_node_f32, sides) : offsetof(fdcg_node_f64, sides);
  const std::size_t plane = !options.store_planes ? 0 : is_f32 ? sizeof(fdcg_plane_f32) : sizeof(fdcg_plane_f64);
  const std::size_t edge = !options.store_planes ? 0
                           : is_f32              ? sizeof(fdcg_connection_geometry_f32)
                                                 : sizeof(fdcg_connection_geometry_f64);
  const std::size_t corner = is_f32 ? sizeof(fdcg_corner_f32) : sizeof(fdcg_corner_f64);
  const std::size_t hierarchy = sizeof(fdcg_box8) / (FDCG_LEAF_NODES * (FDCG_TREE_WAYS - 1)) + 1;
  const std::size_t per_face = node + hierarchy + sizeof(std::uint32_t);
  const std::size_t per_side = sizeof(fdcg_side) + plane + (sizeof(fdcg_connection) + edge) / 2 + corner / 6;
  constexpr std::size_t kHeaderAndInfo = 4096;
  const std::size_t seen =
      options.visual ? soup.corners.size() * (sizeof(fdcg_visual_vertex) / 6 + 2 * sizeof(std::uint32_t)) : 0;
  std::size_t felt = options.heights ? soup.face_count() * sizeof(fdcg_node_place) : 0;
  for (const HeightImage& image : soup.appearance.images)
    felt += options.heights ? image.values.size() * 5 : 0;  // 2 1/3 numbers a texel, in all levels
  return kHeaderAndInfo + soup.face_count() * per_face + soup.corners.size() * per_side + seen + felt;
}

double quantum_that_counts(double given, const PolygonSoup& soup) {
  return at_most_a_share(given, soup.points);
}

Result<Compiled> compile_by(const PolygonSoup& soup, const CompileOptions& options, RepairStage* repair, PolygonSoup* spare) {
  if (std::string reason = check_options(options); !reason.empty()) return Failure{2, std::move(reason)};
  if (options.normals == Normals::file && soup.corner_normals.empty())
    return Failure{2,
                   soup.name +
                       ": holds no normals (vn of OBJ, nx ny nz of PLY, NORMAL of glTF, normals of Draco); --normals faces "
                       "makes them from the faces",
                   {}};
  if (options.heights) {
    if (std::string missing = missing_for_heights(soup, options); !missing.empty()) return Failure{2, std::move(missing), {}};
  }
  const unsigned jobs = resolve_jobs(options.jobs);
  const auto stage = [&](std::string_view name, double fraction) {
    if (options.progress) options.progress(name, fraction);
  };
  Compiled compiled;
  stage("weld", 0);
  Prepared ready = prepare(soup, options.weld, options.precision, options.orient, jobs);
  compiled.flipped_faces = ready.flipped_faces;
  stage("check", 0.2);
  const CheckOptions how = check_options_of(options, jobs);
  compiled.report = check(soup, ready.mesh, ready.topology, ready.states, how);
  if (options.repair && repair != nullptr) repair(soup, options, how, compiled, ready);
  if (!compiled.report.passes()) return compiled;
  release(ready.states);
  stage("graph", 0.5);
  const auto file = build(soup, std::move(ready.mesh), std::move(ready.topology), options, jobs, compiled, spare);
  if (!file) return file.error();
  if (options.allocate) compiled.placed = *file;
  stage("graph", 1);
  return compiled;
}

}  // namespace fdcg::bake
