// SPDX-License-Identifier: Apache-2.0
#include "truth.hpp"

#include <algorithm>
#include <limits>
#include <list>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bodies.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

template <class To, class From>
ReferenceContact<To> contact_in(const ReferenceContact<From>& from) {
  const auto point = [](const Vector<From>& v) {
    return Vector<To>{static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
  };
  return {point(from.god_object), point(from.hip), from.is_started,   from.state,
          from.feature,           from.seat_state, from.seat_feature, from.is_slipping};
}

}  // namespace

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

Feel TrueBody::feel_of(const ReferenceContact<long double>& contact, const Point& hip_m, const Point& shift_m) const {
  Feel feel;
  feel.in_contact = contact.state != FDCG_FREE;
  feel.god_object = hip_m;
  if (!feel.in_contact) return feel;
  const Vector<long double>&go = contact.god_object, &hip = contact.hip;
  const long double place[3] = {go.x, go.y, go.z}, depth[3] = {go.x - hip.x, go.y - hip.y, go.z - hip.z};
  for (std::size_t k = 0; k < 3; ++k) {
    feel.god_object[k] = static_cast<double>(place[k] + surface_->origin[k] - shift_m[k]);
    feel.force[k] = static_cast<double>(depth[k]) * kStiffness_n_per_m;
  }
  return feel;
}

// What else may be right after a tie.
class TrueBody::Branches {
 public:
  Branches(const TrueBody& body, double tie) : body_(body), tie_(tie), off_m_(tie * body.surface_->extent) {}

  // Before a step: `walker` is at the tick before.
  void remember(const ReferenceWalker<long double>& walker) { before_ = walker.contact; }

  // After it. Returns how many it has added to the tick's others.
  std::size_t follow(const ReferenceWalker<long double>& walker, const ReferenceFriction& friction, const Point& hip_m,
                     Tick& tick) {
    const std::size_t before = tick.others.size();
    if (tick.visit.margin < tie_ && walkers_.empty()) begin(friction);
    for (Branch& branch : walkers_) {
      const Point hip = hip_m + branch.shift_m;
      branch.walker.step(body_.surface_->local(hip.data()));
      const ReferenceContact<long double>& contact = branch.walker.contact;
      const Feel feel = body_.feel_of(contact, hip_m, branch.shift_m);
      const double apart_m = length(feel.god_object - tick.feel.god_object);
      branch.is_one = contact.state == walker.contact.state && contact.feature == walker.contact.feature && apart_m < kApart_m;
      if (feel.in_contact != tick.feel.in_contact || apart_m >= kApart_m) tick.others.push_back(feel);
    }
    std::erase_if(walkers_, [](const Branch& branch) { return branch.is_one; });
    return tick.others.size() - before;
  }
  [[nodiscard]] bool has_any() const { return !walkers_.empty(); }

 private:
  struct Branch {
    ReferenceWalker<long double> walker;
    Point shift_m;
    bool is_one = false;  // with the truth again
  };
  void begin(const ReferenceFriction& friction) {
    for (const Point& corner : {Point{1, 1, 1}, Point{1, -1, -1}, Point{-1, 1, -1}, Point{-1, -1, 1}}) {
      Branch branch{ReferenceWalker<long double>(*body_.surface_, friction), corner * off_m_};
      branch.walker.contact = before_;
      for (Vector<long double>* place : {&branch.walker.contact.hip, &branch.walker.contact.god_object}) {
        if (before_.state != FDCG_FREE && place != &branch.walker.contact.hip) continue;  // a god-object stays on its feature
        place->x += branch.shift_m[0], place->y += branch.shift_m[1], place->z += branch.shift_m[2];
      }
      walkers_.push_back(std::move(branch));
    }
  }

  const TrueBody& body_;
  double tie_, off_m_;
  ReferenceContact<long double> before_;
  std::list<Branch> walkers_;
};

// What is a tie is decided anew in 256 bits. How near it was stays: others may be as right to what computes in less.
ReferenceStep TrueBody::step(ReferenceWalker<long double>& walker, const std::array<double, 3>& hip_local,
                             const ReferenceFriction& friction) const {
  const ReferenceContact<long double> before = walker.contact;
  ReferenceStep first = walker.step(hip_local);
  if (first.margin >= kTieOfDoubles || view_.header->node_count > kLargestIn256Bits) return first;
  if (!widest_) widest_ = std::make_unique<ReferenceSurface<Mpfr256>>(view_);
  ReferenceWalker<Mpfr256> again(*widest_, friction);
  again.contact = contact_in<Mpfr256>(before);
  ReferenceStep sure = again.step(hip_local);
  sure.margin = std::min(sure.margin, first.margin);
  walker.contact = contact_in<long double>(again.contact);
  return sure;
}

std::vector<TrueBody::Tick> TrueBody::follow(const Way& way, const ReferenceFriction& friction) const {
  if (!surface_) return follow_by_runtime(way, friction);
  ReferenceWalker<long double> walker(*surface_, friction);
  Branches branches(*this, kTie), close(*this, kTieOfDoubles);
  std::vector<Tick> ticks(way.size());
  double clear = 0;  // no surface is nearer to the last HIP than this; 0: not known
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::array<double, 3> local = surface_->local(way[i].data());
    const double way_m = i > 0 ? length(way[i] - way[i - 1]) : 0;
    const bool is_free =
        walker.contact.is_started && walker.contact.state == FDCG_FREE && !branches.has_any() && !close.has_any();
    if (is_free && clear <= way_m) clear = ground_.closest(way[i - 1]).distance * (1 - 1e-9);
    Tick& tick = ticks[i];
    branches.remember(walker);
    close.remember(walker);
    if (is_free && clear > way_m) {
      clear -= way_m;
      walker.contact.hip = {local[0], local[1], local[2]};
      walker.contact.god_object = walker.contact.hip;
      walker.contact.is_slipping = false;
    } else {
      clear = 0;
      ReferenceStep done = step(walker, local, friction);
      tick.feel.transitions = done.transitions;
      tick.visit = {std::move(done.visited), done.margin};
    }
    const std::uint32_t transitions = tick.feel.transitions;
    tick.state = walker.contact.state;
    tick.feature = walker.contact.feature;
    tick.feel = feel_of(walker.contact, way[i], {});
    tick.feel.transitions = transitions;
    branches.follow(walker, friction, way[i], tick);
    tick.as_right_in_doubles = close.follow(walker, friction, way[i], tick);
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

TrueBody::Visit TrueBody::visit(Place* place, const Point& hip_m, const ReferenceFriction& friction) const {
  const auto vector = [&](const Point& point) {
    const std::array<double, 3> local = surface_->local(point.data());
    return Vector<long double>{local[0], local[1], local[2]};
  };
  ReferenceWalker<long double> walker(*surface_, friction);
  walker.contact.is_started = true;
  walker.contact.god_object = vector(place->god_object);
  walker.contact.hip = vector(place->hip);
  std::tie(walker.contact.state, walker.contact.feature) = place->feature;
  ReferenceStep done = step(walker, surface_->local(hip_m.data()), friction);
  *place = {{walker.contact.state, walker.contact.feature}, feel_of(walker.contact, hip_m, {}).god_object, hip_m};
  return {std::move(done.visited), done.margin};
}

std::string TrueBody::reference(const Way& way, const std::vector<Tick>& ticks) const {
  if (surface_)
    return view_.header->node_count > kLargestIn256Bits ? "brute force, long double"
                                                        : "brute force, long double, ties in 256 bits";
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
