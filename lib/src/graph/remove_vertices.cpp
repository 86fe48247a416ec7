// SPDX-License-Identifier: Apache-2.0
#include "graph/remove_vertices.hpp"

#include <algorithm>
#include <span>

#include "base/vec3.hpp"
#include "exact/exact.hpp"
#include "exact/planes.hpp"

namespace fdcg::bake {

VertexRemover::VertexRemover(Mesh& mesh, Topology& topology, std::vector<EdgeClass>& edges, const Regions& regions,
                             const std::vector<Projection>& views, const MergeOptions& options)
    : mesh_(mesh), topology_(topology), edges_(edges), regions_(regions), views_(views), options_(options) {
  slot_of_.assign(mesh.points.size(), kNone);
  for (std::uint32_t slot = 0; slot < mesh.corners.size(); ++slot) {
    if (region(slot) != kNone) slot_of_[tail(slot)] = slot;
  }
  swallowed_ = LazyArray<NoneYet>(mesh.corners.size());
  next_swallowed_ = LazyArray<NoneYet>(mesh.points.size());
}

void VertexRemover::run() {
  remove_inner();
  remove_border();
}

// Small fans first, so that the fans of those that remain stay small.
void VertexRemover::remove_inner() {
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t v = 0; v < slot_of_.size(); ++v) {
    if (slot_of_[v] != kNone) waiting.push_back(v);
  }
  constexpr std::size_t kSmallFan = 8;
  for (std::size_t largest = kSmallFan; !waiting.empty(); largest *= 2) {
    std::size_t kept = 0;
    for (const std::uint32_t v : waiting) {
      if (try_inner(v, largest) == Outcome::later) waiting[kept++] = v;
    }
    waiting.resize(kept);
  }
}

// Works in rounds and never removes two neighbours in one round: a long straight border is halved in each round, so that the
// lists of removed vertices are checked a logarithmic number of times.
void VertexRemover::remove_border() {
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t v = 0; v < slot_of_.size(); ++v) {
    if (slot_of_[v] != kNone) waiting.push_back(v);
  }
  std::vector<std::uint32_t> touched(slot_of_.size(), 0);
  bool goes_on = true;
  for (std::uint32_t round = 1; goes_on; ++round) {
    goes_on = false;
    std::size_t kept = 0;
    for (const std::uint32_t v : waiting) {
      std::uint32_t left = kNone, right = kNone;
      const Outcome outcome = touched[v] == round ? Outcome::later : try_border(v, left, right);
      if (outcome == Outcome::removed) {
        touched[left] = touched[right] = round;
        goes_on = true;
      }
      if (outcome == Outcome::later) waiting[kept++] = v;
    }
    waiting.resize(kept);
  }
}

bool VertexRemover::read_fan(std::uint32_t vertex) {
  const std::uint32_t start = slot_of_[vertex];
  fan_.clear();
  std::uint32_t slot = start;
  do {
    fan_.push_back(slot);
    const HalfedgeId across = twin(previous(slot));
    if (across == Topology::kBoundary) {
      const auto behind = static_cast<std::ptrdiff_t>(fan_.size());
      for (HalfedgeId back = twin(start); back != Topology::kBoundary; back = twin(fan_.back()))
        fan_.push_back(next(+back));
      std::reverse(fan_.begin() + behind, fan_.end());
      std::rotate(fan_.begin(), fan_.begin() + behind, fan_.end());
      return false;
    }
    slot = +across;
  } while (slot != start);
  return true;
}

void VertexRemover::read_ring(Star& star, bool is_closed) const {
  star.ring.clear();
  star.ring_edges.clear();
  for (const std::uint32_t slot : star.out) {
    const std::uint32_t outer = next(slot);
    star.ring.push_back(head(slot));
    star.ring_edges.push_back({+twin(outer), edges_[outer], swallowed_[outer], false});
  }
  if (!is_closed) {
    star.ring.push_back(tail(previous(star.out.back())));
    star.ring_edges.push_back({+Topology::kBoundary, {}, kNone, true});
  }
}

bool VertexRemover::cut(Star& star, std::uint32_t vertex) {
  star.ears.clear();
  if (star.ring.size() == 2) {  // one degenerate triangle: the triangle behind it takes over its border edge
    const HalfedgeId behind{star.ring_edges.front().across};
    return behind != Topology::kBoundary && region(+behind) == region(star.out.front());
  }
  star.points.clear();
  for (const std::uint32_t v : star.ring)
    star.points.push_back(point(v));
  const Projection& projection = views_[region(star.out.front())];
  const std::span<const Ear> ears = cutter_.cut_star(projection, star.points, point(vertex));
  star.ears.assign(ears.begin(), ears.end());
  // Every edge of the result is a side of an ear.
  const Vec3& normal = regions_.list[region(star.out.front())].plane.normal;
  return !ears.empty() && std::all_of(ears.begin(), ears.end(), [&](const Ear& ear) {
    return runs_along(normal, star.points[ear[0]], star.points[ear[2]]) &&
           runs_along(normal, star.points[ear[0]], star.points[ear[1]]) &&
           runs_along(normal, star.points[ear[1]], star.points[ear[2]]);
  });
}

