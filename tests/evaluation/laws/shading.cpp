// SPDX-License-Identifier: Apache-2.0
// What is felt of the facets of a sphere: a HIP slides over it at a constant depth without friction, and its force is compared
// with the sphere's own. Facets (of the mesh, and of ones with 4 and 16 times as many), shading by the cone, and the facets'
// force turned into the interpolated normal after the fact, as CHAI3D does it.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include "band.hpp"
#include "laws.hpp"
#include "meshes.hpp"
#include "pressed.hpp"
#include "random.hpp"
#include "shaded_normal.hpp"

namespace fdcg::test {
namespace {

constexpr double kRadius_m = 0.05, kDepth_m = 1.5e-3, kSpeed_m_per_s = 0.1, kRate_hz = 1000;
constexpr double kLow_hz = 80, kHigh_hz = 450;  // where skin feels best
constexpr int kEntryTicks = 50, kSettleTicks = 100;

enum class Method { facets, shaded, turned_after, sphere };
constexpr const char* kMethods[] = {"facets", "shaded by the cone", "turned after the fact", "sphere by formula"};

struct Way {
  Hip u, v;

  [[nodiscard]] Hip at(int tick) const {
    const double angle = tick * kSpeed_m_per_s / kRate_hz / kRadius_m;
    const double from_entry = std::min(1.0, static_cast<double>(tick) / kEntryTicks);
    const double radius = kRadius_m + kDepth_m - 2 * kDepth_m * from_entry;
    Hip hip{};
    for (std::size_t c = 0; c < 3; ++c)
      hip[c] = radius * (u[c] * std::cos(angle) + v[c] * std::sin(angle));
    return hip;
  }
};

std::vector<Way> ways(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<Way> result;
  for (int i = 0; i < count; ++i) {
    const Hip u = point_of(random.direction());
    Hip v = point_of(random.direction());
    const double along = dot(u, v);
    for (std::size_t c = 0; c < 3; ++c)
      v[c] -= along * u[c];
    const double length = norm(v);
    for (double& x : v)
      x /= length;
    result.push_back({u, v});
  }
  return result;
}

struct Felt {
  double vibration_n = 0;    // RMS within the band, all components
  double direction_rad = 0;  // largest angle between the force and the sphere's normal
  double size_n = 0;         // largest error of the force's size
  double turn_rad = 0;       // largest from tick to tick
  double ns = 0;             // of a step, the mean
};

Hip turned(const fdcg_graph& graph, const fdcg_result& result) {
  const Hip force = {result.force_n[0], result.force_n[1], result.force_n[2]};
  const Hip place = {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]};
  std::uint32_t node = result.feature;
  if (result.state == FDCG_EDGE) node = fdcg_get_connection(&graph, result.feature).node[0];
  if (result.state != FDCG_FACE && result.state != FDCG_EDGE) return force;
  const Hip normal = shaded_normal(graph, node, place);
  const double size = norm(force);
  return {normal[0] * size, normal[1] * size, normal[2] * size};
}

double angle_between(const Hip& a, const Hip& b) {
  const double size = norm(a) * norm(b);
  return size > 0 ? std::acos(std::min(1.0, dot(a, b) / size)) : 0;
}

Felt feel(const fdcg_graph& graph, Method method, const std::vector<Way>& all, int ticks) {
  fdcg_params params = contact_params(0, 0);
  params.stiffness_n_per_m = 1000;
  if (method == Method::shaded) params.friction_flags = FDCG_FRICTION_SHADING;
  Felt felt;
  double power = 0;
  for (const Way& way : all) {
    Pressed pressed{&graph};
    std::array<std::vector<double>, 3> signal;
    Hip last{};
    for (int tick = 0; tick < ticks + kSettleTicks; ++tick) {
      const Hip hip = way.at(tick);
      pressed.step(params, hip);
      if (tick < kSettleTicks) continue;
      Hip force = {pressed.result.force_n[0], pressed.result.force_n[1], pressed.result.force_n[2]};
      if (method == Method::turned_after) force = turned(graph, pressed.result);
      if (method == Method::sphere)
        for (std::size_t c = 0; c < 3; ++c)
          force[c] = hip[c] / norm(hip) * params.stiffness_n_per_m * kDepth_m;
      felt.direction_rad = std::max(felt.direction_rad, angle_between(force, hip));
      felt.size_n = std::max(felt.size_n, std::fabs(norm(force) - params.stiffness_n_per_m * kDepth_m));
      if (tick > kSettleTicks) felt.turn_rad = std::max(felt.turn_rad, angle_between(force, last));
      for (std::size_t c = 0; c < 3; ++c)
        signal[c].push_back(force[c]);
      last = force;
    }
    for (const std::vector<double>& component : signal)
      power += band_power(component, kRate_hz, kLow_hz, kHigh_hz);
  }
  felt.vibration_n = std::sqrt(power / static_cast<double>(all.size()));
  return felt;
}

// The least of some rounds over the same way, so that what else the machine does counts little.
double time_of_step_ns(const fdcg_graph& graph, Method method, const Way& way) {
  constexpr int kRounds = 20, kTicks = 2000;
  fdcg_params params = contact_params(0, 0);
  if (method == Method::shaded) params.friction_flags = FDCG_FRICTION_SHADING;
  std::vector<Hip> hips;
  for (int tick = 0; tick < kTicks; ++tick)
    hips.push_back(way.at(tick));
  double least = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    Pressed pressed{&graph};
    const auto begin = std::chrono::steady_clock::now();
    for (const Hip& hip : hips)
      pressed.step(params, hip);
    least =
        std::min(least, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count() / kTicks);
  }
  return least;
}

}  // namespace

