// SPDX-License-Identifier: Apache-2.0
// What is felt of the facets of scans, with and without shading: a HIP slides without friction below a smooth curve
// through the surface. Ways are told apart by how far the nearest place of the surface leaps within a tick, as a share of the
// depth: there the hand is deeper than the surface bends, and the force leaps whatever the normals. What the shape itself does
// on a way is told by the scan refined to a smoother surface, of 16 times the faces.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "band.hpp"
#include "fdcg/query.h"
#include "laws.hpp"
#include "loop_refined.hpp"
#include "pressed.hpp"
#include "random.hpp"

namespace fdcg::test {
namespace {

constexpr double kSize_m = 0.15;  // the largest side of every scan
constexpr double kWay_m = 0.03, kRate_hz = 1000, kLow_hz = 80, kHigh_hz = 450;
constexpr std::array<double, 2> kDepths_m = {1.5e-3, 3e-3};  // 1.5 and 3 N
constexpr int kTicks = 300;                                  // 0.1 m/s
constexpr int kEntryTicks = 40, kSettleTicks = 30;
constexpr std::size_t kCoefficients = 6;  // of the curve, a polynomial

Hip along(const Hip& from, const Hip& direction, double way) {
  Hip to;
  for (std::size_t c = 0; c < 3; ++c)
    to[c] = from[c] + way * direction[c];
  return to;
}
Hip across(const Hip& a, const Hip& b) {
  const Hip v = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return along({}, v, 1 / norm(v));
}

// Where a ray first meets the surface, and the face's normal; nothing: it does not.
struct Met {
  Hip place, normal;
};
std::optional<Met> cast(const fdcg_graph& graph, const Hip& from, const Hip& direction, double reach_m) {
  fdcg_surface_hit hit = fdcg_make_surface_hit();
  if (fdcg_cast_ray(&graph, from.data(), direction.data(), reach_m, &hit, nullptr) != FDCG_OK) return std::nullopt;
  return Met{{hit.point_m[0], hit.point_m[1], hit.point_m[2]}, {hit.normal[0], hit.normal[1], hit.normal[2]}};
}

// Least squares over places s of -0.5 to 0.5, by the normal equations.
std::array<double, kCoefficients> fitted(const std::vector<double>& heights) {
  std::array<std::array<double, kCoefficients + 1>, kCoefficients> a{};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    std::array<double, kCoefficients> power{1};
    const double s = static_cast<double>(i) / static_cast<double>(heights.size() - 1) - 0.5;
    for (std::size_t k = 1; k < kCoefficients; ++k)
      power[k] = power[k - 1] * s;
    for (std::size_t r = 0; r < kCoefficients; ++r) {
      for (std::size_t c = 0; c < kCoefficients; ++c)
        a[r][c] += power[r] * power[c];
      a[r][kCoefficients] += power[r] * heights[i];
    }
  }
  for (std::size_t i = 0; i < kCoefficients; ++i) {
    for (std::size_t r = 0; r < kCoefficients; ++r) {
      const double factor = r == i ? 0 : a[r][i] / a[i][i];
      for (std::size_t c = i; c <= kCoefficients; ++c)
        a[r][c] -= factor * a[i][c];
    }
  }
  std::array<double, kCoefficients> result{};
  for (std::size_t i = 0; i < kCoefficients; ++i)
    result[i] = a[i][kCoefficients] / a[i][i];
  return result;
}

struct ScanWay {
  Hip middle, normal, direction;
  std::array<double, kCoefficients> curve;
  double depth_m;