// Replaces the star's triangles by the ears. Returns the slot of the edge that closes the ring of a border vertex.
std::uint32_t VertexRemover::replace(Star& star) {
  const std::uint32_t r = region(star.out.front());
  const Region& home = regions_.list[r];
  const EdgeClass inner = home.is_exact ? EdgeClass{FDCG_COPLANAR, Flat::exact} : EdgeClass{FDCG_CONVEX, home.tier};
  std::uint32_t closing = kNone;
  if (star.ring.size() == 2) {
    closing = star.ring_edges.front().across;
    slot_of_[tail(closing)] = closing;
    slot_of_[head(closing)] = next(closing);
  }
  const auto close = [&](std::uint32_t ring_index, std::uint32_t slot) {
    const RingEdge& edge = star.ring_edges[ring_index];
    edges_[slot] = edge.edge;
    swallowed_.set(slot, edge.swallowed);
    topology_.twin[slot] = HalfedgeId{edge.across};
    if (edge.closes) closing = slot;
    if (HalfedgeId{edge.across} != Topology::kBoundary) topology_.twin[edge.across] = HalfedgeId{slot};
  };
  for (std::size_t i = 0; i < star.out.size(); ++i) {
    const std::uint32_t slot = star.out[i] / 3 * 3;
    if (i >= star.ears.size()) {
      std::fill_n(mesh_.corners.begin() + slot, 3, VertexId{kNone});
      continue;
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      mesh_.corners[slot + k] = VertexId{star.ring[star.ears[i][k]]};
      slot_of_[tail(slot + k)] = slot + k;
    }
    close(star.ears[i][0], slot);
    close(star.ears[i][1], slot + 1);
    if (i + 1 < star.ears.size()) {
      edges_[slot + 2] = inner;
      swallowed_.set(slot + 2, kNone);
      star.ring_edges[star.ears[i][0]] = {slot + 2, inner, kNone, false};
    } else {
      close(star.ears[i][2], slot + 2);
    }
  }
  return closing;
}

bool VertexRemover::goes_once_round(const Star& star, std::uint32_t vertex) const {
  const Projection& projection = views_[region(star.out.front())];
  const double height = projection.v(point(vertex));
  int rounds = 0;
  bool was_below = projection.v(point(star.ring.back())) < height;
  for (const std::uint32_t v : star.ring) {
    const bool is_below = projection.v(point(v)) < height;
    if (was_below && !is_below) ++rounds;
    was_below = is_below;
  }
  return rounds == 1;
}

VertexRemover::Outcome VertexRemover::try_inner(std::uint32_t vertex, std::size_t largest_fan) {
  if (!read_fan(vertex)) return Outcome::kept;
  const std::uint32_t r = region(fan_.front());
  if (r == kNone || !std::all_of(fan_.begin(), fan_.end(), [&](std::uint32_t slot) { return region(slot) == r; }))
    return Outcome::kept;
  if (fan_.size() > largest_fan) return Outcome::later;
  left_star_.out.assign(fan_.begin(), fan_.end());
  read_ring(left_star_, true);
  if (!goes_once_round(left_star_, vertex) || !cut(left_star_, vertex)) return Outcome::kept;
  replace(left_star_);
  slot_of_[vertex] = kNone;
  return Outcome::removed;
}

