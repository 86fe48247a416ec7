// SPDX-License-Identifier: Apache-2.0
// Do contacts hold an object?
#include "bind.hpp"
#include "fdcg/grasp.hpp"

namespace fdcg::python {
namespace {

bake::Vec3 vector_at(const Places& rows, py::ssize_t i) {
  return {*rows.data(i, 0), *rows.data(i, 1), *rows.data(i, 2)};
}

py::dict judge_grasp(const Places& points_m, const Places& inward, double mu, double torsion_m, const py::object& centre_m,
                     double torque_scale_m) {
  grasp::Grasp held;
  const py::ssize_t count = rows_of(points_m, "points_m");
  if (rows_of(inward, "inward") != count) raise("points_m and inward must have as many rows");
  for (py::ssize_t i = 0; i < count; ++i)
    held.contacts.push_back({vector_at(points_m, i), vector_at(inward, i), mu, torsion_m});
  const Place centre = centre_m.is_none() ? Place{0, 0, 0} : place_from(centre_m, "centre_m");
  held.centre_m = {centre[0], centre[1], centre[2]};
  held.torque_scale_m = torque_scale_m;
  if (const auto problem = grasp::problem_of(held)) raise(*problem);
  grasp::Closure closure;
  grasp::Epsilon epsilon;
  {
    py::gil_scoped_release others_run;
    closure = grasp::force_closure(held);
    epsilon = grasp::ferrari_canny(held);
  }
  py::dict found;
  found["holds"] = closure.verdict == grasp::Verdict::closure      ? py::object(py::bool_(true))
                   : closure.verdict == grasp::Verdict::no_closure ? py::object(py::bool_(false))
                                                                   : py::object(py::none());
  found["epsilon"] = epsilon.value;
  found["epsilon_lower"] = epsilon.lower;
  const bake::Vec3 &force = closure.weakest.force_n, &torque = closure.weakest.torque_nm;
  found["weakest_force_n"] = Place{force.x, force.y, force.z};
  found["weakest_torque_n_m"] = Place{torque.x, torque.y, torque.z};
  return found;
}

}  // namespace

void bind_grasp(py::module_& module) {
  module.def("grasp", &judge_grasp, py::arg("points_m"), py::arg("inward"), py::arg("mu"), py::arg("torsion_m") = 0.0,
             py::arg("centre_m") = py::none(), py::arg("torque_scale_m") = 1.0,
             "Force closure (holds: True, False, or None where neither is proved) and the Ferrari-Canny epsilon.");
}

}  // namespace fdcg::python
