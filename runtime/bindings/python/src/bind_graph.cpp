// SPDX-License-Identifier: Apache-2.0
// Graphs: opened, looked at, asked for nearest points and rays.
#include "fdcg/query.h"

#include <cmath>
#include <limits>
#include <memory>

#include "bind.hpp"

namespace fdcg::python {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<Graph> open_graph(const std::string& path) {
  auto graph = std::make_shared<Graph>();
  fdcg_error error;
  fdcg_status status;
  {
    py::gil_scoped_release others_run;
    status = fdcg_open_file(path.c_str(), FDCG_VERIFY_SAFE, &graph->view, &error);
  }
  check(status, error);
  return graph;
}

// A view of the buffer where it is aligned, which is kept and must not be written.
std::shared_ptr<Graph> graph_from_bytes(const py::buffer& buffer) {
  const py::buffer_info info = buffer.request();
  const auto bytes = static_cast<std::size_t>(info.size * info.itemsize);
  auto graph = std::make_shared<Graph>();
  const void* data = info.ptr;
  if (reinterpret_cast<std::uintptr_t>(data) % 8 != 0) {
    const auto* first = static_cast<const std::byte*>(data);
    graph->bytes.assign(first, first + bytes);
    data = graph->bytes.data();
  } else {
    graph->buffer = buffer;
  }
  fdcg_error error;
  check(fdcg_open_memory(data, bytes, FDCG_VERIFY_SAFE, &graph->view, &error), error);
  return graph;
}

py::bytes bytes_of(const Graph& graph) {
  return {reinterpret_cast<const char*>(graph.view.header), static_cast<std::size_t>(graph.view.header->file_bytes)};
}

void save_graph(const Graph& graph, const std::string& path) {
  py::module_::import("pathlib").attr("Path")(path).attr("write_bytes")(bytes_of(graph));
}

void put_metres(const fdcg_header& header, const double local[3], double* metres) {
  for (int k = 0; k < 3; ++k)
    metres[k] = (local[k] + header.origin[k]) * header.metres_per_unit;
}

py::array_t<double> corners_of(const Graph& graph) {
  const fdcg_header& header = *graph.view.header;
  py::array_t<double> corners({static_cast<py::ssize_t>(header.corner_count), py::ssize_t{3}});
  for (std::uint32_t c = 0; c < header.corner_count; ++c)
    put_metres(header, fdcg_get_corner(&graph.view, c).point, corners.mutable_data(c, 0));
  return corners;
}

py::array_t<double> bounds_of(const Graph& graph) {
  py::array_t<double> bounds({py::ssize_t{2}, py::ssize_t{3}});
  const fdcg_header& header = *graph.view.header;
  put_metres(header, header.bounds_min, bounds.mutable_data(0, 0));
  put_metres(header, header.bounds_max, bounds.mutable_data(1, 0));
  return bounds;
}

// Each node as a fan of triangles: what plotting libraries draw.
py::array_t<std::uint32_t> triangles_of(const Graph& graph) {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t n = 0; n < graph.view.header->node_count; ++n) {
    const std::uint32_t sides = fdcg_get_node(&graph.view, n).side_count;
    for (std::uint32_t k = 2; k < sides; ++k) {
      for (const std::uint32_t side : {0u, k - 1, k})
        corners.push_back(fdcg_get_side(&graph.view, n, side).corner);
    }
  }
  return py::array_t<std::uint32_t>({static_cast<py::ssize_t>(corners.size() / 3), py::ssize_t{3}}, corners.data());
}

// What many points or rays have found: arrays of one entry each. Of those that found nothing distances are NaN.
struct Hits {
  py::array_t<double> points, normals, distances;
  py::array_t<std::uint32_t> nodes;
  py::array_t<std::int32_t> sides;

  explicit Hits(py::ssize_t count)
      : points({count, py::ssize_t{3}}), normals({count, py::ssize_t{3}}), distances(count), nodes(count), sides(count) {}
};

struct HitRow {
  double *point, *normal, *distance;
  std::uint32_t* node;
  std::int32_t* side;

  HitRow(Hits& hits, py::ssize_t i)
      : point(hits.points.mutable_data() + 3 * i),
        normal(hits.normals.mutable_data() + 3 * i),
        distance(hits.distances.mutable_data() + i),
        node(hits.nodes.mutable_data() + i),
        side(hits.sides.mutable_data() + i) {}
  void put(const fdcg_surface_hit* hit) const {
    for (int k = 0; k < 3; ++k) {
      point[k] = hit != nullptr ? hit->point_m[k] : kNan;
      normal[k] = hit != nullptr ? hit->normal[k] : kNan;
    }
    *distance = hit != nullptr ? hit->distance_m : kNan;
    *node = hit != nullptr ? hit->node : FDCG_NONE;
    *side = hit != nullptr ? hit->side : 0;
  }
};

