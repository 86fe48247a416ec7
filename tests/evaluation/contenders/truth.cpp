// SPDX-License-Identifier: Apache-2.0
#include "truth.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bodies.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

TrueBody::TrueBody(const Ground& ground) : ground_(ground) {
  bake::CompileOptions options;
  options.merge = false;
  options.without = {"source-map", "info"};
  auto compiled = bake::compile(ground.soup(), options);
  if (!compiled || compiled->bytes.empty()) throw std::runtime_error(ground.soup().name + " does not compile");
  file_ = std::move(compiled->bytes);
  fdcg_error error{};
  if (fdcg_open_memory(file_.data(), file_.size(), FDCG_VERIFY_TRUSTED, &view_, &error) != FDCG_OK) {
    throw std::runtime_error(error.message);
  }
  if (view_.header->node_count <= kLargestBruteForce) surface_ = std::make_unique<ReferenceSurface<long double>>(view_);
}

std::vector<TrueBody::Tick> TrueBody::follow(const Way& way, const ReferenceFriction& friction) const {
  if (!surface_) return follow_by_runtime(way, friction);
  ReferenceWalker<long double> walker(*surface_, friction);
  std::vector<Tick> ticks(way.size());
  bool is_tied = false;
  double clear = 0;  // no surface is nearer to the last HIP than this; 0: not known
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::array<double, 3> local = surface_->local(way[i].data());
    const double way_m = i > 0 ? length(way[i] - way[i - 1]) : 0;
    const bool is_free = walker.contact.is_started && walker.contact.state == FDCG_FREE;
    if (is_free && clear <= way_m) clear = ground_.closest(way[i - 1]).distance * (1 - 1e-9);
    if (is_free && clear > way_m) {
      clear -= way_m;
      walker.contact.hip = {local[0], local[1], local[2]};
      walker.contact.god_object = walker.contact.hip;
      walker.contact.is_slipping = false;
    } else {
      clear = 0;
      const ReferenceStep step = walker.step(local);
      ticks[i].feel.transitions = step.transitions;
      is_tied = is_tied || step.margin < kTie;
    }
    Tick& tick = ticks[i];
    tick.state = walker.contact.state;
    tick.feature = walker.contact.feature;
    tick.feel.in_contact = tick.state != FDCG_FREE;
    tick.feel.god_object = way[i];
    is_tied = is_tied && tick.feel.in_contact;
    tick.is_tied = is_tied;
    if (!tick.feel.in_contact) continue;
    const Vector<long double>& go = walker.contact.god_object;
    const long double place[3] = {go.x, go.y, go.z};
    for (std::size_t k = 0; k < 3; ++k) {
      tick.feel.god_object[k] = static_cast<double>(place[k] + surface_->origin[k]);
      tick.feel.force[k] = static_cast<double>(place[k] - local[k]) * kStiffness_n_per_m;
    }
  }
  return ticks;
}

std::vector<TrueBody::Tick> TrueBody::follow_by_runtime(const Way& way, const ReferenceFriction& friction) const {
  fdcg_params params = fdcg_make_params();
  params.mu_static = friction.mu_static;
  params.mu_dynamic = friction.mu_dynamic;
  params.stiffness_n_per_m = kStiffness_n_per_m;
  fdcg_contact contact{};
  std::vector<Tick> ticks(way.size());
  for (std::size_t i = 0; i < way.size(); ++i) {
    fdcg_result result;
    fdcg_step(&view_, &params, &contact, way[i].data(), &result);
    Tick& tick = ticks[i];
    tick.state = result.state;
    tick.feature = result.feature;
    tick.feel.in_contact = result.state != FDCG_FREE;
    tick.feel.transitions = result.transitions;
    for (std::size_t k = 0; k < 3; ++k) {
      tick.feel.god_object[k] = result.god_object_m[k];
      tick.feel.force[k] = result.force_n[k];
    }
  }
  return ticks;
}

std::string TrueBody::reference(const Way& way, const std::vector<Tick>& ticks) const {
  if (surface_) return "brute force, long double";
  constexpr std::size_t kEvery = 37;                 // ticks
  constexpr double kRounding_m = kBody_m * 0x1p-48;  // of the ground's tree
  std::size_t seen = 0, closest = 0;
  for (std::size_t i = 0; i < way.size(); i += kEvery) {
    if (!ticks[i].feel.in_contact) continue;
    ++seen;
    closest += length(ticks[i].feel.god_object - way[i]) <= ground_.closest(way[i]).distance + kRounding_m;
  }
  return "own f64 unmerged; " + std::to_string(closest) + " of " + std::to_string(seen) +
         " sampled contacts are closest points";
}

double TrueBody::distance_to(std::uint32_t state, std::uint32_t feature, const Point& point) const {
  const double* origin = view_.header->origin;
  const auto at = [&](std::uint32_t corner) {
    const fdcg_corner_info info = fdcg_get_corner(&view_, corner);
    return Point{info.point[0] + origin[0], info.point[1] + origin[1], info.point[2] + origin[2]};
  };
  if (state == FDCG_VERTEX) return length(point - at(feature));
  if (state == FDCG_EDGE) {
    const fdcg_connection_info edge = fdcg_get_connection(&view_, feature);
    const Point a = at(edge.corner[0]), b = at(edge.corner[1]);
    const double part = std::clamp(dot(point - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
    return length(point - (a + (b - a) * part));
  }
  double least = std::numeric_limits<double>::infinity();
  const auto corner = [&](std::uint32_t side) { return at(fdcg_get_side(&view_, feature, side).corner); };
  const Point first = corner(0);
  for (std::uint32_t k = 1; k + 1 < fdcg_get_node(&view_, feature).side_count; ++k) {
    least = std::min(least, length(point - nearest_on_triangle(point, first, corner(k), corner(k + 1)).point));
  }
  return least;
}

}  // namespace fdcg::test
