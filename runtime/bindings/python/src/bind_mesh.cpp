// SPDX-License-Identifier: Apache-2.0
// Meshes: read, validate, repair, compile, write.
#include <algorithm>
#include <memory>

#include "bind.hpp"

namespace fdcg::python {
namespace {

using bake::PolygonSoup;

template <class T>
T value_of(bake::Result<T>&& result) {
  if (!result) raise(result.error().message);
  return std::move(*result);
}

PolygonSoup read_mesh(const std::string& path) {
  py::gil_scoped_release others_run;
  bake::Result<PolygonSoup> soup = bake::import_mesh(path);
  py::gil_scoped_acquire own;
  return value_of(std::move(soup));
}

void write_mesh(const PolygonSoup& soup, const std::string& path) {
  bake::ExportOptions options;
  const std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  if (ending == ".obj") {
    options.format = bake::Format::obj;
  } else if (ending == ".ply") {
    options.format = bake::Format::ply;
  } else if (ending == ".stl") {
    options.format = bake::Format::stl;
  } else if (ending != ".off") {
    raise("'" + path + "': meshes are written as .off, .obj, .ply and .stl");
  }
  const std::string bytes = value_of(bake::export_mesh(soup, options));
  py::module_::import("pathlib").attr("Path")(path).attr("write_bytes")(py::bytes(bytes));
}

void set_points(PolygonSoup& soup, const Places& points) {
  const auto count = static_cast<std::size_t>(rows_of(points, "points"));
  soup.points.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    soup.points[i] = {points.data()[3 * i], points.data()[3 * i + 1], points.data()[3 * i + 2]};
}

void add_corner(PolygonSoup& soup, std::int64_t corner) {
  const bool is_valid = corner >= 0 && static_cast<std::uint64_t>(corner) < soup.points.size();
  soup.corners.push_back(is_valid ? static_cast<std::uint32_t>(corner) : PolygonSoup::kInvalidVertex);
}

// `faces`: an integer array (n, sides), or any sequence of sequences.
PolygonSoup make_mesh(const Places& points, const py::object& faces, const std::string& name) {
  PolygonSoup soup;
  soup.name = name;
  soup.relative_quantum = 0x1p-53;
  set_points(soup, points);
  soup.face_first.push_back(0);
  if (py::isinstance<py::array>(faces)) {
    const auto array = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(faces);
    if (!array || array.ndim() != 2) raise("faces must have the shape (n, corners) and hold whole numbers");
    for (py::ssize_t f = 0; f < array.shape(0); ++f) {
      for (py::ssize_t k = 0; k < array.shape(1); ++k)
        add_corner(soup, *array.data(f, k));
      soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    }
    return soup;
  }
  for (const py::handle face : faces) {
    for (const py::handle corner : face)
      add_corner(soup, corner.cast<std::int64_t>());
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  return soup;
}

py::array_t<double> points_of(const py::object& self) {
  auto& soup = self.cast<PolygonSoup&>();
  static_assert(sizeof(bake::Vec3) == 3 * sizeof(double));
  const py::ssize_t count = static_cast<py::ssize_t>(soup.points.size());
  return py::array_t<double>({count, py::ssize_t{3}}, reinterpret_cast<const double*>(soup.points.data()), self);
}

std::vector<std::vector<std::uint32_t>> faces_of(const PolygonSoup& soup) {
  std::vector<std::vector<std::uint32_t>> faces(soup.face_count());
  for (std::size_t f = 0; f < faces.size(); ++f)
    faces[f].assign(soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
  return faces;
}

const char* name_of(bake::Severity severity) {
  return severity == bake::Severity::error ? "error" : severity == bake::Severity::warning ? "warning" : "note";
}

bake::Precision precision_from(const std::string& name) {
  if (name == "f64") return bake::Precision::f64;
  if (name == "f32") return bake::Precision::f32;
  raise("precision is '" + name + "', allowed are f64 and f32");
}

bake::RepairLevel level_from(const std::string& name) {
  if (name == "safe") return bake::RepairLevel::safe;
  if (name == "full") return bake::RepairLevel::full;
  raise("level is '" + name + "', allowed are safe and full");
}

bake::Report validate_mesh(const PolygonSoup& soup, bool orient, const std::string& precision) {
  bake::ValidateOptions options;
  options.orient = orient;
  options.precision = precision_from(precision);
  py::gil_scoped_release others_run;
  return bake::validate(soup, options);
}

py::tuple repair_mesh(const PolygonSoup& soup, const std::string& level) {
  const bake::RepairOptions options = bake::repair_options(level_from(level));
  py::gil_scoped_release others_run;
  bake::Result<bake::Repaired> repaired = bake::repair(soup, options);
  py::gil_scoped_acquire own;
  bake::Repaired value = value_of(std::move(repaired));
  py::dict counts;
  for (const bake::RepairAction& action : value.actions) {
    if (action.total > 0) counts[action.name.c_str()] = action.total;
  }
  return py::make_tuple(std::move(value.soup), counts);
}

std::shared_ptr<Graph> compile_mesh(const PolygonSoup& soup, double metres_per_unit, const std::string& precision, bool merge,
                                    bool orient, bool triangles, double density_kg_per_m3, const py::object& repair) {
  bake::CompileOptions options;
  options.metres_per_unit = metres_per_unit;
  options.precision = precision_from(precision);
  options.merge = merge;
  options.orient = orient;
  options.triangles = triangles;
  options.density_kg_per_m3 = density_kg_per_m3;
  if (!repair.is_none()) options.repair = level_from(repair.cast<std::string>());
  py::gil_scoped_release others_run;
  bake::Result<bake::Compiled> result = bake::compile(soup, options);
  py::gil_scoped_acquire own;
  bake::Compiled compiled = value_of(std::move(result));
  if (!compiled.report.passes()) raise(bake::report_text(compiled.report, false));
  auto graph = std::make_shared<Graph>();
  graph->bytes = std::move(compiled.bytes);
  fdcg_error error;
  check(fdcg_open_memory(graph->bytes.data(), graph->bytes.size(), FDCG_VERIFY_TRUSTED, &graph->view, &error), error);
  return graph;
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::class_<PolygonSoup>(module, "Mesh", "A polygon mesh, in the units of its file.")
      .def(py::init(&make_mesh), py::arg("points"), py::arg("faces"), py::arg("name") = "mesh",
           "points: (n, 3); faces: (m, corners), or sequences of corners of any lengths, counter-clockwise from outside.")
      .def_property_readonly("points", &points_of, "(n, 3), the file's units; a view, not a copy")
      .def_property_readonly("faces", &faces_of, "lists of corners")
      .def_property_readonly("face_count", &PolygonSoup::face_count)
      .def_readonly("metres_per_unit", &PolygonSoup::metres_per_unit, "as the file states it; 0: it does not")
      .def_readonly("materials", &PolygonSoup::materials, "names, in order of first use")
      .def_readonly("name", &PolygonSoup::name)
      .def("write", &write_mesh, py::arg("path"), "Writes OFF, OBJ, PLY or STL, by the path's ending.");
  py::class_<bake::Issue>(module, "Issue", "Everything found under one rule.")
      .def_readonly("rule", &bake::Issue::rule)
      .def_property_readonly("severity", [](const bake::Issue& issue) { return name_of(issue.severity); })
      .def_readonly("total", &bake::Issue::total, "exact, however few are listed")
      .def_readonly("message", &bake::Issue::message)
      .def_property_readonly(
          "faces",
          [](const bake::Issue& issue) {
            std::vector<std::vector<std::uint32_t>> faces;
            for (const bake::Element& element : issue.elements)
              faces.push_back(element.faces);
            return faces;
          },
          "of each listed finding, its faces");
  py::class_<bake::Report>(module, "Report", "What validate found.")
      .def_property_readonly("passes", [](const bake::Report& report) { return report.passes(); })
      .def_readonly("issues", &bake::Report::issues)
      .def_readonly("components", &bake::Report::components)
      .def("__bool__", [](const bake::Report& report) { return report.passes(); })
      .def("__str__", [](const bake::Report& report) { return bake::report_text(report, false); });
  module.def("read", &read_mesh, py::arg("path"), "Reads a mesh file of any format that fdcg reads.");
  module.def("validate", &validate_mesh, py::arg("mesh"), py::arg("orient") = false, py::arg("precision") = "f64",
             "Checks a mesh; the report is true where it passes.");
  module.def("repair", &repair_mesh, py::arg("mesh"), py::arg("level") = "safe",
             "The repaired mesh, and how often each step did something, by its name.");
  module.def("compile", &compile_mesh, py::arg("mesh"), py::arg("metres_per_unit") = 1.0, py::arg("precision") = "f64",
             py::arg("merge") = true, py::arg("orient") = false, py::arg("triangles") = false,
             py::arg("density_kg_per_m3") = 0.0, py::arg("repair") = py::none(),
             "Compiles a mesh into a graph. Error, with the report, where the mesh does not pass.");
}

}  // namespace fdcg::python
