// SPDX-License-Identifier: Apache-2.0
// The offline pipeline on one screen.
#include "fdcg/bake.hpp"

#include <algorithm>
#include <utility>

#include "classify.hpp"
#include "graph.hpp"
#include "info.hpp"
#include "parallel.hpp"
#include "quantum.hpp"
#include "regions.hpp"
#include "serialise.hpp"
#include "topology.hpp"
#include "vec.hpp"
#include "weld.hpp"

namespace fdcg::bake {
namespace {

Quantum quantum_of(const PolygonSoup& soup, const Mesh& mesh, Precision precision) {
  constexpr double kHalfUlpOfFloat = 0x1p-24;
  return {soup.relative_quantum, soup.absolute_quantum, precision == Precision::f32 ? kHalfUlpOfFloat : 0, mesh.origin};
}

// Of one coordinate at the object's extent: what the header tells.
double header_quantum(const PolygonSoup& soup, const Mesh& mesh) {
  double extent = 0;
  for (const Vec3& point : mesh.points)
    extent = std::max(extent, largest_component(point + mesh.origin));
  return std::max(soup.relative_quantum * extent, soup.absolute_quantum);
}

SerialiseInput serialise_input(const PolygonSoup& soup, const Mesh& mesh, const CompileOptions& options, unsigned jobs) {
  SerialiseInput input;
  input.origin = mesh.origin;
  input.metres_per_unit = options.metres_per_unit;
  input.quantum = header_quantum(soup, mesh);
  input.source_vertex_count = static_cast<std::uint32_t>(soup.points.size());
  input.source_face_count = static_cast<std::uint32_t>(soup.face_count());
  input.precision = options.precision;
  input.with_voronoi_planes = options.store_voronoi_planes;
  input.with_hierarchy = !options.without.contains("hierarchy");
  input.with_source_map = !options.without.contains("source-map");
  input.jobs = jobs;
  return input;
}

}  // namespace

Result<Compiled> compile(const PolygonSoup& soup, const CompileOptions& options) {
  const unsigned jobs = resolve_jobs(options.jobs);
  Compiled compiled;
  Mesh mesh = weld_points(soup, options.weld, options.precision, jobs);
  Topology topology = pair_halfedges(mesh);
  const Quantum quantum = quantum_of(soup, mesh, options.precision);
  std::vector<EdgeClass> edges = classify_edges(mesh, topology, quantum, options.coplanar, jobs);
  Regions regions;
  SerialiseInput input = serialise_input(soup, mesh, options, jobs);
  if (!options.without.contains("info")) input.info = info_json(soup, options, compiled);
  const Graph graph = order_graph(std::move(mesh), std::move(topology), std::move(edges), std::move(regions), jobs);
  auto bytes = serialise(graph, input);
  if (!bytes) return bytes.error();
  compiled.bytes = std::move(*bytes);
  return compiled;
}

}  // namespace fdcg::bake
