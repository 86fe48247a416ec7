// SPDX-License-Identifier: Apache-2.0
// Passivity: over a closed loop of the HIP the hand gets no more work than sampling allows, whatever body and friction.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "hip_loop.hpp"
#include "laws.hpp"
#include "meshes.hpp"
#include "parallel.hpp"
#include "plain_graph.hpp"
#include "pressed.hpp"

namespace fdcg::test {
namespace {

constexpr std::size_t kAllLoops = 100'000, kQuickLoops = 4'000;
constexpr double kFrictions[][2] = {{0, 0}, {0.3, 0.2}, {0.6, 0.4}, {1, 1}, {2, 1}, {1, 0}};
constexpr int kBins = 40;  // of work / bound between -1 and 1; less goes to the first
constexpr double kBinWidth = 2.0 / kBins;
constexpr double kStiffness_n_per_m = 1000;

std::vector<PolygonSoup> bodies() {
  const Rotation tilt = random_rotation(31);
  std::vector<PolygonSoup> soups = {transformed(cube(), tilt),
                                    transformed(triangulated(corner_pit()), tilt),
                                    v_groove(1.2),
                                    cone_pit(12),
                                    cone(48),
                                    saddle_block(),
                                    star_sphere(2, 0.3, 8),
                                    spiky_sphere(2, 1, 2),
                                    thin_plate(1e-3),
                                    torus(24, 12),
                                    ico_sphere(2),
                                    transformed(l_prism(), tilt)};
  for (PolygonSoup& soup : soups)
    soup = scaled(soup, kObject_m / extent(soup));
  return soups;
}

// A loop as the hand of a user would not make it: sums of a few waves, fast and slow, through and around the body.
std::vector<Hip> wavy_loop(Random& random, double extent, int ticks) {
  constexpr int kWaves = 5;
  std::array<Hip, kWaves> waves;
  for (std::size_t w = 0; w < kWaves; ++w) {
    const Vec3 d = random.direction();
    const double size = extent * random.uniform(0.2, 1.5) / static_cast<double>(w + 1);
    waves[w] = {d.x * size, d.y * size, d.z * size};
  }
  const Vec3 out = random.direction();
  std::vector<Hip> hips;
  for (int i = 0; i <= ticks; ++i) {
    const double turn = i == ticks ? 0 : static_cast<double>(i) / ticks;
    const double outside = 4 * extent * std::pow(std::cos(kPi * turn), 8);  // far away at both ends
    Hip hip = {outside * out.x, outside * out.y, outside * out.z};
    for (std::size_t w = 0; w < kWaves; ++w) {
      const double s = std::sin(2 * kPi * static_cast<double>(w + 1) * turn);
      for (std::size_t c = 0; c < 3; ++c)
        hip[c] += waves[w][c] * s;
    }
    hips.push_back(hip);
  }
  return hips;
}

// What the loops on one body with one friction came to.
struct Sum {
  std::uint64_t loops = 0, touched = 0, closed = 0, exceeding = 0;
  double largest_ratio = -1e300, largest_excess_j = -1e300;
  std::array<std::uint64_t, kBins> histogram{};
};

void add(const LoopAccount& account, Sum* sum) {
  ++sum->loops;
  if (!account.has_touched()) return;
  ++sum->touched;
  sum->closed += account.is_closed;
  const double ratio = account.work_j / account.bound_j;
  const double excess_j = account.work_j - account.bound_j * (1 + 1e-12) - account.rounding_j;
  sum->exceeding += excess_j > 0;
  sum->largest_ratio = std::max(sum->largest_ratio, ratio);
  sum->largest_excess_j = std::max(sum->largest_excess_j, excess_j);
  const int bin = std::clamp(static_cast<int>(std::floor((ratio + 1) / kBinWidth)), 0, kBins - 1);
  ++sum->histogram[static_cast<std::size_t>(bin)];
}

// Points that single precision has, so that the step sees the very loop that is accounted for.
void round_to_float(std::vector<Hip>& hips) {
  for (Hip& hip : hips) {
    for (double& c : hip)
      c = static_cast<double>(static_cast<float>(c));
  }
}

Sum loops_on(const PlainGraph& graph, double extent, const double (&mu)[2], std::size_t loops, std::uint64_t seed) {
  Random random(seed);
  fdcg_params params = contact_params(mu[0], mu[1]);
  params.stiffness_n_per_m = kStiffness_n_per_m;
  Sum sum;
  for (std::size_t i = 0; i < loops; ++i) {
    const int ticks = static_cast<int>(100 * std::pow(2, random.uniform(0, 4)));
    std::vector<Hip> hips = i % 2 == 0 ? elliptic_loop(random, extent, ticks) : wavy_loop(random, extent, ticks);
    if (graph.view().header->real_bytes == sizeof(float)) round_to_float(hips);
    add(account_of(graph.view(), params, hips), &sum);
  }
  return sum;
}

}  // namespace

void measure_energy(const LawOptions& options, Bars& bars) {
  const std::vector<PolygonSoup> soups = bodies();
  constexpr std::size_t kFrictionCount = std::size(kFrictions);
  std::vector<std::unique_ptr<PlainGraph>> graphs(2 * soups.size());
  for_each_index(graphs.size(), options.threads,
                 [&](std::size_t g) { graphs[g] = std::make_unique<PlainGraph>(soups[g / 2], kBothPrecisions[g % 2]); });
  std::vector<Sum> sums(graphs.size() * kFrictionCount);
  const std::size_t loops = (options.is_quick ? kQuickLoops : kAllLoops) / (soups.size() * kFrictionCount) + 1;
  for_each_index(sums.size(), options.threads, [&](std::size_t i) {
    const std::size_t g = i / kFrictionCount;
    sums[i] = loops_on(*graphs[g], extent(soups[g / 2]), kFrictions[i % kFrictionCount], loops, options.seed * 65537 + i);
  });
  Table table(options.output, "energy",
              {"body", "precision", "mu_static", "mu_dynamic", "loops", "touched", "closed", "exceeding",
               "largest_work_over_bound", "largest_excess_j"});
  Table histogram(options.output, "energy_histogram",
                  {"precision", "mu_static", "mu_dynamic", "work_over_bound_from", "loops"});
  for (std::size_t p = 0; p < 2; ++p) {
    Sum all;
    for (std::size_t f = 0; f < kFrictionCount; ++f) {
      const auto& mu = kFrictions[f];
      std::array<std::uint64_t, kBins> bins{};
      for (std::size_t b = 0; b < soups.size(); ++b) {
        const Sum& s = sums[(2 * b + p) * kFrictionCount + f];
        table.row(soups[b].name, name_of(kBothPrecisions[p]), mu[0], mu[1], s.loops, s.touched, s.closed, s.exceeding,
                  s.largest_ratio, s.largest_excess_j);
        all.loops += s.loops, all.touched += s.touched, all.closed += s.closed, all.exceeding += s.exceeding;
        all.largest_ratio = std::max(all.largest_ratio, s.largest_ratio);
        for (std::size_t k = 0; k < kBins; ++k)
          bins[k] += s.histogram[k];
      }
      for (std::size_t k = 0; k < kBins; ++k)
        histogram.row(name_of(kBothPrecisions[p]), mu[0], mu[1], -1 + kBinWidth * static_cast<double>(k), bins[k]);
    }
    const std::string of = std::string(", ") + name_of(kBothPrecisions[p]);
    bars.at_most("energy: closed loops above the zero-order hold's bound" + of, static_cast<double>(all.exceeding), 0, "loops",
                 std::to_string(all.loops) + " loops, " + std::to_string(all.touched) + " touched, " +
                     std::to_string(all.closed) + " of them ended free; largest work / bound " + cell(all.largest_ratio));
    bars.at_least("energy: share of the loops that touched" + of,
                  static_cast<double>(all.touched) / static_cast<double>(all.loops), 0.5, "",
                  "else the bar above says nothing");
  }
}

}  // namespace fdcg::test