// Tries to remove a vertex on a straight border between one region and the open boundary or one other region. `later`: it is
// such a vertex but cannot be removed now.
VertexRemover::Outcome VertexRemover::try_border(std::uint32_t vertex, std::uint32_t& left, std::uint32_t& right) {
  const bool is_closed = read_fan(vertex);
  const std::size_t count = fan_.size();
  std::size_t changes = 0, begin = 0, end = count;
  const auto differ = [&](std::uint32_t a, std::uint32_t b) { return region(a) != region(b) || region(a) == kNone; };
  for (std::size_t i = is_closed ? 0 : 1; i < count; ++i) {
    if (differ(fan_[i > 0 ? i - 1 : count - 1], fan_[i])) (changes++ == 0 ? begin : end) = i;
  }
  if (changes != (is_closed ? 2u : 0u) || region(fan_[begin]) == kNone) return Outcome::kept;
  left_star_.out.assign(fan_.begin() + static_cast<std::ptrdiff_t>(begin), fan_.begin() + static_cast<std::ptrdiff_t>(end));
  right_star_.out.assign(fan_.begin() + static_cast<std::ptrdiff_t>(end), fan_.end());
  right_star_.out.insert(right_star_.out.end(), fan_.begin(), fan_.begin() + static_cast<std::ptrdiff_t>(begin));
  if (is_closed && region(right_star_.out.front()) == kNone) return Outcome::kept;
  const std::uint32_t edge_out = left_star_.out.front(), edge_in = previous(left_star_.out.back());
  if (edges_[edge_out].sign() != edges_[edge_in].sign()) return Outcome::later;

  left = head(edge_out);
  right = tail(edge_in);
  const std::uint32_t list_out = swallowed_[edge_out], list_in = swallowed_[edge_in];
  bool is_exact = false;
  if (!is_straight(left, vertex, right, list_in, list_out, is_exact)) return Outcome::later;
  const std::size_t thin = (left_star_.out.size() == 1 ? 1u : 0u) + (is_closed && right_star_.out.size() == 1 ? 1u : 0u);
  if (count_edges(left, right) != thin) return Outcome::later;
  read_ring(left_star_, false);
  if (!cut(left_star_, vertex)) return Outcome::later;
  if (is_closed) {
    read_ring(right_star_, false);
    if (!cut(right_star_, vertex)) return Outcome::later;
  }
  const EdgeClass border = edges_[edge_out];
  std::uint32_t list = join_lists(list_in, list_out);
  if (!is_exact) {
    next_swallowed_.set(vertex, list);
    list = vertex;
  }
  measure(left, right, list);
  const std::uint32_t left_slot = replace(left_star_);
  edges_[left_slot] = border;
  swallowed_.set(left_slot, list);
  topology_.twin[left_slot] = Topology::kBoundary;
  if (is_closed) {
    read_ring(right_star_, false);  // again: replacing the left star may have changed its neighbours
    const std::uint32_t right_slot = replace(right_star_);
    edges_[right_slot] = border;
    swallowed_.set(right_slot, list);
    topology_.twin[right_slot] = HalfedgeId{left_slot};
    topology_.twin[left_slot] = HalfedgeId{right_slot};
  }
  slot_of_[vertex] = kNone;
  return Outcome::removed;
}

std::size_t VertexRemover::count_edges(std::uint32_t from, std::uint32_t to) const {
  const std::uint32_t start = slot_of_[from];
  std::uint32_t slot = start;
  std::size_t count = 0;
  do {
    count += head(slot) == to ? 1 : 0;
    const HalfedgeId across = twin(previous(slot));
    if (across == Topology::kBoundary) {
      count += tail(previous(slot)) == to ? 1 : 0;
      for (HalfedgeId back = twin(start); back != Topology::kBoundary; back = twin(slot)) {
        slot = next(+back);
        count += head(slot) == to ? 1 : 0;
      }
      return count;
    }
    slot = +across;
  } while (slot != start);
  return count;
}

bool VertexRemover::is_near(const Vec3& from, const Vec3& to, const Vec3& x) const {
  const Vec3 edge = to - from, d = x - from;
  const Quantum& quantum = options_.quantum;
  const double reach = kQuantumReach * std::max({quantum.at(x), quantum.at(from), quantum.at(to)});
  const double along = dot(edge, d), squared = squared_length(edge);
  return along > 0 && along < squared && squared_length(cross(edge, d)) <= reach * reach * squared;
}

bool VertexRemover::all_near(const Vec3& from, const Vec3& to, std::uint32_t list) const {
  for (; list != kNone; list = next_swallowed_[list]) {
    if (!is_near(from, to, point(list))) return false;
  }
  return true;
}

void VertexRemover::measure(std::uint32_t from, std::uint32_t to, std::uint32_t list) {
  const Vec3 &a = point(from), edge = point(to) - a;
  for (; list != kNone; list = next_swallowed_[list])
    largest_distance_ = std::max(largest_distance_, length(cross(edge, point(list) - a)) / length(edge));
}

bool VertexRemover::is_straight(std::uint32_t from, std::uint32_t vertex, std::uint32_t to, std::uint32_t list_in,
                                std::uint32_t list_out, bool& is_exact) const {
  if (from == to) return false;
  const Vec3 &a = point(from), &v = point(vertex), &b = point(to);
  is_exact = exact::collinear(a, v, b) && exact::dot_sign(v, a, b) < 0;
  if (options_.coplanar.kind == Coplanar::Kind::exact) return is_exact;
  return (is_exact || is_near(a, b, v)) && all_near(a, b, list_in) && all_near(a, b, list_out);
}

std::uint32_t VertexRemover::join_lists(std::uint32_t a, std::uint32_t b) {
  if (a == kNone) return b;
  std::uint32_t last = a;
  while (next_swallowed_[last] != kNone)
    last = next_swallowed_[last];
  next_swallowed_.set(last, b);
  return a;
}

}  // namespace fdcg::bake
