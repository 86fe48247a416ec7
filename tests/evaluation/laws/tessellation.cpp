// SPDX-License-Identifier: Apache-2.0
// How near a tessellation comes to the smooth shape that it stands for, at the hand: the god-object and the force of a HIP that
// slides at a constant depth, without friction, against the formula.
//
// Two errors of the god-object are told apart. Off the true surface it is by the sagitta of a facet, of second order in the
// edge's length. Along the surface it is by depth times the angle between facet and surface, of first order: at a fixed depth a
// facet's normal is what the god-object follows, and that is no better however exact the step is (on a cylinder of n sides, at
// most depth sin(pi / n)). The force's direction is of first order for the same reason, its size of second.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "laws.hpp"
#include "parallel.hpp"
#include "pressed.hpp"
#include "smooth_shape.hpp"

namespace fdcg::test {
namespace {

constexpr double kSpeed_m_per_s = 0.1, kTick_s = 1e-3, kStiffness_n_per_m = 1000;
constexpr double kDepths[] = {0.03, 0.3};  // of the least radius of curvature
constexpr double kDegrees = 180 / kPi;
constexpr int kWarmUpTicks = 10;  // from the entry of the facet to where a slide would have come

struct Errors {
  std::uint64_t ticks = 0, contact_ticks = 0;
  long double place2 = 0, force2 = 0, direction2 = 0;  // sums of squares
  long double place_max = 0, off_surface_max = 0, force_max = 0, size_max = 0, direction_max = 0;
  long double jump_max = 0, smooth_jump_max = 0;  // newtons between two ticks; of the smooth shape

  [[nodiscard]] double rms(long double sum) const {
    return contact_ticks == 0 ? std::nan("") : static_cast<double>(std::sqrt(sum / static_cast<long double>(contact_ticks)));
  }
  [[nodiscard]] bool is_in_contact() const { return ticks > 0 && contact_ticks == ticks; }
};

struct Level {
  std::uint64_t faces = 0;
  double edge_m = 0;  // root of twice the mean face's area, as if triangles were half squares
  std::array<std::array<Errors, std::size(kDepths)>, 2> errors;  // by precision and depth
};

SmoothPoint smooth(const double (&p)[3]) {
  return {p[0], p[1], p[2]};
}

Hip hip_under(const SurfacePoint& at, long double depth_m) {
  const SmoothPoint p = at.point - at.normal * depth_m;
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

void observe(const SmoothShape& shape, const SurfacePoint& at, const fdcg_result& result, double depth_m, Errors* errors) {
  ++errors->ticks;
  if (result.state == FDCG_FREE) return;
  ++errors->contact_ticks;
  const SmoothPoint god_object = smooth(result.god_object_m), force = smooth(result.force_n);
  const SmoothPoint expected = at.normal * (static_cast<long double>(kStiffness_n_per_m) * depth_m);
  const long double place = length(god_object - at.point), wrong = length(force - expected);
  const long double degrees = std::atan2(length(cross(force, at.normal)), dot(force, at.normal)) * kDegrees;
  errors->place2 += place * place, errors->force2 += wrong * wrong, errors->direction2 += degrees * degrees;
  errors->place_max = std::max(errors->place_max, place);
  errors->off_surface_max = std::max(errors->off_surface_max, std::abs(shape.distance(god_object)));
  errors->force_max = std::max(errors->force_max, wrong);
  errors->size_max = std::max(errors->size_max, std::abs(length(force) - length(expected)));
  errors->direction_max = std::max(errors->direction_max, degrees);
}

Errors slide(const SmoothShape& shape, const fdcg_graph& graph, double depth_m, int ticks) {
  constexpr long double kSmall = 1e-6L;  // of the parameter, for the curve's speed
  fdcg_params params = contact_params(0, 0);
  params.stiffness_n_per_m = kStiffness_n_per_m;
  Pressed pressed{&graph};
  long double t = 0.123L;
  pressed.step(params, hip_under(shape.curve(t), -shape.curvature_radius_m()));
  Errors errors;
  SmoothPoint last_force, last_smooth;
  for (int tick = -kWarmUpTicks; tick < ticks; ++tick) {
    const SurfacePoint at = shape.curve(t);
    pressed.step(params, hip_under(at, depth_m));
    const SmoothPoint force = smooth(pressed.result.force_n),
                      smooth_force = at.normal * (static_cast<long double>(kStiffness_n_per_m) * depth_m);
    if (tick > 0) {
      errors.jump_max = std::max(errors.jump_max, length(force - last_force));
      errors.smooth_jump_max = std::max(errors.smooth_jump_max, length(smooth_force - last_smooth));
    }
    if (tick >= 0) observe(shape, at, pressed.result, depth_m, &errors);
    last_force = force, last_smooth = smooth_force;
    const SmoothPoint way = shape.curve(t + kSmall).point - shape.curve(t - kSmall).point;
    t += static_cast<long double>(kSpeed_m_per_s * kTick_s) * 2 * kSmall / length(way);
  }
  return errors;
}

double mean_edge_m(const PolygonSoup& soup) {
  double area = 0;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], end = soup.face_first[f + 1];
    const Hip a = point_of(soup.points[soup.corners[first]]);
    for (std::uint32_t k = first + 1; k + 1 < end; ++k) {
      const Hip u = difference(point_of(soup.points[soup.corners[k]]), a),
                v = difference(point_of(soup.points[soup.corners[k + 1]]), a);
      area += norm({u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]}) / 2;
    }
  }
  return std::sqrt(2 * area / static_cast<double>(soup.face_count()));
}