  // From above the surface in the first ticks, which count below 0.
  [[nodiscard]] Hip at(int tick) const {
    const double s = static_cast<double>(std::max(tick, 0)) / kTicks - 0.5;
    double height = 0;
    for (std::size_t k = kCoefficients; k-- > 0;)
      height = height * s + curve[k];
    const double depth = tick < 0 ? depth_m * (1 + 2.0 * tick / kEntryTicks) : depth_m;
    return along(along(middle, direction, s * kWay_m), normal, height - depth);
  }
};

// A random place of the surface, and a way through it that has the surface below itself all along.
std::optional<ScanWay> draw_way(const fdcg_graph& graph, Random& random) {
  constexpr double kSeen_m = 0.02, kLeastFacing = 0.3, kMostOff_m = 1e-3;
  const fdcg_header& header = *graph.header;
  Hip inside{};
  for (std::size_t c = 0; c < 3; ++c)
    inside[c] = (random.uniform(header.bounds_min[c], header.bounds_max[c]) + header.origin[c]) * header.metres_per_unit;
  const Hip out = point_of(random.direction());
  const std::optional<Met> met = cast(graph, along(inside, out, 2 * kSize_m), along({}, out, -1), 4 * kSize_m);
  const Hip side = point_of(random.direction());
  if (!met) return std::nullopt;
  ScanWay way{met->place, met->normal, across(met->normal, side), {}, kDepths_m[0]};
  std::vector<double> heights;
  for (int i = 0; i <= kTicks; ++i) {
    const Hip above =
        along(along(way.middle, way.direction, (static_cast<double>(i) / kTicks - 0.5) * kWay_m), way.normal, kSeen_m);
    const std::optional<Met> below = cast(graph, above, along({}, way.normal, -1), 2 * kSeen_m);
    if (!below || dot(below->normal, way.normal) < kLeastFacing) return std::nullopt;
    heights.push_back(dot(along(below->place, way.middle, -1), way.normal));
  }
  way.curve = fitted(heights);
  for (int i = 0; i <= kTicks; ++i) {
    const double off = dot(along(way.at(i), way.middle, -1), way.normal) + way.depth_m - heights[static_cast<std::size_t>(i)];
    if (std::fabs(off) > kMostOff_m) return std::nullopt;
  }
  return way;
}

// How far the nearest place of the surface moves within a tick, at most.
double largest_leap_m(const fdcg_graph& graph, const ScanWay& way) {
  double largest = 0;
  Hip last{};
  for (int tick = 0; tick <= kTicks; ++tick) {
    const Hip hip = way.at(tick);
    fdcg_surface_hit hit = fdcg_make_surface_hit();
    if (fdcg_find_nearest(&graph, hip.data(), kSize_m, &hit, nullptr) != FDCG_OK) return kSize_m;
    const Hip place = {hit.point_m[0], hit.point_m[1], hit.point_m[2]};
    if (tick > 0) largest = std::max(largest, norm(along(place, last, -1)));
    last = place;
  }
  return largest;
}

using Force = std::array<std::vector<double>, 3>;

// On a way, each tick; nothing: the contact was lost.
std::optional<Force> felt(const fdcg_graph& graph, const ScanWay& way, std::uint32_t friction_flags) {
  fdcg_params params = contact_params(0, 0);
  params.stiffness_n_per_m = 1000;
  params.friction_flags = friction_flags;
  Pressed pressed{&graph};
  Force force;
  for (int tick = -kEntryTicks; tick < kTicks; ++tick) {
    pressed.step(params, way.at(tick));
    if (tick < kSettleTicks) continue;
    if (pressed.result.state == FDCG_FREE) return std::nullopt;
    for (std::size_t c = 0; c < 3; ++c)
      force[c].push_back(pressed.result.force_n[c]);
  }
  return force;
}

// Mean square within the band, all components.
double vibration(const Force& force) {
  double power = 0;
  for (const std::vector<double>& component : force)
    power += band_power(component, kRate_hz, kLow_hz, kHigh_hz);
  return power;
}

struct Sums {
  int ways = 0;
  int refined_leaps = 0;                       // ways of them on which the refined surface leaps as far
  double facets = 0, shaded = 0, refined = 0;  // of the mean squares

