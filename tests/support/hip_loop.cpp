// SPDX-License-Identifier: Apache-2.0
#include "hip_loop.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace fdcg::test {

LoopAccount account_of(const fdcg_graph& graph, const fdcg_params& params, const std::vector<Hip>& hips) {
  constexpr double kRoundings = 16;  // of |GO - HIP| in a step
  const fdcg_header& header = *graph.header;
  const double eps = header.real_bytes == sizeof(float) ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                                        : std::numeric_limits<double>::epsilon();
  const double rounding_m = kRoundings * eps * header.extent * header.metres_per_unit;
  const double k = params.stiffness_n_per_m;
  LoopAccount account;
  Contact contact(graph, params);
  contact.step(hips.front());
  bool was_free = true;
  for (std::size_t i = 1; i < hips.size(); ++i) {
    const Hip force = contact.force();  // holds over the interval
    const Hip way = difference(hips[i], hips[i - 1]);
    account.work_j += dot(force, way);
    if (!was_free) account.bound_j += k * dot(way, way) / 2;
    const bool is_free = contact.step(hips[i]).state == FDCG_FREE;
    const double gap_m = distance(contact.god_object(), hips[i]);
    if (!is_free) {
      ++account.contact_ticks;
      account.rounding_j += k * gap_m * rounding_m;
      if (was_free) account.bound_j += k * gap_m * gap_m / 2;
    }
    was_free = is_free;
  }
  account.is_closed = was_free;
  return account;
}

std::vector<Hip> elliptic_loop(Random& random, double extent, int ticks) {
  const Hip u = point_of(random.direction()), v = point_of(random.direction());
  const double size = extent * random.uniform(0.2, 1.2), far = 2.5 * extent;
  std::vector<Hip> hips;
  for (int i = 0; i <= ticks; ++i) {
    const double a = i == ticks ? 0 : 2 * std::numbers::pi * i / ticks;
    Hip hip;
    for (std::size_t c = 0; c < 3; ++c)
      hip[c] = (far - size) * u[c] * std::cos(a) + u[c] * size + size * v[c] * std::sin(a);
    hips.push_back(hip);
  }
  return hips;
}

}  // namespace fdcg::test
