// SPDX-License-Identifier: Apache-2.0
// Reliefs and effects of a contact.
#include <memory>
#include <string>

#include "bind.hpp"

namespace fdcg::python {
namespace {

// In its last place, since it names what is beside it.
std::shared_ptr<Relief> finished(std::shared_ptr<Relief> made, double reserve_j, double power_w) {
  made->relief.reserve_j = reserve_j;
  made->relief.power_w = power_w;
  fdcg_error error;
  check(fdcg_check_relief(&made->relief, &error), error);
  return made;
}

std::shared_ptr<Relief> of_waves(const fdcg_waves& waves, double reserve_j, double power_w) {
  auto made = std::make_shared<Relief>();
  made->waves = waves;
  made->relief = fdcg_make_relief(&made->waves);
  return finished(std::move(made), reserve_j, power_w);
}

std::shared_ptr<Relief> of_images(std::shared_ptr<Graph> graph, double reserve_j, double power_w) {
  auto made = std::make_shared<Relief>();
  fdcg_error error;
  check(fdcg_get_heights(&graph->view, &made->heights, &error), error);
  made->graph = std::move(graph);
  made->relief = fdcg_make_height_relief(&made->heights);
  return finished(std::move(made), reserve_j, power_w);
}

fdcg_effect checked(const fdcg_effect& effect, double tick_s) {
  fdcg_error error;
  check(fdcg_check_effect(&effect, tick_s, &error), error);
  return effect;
}

}  // namespace

fdcg_result step_felt(Contact& contact, const double hip_m[3]) {
  fdcg_result result;
  const double tick_s = contact.params.tick_s;
  double moved_m[3] = {hip_m[0], hip_m[1], hip_m[2]};
  if (contact.relief) fdcg_relief_move(&contact.relief->relief, &contact.relief_state, hip_m, tick_s, moved_m);
  fdcg_step(&contact.graph->view, &contact.params, &contact.state, moved_m, &result);
  double reach_m = 0;
  for (const fdcg_effect& effect : contact.effects)
    if (effect.kind == FDCG_EFFECT_MAGNET && effect.distance_m > reach_m) reach_m = effect.distance_m;
  fdcg_effect_facts facts;
  if (fdcg_get_effect_facts(&contact.graph->view, &result, moved_m, reach_m, tick_s, &facts, nullptr) != FDCG_OK) return result;
  if (contact.relief) fdcg_relief_turn(&contact.relief->relief, &contact.relief_state, &facts, result.force_n);
  for (std::size_t i = 0; i < contact.effects.size(); ++i)
    fdcg_effect_step(&contact.effects[i], &facts, &contact.effect_states[i], result.force_n);
  return result;
}

void bind_relief(py::module_& module) {
  const auto reserve = py::arg("reserve_j") = 0.002, power = py::arg("power_w") = 0.02;
  py::class_<Relief, std::shared_ptr<Relief>>(module, "Relief", "Heights that are felt and not in the mesh; metres.")
      .def_static(
          "ridges",
          [](double amplitude_m, double wavelength_m, const Place& direction, double reserve_j, double power_w) {
            return of_waves(fdcg_make_ridges(amplitude_m, wavelength_m, direction.data()), reserve_j, power_w);
          },
          py::arg("amplitude_m"), py::arg("wavelength_m"), py::arg("direction") = Place{1, 0, 0}, reserve, power)
      .def_static(
          "bumps",
          [](double amplitude_m, double wavelength_m, double reserve_j, double power_w) {
            return of_waves(fdcg_make_bumps(amplitude_m, wavelength_m), reserve_j, power_w);
          },
          py::arg("amplitude_m"), py::arg("wavelength_m"), reserve, power)
      .def_static(
          "grain",
          [](double rms_m, double shortest_m, double longest_m, double exponent, std::uint32_t seed, double reserve_j,
             double power_w) {
            if (!(shortest_m > 0 && longest_m >= shortest_m)) raise("shortest_m must be above 0, longest_m at least as long");
            return of_waves(fdcg_make_grain(rms_m, shortest_m, longest_m, exponent, seed), reserve_j, power_w);
          },
          py::arg("rms_m"), py::arg("shortest_m"), py::arg("longest_m"), py::arg("exponent") = 1.0, py::arg("seed") = 0,
          reserve, power)
      .def_static("images", &of_images, py::arg("graph"), reserve, power, "The images of a graph compiled with --heights.")
      .def_property_readonly(
          "most_m", [](const Relief& relief) { return relief.relief.most_m; }, "No height is larger.")
      .def_property_readonly("curvature_per_m", [](const Relief& relief) { return relief.relief.curvature_per_m; });
  const auto tick = py::arg("tick_s") = 0.001;
  py::class_<fdcg_effect>(module, "Effect", "A force on top of a contact's; tick_s is the longest tick that it is used with.")
      .def_static(
          "magnet",
          [](double force_n, double distance_m, double tick_s) {
            return checked(fdcg_make_magnet(force_n, distance_m), tick_s);
          },
          py::arg("force_n"), py::arg("distance_m"), tick)
      .def_static(
          "viscosity", [](double viscosity, double tick_s) { return checked(fdcg_make_viscosity(viscosity), tick_s); },
          py::arg("viscosity_n_s_per_m"), tick)
      .def_static(
          "stick_slip",
          [](double stiffness, double force_n, double tick_s) {
            return checked(fdcg_make_stick_slip(stiffness, force_n), tick_s);
          },
          py::arg("stiffness_n_per_m"), py::arg("force_n"), tick)
      .def_static(
          "vibration",
          [](double force_n, double frequency_hz, double tick_s) {
            return checked(fdcg_make_vibration(force_n, frequency_hz), tick_s);
          },
          py::arg("force_n"), py::arg("frequency_hz"), tick)
      .def_static(
          "noise",
          [](double force_n, double low_hz, double high_hz, double tick_s) {
            return checked(fdcg_make_noise(force_n, low_hz, high_hz), tick_s);
          },
          py::arg("force_n"), py::arg("low_hz"), py::arg("high_hz"), tick)
      .def_static(
          "tap",
          [](double impact, double frequency_hz, double decay_s, double tick_s) {
            return checked(fdcg_make_tap(impact, frequency_hz, decay_s), tick_s);
          },
          py::arg("impact_n_s_per_m"), py::arg("frequency_hz"), py::arg("decay_s"), tick)
      .def_static(
          "pulse",
          [](double force_n, double duration_s, double period_s, double tick_s) {
            return checked(fdcg_make_pulse(force_n, duration_s, period_s), tick_s);
          },
          py::arg("force_n"), py::arg("duration_s"), py::arg("period_s") = 0.0, tick);
}

}  // namespace fdcg::python