void measure_shading(const LawOptions& options, Bars& bars) {
  constexpr int kFirstLevel = 2;  // 320 faces
  constexpr double kLeastFaces = 1280;
  const int levels = options.is_quick ? 3 : 5, ticks = options.is_quick ? 1000 : 3000;
  const std::vector<Way> all = ways(options.seed, options.is_quick ? 2 : 8);
  Table table(options.output, "shading",
              {"method", "faces", "vibration_mn", "direction_error_max_rad", "force_size_error_max_n", "turn_max_rad_per_ms",
               "step_ns"});
  double worst_share = 0, most_n = 0, worst_turn = 0;
  for (int level = kFirstLevel; level < kFirstLevel + levels; ++level) {
    bake::CompileOptions compile;
    compile.normals = bake::Normals::faces;
    compile.jobs = 1;
    const CompiledMesh mesh(scaled(ico_sphere(level), kRadius_m), compile);
    std::array<Felt, std::size(kMethods)> felt;
    for (std::size_t m = 0; m < felt.size(); ++m) {
      const auto method = static_cast<Method>(m);
      felt[m] = feel(mesh.view(), method, all, ticks);
      if (method != Method::sphere) felt[m].ns = time_of_step_ns(mesh.view(), method, all[0]);
      table.row(kMethods[m], mesh.view().header->node_count, felt[m].vibration_n * 1e3, felt[m].direction_rad, felt[m].size_n,
                felt[m].turn_rad, felt[m].ns);
    }
    const Felt &facets = felt[0], &shaded = felt[1], &sphere = felt[3];
    worst_share = std::max(worst_share, shaded.vibration_n / facets.vibration_n);
    if (mesh.view().header->node_count >= kLeastFaces) most_n = std::max(most_n, shaded.vibration_n);
    worst_turn = std::max(worst_turn, shaded.turn_rad / sphere.turn_rad);
  }
  bars.at_most("shading: vibration of 80 to 450 Hz as a share of the facets'", worst_share, 0.1, "", "spheres, 0.1 m/s, 1.5 N");
  bars.at_most("shading: vibration of 80 to 450 Hz from 1,280 faces on", most_n * 1e3, 2, "mN",
               "the threshold of skin is 1 to 10");
  bars.at_most("shading: largest turn of the force in 0.1 mm over the sphere's", worst_turn, 1.2, "", "across smooth edges");
}

}  // namespace fdcg::test
