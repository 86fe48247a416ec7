// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/vec3.hpp"
#include "fdcg/grasp.hpp"

namespace fdcg::grasp {
namespace {

constexpr double kMostScales = 1000;  // beyond it the torque of one newton exceeds what the tolerance can resolve
constexpr double kUnitWithin = 1e-9;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

bool is_finite(const bake::Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_force(double newtons) {
  return newtons >= kLeastForce_n && newtons <= kMostForce_n;
}

std::string outside(const char* name, double value, const std::string& range) {
  return std::string(name) + " " + number(value) + " is not " + range;
}

std::string problem_of_contact(const Contact& contact, const Grasp& grasp) {
  using bake::operator-;
  if (!is_finite(contact.point_m)) return "the point is not finite";
  const double far = bake::length(contact.point_m - grasp.centre_m) / grasp.torque_scale_m;
  if (!(far <= kMostScales))
    return "the point is " + number(far) + " torque scales from the centre, more than " + number(kMostScales) +
           "; raise the torque scale";
  const double length = bake::length(contact.inward);
  if (!(std::abs(length - 1) <= kUnitWithin)) return outside("the normal's length", length, "1 (within 1e-9)");
  if (!(contact.mu >= 0 && contact.mu <= kMostMu)) return outside("mu", contact.mu, "between 0 and " + number(kMostMu));
  const double most_torsion = kMostTorsionScales * grasp.torque_scale_m;
  if (!(contact.torsion_m >= 0 && contact.torsion_m <= most_torsion))
    return outside("torsion", contact.torsion_m, "between 0 and " + number(most_torsion) + " m");
  if (!is_force(contact.cap_n) && contact.cap_n != std::numeric_limits<double>::infinity())
    return outside("cap", contact.cap_n, "from 1e-100 to 1e100 N, or infinite: none");
  return "";
}

}  // namespace

std::optional<std::string> problem_of(const Grasp& grasp) {
  const std::size_t count = grasp.contacts.size();
  if (count == 0) return "there are no contacts; name at least one";
  if (count > kMostContacts)
    return "there are " + std::to_string(count) + " contacts, at most " + std::to_string(kMostContacts) + " are judged";
  for (const double x : {grasp.centre_m.x, grasp.centre_m.y, grasp.centre_m.z})
    if (!(std::abs(x) <= kFarthest_m)) return outside("the centre's coordinate", x, "from -1e12 to 1e12 m");
  if (!(grasp.torque_scale_m >= 1e-100 && grasp.torque_scale_m <= 1e100))
    return outside("the torque scale", grasp.torque_scale_m, "from 1e-100 to 1e100 m");
  for (std::size_t i = 0; i < count; ++i) {
    const std::string problem = problem_of_contact(grasp.contacts[i], grasp);
    if (!problem.empty()) return "contact " + std::to_string(i) + ": " + problem;
  }
  return std::nullopt;
}

std::optional<std::string> problem_of(const Wrench& load, double torque_scale_m) {
  const bake::Vec3 &f = load.force_n, &t = load.torque_nm;
  const auto norm = [](const bake::Vec3& v) { return std::hypot(std::hypot(v.x, v.y), v.z); };  // of three infinity is NaN
  const double length = std::hypot(norm(f), norm(t) / torque_scale_m);
  if (is_force(length)) return std::nullopt;
  if (length == 0) return "a load of nothing slips never; give one other than zero";
  return outside("the load of", length, "from 1e-100 to 1e100 N");
}

}  // namespace fdcg::grasp
