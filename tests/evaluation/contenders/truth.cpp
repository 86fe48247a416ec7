// SPDX-License-Identifier: Apache-2.0
#include "truth.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

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
  surface_ = std::make_unique<ReferenceSurface<long double>>(view_);
}

std::vector<TrueBody::Tick> TrueBody::follow(const Way& way, const ReferenceFriction& friction) const {
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

double TrueBody::distance_to(std::uint32_t state, std::uint32_t feature, const Point& point) const {
  const Point x = point - surface_->origin;
  const auto at = [&](std::uint32_t corner) {
    const Vector<long double>& p = surface_->corners[corner].point;
    return Point{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  };
  if (state == FDCG_VERTEX) return length(x - at(feature));
  if (state == FDCG_EDGE) {
    const auto& edge = surface_->edges[feature];
    const Point a = at(edge.corner[0]), b = at(edge.corner[1]);
    const double part = std::clamp(dot(x - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
    return length(x - (a + (b - a) * part));
  }
  double least = std::numeric_limits<double>::infinity();
  const std::vector<std::uint32_t>& loop = surface_->faces[feature].corners;
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    const OnTriangle nearest = nearest_on_triangle(x, at(loop[0]), at(loop[k]), at(loop[k + 1]));
    least = std::min(least, length(x - nearest.point));
  }
  return least;
}

}  // namespace fdcg::test