  [[nodiscard]] double mn(double square) const { return 1e3 * std::sqrt(square / ways); }
};
Sums operator+(const Sums& a, const Sums& b) {
  return {a.ways + b.ways, a.refined_leaps + b.refined_leaps, a.facets + b.facets, a.shaded + b.shaded, a.refined + b.refined};
}

// By the largest leap, as a share of the depth.
constexpr std::array<const char*, 3> kKinds = {"smooth", "bent", "leaping"};
constexpr double kSmooth = 0.5, kBent = 1;
std::size_t kind_of(double leap_m, double depth_m) {
  return leap_m <= kSmooth * depth_m ? 0 : leap_m <= kBent * depth_m ? 1 : 2;
}

void measure_scan(const LawOptions& options, const std::filesystem::path& path, Table& table, Bars& bars) {
  const int wanted = options.is_quick ? 12 : 60, tries = 100 * wanted;
  auto soup = bake::import_mesh(path);
  if (!soup) return;
  Hip low = {1e300, 1e300, 1e300}, high = {-1e300, -1e300, -1e300};
  for (const bake::Vec3& point : soup->points) {
    const Hip p = {point.x, point.y, point.z};
    for (std::size_t c = 0; c < 3; ++c)
      low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
  }
  bake::CompileOptions compile;
  compile.metres_per_unit = kSize_m / std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  compile.normals = bake::Normals::faces;
  compile.repair = bake::RepairLevel::full;
  compile.jobs = options.threads;
  const CompiledMesh mesh(*soup, compile), refined(loop_refined(loop_refined(*soup)), compile);
  Random random(options.seed);
  std::array<std::array<Sums, kKinds.size()>, kDepths_m.size()> sums;
  const auto calm = [&](std::size_t d) { return sums[d][0] + sums[d][1]; };
  for (int i = 0; i < tries && calm(0).ways < wanted; ++i) {
    std::optional<ScanWay> way = draw_way(mesh.view(), random);
    for (std::size_t d = 0; way && d < kDepths_m.size(); ++d) {
      way->depth_m = kDepths_m[d];
      const std::optional<Force> facets = felt(mesh.view(), *way, 0), shaded = felt(mesh.view(), *way, FDCG_FRICTION_SHADING);
      const std::optional<Force> smoother = felt(refined.view(), *way, FDCG_FRICTION_SHADING);
      if (!facets || !shaded || !smoother) continue;
      const std::size_t kind = kind_of(largest_leap_m(mesh.view(), *way), way->depth_m);
      Sums& sum = sums[d][kind];
      ++sum.ways;
      sum.facets += vibration(*facets);
      sum.shaded += vibration(*shaded);
      sum.refined += vibration(*smoother);
      if (kind_of(largest_leap_m(refined.view(), *way), way->depth_m) >= kind) ++sum.refined_leaps;
    }
  }
  const std::string name = path.stem().string();
  for (std::size_t d = 0; d < kDepths_m.size(); ++d) {
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      const Sums& sum = sums[d][k];
      if (sum.ways == 0) continue;
      table.row(name, mesh.view().header->node_count, 1e3 * kDepths_m[d], kKinds[k], sum.ways, sum.mn(sum.facets),
                sum.mn(sum.shaded), sum.mn(sum.refined), sum.refined_leaps);
    }
  }
  constexpr double kMostShare = 1.0 / 3;
  const Sums near = calm(0), deep = calm(1);
  bars.at_most("scans: vibration of 80 to 450 Hz as a share of the facets', " + name, std::sqrt(near.shaded / near.facets),
               kMostShare, "", "where the nearest place does not leap; 0.1 m/s, 1.5 N, 15 cm large");
  const double most = std::max(deep.refined, kMostShare * kMostShare * deep.facets);
  bars.at_most("scans: the same at 3 mm, as a share of the refined scan's or of a third of the facets', " + name,
               std::sqrt(deep.shaded / most), 1, "", "where the nearest place does not leap; 3 N");
}

}  // namespace

void measure_scans(const LawOptions& options, Bars& bars) {
  Table table(options.output, "scans",
              {"scan", "faces", "depth_mm", "ways", "count", "facets_mn", "shaded_mn", "refined_mn", "refined_leaps"});
  for (const char* const name : {"bunny00.off", "armadillo.off", "elephant.off"}) {
    const std::filesystem::path path = std::filesystem::path(FDCG_CGAL_DATA) / "data/meshes" / name;
    if (std::filesystem::exists(path)) measure_scan(options, path, table, bars);
  }
}

}  // namespace fdcg::test
