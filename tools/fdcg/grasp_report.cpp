// SPDX-License-Identifier: Apache-2.0
#include "grasp_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../common/terminal.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::tools {
namespace {

using Json = nlohmann::ordered_json;
using bake::Vec3;

Json vector(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Json wrench(const grasp::Wrench& w) {
  return {{"force_n", vector(w.force_n)}, {"torque_nm", vector(w.torque_nm)}};
}

// JSON has no infinity.
Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

const char* verdict_name(grasp::Verdict verdict) {
  constexpr const char* kNames[] = {"closure", "no-closure", "marginal"};
  return kNames[static_cast<int>(verdict)];
}

Json contact_json(const GraspReport& report, std::size_t i) {
  const NamedContact& asked = report.asked[i];
  const SurfacePoint& found = report.found[i];
  const grasp::Contact& contact = report.grasp.contacts[i];
  return {{"name", asked.name},
          {"asked_m", vector(asked.point_m)},
          {"point_m", vector(contact.point_m)},
          {"distance_m", found.distance_m},
          {"node", found.node},
          {"is_on_edge", found.is_on_edge},
          {"inward", vector(contact.inward)},
          {"inward_from", asked.inward ? "contacts" : "surface"},
          {"mu", contact.mu},
          {"torsion_m", contact.torsion_m},
          {"cap_n", finite(contact.cap_n)}};
}

Json margin_json(const GraspReport& report) {
  if (!report.margin) return nullptr;
  const grasp::Margin& margin = *report.margin;
  Json contacts = Json::array();
  for (std::size_t i = 0; i < margin.forces.size(); ++i) {
    const grasp::ContactForce& force = margin.forces[i];
    contacts.push_back({{"name", report.asked[i].name},
                        {"press_n", force.press_n},
                        {"tangential_n", vector(force.tangential_n)},
                        {"moment_nm", force.moment_nm},
                        {"used", force.used},
                        {"carried", force.carried},
                        {"load_factor_without", force.factor_without}});
  }
  return {{"load", wrench(report.load)},
          {"load_from", report.load_text},
          {"grip_n", report.grip_n ? Json(*report.grip_n) : Json(nullptr)},
          {"holds", margin.load_factor >= 1},
          {"load_factor", margin.load_factor},
          {"upper", margin.upper},
          {"margin", margin.load_factor - 1},
          {"contacts", contacts}};
}

// ---- text ----------------------------------------------------------------------------------------------------------------

// What is small beside `size` is a rounding, and no news.
std::string shown(double value, double size) {
  constexpr double kSmall = 1e-8;
  return short_number(std::abs(value) <= kSmall * size ? 0 : value);
}
std::string three_numbers(const Vec3& v, double size) {
  return "(" + shown(v.x, size) + ", " + shown(v.y, size) + ", " + shown(v.z, size) + ")";
}
std::string three_numbers(const Vec3& v) {
  return three_numbers(v, std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string wrench_text(const grasp::Wrench& w, double torque_scale_m) {
  const auto length = [](const Vec3& v) { return std::hypot(v.x, v.y, v.z); };
  const double size = std::max(length(w.force_n), length(w.torque_nm) / torque_scale_m);
  return "force " + three_numbers(w.force_n, size) + " N, torque " + three_numbers(w.torque_nm, size * torque_scale_m) + " Nm";
}

// Six digits of a value, rounded down or up.
std::string rounded(double value, bool up) {
  constexpr int kDigits = 6;
  if (value == 0 || !std::isfinite(value)) return short_number(value);
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - (kDigits - 1));
  std::string text = short_number(value);
  const double shown = std::strtod(text.c_str(), nullptr);
  if (up ? shown < value : shown > value) text = short_number(shown + (up ? unit : -unit));
  return text;
}
std::string interval(double lower, double upper) {
  return "[" + rounded(lower, false) + ", " + rounded(upper, true) + "]";
}

std::size_t name_width(const GraspReport& report) {
  std::size_t width = 0;
  for (const NamedContact& contact : report.asked)
    width = std::max(width, contact.name.size());
  return std::min<std::size_t>(width, 40) + 2;
}

std::string contacts_text(const GraspReport& report) {
  std::string text = "  contacts\n";
  const double scale = report.grasp.torque_scale_m;
  for (std::size_t i = 0; i < report.asked.size(); ++i) {
    const grasp::Contact& contact = report.grasp.contacts[i];
    text += "    " + padded(report.asked[i].name, name_width(report)) + "at " + three_numbers(contact.point_m, scale) + " m, " +
            shown(report.found[i].distance_m, scale) + " m from the point given, on node " +
            std::to_string(report.found[i].node) + ", presses along " + three_numbers(contact.inward) + ", mu " +
            short_number(contact.mu);
    if (contact.torsion_m > 0) text += ", torsion " + short_number(contact.torsion_m) + " m";
    if (std::isfinite(contact.cap_n)) text += ", at most " + short_number(contact.cap_n) + " N";
    text += "\n";
  }
  return text;
}

std::string closure_text(const grasp::Closure& closure) {
  if (closure.verdict == grasp::Verdict::closure) return "yes";
  if (closure.verdict == grasp::Verdict::marginal) return "marginal: neither yes nor no is proved";
  return closure.is_flat ? "no: nothing resists the weakest direction, nor its opposite"
                         : "no: nothing resists the weakest direction";
}

std::string margin_text(const GraspReport& report) {
  if (!report.margin) return "  margin         not asked for: give --grip, or a cap for each contact\n";
  const grasp::Margin& margin = *report.margin;
  std::string text =
      "  load           " + wrench_text(report.load, report.grasp.torque_scale_m) + " (" + report.load_text + ")\n";
  text += "  margin         " + std::string(margin.load_factor >= 1 ? "holds: " : "slips: ") + "up to " +
          short_number(margin.load_factor) + " times the load, proved in " + interval(margin.load_factor, margin.upper) +
          (report.grip_n ? ", contacts pressing with " + short_number(*report.grip_n) + " N together" : "") + "\n";
  text += "  at the limit\n";
  for (std::size_t i = 0; i < margin.forces.size(); ++i) {
    const grasp::ContactForce& force = margin.forces[i];
    text += "    " + padded(report.asked[i].name, name_width(report)) + "presses " + short_number(force.press_n) + " N, " +
            short_number(100 * force.used) + " % of its friction used, " + short_number(100 * force.carried) +
            " % of the load carried; without it " +
            (force.factor_without > 0 ? short_number(force.factor_without) + " times the load" : "nothing of it") + "\n";
  }
  return text;
}

}  // namespace

std::string grasp_report_json(const GraspReport& report) {
  Json contacts = Json::array();
  for (std::size_t i = 0; i < report.asked.size(); ++i)
    contacts.push_back(contact_json(report, i));
  const grasp::Closure& closure = report.closure;
  const grasp::Epsilon& epsilon = report.epsilon;
  const Json json{{"tool", {{"name", "fdcg"}, {"version", FDCG_VERSION_STRING}}},
                  {"object",
                   {{"file", report.object},
                    {"nodes", report.faces},
                    {"centre_m", vector(report.grasp.centre_m)},
                    {"centre_from", report.centre_from},
                    {"com_m", report.com_m ? vector(*report.com_m) : Json(nullptr)},
                    {"com_from", report.com_m ? Json(report.com_from) : Json(nullptr)},
                    {"torque_scale_m", report.grasp.torque_scale_m},
                    {"torque_scale_from", report.torque_scale_from}}},
                  {"tolerance", grasp::kTolerance},
                  {"contacts", contacts},
                  {"closure",
                   {{"verdict", verdict_name(closure.verdict)},
                    {"lower", finite(closure.lower)},
                    {"upper", closure.upper},
                    {"is_flat", closure.is_flat},
                    {"weakest", wrench(closure.weakest)}}},
                  {"epsilon",
                   {{"effort", report.effort == grasp::Effort::together ? "together" : "each"},
                    {"value", epsilon.value},
                    {"lower", epsilon.lower},
                    {"is_tight", epsilon.is_tight},
                    {"cones", epsilon.cells},
                    {"weakest", wrench(epsilon.weakest)}}},
                  {"margin", margin_json(report)},
                  {"warnings", report.warnings}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string grasp_report_text(const GraspReport& report) {
  const grasp::Closure& closure = report.closure;
  const grasp::Epsilon& epsilon = report.epsilon;
  const bool is_closed = closure.verdict == grasp::Verdict::closure;
  const double scale = report.grasp.torque_scale_m;
  std::string text =
      report.object + ": " + counted(report.asked.size(), "contact") + " on " + counted(report.faces, "node") + "\n";
  text += "  centre         " + three_numbers(report.grasp.centre_m, scale) + " m (" + report.centre_from + ")\n";
  if (report.com_m && report.centre_from != report.com_from)
    text += "  centre of mass " + three_numbers(*report.com_m, scale) + " m (" + report.com_from + ")\n";
  text += "  torque scale   " + short_number(report.grasp.torque_scale_m) + " m (" + report.torque_scale_from + ")\n";
  text += contacts_text(report);
  text += "  force closure  " + closure_text(closure) + "\n";
  if (is_closed) {
    text += "  epsilon        " + short_number(epsilon.value) + ", proved in " + interval(epsilon.lower, epsilon.value) +
            " (1 N of normal force " + (report.effort == grasp::Effort::together ? "together" : "each") + ")\n";
  }
  text += "  weakest        " + wrench_text(is_closed ? epsilon.weakest : closure.weakest, report.grasp.torque_scale_m) + "\n";
  return text + margin_text(report);
}

}  // namespace fdcg::tools
