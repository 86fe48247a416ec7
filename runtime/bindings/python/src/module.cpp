// SPDX-License-Identifier: Apache-2.0
// The module fdcg._core.
#include "bind.hpp"

namespace fdcg::python {
namespace {

PyObject* error_type = nullptr;  // fdcg.Error

}  // namespace

void raise(const std::string& message) {
  PyErr_SetString(error_type, message.c_str());
  throw py::error_already_set();
}

Place place_from(const py::handle& sequence, const char* name) {
  Place place;
  if (PyTuple_CheckExact(sequence.ptr()) && PyTuple_GET_SIZE(sequence.ptr()) == 3) {
    for (std::size_t k = 0; k < 3; ++k)
      place[k] = PyFloat_AsDouble(PyTuple_GET_ITEM(sequence.ptr(), static_cast<Py_ssize_t>(k)));
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
    return place;
  }
  const Places array = Places::ensure(sequence);
  if (!array || array.size() != 3) {
    PyErr_Clear();
    raise(std::string(name) + " is not three numbers");
  }
  for (std::size_t k = 0; k < 3; ++k)
    place[k] = array.data()[k];
  return place;
}

py::ssize_t rows_of(const Places& places, const char* name) {
  if (places.ndim() != 2 || places.shape(1) != 3) raise(std::string(name) + " must have the shape (n, 3)");
  return places.shape(0);
}

}  // namespace fdcg::python

PYBIND11_MODULE(_core, module) {
  using namespace fdcg::python;
  module.doc() = "The compiled part of fdcg; import fdcg instead.";
  module.attr("__version__") = FDCG_VERSION_STRING;
  error_type = py::exception<void>(module, "Error", PyExc_ValueError).release().ptr();
  bind_mesh(module);
  bind_graph(module);
  bind_relief(module);
  bind_contact(module);
  bind_scene(module);
  bind_grasp(module);
}
