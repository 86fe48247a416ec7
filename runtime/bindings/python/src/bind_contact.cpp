// SPDX-License-Identifier: Apache-2.0
// Parameters, contacts, and whole paths in one call.
#include <memory>
#include <optional>

#include "bind.hpp"
#include "fdcg/query.h"

namespace fdcg::python {
namespace {

using Results = py::array_t<fdcg_result, py::array::c_style>;

const char* name_of_state(std::uint32_t state) {
  static constexpr const char* kNames[] = {"free", "face", "edge", "vertex"};
  return kNames[state <= FDCG_VERTEX ? state : 0];
}

py::tuple triple(const double (&values)[3]) {
  return py::make_tuple(values[0], values[1], values[2]);
}

fdcg_params make_params(double mu_static, double mu_dynamic, double stiffness, double damping, double tick_s,
                        const std::string& edge_friction) {
  fdcg_params params = fdcg_make_params();
  params.mu_static = mu_static;
  params.mu_dynamic = mu_dynamic;
  params.stiffness_n_per_m = stiffness;
  params.damping_n_s_per_m = damping;
  params.tick_s = tick_s;
  if (edge_friction != "wedge" && edge_friction != "paper")
    raise("edge_friction is '" + edge_friction + "', allowed are wedge and paper");
  params.edge_friction = edge_friction == "wedge" ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER;
  fdcg_error error;
  check(fdcg_check_params(&params, &error), error);
  return params;
}

std::shared_ptr<Contact> make_contact(std::shared_ptr<Graph> graph, const std::optional<fdcg_params>& params,
                                      std::shared_ptr<Relief> relief, std::vector<fdcg_effect> effects) {
  if (relief && relief->graph && relief->graph != graph) raise("the relief's images are of another graph");
  auto contact = std::make_shared<Contact>();
  contact->graph = std::move(graph);
  contact->params = params ? *params : fdcg_make_params();
  contact->relief = std::move(relief);
  contact->effects = std::move(effects);
  contact->reset();
  return contact;
}

fdcg_result step(Contact& contact, const py::handle& hip_m) {
  const Place hip = place_from(hip_m, "hip_m");
  if (!contact.is_plain()) return step_felt(contact, hip.data());
  fdcg_result result;
  fdcg_step(&contact.graph->view, &contact.params, &contact.state, hip.data(), &result);
  return result;
}

Results path(Contact& contact, const Places& hips_m, const std::optional<Results>& out) {
  const py::ssize_t count = rows_of(hips_m, "hips_m");
  if (out && (out->ndim() != 1 || out->shape(0) != count)) raise("out must have an entry for each row of hips_m");
  Results results = out ? *out : Results(count);
  fdcg_result* const first = results.mutable_data();
  const double* const hips = hips_m.data();
  py::gil_scoped_release others_run;
  if (!contact.is_plain()) {
    for (py::ssize_t i = 0; i < count; ++i)
      first[i] = step_felt(contact, hips + 3 * i);
    return results;
  }
  fdcg_step_path(&contact.graph->view, &contact.params, &contact.state, hips, first, static_cast<std::uint64_t>(count));
  return results;
}

fdcg_contact_info info_of(const Contact& contact, const fdcg_result& now, const fdcg_result* before) {
  fdcg_contact_info info = fdcg_make_contact_info();
  fdcg_error error;
  check(fdcg_get_contact_info(&contact.graph->view, nullptr, before, &now, contact.params.tick_s, &info, &error), error);
  return info;
}

}  // namespace

void bind_contact(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(fdcg_result, force_n, god_object_m, state, feature, slipping, transitions, flags, reserved);
  module.attr("result_dtype") = py::dtype::of<fdcg_result>();
  py::class_<fdcg_params>(module, "Params", "What a contact feels like; SI units.")
      .def(py::init(&make_params), py::arg("mu_static") = 0.6, py::arg("mu_dynamic") = 0.4,
           py::arg("stiffness_n_per_m") = 1000.0, py::arg("damping_n_s_per_m") = 0.0, py::arg("tick_s") = 0.001,
           py::arg("edge_friction") = "wedge")
      .def_readonly("mu_static", &fdcg_params::mu_static)
      .def_readonly("mu_dynamic", &fdcg_params::mu_dynamic)
      .def_readonly("stiffness_n_per_m", &fdcg_params::stiffness_n_per_m)
      .def_readonly("damping_n_s_per_m", &fdcg_params::damping_n_s_per_m)
      .def_readonly("tick_s", &fdcg_params::tick_s);
  py::class_<fdcg_result>(module, "Result", "What the hand feels in one tick.")
      .def_property_readonly(
          "force_n", [](const fdcg_result& result) { return triple(result.force_n); }, "newtons, on the hand")
      .def_property_readonly("god_object_m", [](const fdcg_result& result) { return triple(result.god_object_m); })
      .def_property_readonly(
          "state", [](const fdcg_result& result) { return name_of_state(result.state); }, "free, face, edge or vertex")
      .def_readonly("feature", &fdcg_result::feature)
      .def_property_readonly("is_slipping", [](const fdcg_result& result) { return result.slipping != 0; })
      .def_readonly("flags", &fdcg_result::flags);
  py::class_<fdcg_contact_info>(module, "ContactInfo", "What a contact is on.")
      .def_readonly("node", &fdcg_contact_info::node)
      .def_readonly("material", &fdcg_contact_info::material)
      .def_readonly("events", &fdcg_contact_info::events)
      .def_property_readonly("normal", [](const fdcg_contact_info& info) { return triple(info.normal); })
      .def_property_readonly("weights", [](const fdcg_contact_info& info) { return triple(info.weights); })
      .def_property_readonly("corners",
                             [](const fdcg_contact_info& info) {
                               return std::array<std::uint32_t, 3>{info.corners[0], info.corners[1], info.corners[2]};
                             })
      .def_property_readonly("slip_m_per_s", [](const fdcg_contact_info& info) { return triple(info.slip_m_per_s); });
  py::class_<Contact, std::shared_ptr<Contact>>(module, "Contact", "One contact point on one graph.")
      .def(py::init(&make_contact), py::arg("graph"), py::arg("params") = py::none(), py::arg("relief") = py::none(),
           py::arg("effects") = std::vector<fdcg_effect>{}, "`relief` and `effects`: on top of the contact (Relief, Effect).")
      .def("step", &step, py::arg("hip_m"), "A tick: moves the HIP (metres, object's frame) and computes the force.")
      .def("path", &path, py::arg("hips_m"), py::arg("out") = py::none(),
           "A tick for each row of (n, 3); an array of result_dtype, `out` if it is given.")
      .def("info", &info_of, py::arg("now"), py::arg("before") = py::none(), "What a result of this contact is on.")
      .def(
          "reset", [](Contact& contact) { contact.reset(); }, "Forgets the surface: the next tick starts anew, free.")
      .def_readonly("graph", &Contact::graph);
}

}  // namespace fdcg::python
