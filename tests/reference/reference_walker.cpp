// SPDX-License-Identifier: Apache-2.0
// Over 400 lines: the whole contact model in one place, in its own order.
#include "reference_walker.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "step/contact_internals.hpp"

namespace fdcg::test {
namespace {

constexpr std::uint32_t kGuard = 1000000;     // far beyond any walk that makes progress
constexpr double kStickFactor = 1 - 0x1p-20;  // a slipping god-object sticks again below this part of the circle
constexpr double kLargestWedge = 1024;        // wedge load per distance from the edge
constexpr double kNearlyMet = 1e-4;           // of the extent: a face that a segment misses by more is not noted

template <class Real>
Real absolute(const Real& x) {
  return x < 0 ? Real(-x) : x;
}

constexpr double kCoarse = 1e-12;  // far beyond what coarse_side() is off, as a part of the lengths in it

template <class Real>
Vector<double> coarse(const Vector<Real>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

double coarse_side(const std::array<double, 4>& plane, const Vector<double>& x) {
  return plane[0] * x.x + plane[1] * x.y + plane[2] * x.z + plane[3];
}

}  // namespace

template <class Real>
void ReferenceWalker<Real>::note(const Real& distance) {
  step_.margin = std::min(step_.margin, static_cast<double>(absolute(distance)) / (surface_.extent * step_.amplification));
}

// A way of this length changes its distance to what it meets by this much.
template <class Real>
void ReferenceWalker<Real>::amplify(const Real& way, const Real& change) {
  if (change > 0) step_.amplification = std::max(step_.amplification, static_cast<double>(way / change));
}

template <class Real>
ReferenceStep ReferenceWalker<Real>::step(const std::array<double, 3>& hip_local) {
  step_ = {};
  hip_ = {Real(hip_local[0]), Real(hip_local[1]), Real(hip_local[2])};
  if (!contact.is_started) {
    contact = {};
    contact.is_started = true;
    contact.god_object = contact.hip = hip_;
    return step_;
  }
  if (contact.state == FDCG_FREE) contact.god_object = contact.hip;
  left_out_.clear();
  met_.clear();
  const Point offset = contact.god_object - hip_;
  met_[{contact.state, contact.feature}] = dot(offset, offset);
  step_.visited.emplace_back(contact.state, contact.feature);
  is_exact_place_ = std::numeric_limits<Real>::digits > 256;
  for (is_resting_ = false; !is_resting_;) {
    switch (contact.state) {
      case FDCG_FREE:
        step_free();
        break;
      case FDCG_FACE:
        step_face();
        break;
      case FDCG_EDGE:
        step_edge();
        break;
      default:
        step_vertex();
        break;
    }
    if (step_.transitions > kGuard) throw std::logic_error("the reference does not come to rest");
  }
  contact.hip = hip_;
  return step_;
}

template <class Real>
void ReferenceWalker<Real>::resynchronise(const fdcg_contact& other) {
  const auto point = [](const double* v) { return Point{Real(v[0]), Real(v[1]), Real(v[2])}; };
  contact.god_object = point(other.god_object);
  contact.hip = other.state == FDCG_FREE ? contact.god_object : point(other.hip);
  contact.is_started = other.started != 0;
  contact.state = other.state;
  contact.feature = other.feature;
  contact.seat_state = internals_of(other).seat_state;
  contact.seat_feature = internals_of(other).seat_feature;
  contact.is_slipping = other.slipping != 0;
}

// ---- changes of state ------------------------------------------------------------------------------------------------------

template <class Real>
void ReferenceWalker<Real>::change(std::uint32_t state, std::uint32_t feature) {
  ++step_.transitions;
  step_.visited.emplace_back(state, feature);
  contact.state = state;
  contact.feature = feature;
  if (state == FDCG_FREE) return;
  const Point offset = contact.god_object - hip_;
  const Real distance2 = dot(offset, offset);
  const auto [it, is_new] = met_.try_emplace({state, feature}, distance2);
  if (is_new) return;
  if (distance2 >= it->second) {
    step_.met_again = true;
    step_.margin = 0;
    rest();
  }
  it->second = distance2;
}

template <class Real>
void ReferenceWalker<Real>::release(std::vector<std::uint32_t> left_out_faces) {
  left_out_ = std::move(left_out_faces);
  if (contact.state != FDCG_VERTEX) is_exact_place_ = false;  // the runtime starts a rounding in front of what it leaves
  change(FDCG_FREE, FDCG_NONE);
}

template <class Real>
void ReferenceWalker<Real>::seat(std::uint32_t state, std::uint32_t feature) {
  contact.seat_state = state;
  contact.seat_feature = state == FDCG_FREE ? FDCG_NONE : feature;
}

// ---- free space ------------------------------------------------------------------------------------------------------------

template <class Real>
void ReferenceWalker<Real>::step_free() {
  const std::optional<Hit> hit = sweep(contact.god_object, hip_);
  left_out_.clear();
  if (!hit) {
    contact.god_object = hip_;
    contact.is_slipping = false;
    seat(FDCG_FREE, FDCG_NONE);
    rest();
    return;
  }
  if (hit->state != FDCG_VERTEX) amplify(length(hip_ - contact.god_object), hit->change);
  contact.god_object = hit->point;
  is_exact_place_ = is_exact_place_ && hit->state == FDCG_VERTEX;
  const bool is_seat = hit->state != FDCG_FACE;
  seat(is_seat ? hit->state : static_cast<std::uint32_t>(FDCG_FREE), hit->feature);
  change(hit->state, hit->feature);
}

template <class Real>
auto ReferenceWalker<Real>::sweep(const Point& from, const Point& to) -> std::optional<Hit> {
  std::optional<Hit> first, second;
  const Vector<double> coarse_from = coarse(from), coarse_to = coarse(to);
  const double far = surface_.extent * kNearlyMet + kCoarse * (length(coarse_from) + length(coarse_to) + surface_.extent);
  for (std::uint32_t f = 0; f < surface_.faces.size(); ++f) {
    const std::array<double, 4>& plane = surface_.coarse_planes[f];
    if (coarse_side(plane, coarse_from) < -far || coarse_side(plane, coarse_to) > far) continue;  // meet() would say so, slowly
    if (std::find(left_out_.begin(), left_out_.end(), f) != left_out_.end()) continue;
    std::optional<Hit> hit = meet(f, from, to);
    if (!hit) continue;
    const bool is_same = first && hit->state == first->state && hit->feature == first->feature;
    if (is_same) continue;
    if (first && hit->t >= first->t) {
      if (!second || hit->t < second->t) second = hit;
      continue;
    }
    second = std::exchange(first, hit);
  }
  if (first && second) note((second->t - first->t) * length(to - from));
  return first;
}

// How far a point lies beside a face, or 0 where it lies over it.
template <class Real>
Real ReferenceWalker<Real>::beside(std::uint32_t f, const Point& point) const {
  Real by = 0;
  for (const std::uint32_t c : surface_.faces[f].connections) {
    const Edge& edge = surface_.edges[c];
    by = std::max<Real>(by, edge.voronoi[edge.face[0] == f ? 0 : 1].side(point));
  }
  return by;
}

// The segment's entry into one face from its front, its border included.
template <class Real>
auto ReferenceWalker<Real>::meet(std::uint32_t f, const Point& from, const Point& to) -> std::optional<Hit> {
  const Face& face = surface_.faces[f];
  const Real side_from = face.plane.side(from), side_to = face.plane.side(to);
  Real missed_by = 0, met_by = std::min<Real>(absolute(side_from), absolute(side_to));
  bool is_met = true;
  const auto require = [&](bool holds, const Real& distance) {
    if (!holds) missed_by = std::max(missed_by, absolute(distance));
    met_by = std::min(met_by, absolute(distance));
    is_met = is_met && holds;
  };
  require(side_from >= 0, side_from);
  require(side_to < 0, side_to);
  if (missed_by > surface_.extent * kNearlyMet) return std::nullopt;  // neither met nor nearly so
  if (side_from < side_to) {  // along the face or out of it: its line would pass the sides the other way round
    note(std::max<Real>(missed_by, beside(f, from)));
    return std::nullopt;
  }
  const Point along = to - from;
  const Real along_length = length(along);
  const std::size_t n = face.corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Point &v0 = surface_.corners[face.corners[k]].point, &v1 = surface_.corners[face.corners[(k + 1) % n]].point;
    const Real volume = dot(along, cross(v1 - from, v0 - from));  // >= 0 on the inner side of v0 -> v1
    require(volume >= 0,
            along_length > 0 ? Real(volume / (along_length * surface_.edges[face.connections[k]].length)) : Real(0));
  }
  if (!is_exact_place_ || !face.is_exact) note(is_met ? met_by : missed_by);
  if (!is_met) return std::nullopt;
  return located(face, f, side_from, side_to, from, to);
}

// What of the face the segment meets: a corner or an edge when it does so exactly.
template <class Real>
auto ReferenceWalker<Real>::located(const Face& face, std::uint32_t f, const Real& side_from, const Real& side_to,
                                    const Point& from, const Point& to) -> Hit {
  const Real change = side_from - side_to, t = side_from / change;
  const Point along = to - from;
  for (const std::uint32_t v : face.corners) {
    const Point& corner = surface_.corners[v].point;
    const Point off = cross(along, corner - from);
    if (dot(off, off) == 0) return {t, change, FDCG_VERTEX, v, corner};
  }
  const Point point = from + along * t;
  for (const std::uint32_t c : face.connections) {
    const Edge& edge = surface_.edges[c];
    const Point& v0 = surface_.corners[edge.corner[0]].point;
    if (dot(along, cross(edge.span, v0 - from)) != 0) continue;
    const Real u = dot(point - v0, edge.direction);
    // Whether a place this near an end is the corner the model leaves open for a sweep.
    const Real tolerance = 8 * surface_.epsilon * (length(v0) + 2 * edge.length);
    if (u <= tolerance || edge.length - u <= tolerance) note(Real(0));
    if (u > 0 && u < edge.length) return {t, change, FDCG_EDGE, c, v0 + edge.direction * u};
  }
  return {t, change, FDCG_FACE, f, point};
}

// ---- face ------------------------------------------------------------------------------------------------------------------

template <class Real>
void ReferenceWalker<Real>::step_face() {
  const std::uint32_t f = contact.feature;
  const Face& face = surface_.faces[f];
  const Real side = face.plane.side(hip_);
  note(side);
  if (side >= 0) {
    if (contact.seat_state == FDCG_FREE) {
      release({f});
    } else {
      change(contact.seat_state, contact.seat_feature);
    }
    return;
  }
  const Real depth = -side;
  const Point surface_point = hip_ + face.normal * depth;
  Point q = contact.god_object - surface_point;
  q = q - face.normal * dot(face.normal, q);
  const Real r = length(q);
  if (decide_friction(r, depth, Real(0)) == Friction::rests) {
    rest();
    return;
  }
  move_on_face(face, surface_point + q * Real(friction_.mu_dynamic * depth / r));
}

// contact-model FRIC-1 to FRIC-5: whether the god-object, r away from the surface point under a load, stays where it is. Keeps
// the slip flag. load_error: how much the load may be off for one unit of rounding.
template <class Real>
auto ReferenceWalker<Real>::decide_friction(const Real& r, const Real& load, const Real& load_error) -> Friction {
  const Real static_limit = friction_.mu_static * load, dynamic_limit = friction_.mu_dynamic * load;
  const Real doubt = 1 + friction_.mu_static * (1 + load_error);
  if (!contact.is_slipping) {
    note((r - static_limit) / doubt);
    if (r <= static_limit) return Friction::rests;
    contact.is_slipping = true;
    return Friction::moves;
  }
  const Real stick_limit = kStickFactor * dynamic_limit;
  note((r - stick_limit) / doubt);
  if (r <= stick_limit) {
    contact.is_slipping = false;
    return Friction::rests;
  }
  return r <= dynamic_limit ? Friction::rests : Friction::moves;
}

template <class Real>
void ReferenceWalker<Real>::move_on_face(const Face& face, const Point& target) {
  const Point from = contact.god_object;
  const Real distance = length(target - from);
  std::optional<Real> first;
  Real change = 0;
  std::uint32_t crossed = FDCG_NONE;
  for (const std::uint32_t c : face.connections) {
    const Edge& edge = surface_.edges[c];
    const ReferencePlane<Real>& plane = edge.voronoi[&surface_.faces[edge.face[0]] == &face ? 0 : 1];
    const Real s0 = plane.side(from), s1 = plane.side(target);
    note(s1);
    if (!(s1 >= 0 && s1 > s0)) continue;
    const Real t = std::max<Real>(Real(0), -s0 / (s1 - s0));
    if (first) note((t - *first) * distance);
    if (!first || t < *first) {
      first = t;
      change = s1 - s0;
      crossed = c;
    }
  }
  if (!first) {
    contact.god_object = target;
    is_exact_place_ = false;
    seat(FDCG_FREE, FDCG_NONE);
    rest();
    return;
  }
  amplify(distance, change);
  const Edge& edge = surface_.edges[crossed];
  const Point landing = from + (target - from) * *first;
  place_on_edge(crossed, dot(landing - surface_.corners[edge.corner[0]].point, edge.direction));
}

// Puts the god-object on an edge, clamped to it; on a corner if it is as near as rounding lets one tell.
template <class Real>
void ReferenceWalker<Real>::place_on_edge(std::uint32_t c, const Real& along) {
  const Edge& edge = surface_.edges[c];
  const Real from_end[2] = {along, edge.length - along};
  const std::size_t nearer = from_end[0] <= from_end[1] ? 0 : 1;
  const Point& corner = surface_.corners[edge.corner[nearer]].point;
  const Real tolerance = 8 * surface_.epsilon * (length(corner) + edge.length);
  note(from_end[nearer] - tolerance);
  if (from_end[nearer] <= tolerance) {
    contact.god_object = corner;
    is_exact_place_ = std::numeric_limits<Real>::digits > 256;
    seat(FDCG_VERTEX, edge.corner[nearer]);
    change(FDCG_VERTEX, edge.corner[nearer]);
    return;
  }
  contact.god_object = surface_.corners[edge.corner[0]].point + edge.direction * along;
  is_exact_place_ = false;
  seat(FDCG_EDGE, c);
  if (contact.state == FDCG_EDGE) {
    rest();  // moved along it: r = R
  } else {
    change(FDCG_EDGE, c);
  }
}

// ---- edge ------------------------------------------------------------------------------------------------------------------

template <class Real>
void ReferenceWalker<Real>::step_edge() {
  const std::uint32_t c = contact.feature;
  const Edge& edge = surface_.edges[c];
  const bool is_open = edge.face[1] == FDCG_NONE;
  Real side[2] = {0, 0}, s[2] = {0, 0};
  bool is_candidate[2] = {false, false};
  for (std::size_t k = 0; k < (is_open ? 1 : 2); ++k) {
    side[k] = surface_.faces[edge.face[k]].plane.side(hip_);
    s[k] = edge.voronoi[k].side(hip_);
    note(side[k]);
    note(s[k]);
    is_candidate[k] = side[k] < 0 && s[k] < 0;
  }
  if (is_open) {
    if (is_candidate[0]) {
      change(FDCG_FACE, edge.face[0]);
    } else {
      release({edge.face[0]});
    }
    return;
  }
  const bool is_clear = edge.type == FDCG_CONCAVE ? side[0] >= 0 && side[1] >= 0 : side[0] >= 0 || side[1] >= 0;
  if (is_clear) {
    release({edge.face[0], edge.face[1]});
    return;
  }
  if (is_candidate[0] && is_candidate[1]) note(s[0] - s[1]);
  if (is_candidate[0] || is_candidate[1]) {
    const bool takes_first = is_candidate[0] && (!is_candidate[1] || s[0] <= s[1]);
    change(FDCG_FACE, edge.face[takes_first ? 0 : 1]);
    return;
  }
  const Point& v0 = surface_.corners[edge.corner[0]].point;
  const Real foot = dot(hip_ - v0, edge.direction);
  const Real here = dot(contact.god_object - v0, edge.direction);
  const Point from_line = hip_ - (v0 + edge.direction * foot);
  Real load_error = 0;
  bool is_fold = false;
  const Real load = edge_load(edge, from_line, load_error, is_fold);
  const Real r = absolute<Real>(here - foot);
  if (is_fold || decide_friction(r, load, load_error) == Friction::rests) {
    rest();
    return;
  }
  const Real reach = friction_.mu_dynamic * load;
  place_on_edge(c, here > foot ? Real(foot + reach) : Real(foot - reach));
}

template <class Real>
Real ReferenceWalker<Real>::edge_load(const Edge& edge, const Point& from_line, Real& load_error, bool& is_fold) const {
  const Real h = length(from_line);
  if (!friction_.is_wedge) return h;
  const Point sum = surface_.faces[edge.face[0]].normal + surface_.faces[edge.face[1]].normal;
  const Real square = dot(sum, sum);
  is_fold = square == 0;
  if (is_fold) return Real(0);
  load_error = 2 / length(sum);
  const Real load = -2 * dot(sum, from_line) / square;
  return std::clamp<Real>(load, Real(0), kLargestWedge * h);
}

// ---- vertex ----------------------------------------------------------------------------------------------------------------

template <class Real>
void ReferenceWalker<Real>::step_vertex() {
  const Corner& corner = surface_.corners[contact.feature];
  const Point t = hip_ - corner.point;
  struct Choice {
    Real climb{0};
    std::uint32_t state = FDCG_VERTEX, feature = FDCG_NONE;
  };
  Choice best, second;
  const auto offer = [&](const Choice& choice) {
    if (choice.climb > best.climb) {
      second = std::exchange(best, choice);
    } else if (choice.climb > second.climb) {
      second = choice;
    }
  };
  for (const std::uint32_t c : corner.connections) {
    const Edge& edge = surface_.edges[c];
    const Real along = dot(t, edge.direction);
    offer({edge.corner[0] == contact.feature ? along : Real(-along), FDCG_EDGE, c});
  }
  std::vector<std::pair<Real, Real>> outside;  // climbs of projections that fall outside their sector, and by how much
  for (const std::uint32_t f : corner.faces) {
    const Face& face = surface_.faces[f];
    Real s_worst = -surface_.extent;
    for (const std::uint32_t c : face.connections) {
      const Edge& edge = surface_.edges[c];
      if (edge.corner[0] != contact.feature && edge.corner[1] != contact.feature) continue;
      s_worst = std::max(s_worst, edge.voronoi[edge.face[0] == f ? 0 : 1].side(hip_));
    }
    const Real climb = length(t - face.normal * dot(t, face.normal));
    if (s_worst < 0) {
      offer({climb, FDCG_FACE, f});
    } else {
      outside.emplace_back(climb, s_worst);
    }
  }
  for (const auto& [climb, by] : outside) {
    if (climb > best.climb) note(by);
  }
  note(best.climb - second.climb);

  const auto side = [&](std::uint32_t f) { return surface_.faces[f].plane.side(hip_); };
  bool is_clear = false;
  if (best.state == FDCG_FACE) {
    note(side(best.feature));
    is_clear = side(best.feature) >= 0;
  } else if (best.state == FDCG_EDGE) {
    const Edge& edge = surface_.edges[best.feature];
    if (edge.face[1] == FDCG_NONE) {
      const Real side_a = side(edge.face[0]), s_a = edge.voronoi[0].side(hip_);
      note(side_a);
      note(s_a);
      is_clear = !(side_a < 0 && s_a < 0);
      best.state = FDCG_FACE;
      best.feature = edge.face[0];
    } else {
      const Real sum = side(edge.face[0]) + side(edge.face[1]);
      note(sum);
      is_clear = sum >= 0;
    }
  } else {
    // The file keeps the corner's normal as float: a sign within its rounding is nobody's fault.
    const Real height = dot(t, corner.normal), doubt = length(t) * 0x1p-22;
    note(std::max<Real>(Real(0), absolute(height) - doubt));
    is_clear = corner.is_open || height >= 0;
  }
  if (is_clear) {
    release(corner.faces);
  } else if (best.state == FDCG_VERTEX) {
    rest();
  } else {
    change(best.state, best.feature);
  }
}

std::string describe(const ReferenceStep& step) {
  static const char* const names[] = {"free", "face", "edge", "vertex"};
  constexpr std::size_t kShown = 12;
  std::ostringstream text;
  for (std::size_t i = 0; i < step.visited.size(); ++i) {
    const bool is_shown = i < kShown || i + kShown >= step.visited.size();
    if (i == kShown && !is_shown) text << "... (" << step.visited.size() << " in all); ";
    if (!is_shown) continue;
    text << names[step.visited[i].first];
    if (step.visited[i].second != FDCG_NONE) text << ' ' << step.visited[i].second;
    text << "; ";
  }
  text << "margin " << step.margin << ", amplification " << step.amplification
       << (step.met_again ? ", ended by meeting a feature again" : "");
  return text.str();
}

template class ReferenceWalker<long double>;
template class ReferenceWalker<Mpfr256>;
template class ReferenceWalker<HighPrecision>;

}  // namespace fdcg::test