Hits nearest_of(const Graph& graph, const Places& points, double reach_m) {
  const py::ssize_t count = rows_of(points, "points");
  Hits hits(count);
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  fdcg_error error;
  for (py::ssize_t i = 0; i < count; ++i) {
    const fdcg_status status = fdcg_find_nearest(&graph.view, points.data() + 3 * i, reach_m, &hit, &error);
    if (status != FDCG_E_ABSENT) check(status, error);
    HitRow(hits, i).put(status == FDCG_OK ? &hit : nullptr);
  }
  return hits;
}

Hits rays_of(const Graph& graph, const Places& from, const Places& directions, double reach_m) {
  const py::ssize_t count = rows_of(from, "origins");
  if (rows_of(directions, "directions") != count) raise("origins and directions must have as many rows");
  Hits hits(count);
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  fdcg_error error;
  for (py::ssize_t i = 0; i < count; ++i) {
    const fdcg_status status =
        fdcg_cast_ray(&graph.view, from.data() + 3 * i, directions.data() + 3 * i, reach_m, &hit, &error);
    if (status != FDCG_E_ABSENT) check(status, error);
    HitRow(hits, i).put(status == FDCG_OK ? &hit : nullptr);
  }
  return hits;
}

py::array_t<double> signed_distances(const Graph& graph, const Places& points) {
  const py::ssize_t count = rows_of(points, "points");
  py::array_t<double> distances(count);
  fdcg_error error;
  for (py::ssize_t i = 0; i < count; ++i)
    check(fdcg_get_signed_distance(&graph.view, points.data() + 3 * i, distances.mutable_data() + i, &error), error);
  return distances;
}

py::object mass_of(const Graph& graph) {
  fdcg_mass mass;
  fdcg_error error;
  const fdcg_status status = fdcg_get_mass(&graph.view, &mass, &error);
  if (status == FDCG_E_ABSENT) return py::none();
  check(status, error);
  py::dict values;
  values["volume_m3"] = mass.volume_m3;
  values["centroid_m"] = Place{mass.centroid_m[0], mass.centroid_m[1], mass.centroid_m[2]};
  values["density_kg_per_m3"] = mass.density_kg_per_m3;
  values["mass_kg"] = mass.mass_kg;
  return values;
}

}  // namespace

void bind_graph(py::module_& module) {
  py::class_<Hits>(module, "Hits", "Places on a surface, an entry for each point or ray; NaN where nothing was found.")
      .def_readonly("points_m", &Hits::points)
      .def_readonly("normals", &Hits::normals)
      .def_readonly("distances_m", &Hits::distances)
      .def_readonly("nodes", &Hits::nodes)
      .def_readonly("sides", &Hits::sides, "1: in front of the surface, -1: behind it");
  const double infinity = std::numeric_limits<double>::infinity();
  py::class_<Graph, std::shared_ptr<Graph>>(module, "Graph", "What fdcg compile makes of a mesh; only read.")
      .def_static("open", &open_graph, py::arg("path"), "Maps and verifies a .fdcg file.")
      .def_static("from_bytes", &graph_from_bytes, py::arg("buffer"), "Verifies and views a buffer, which must stay as it is.")
      .def("to_bytes", &bytes_of)
      .def("save", &save_graph, py::arg("path"))
      .def_property_readonly("node_count", [](const Graph& graph) { return graph.view.header->node_count; })
      .def_property_readonly("connection_count", [](const Graph& graph) { return graph.view.header->connection_count; })
      .def_property_readonly("corner_count", [](const Graph& graph) { return graph.view.header->corner_count; })
      .def_property_readonly("metres_per_unit", [](const Graph& graph) { return graph.view.header->metres_per_unit; })
      .def_property_readonly("bounds_m", &bounds_of, "(2, 3): least and greatest coordinates, metres")
      .def_property_readonly("mass", &mass_of, "volume, centroid, density and mass; None where the file has none")
      .def("corners_m", &corners_of, "(n, 3), metres")
      .def("triangles", &triangles_of, "(m, 3): the nodes as triangles, by their corners")
      .def("nearest", &nearest_of, py::arg("points"), py::arg("reach_m") = infinity,
           "For each point (metres) the nearest place of the surface.")
      .def("signed_distance", &signed_distances, py::arg("points"), "Metres; negative inside.")
      .def("cast_rays", &rays_of, py::arg("origins"), py::arg("directions"), py::arg("reach_m") = infinity,
           "For each ray what it meets first.");
}

}  // namespace fdcg::python
