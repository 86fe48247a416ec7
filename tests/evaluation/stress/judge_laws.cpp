// SPDX-License-Identifier: Apache-2.0
// Coulomb's law, tick by tick: in long double, from the judge's own planes. And what the exact certificate says.
#include <algorithm>
#include <cmath>
#include <vector>

#include "judge.hpp"
#include "result_law.hpp"

namespace fdcg::test {
namespace {

using Real = long double;
using Long = std::array<Real, 3>;

Long way(const Hip& from, const Hip& to) {
  return {Real(to[0]) - from[0], Real(to[1]) - from[1], Real(to[2]) - from[2]};
}
Real dot(const Long& a, const Hip& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Real length(const Long& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}
Long without(const Long& a, const Hip& unit) {
  const Real along = dot(a, unit);
  return {a[0] - unit[0] * along, a[1] - unit[1] * along, a[2] - unit[2] * along};
}

constexpr Real kWayOfStickAgain = 1 - 0x1p-20L;  // contact-model FRIC-3
constexpr double kMostWedge = 1024;              // EDGE-4
constexpr double kMostLoadError = 0.01;

}  // namespace

void Judge::look_at_result(Tick& tick, const Hip& hip_m) const {
  const ResultLaw law = result_law(specimen_.header(), params_, tick.after, hip_m, tick.result);
  if (!law.is_of_contact) tick.faults |= bit(Fault::report);
  if (!law.is_of_spring) tick.faults |= bit(Fault::force);
}

// Where friction acts: in a face's plane by the depth, along an edge by the load of its two faces.
std::optional<Judge::Rubbing> Judge::rubbing_at(const Tick& tick) const {
  if (tick.after.state == FDCG_FACE) return rubbing_on_face(tick, tick.after.feature);
  if (tick.after.state != FDCG_EDGE) return std::nullopt;
  return rubbing_on_edge(tick, specimen_.edges[tick.after.feature]);
}

Judge::Rubbing Judge::rubbing_on_face(const Tick& tick, std::uint32_t node) const {
  Rubbing rubbing;
  rubbing.load = std::max(0.0, -in_front_of_node(node, tick.hip));
  rubbing.gap = static_cast<double>(length(without(way(tick.hip, tick.god_object), specimen_.nodes[node].normal)));
  rubbing.slack = (kMostFriction_eps * tick.rounding + deviation_) * (1 + params_.mu_static);
  return rubbing;
}

std::optional<Judge::Rubbing> Judge::rubbing_on_edge(const Tick& tick, const EdgeShape& edge) const {
  if (edge.node[1] == FDCG_NONE) return std::nullopt;
  const Long gap = way(tick.hip, tick.god_object);
  const double mu = params_.mu_static;
  Rubbing rubbing;
  rubbing.slack = kMostFriction_eps * tick.rounding + deviation_;
  const Real ahead = dot(gap, edge.direction);
  const Long across = without(way(edge.start, tick.hip), edge.direction);
  const double distance = static_cast<double>(length(across));
  rubbing.gap = static_cast<double>(std::abs(ahead));
  rubbing.load = distance;
  rubbing.slack *= 1 + mu;
  if (params_.edge_friction != FDCG_EDGE_WEDGE) return rubbing;
  const Hip &a = specimen_.nodes[edge.node[0]].normal, &b = specimen_.nodes[edge.node[1]].normal;
  const Hip sum = {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  const double sum2 = fdcg::test::dot(sum, sum);
  // How much of the distance the load errs by, since the normals are rounded; a closed slit, but for that, has any load.
  const double error = 8 * epsilon_ / sum2, steep = 1 + 4 / std::sqrt(sum2);
  if (!(error < kMostLoadError)) return std::nullopt;
  const auto load = static_cast<double>(-2 * dot(across, sum) / sum2);
  rubbing.load = std::clamp(load, 0.0, kMostWedge * distance);
  rubbing.slack *= steep;
  rubbing.slack += mu * (distance * error + rubbing.load * 8 * epsilon_ * steep);
  return rubbing;
}

// A slip flag that was set ends only where the god-object sticks; what does not slip is within the static cone, what slips on
// the rim of the dynamic one, but for the share at which it would stick, or where it came onto its feature.
bool Judge::look_at_friction(Tick& tick) const {
  const std::optional<Rubbing> rubbing = rubbing_at(tick);
  if (!rubbing) return false;
  const auto [load, gap, slack] = *rubbing;
  const bool was_slipping = tick.before.slipping != 0, is_slipping = tick.result.slipping != 0;
  const double dynamic_reach = params_.mu_dynamic * load;
  bool holds = gap <= (is_slipping ? params_.mu_dynamic : params_.mu_static) * load + slack;
  if (was_slipping && !is_slipping && tick.before.state != FDCG_FREE) holds = holds && gap <= dynamic_reach + slack;
  const bool is_same_feature = tick.result.transitions == 0 && tick.before.state == tick.after.state &&
                               tick.before.feature == tick.after.feature && tick.before.started != 0;
  const bool is_still = is_same(tick.before.god_object, tick.after.god_object);
  // A face lost and found again within the tick leaves the flag set, and the god-object where the way met it.
  const double least = static_cast<double>(kWayOfStickAgain) * dynamic_reach - slack;
  if (is_slipping && !is_still && !is_on_rim(tick)) holds = holds && gap >= least;
  if (is_same_feature) holds = holds && moves_by_coulomb(tick, *rubbing, is_still);
  if (!holds && !is_held_beside(tick)) tick.faults |= bit(Fault::friction);
  return true;
}

bool Judge::is_held_by_face(const Tick& tick, std::uint32_t node) const {
  const auto [load, gap, slack] = rubbing_on_face(tick, node);
  return gap <= (tick.result.slipping != 0 ? params_.mu_dynamic : params_.mu_static) * load + slack;
}

// Whether the HIP is clearly over a face, as far as its sides at the god-object say.
bool Judge::is_over_at(std::uint32_t n, const Tick& tick, double sure) const {
  const NodeShape& node = specimen_.nodes[n];
  for (std::uint32_t k = 0; k < node.side_count; ++k) {
    const Rim& rim = specimen_.rims[node.first_side + k];
    const bool is_here = signed_distance(rim.normal, rim.offset, tick.god_object) > -sure;
    if (is_here && signed_distance(rim.normal, rim.offset, tick.hip) > -sure) return false;
  }
  return true;
}

bool Judge::is_held_by_edge(const Tick& tick, const EdgeShape& edge) const {
  const std::optional<Rubbing> rubbing = rubbing_on_edge(tick, edge);
  if (!rubbing) return true;  // a closed slit: its load is any
  return rubbing->gap <= (tick.result.slipping != 0 ? params_.mu_dynamic : params_.mu_static) * rubbing->load + rubbing->slack;
}

// A god-object of a corner that is on the rim of a friction cone there, but for rounding. What leads nearest to the HIP is
// asked, and nothing else (contact-model CORNER-1, CORNER-3): the edge or the face, of those that are not in front of the HIP,
// along which it reaches farthest; of several that tie but for rounding one that holds will do. Where none leads nearer the
// corner holds.
bool Judge::is_held_at_corner(const Tick& tick) const {
  const std::uint32_t corner = tick.after.feature;
  const fdcg_graph& graph = specimen_.graph();
  std::vector<std::uint32_t> fan(fdcg_get_fan(&graph, corner, nullptr, 0));
  fdcg_get_fan(&graph, corner, fan.data(), static_cast<std::uint32_t>(fan.size()));
  const Long t = way(specimen_.corners[corner].point, tick.hip);
  const double sure = kMostDescent_eps * tick.rounding + deviation_;
  double most = 0, most_held = 0;
  const auto look_at = [&](double reach, bool is_held) {
    most = std::max(most, reach);
    if (is_held) most_held = std::max(most_held, reach);
  };
  for (const std::uint32_t entry : fan) {
    const EdgeShape& edge = specimen_.edges[entry >> 1];
    const auto ahead = static_cast<double>(dot(t, edge.direction) * ((entry & 1) == 0 ? 1 : -1));
    const bool may_hold = edge.node[1] != FDCG_NONE && in_front_of_edge(edge, tick.hip) < -sure;
    if (may_hold && ahead > sure) look_at(ahead, is_held_by_edge(tick, edge));
    const std::uint32_t n = edge.node[entry & 1];
    if (n == FDCG_NONE || !(in_front_of_node(n, tick.hip) < -sure)) continue;
    const auto flat = static_cast<double>(length(without(t, specimen_.nodes[n].normal)));
    if (is_over_at(n, tick, sure)) look_at(flat, is_held_by_face(tick, n));
  }
  return most_held >= most - sure;
}

// A god-object of a face that is on one of its edges but for rounding: the edge's own friction may hold it. Or the face's, one
// of an edge.
bool Judge::is_held_beside(const Tick& tick) const {
  if (tick.result.transitions == 0) return false;
  const std::uint32_t feature = tick.after.feature;
  const auto holds = [&](std::uint32_t n) { return n != FDCG_NONE && is_held_by_face(tick, n); };
  if (tick.after.state == FDCG_EDGE) return holds(specimen_.edges[feature].node[0]) || holds(specimen_.edges[feature].node[1]);
  const NodeShape& node = specimen_.nodes[feature];
  for (std::uint32_t k = 0; k < node.side_count; ++k) {
    const Rim& rim = specimen_.rims[node.first_side + k];
    if (signed_distance(rim.normal, rim.offset, tick.god_object) < -kMostOffSurface_eps * tick.rounding - deviation_) continue;
    if (is_held_by_edge(tick, specimen_.edges[rim.edge])) return true;
  }
  return false;
}

bool Judge::is_on_rim(const Tick& tick) const {
  const double near = kMostOffSurface_eps * tick.rounding + deviation_;
  if (tick.after.state == FDCG_EDGE) {
    const EdgeShape& edge = specimen_.edges[tick.after.feature];
    const double along = static_cast<double>(dot(way(edge.start, tick.god_object), edge.direction));
    return along <= near || edge.length - along <= near || tick.result.transitions > 0;  // by whichever face it came
  }
  const NodeShape& node = specimen_.nodes[tick.after.feature];
  for (std::uint32_t k = 0; k < node.side_count; ++k) {
    const Rim& rim = specimen_.rims[node.first_side + k];
    if (signed_distance(rim.normal, rim.offset, tick.god_object) >= -near) return true;
  }
  return false;
}

// On one feature all the tick: friction holds the god-object, to the bit, or lets it slide straight to the dynamic cone's rim.
bool Judge::moves_by_coulomb(const Tick& tick, const Rubbing& rubbing, bool is_still) const {
  const auto [load, gap, slack] = rubbing;
  const bool was_slipping = tick.before.slipping != 0, is_slipping = tick.result.slipping != 0;
  Tick unmoved = tick;
  unmoved.god_object = {tick.before.god_object[0], tick.before.god_object[1], tick.before.god_object[2]};
  const double reach = rubbing_at(unmoved)->gap;  // of where it was
  const double holding =
      was_slipping ? static_cast<double>(kWayOfStickAgain) * params_.mu_dynamic * load : params_.mu_static * load;
  if (reach < holding - slack) return is_still && !is_slipping;
  if (was_slipping && reach > holding + slack && !is_slipping) return false;
  const double sliding = was_slipping ? params_.mu_dynamic * load : params_.mu_static * load;
  if (!(reach > sliding + slack)) return true;  // either, within rounding
  if (!is_slipping || std::abs(gap - params_.mu_dynamic * load) > slack) return false;
  // Straight: what is left of the way to the HIP's foot is what was, shortened.
  const Hip& from = unmoved.god_object;
  const double share = gap / reach, moved = static_cast<double>(length(way(from, tick.god_object)));
  return std::abs(moved - (1 - share) * reach) <= slack + kMostFriction_eps * tick.rounding;
}

// Two faces below an edge pull the god-object: the nearer plane wins (contact-model EDGE-2).
void Judge::look_at_choice(Tick& tick) const {
  const bool is_from_edge = tick.before.state == FDCG_EDGE && tick.after.state == FDCG_FACE && tick.result.transitions == 1;
  if (!is_from_edge || deviation_ > 0) return;
  const EdgeShape& edge = specimen_.edges[tick.before.feature];
  if (edge.node[1] == FDCG_NONE || (tick.after.feature != edge.node[0] && tick.after.feature != edge.node[1])) return;
  const Hip t = difference(tick.hip, edge.start);
  const double sure = kMostDescent_eps * tick.rounding;
  double into[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const Hip& n = specimen_.nodes[edge.node[k]].normal;
    into[k] = fdcg::test::dot(t, k == 0 ? cross_product(n, edge.direction) : cross_product(edge.direction, n));
  }
  const std::size_t taken = tick.after.feature == edge.node[0] ? 0 : 1, left = 1 - taken;
  if (!(in_front_of_node(edge.node[left], tick.hip) < -sure)) return;  // it might not pull
  if (into[left] > into[taken] + 2 * sure && into[left] > sure) tick.faults |= bit(Fault::wrong_face);
}

// Without friction, by exact rationals: whether the god-object is where |x - HIP| has a local minimum over the closed outside.
// Where it is not, HIPs within rounding are tried before that is called a fault.
void Judge::look_at_certificate(Tick& tick, Verdicts& v) {
  const Certificate* certificate = specimen_.certificate.get();
  constexpr std::uint64_t kOneIn = 1000, kOneCornerIn = 20;
  if (certificate == nullptr || has_friction_) return;
  asked_certificates_ += 1;
  const bool is_corner = tick.after.state == FDCG_VERTEX;
  const bool is_due = asked_certificates_ % kOneIn == 0 || (is_corner && asked_certificates_ % kOneCornerIn == 0);
  if (!is_due && !certifies_all_) return;
  const Hip hip = hip_of(tick.after.hip);
  if (std::abs(hip[0]) + std::abs(hip[1]) + std::abs(hip[2]) > 8 * specimen_.header().extent)
    return;  // coarser than the object
  ++v.certified;
  using Verdict = Certificate::Verdict;
  const Verdict verdict = certificate->check(hip, tick.after).verdict;
  if (verdict == Verdict::certified || verdict == Verdict::tie) return;
  if (!certificate->holds_nearby(hip, tick.after, kMostDescent_eps)) tick.faults |= bit(Fault::uncertified);
}

// What another sheet at the god-object may hold is asked only where a law of one sheet's rest fails.
void Judge::pass_over_between_sheets(Tick& tick, Verdicts& v) const {
  constexpr std::uint32_t kOfRest =
      bit(Fault::pull) | bit(Fault::descent) | bit(Fault::free_air) | bit(Fault::friction) | bit(Fault::wrong_face);
  if ((tick.faults & kOfRest) == 0 || !is_on_other_sheet(tick)) return;
  tick.faults &= ~kOfRest;
  ++v.between;
}

// Whether the god-object is on a face that has no corner of its feature.
bool Judge::is_on_other_sheet(const Tick& tick) const {
  const fdcg_graph& graph = specimen_.graph();
  const std::uint32_t feature = tick.after.feature;
  std::vector<std::uint32_t> own;  // corners
  if (tick.after.state == FDCG_FACE) {
    for (std::uint32_t k = 0; k < specimen_.nodes[feature].side_count; ++k)
      own.push_back(fdcg_get_side(&graph, feature, k).corner);
  } else if (tick.after.state == FDCG_EDGE) {
    own.assign(std::begin(specimen_.edges[feature].corner), std::end(specimen_.edges[feature].corner));
  } else {
    own.push_back(feature);
  }
  const double near = kMostOffSurface_eps * tick.rounding + deviation_;
  const auto is_on = [&](std::uint32_t n) {
    const NodeShape& node = specimen_.nodes[n];
    if (std::abs(in_front_of_node(n, tick.god_object)) > near) return false;
    for (std::uint32_t k = 0; k < node.side_count; ++k) {
      const Rim& rim = specimen_.rims[node.first_side + k];
      if (signed_distance(rim.normal, rim.offset, tick.god_object) > near) return false;
      if (std::find(own.begin(), own.end(), fdcg_get_side(&graph, n, k).corner) != own.end()) return false;
    }
    return true;
  };
  for (std::uint32_t n = 0; n < specimen_.nodes.size(); ++n) {
    if (is_on(n)) return true;
  }
  return false;
}

}  // namespace fdcg::test
