// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/vec3.hpp"

namespace fdcg::grasp {
namespace {

using bake::cross;

Vec6 wrench_of(const Vec3& force, const Vec3& torque, double torque_scale) {
  return {force.x, force.y, force.z, torque.x / torque_scale, torque.y / torque_scale, torque.z / torque_scale};
}

}  // namespace

double norm(const Vec6& v) {
  double largest = 0;
  for (const double c : v)
    largest = std::max(largest, std::abs(c));
  return largest == 0 ? 0 : largest * std::sqrt(dot(scaled(1 / largest, v), scaled(1 / largest, v)));
}

Vec6 scaled(double factor, const Vec6& v) {
  Vec6 result{};
  add_scaled(result, factor, v);
  return result;
}

std::array<double, 3> UnitWrenches::slip(const Vec6& u, double& length) const {
  const std::array<double, 3> b{dot(spread[0], u), dot(spread[1], u), dot(spread[2], u)};
  length = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  return b;
}

double UnitWrenches::support(const Vec6& u) const {
  double length = 0;
  static_cast<void>(slip(u, length));
  return dot(centre, u) + length;
}

std::vector<double> Body::presses_n(const Vec6& u) const {
  std::vector<double> supports(contacts.size()), presses(contacts.size(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    supports[i] = contacts[i].support(u);
  if (must_press) {
    presses[static_cast<std::size_t>(std::max_element(supports.begin(), supports.end()) - supports.begin())] = total_n;
    return presses;
  }
  std::vector<std::size_t> order(contacts.size());  // the contact with the largest product per newton presses first
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return supports[a] > supports[b]; });
  double left = total_n;
  for (const std::size_t i : order) {
    if (supports[i] <= 0 || left <= 0) break;
    presses[i] = std::min(left, caps_n[i]);
    left -= presses[i];
  }
  return presses;
}

SupportPoint Body::support(const Vec6& u) const {
  SupportPoint point;
  const auto add = [&](const UnitWrenches& contact, double press) {
    double length = 0;
    const auto b = contact.slip(u, length);
    add_scaled(point.wrench, press, contact.centre);
    for (std::size_t k = 0; length > 0 && k < 3; ++k)
      add_scaled(point.wrench, press * b[k] / length, contact.spread[k]);
    point.value += press * (dot(contact.centre, u) + length);
  };
  if (must_press) {  // the common case, without allocation: one contact carries the whole force
    const UnitWrenches* best = nullptr;
    double most = -std::numeric_limits<double>::infinity();
    for (const UnitWrenches& contact : contacts) {
      const double value = contact.support(u);
      if (value > most) best = &contact, most = value;
    }
    add(*best, total_n);
    return point;
  }
  const std::vector<double> presses = presses_n(u);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (presses[i] > 0) add(contacts[i], presses[i]);
  }
  return point;
}

std::array<Vec3, 2> tangents(const Vec3& normal) {
  Vec3 axis{};
  const int k = bake::dominant_axis(normal);
  (k == 0 ? axis.y : k == 1 ? axis.z : axis.x) = 1;
  const Vec3 across = cross(normal, axis);
  const Vec3 first = (1 / bake::length(across)) * across;
  return {first, cross(normal, first)};
}

Body unit_body(const Grasp& grasp) {
  Body body;
  body.must_press = true;
  for (const Contact& contact : grasp.contacts) {
    const Vec3 arm = contact.point_m - grasp.centre_m;
    const auto push = [&](const Vec3& force) { return wrench_of(force, cross(arm, force), grasp.torque_scale_m); };
    UnitWrenches wrenches;
    wrenches.centre = push(contact.inward);
    const auto along = tangents(contact.inward);
    for (std::size_t k = 0; k < 2; ++k)
      wrenches.spread[k] = scaled(contact.mu, push(along[k]));
    wrenches.spread[2] = wrench_of({}, contact.torsion_m * contact.inward, grasp.torque_scale_m);
    double squares = 0;
    for (const Vec6& s : wrenches.spread)
      squares += dot(s, s);
    wrenches.spread_norm = std::sqrt(squares);
    body.contacts.push_back(wrenches);
    body.caps_n.push_back(std::numeric_limits<double>::infinity());
  }
  return body;
}

ContactForce contact_force(const Contact& contact, double press_n, const std::array<double, 3>& x) {
  const auto along = tangents(contact.inward);
  ContactForce force;
  force.press_n = press_n;
  force.tangential_n = press_n * contact.mu * (x[0] * along[0] + x[1] * along[1]);
  force.moment_nm = press_n * contact.torsion_m * x[2];
  const double tangential = contact.mu > 0 ? std::hypot(x[0], x[1]) : 0, turning = contact.torsion_m > 0 ? x[2] : 0;
  force.used = press_n > 0 ? std::hypot(tangential, turning) : 0;
  return force;
}

}  // namespace fdcg::grasp
