// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "fdcg/grasp.hpp"
#include "grasp/grasp_body.hpp"
#include "grasp/grasp_game.hpp"

namespace fdcg::grasp {
namespace {

// The length of the ray along a direction inside the body, with its certificate.
struct Ray {
  double lower = 0, upper = 0;
  GameResult game;
};

// One ray cast, over directions within `reach` of `centre` (centre.direction = 1). Off: the distance of its wrench from the
// ray.
Ray shoot_near(const Body& body, const Vec6& direction, const Vec6& centre, double reach, double& off) {
  auto corners = around(direction, reach, body.dimensions);
  for (Vec6& corner : corners) {
    add_scaled(corner, 1, centre);
    add_scaled(corner, -1, direction);
  }
  GameOptions options;
  options.max_pivots = 2000;
  const GameResult game = play(body, {corners.data(), body.dimensions}, {}, {}, options);
  Vec6 aside = game.wrench;
  add_scaled(aside, -dot(game.wrench, direction), direction);
  off = norm(aside);
  return {std::max(0.0, game.lower), std::max(0.0, game.upper), game};
}

Ray shoot(const Body& body, const Vec6& direction) {
  // A larger reach allows steeper facets where the ray leaves the body, but loses digits. So the smallest sufficient reach is
  // used, and then smaller ones around the result. A wrench off the ray by a millionth of its length counts as on it: contact
  // points are not known more accurately.
  constexpr double kOnRay = 1e-9, kNearRay = 1e-6;
  Ray ray;
  double reach = 1, off = 0;
  for (const double wider : {1.0, 1e2, 1e4, 1e6}) {
    reach = wider;
    ray = shoot_near(body, direction, direction, reach, off);
    if (off <= kOnRay * ray.lower) break;
  }
  if (!(off <= kNearRay * ray.lower)) {
    ray.lower = ray.upper = 0;
    return ray;
  }
  for (const double nearer : {1e-2, 1e-4, 1e-6}) {
    if (ray.upper - ray.lower <= kOnRay / 10 * ray.upper || nearer * reach > 1) continue;
    const Vec6 centre = scaled(1 / dot(ray.game.direction, direction), ray.game.direction);
    const Ray again = shoot_near(body, direction, centre, nearer * reach, off);
    if (off > kOnRay * again.lower || again.lower < ray.lower) continue;
    const double upper = std::min(ray.upper, again.upper);
    ray = again;
    ray.upper = upper;
  }
  return ray;
}

// The wrench sets of the contacts, with caps in a unit of force that makes the numbers of order one.
Body capped_body(const Grasp& grasp, double total_n, double& unit_n) {
  Body body = unit_body(grasp);
  double sum = 0;
  for (const Contact& contact : grasp.contacts)
    sum += contact.cap_n;
  unit_n = std::min(sum, total_n);
  body.must_press = false;
  body.total_n = total_n / unit_n;
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i)
    body.caps_n[i] = grasp.contacts[i].cap_n / unit_n;
  return body;
}

std::vector<ContactForce> forces_of(const Grasp& grasp, const Body& body, const Vec6& direction, const Ray& ray,
                                    double unit_n) {
  const std::size_t count = grasp.contacts.size();
  std::vector<double> presses(count, 0);
  std::vector<std::array<double, 3>> x(count);
  for (std::size_t c = 0; c < ray.game.column_count; ++c) {
    const Column& column = ray.game.columns[c];
    if (norm(column.at) == 0) continue;  // the start: no force at all
    const auto at = body.presses_n(column.at);
    for (std::size_t i = 0; i < count; ++i) {
      if (at[i] == 0) continue;
      double length = 0;
      const auto b = body.contacts[i].slip(column.at, length);
      presses[i] += column.weight * at[i];
      for (std::size_t k = 0; length > 0 && k < 3; ++k)
        x[i][k] += column.weight * at[i] * b[k] / length;
    }
  }
  std::vector<ContactForce> forces;
  for (std::size_t i = 0; i < count; ++i) {
    for (double& k : x[i])
      k = presses[i] > 0 ? k / presses[i] : 0;
    forces.push_back(contact_force(grasp.contacts[i], presses[i] * unit_n, x[i]));
    Vec6 wrench = body.contacts[i].centre;
    for (std::size_t k = 0; k < 3; ++k)
      add_scaled(wrench, x[i][k], body.contacts[i].spread[k]);
    if (ray.lower > 0) forces.back().carried = presses[i] * dot(wrench, direction) / ray.lower;
  }
  return forces;
}

}  // namespace

Margin slip_margin(const Grasp& grasp, const Wrench& load, double total_n) {
  const double scale = grasp.torque_scale_m;
  const Vec6 against{-load.force_n.x,           -load.force_n.y,           -load.force_n.z,
                     -load.torque_nm.x / scale, -load.torque_nm.y / scale, -load.torque_nm.z / scale};
  const double load_n = norm(against);
  const Vec6 direction = scaled(1 / load_n, against);
  double unit_n = 1;
  const Body body = capped_body(grasp, total_n, unit_n);
  const Ray ray = shoot(body, direction);
  Margin margin;
  margin.load_factor = ray.lower * unit_n / load_n;
  margin.upper = ray.upper * unit_n / load_n;
  margin.forces = forces_of(grasp, body, direction, ray, unit_n);
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    Grasp rest = grasp;
    rest.contacts.erase(rest.contacts.begin() + static_cast<std::ptrdiff_t>(i));
    double rest_unit_n = 1;
    const Body left = capped_body(rest, total_n, rest_unit_n);
    margin.forces[i].factor_without = rest.contacts.empty() ? 0 : shoot(left, direction).lower * rest_unit_n / load_n;
  }
  return margin;
}

}  // namespace fdcg::grasp
