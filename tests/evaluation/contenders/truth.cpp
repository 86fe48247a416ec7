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

ModelOfBody::ModelOfBody(const Ground& ground, bake::Precision precision) {
  bake::CompileOptions options;
  options.precision = precision;
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

Feel ModelOfBody::feel_of(const ReferenceContact<long double>& contact, const Point& hip_m, const Point& shift_m) const {
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

// What is a tie is decided anew in 256 bits. How near it was stays: others may be as right to what computes in less.
ReferenceStep ModelOfBody::step(ReferenceWalker<long double>& walker, const std::array<double, 3>& hip_local,
                                const ReferenceFriction& friction) const {
  const ReferenceContact<long double> before = walker.contact;
  ReferenceStep first = walker.step(hip_local);
  if (first.margin >= kTieOfDoubles || !is_decided_in_256_bits()) return first;
  if (!widest_) widest_ = std::make_unique<ReferenceSurface<Mpfr256>>(view_);
  ReferenceWalker<Mpfr256> again(*widest_, friction);
  again.contact = contact_in<Mpfr256>(before);
  ReferenceStep sure = again.step(hip_local);
  sure.margin = std::min(sure.margin, first.margin);
  walker.contact = contact_in<long double>(again.contact);
  return sure;
}

TrueBody::TrueBody(const Ground& ground) : ground_(ground), model_(ground, bake::Precision::f64) {}

// What else may be right after a tie.
class TrueBody::Branches {
 public:
  Branches(const ModelOfBody& model, double tie) : model_(model), tie_(tie), off_m_(tie * model.surface()->extent) {}

  // Before a step: `walker` is at the tick before, where its hand was at `hip_m`.
  void remember(const ReferenceWalker<long double>& walker, const Point& hip_m) {
    before_ = walker.contact;
    before_m_ = hip_m;
  }

  // After it. Returns how many it has added to the tick's others.
  std::size_t follow(const ReferenceWalker<long double>& walker, const ReferenceFriction& friction, const Point& hip_m,
                     Tick& tick) {
    const std::size_t before = tick.others.size();
    if (tick.visit.margin < tie_ && walkers_.empty()) begin(friction);
    for (Branch& branch : walkers_) {
      const Point hip = hip_m + branch.shift_m;
      branch.walker.step(model_.surface()->local(hip.data()));
      const ReferenceContact<long double>& contact = branch.walker.contact;
      const Feel feel = model_.feel_of(contact, hip_m, branch.shift_m);
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
  // A god-object stays on its feature. A free one goes to where that hand was from where the truth was: off by a tie it may
  // lie behind a face already, which it has met then, and never would from there.
  void begin(const ReferenceFriction& friction) {
    for (const Point& corner : {Point{1, 1, 1}, Point{1, -1, -1}, Point{-1, 1, -1}, Point{-1, -1, 1}}) {
      Branch branch{ReferenceWalker<long double>(*model_.surface(), friction), corner * off_m_};
      branch.walker.contact = before_;
      const Point hip = before_m_ + branch.shift_m;
      const std::array<double, 3> local = model_.surface()->local(hip.data());
      if (before_.is_started && before_.state == FDCG_FREE) branch.walker.step(local);
      branch.walker.contact.hip = {local[0], local[1], local[2]};
      walkers_.push_back(std::move(branch));
    }
  }

  const ModelOfBody& model_;
  double tie_, off_m_;
  ReferenceContact<long double> before_;
  Point before_m_{};
  std::list<Branch> walkers_;
};

// The model along a way. Sweeps through free space are skipped where the ground is farther than the way is long.
class TrueBody::Walk {
 public:
  Walk(const TrueBody& body, const ModelOfBody& model, const ReferenceFriction& friction, double off_m)
      : walker(*model.surface(), friction), body_(body), model_(model), friction_(friction), off_m_(off_m) {}

  // `may_skip`: nobody asks how near a decision was.
  ReferenceStep next(const Way& way, std::size_t i, bool may_skip) {
    const std::array<double, 3> local = model_.surface()->local(way[i].data());
    const double way_m = i > 0 ? length(way[i] - way[i - 1]) : 0;
    const bool is_free = walker.contact.is_started && walker.contact.state == FDCG_FREE && may_skip;
    if (is_free && clear_m_ <= way_m) clear_m_ = body_.ground_.closest(way[i - 1]).distance * (1 - 1e-9) - off_m_;
    if (!(is_free && clear_m_ > way_m)) {
      clear_m_ = 0;
      return model_.step(walker, local, friction_);
    }
    clear_m_ -= way_m;
    walker.contact.hip = {local[0], local[1], local[2]};
    walker.contact.god_object = walker.contact.hip;
    walker.contact.is_slipping = false;
    ReferenceStep none;
    none.margin = 1;
    return none;
  }

  ReferenceWalker<long double> walker;

 private:
  const TrueBody& body_;
  const ModelOfBody& model_;
  ReferenceFriction friction_;
  double off_m_;        // of the model's surface from the ground
  double clear_m_ = 0;  // no surface is nearer to the last HIP than this; 0: not known
};

std::vector<TrueBody::Tick> TrueBody::follow(const Way& way, const ReferenceFriction& friction) const {
  if (!can_visit()) return follow_by_runtime(way, friction);
  Walk walk(*this, model_, friction, 0);
  Branches branches(model_, kTie), close(model_, kTieOfDoubles);
  std::vector<Tick> ticks(way.size());
  bool has_ties = false;
  for (std::size_t i = 0; i < way.size(); ++i) {
    Tick& tick = ticks[i];
    branches.remember(walk.walker, way[i > 0 ? i - 1 : 0]);
    close.remember(walk.walker, way[i > 0 ? i - 1 : 0]);
    ReferenceStep done = walk.next(way, i, !branches.has_any() && !close.has_any());
    tick.visit = {std::move(done.visited), done.margin};
    tick.state = walk.walker.contact.state;
    tick.feature = walk.walker.contact.feature;
    tick.feel = model_.feel_of(walk.walker.contact, way[i], {});
    tick.feel.transitions = done.transitions;
    branches.follow(walk.walker, friction, way[i], tick);
    tick.as_right_in_doubles = close.follow(walk.walker, friction, way[i], tick);
    has_ties = has_ties || !tick.others.empty();
  }
  if (has_ties && model_.is_decided_in_256_bits()) follow_in_floats(way, friction, ticks);
  return ticks;
}

void TrueBody::follow_in_floats(const Way& way, const ReferenceFriction& friction, std::vector<Tick>& ticks) const {
  if (!in_floats_) in_floats_ = std::make_unique<ModelOfBody>(ground_, bake::Precision::f32);
  Walk walk(*this, *in_floats_, friction, kTie * model_.surface()->extent);
  for (std::size_t i = 0; i < way.size(); ++i) {
    Tick& tick = ticks[i];
    walk.next(way, i, true);
    tick.in_floats = in_floats_->feel_of(walk.walker.contact, way[i], {});
    const double apart_m = length(tick.in_floats->god_object - tick.feel.god_object);
    if (tick.in_floats->in_contact != tick.feel.in_contact || apart_m >= kApart_m)
      tick.others.insert(tick.others.begin(), *tick.in_floats);
  }
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
    fdcg_step(&model_.view(), &params, &contact, way[i].data(), &result);
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
    const std::array<double, 3> local = model_.surface()->local(point.data());
    return Vector<long double>{local[0], local[1], local[2]};
  };
  ReferenceWalker<long double> walker(*model_.surface(), friction);
  walker.contact.is_started = true;
  walker.contact.god_object = vector(place->god_object);
  walker.contact.hip = vector(place->hip);
  std::tie(walker.contact.state, walker.contact.feature) = place->feature;
  ReferenceStep done = model_.step(walker, model_.surface()->local(hip_m.data()), friction);
  *place = {{walker.contact.state, walker.contact.feature}, model_.feel_of(walker.contact, hip_m, {}).god_object, hip_m};
  return {std::move(done.visited), done.margin};
}

std::string TrueBody::reference(const Way& way, const std::vector<Tick>& ticks) const {
  if (can_visit())
    return model_.is_decided_in_256_bits() ? "brute force, long double, ties in 256 bits" : "brute force, long double";
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
  const double* origin = model_.view().header->origin;
  const auto at = [&](std::uint32_t corner) {
    const fdcg_corner_info info = fdcg_get_corner(&model_.view(), corner);
    return Point{info.point[0] + origin[0], info.point[1] + origin[1], info.point[2] + origin[2]};
  };
  if (state == FDCG_VERTEX) return length(point - at(feature));
  if (state == FDCG_EDGE) {
    const fdcg_connection_info edge = fdcg_get_connection(&model_.view(), feature);
    const Point a = at(edge.corner[0]), b = at(edge.corner[1]);
    const double part = std::clamp(dot(point - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
    return length(point - (a + (b - a) * part));
  }
  double least = std::numeric_limits<double>::infinity();
  const auto corner = [&](std::uint32_t side) { return at(fdcg_get_side(&model_.view(), feature, side).corner); };
  const Point first = corner(0);
  for (std::uint32_t k = 1; k + 1 < fdcg_get_node(&model_.view(), feature).side_count; ++k) {
    least = std::min(least, length(point - nearest_on_triangle(point, first, corner(k), corner(k + 1)).point));
  }
  return least;
}

}  // namespace fdcg::test