Level measure_level(const SmoothShape& shape, int level, int ticks) {
  const PolygonSoup soup = shape.tessellated(level);
  Level result;
  result.faces = soup.face_count();
  result.edge_m = mean_edge_m(soup);
  for (std::size_t p = 0; p < std::size(kBothPrecisions); ++p) {
    bake::CompileOptions compile;
    compile.precision = kBothPrecisions[p];
    compile.merge = false;  // a node is a facet
    compile.jobs = 1;
    const CompiledMesh mesh(soup, compile);
    for (std::size_t d = 0; d < std::size(kDepths); ++d)
      result.errors[p][d] = slide(shape, mesh.view(), kDepths[d] * shape.curvature_radius_m(), ticks);
  }
  return result;
}

// Of an error from one level to the next, whose edges are half as long; NaN where one of them lost contact.
double order(const Errors& coarse, const Errors& fine, long double Errors::*error) {
  if (!coarse.is_in_contact() || !fine.is_in_contact()) return std::nan("");
  return static_cast<double>(std::log2(coarse.*error / (fine.*error)));
}

const std::vector<std::string> kColumns = {"shape",
                                           "precision",
                                           "level",
                                           "faces",
                                           "mean_edge_m",
                                           "depth_m",
                                           "ticks",
                                           "contact_ticks",
                                           "god_object_error_rms_m",
                                           "god_object_error_max_m",
                                           "off_surface_max_m",
                                           "force_error_rms_n",
                                           "force_error_max_n",
                                           "force_size_error_max_n",
                                           "force_n",
                                           "direction_error_rms_deg",
                                           "direction_error_max_deg",
                                           "largest_jump_n_per_ms",
                                           "smooth_jump_n_per_ms",
                                           "order_off_surface",
                                           "order_god_object",
                                           "order_force_size",
                                           "order_direction"};

void say(const SmoothShape& shape, const std::vector<Level>& levels, Table* table) {
  constexpr double kTick_ms = kTick_s * 1e3;
  for (std::size_t p = 0; p < std::size(kBothPrecisions); ++p) {
    for (std::size_t d = 0; d < std::size(kDepths); ++d) {
      for (std::size_t l = 0; l < levels.size(); ++l) {
        const Errors& e = levels[l].errors[p][d];
        const Errors& before = l > 0 ? levels[l - 1].errors[p][d] : Errors{};
        const double depth_m = kDepths[d] * shape.curvature_radius_m();
        table->row(shape.name(), name_of(kBothPrecisions[p]), l, levels[l].faces, levels[l].edge_m, depth_m, e.ticks,
                   e.contact_ticks, e.rms(e.place2), static_cast<double>(e.place_max), static_cast<double>(e.off_surface_max),
                   e.rms(e.force2), static_cast<double>(e.force_max), static_cast<double>(e.size_max),
                   kStiffness_n_per_m * depth_m, e.rms(e.direction2), static_cast<double>(e.direction_max),
                   static_cast<double>(e.jump_max) / kTick_ms, static_cast<double>(e.smooth_jump_max) / kTick_ms,
                   order(before, e, &Errors::off_surface_max), order(before, e, &Errors::place_max),
                   order(before, e, &Errors::size_max), order(before, e, &Errors::direction_max));
      }
    }
  }
}

// The mean order from the first level that never loses contact to the last.
double mean_order(const std::vector<Level>& levels, std::size_t p, std::size_t d, long double Errors::*error) {
  std::size_t first = 0;
  while (first < levels.size() && !levels[first].errors[p][d].is_in_contact())
    ++first;
  if (first + 1 >= levels.size()) return std::nan("");
  return order(levels[first].errors[p][d], levels.back().errors[p][d], error) / static_cast<double>(levels.size() - 1 - first);
}

}  // namespace

void measure_tessellation(const LawOptions& options, Bars& bars) {
  constexpr double kSecondOrder = 1.9, kFirstOrder = 0.9;  // what of 2 and 1 must be seen
  constexpr int kQuickLevels = 6;
  const int level_count = options.is_quick ? kQuickLevels : SmoothShape::kLevels, ticks = options.is_quick ? 3000 : 20000;
  const std::vector<const SmoothShape*> shapes = smooth_shapes();
  std::vector<std::vector<Level>> levels(shapes.size(), std::vector<Level>(static_cast<std::size_t>(level_count)));
  for_each_index(shapes.size() * static_cast<std::size_t>(level_count), options.threads, [&](std::size_t i) {
    const std::size_t s = i % shapes.size(), l = i / shapes.size();
    levels[s][l] = measure_level(*shapes[s], static_cast<int>(l), ticks);
  });
  Table table(options.output, "tessellation", kColumns);
  for (std::size_t s = 0; s < shapes.size(); ++s)
    say(*shapes[s], levels[s], &table);
  for (std::size_t p = 0; p < std::size(kBothPrecisions); ++p) {
    const auto least = [&](long double Errors::*error) {
      double least_order = std::numeric_limits<double>::infinity();
      for (const std::vector<Level>& of_shape : levels) {
        for (std::size_t d = 0; d < std::size(kDepths); ++d) {
          const double seen = mean_order(of_shape, p, d, error);
          if (!(seen >= least_order)) least_order = seen;  // NaN too: then the bar fails
          if (std::isnan(seen)) return seen;
        }
      }
      return least_order;
    };
    const std::string of = std::string(", ") + name_of(kBothPrecisions[p]);
    bars.at_least("tessellation: order of the god-object's distance from the true surface" + of,
                  least(&Errors::off_surface_max), kSecondOrder, "", "2 in theory; the least of four shapes and two depths");
    bars.at_least("tessellation: order of the force's size" + of, least(&Errors::size_max), kSecondOrder, "", "2 in theory");
    bars.at_least("tessellation: order of the god-object's error along the surface" + of, least(&Errors::place_max),
                  kFirstOrder, "", "1 in theory: depth times the facets' angle, for any exact closest point");
    bars.at_least("tessellation: order of the force's direction" + of, least(&Errors::direction_max), kFirstOrder, "",
                  "1 in theory");
  }
}

}  // namespace fdcg::test
