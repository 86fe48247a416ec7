// SPDX-License-Identifier: Apache-2.0
#include "deform/deform_upkeep.hpp"

#include "base/config.hpp"
#include "base/work.hpp"

namespace fdcg {

template <class Real>
bool Upkeep<Real>::is_line(uint32_t n) const {
  const fdcg_side* const sides = node(n).sides;
  return fdcg::is_line<Real>(widen(point(sides[0].corner)), widen(point(sides[1].corner)), widen(point(sides[2].corner)),
                             d_->header.extent);
}

template <class Real>
void Upkeep<Real>::compute_node(uint32_t n) const {
  Node& here = node(n);
  spend(&d_->upkeep_left, kRenewedNodeWork);
  const Vec3<double> a = widen(point(here.sides[0].corner)), b = widen(point(here.sides[1].corner)),
                     c = widen(point(here.sides[2].corner));
  if (__builtin_expect(fdcg::is_line<Real>(a, b, c, d_->header.extent), false)) {
    compute_sliver(n);
    return;
  }
  Vec3<double> unit;
  if (__builtin_expect(!quick_normal_of(a, b, c, &unit, Real{}), false)) unit = unit_normal_of(a, b, c);
  const Plane<Real> plane = plane_with_normal<Real>(unit, a, b, c);
  here.plane = {{plane.normal.x, plane.normal.y, plane.normal.z}, plane.offset};
  here.flags = 0;
  for (const fdcg_side& side : here.sides)
    place(side.corner).is_marked = 0;
  d_->stale[n / FDCG_LEAF_NODES] = static_cast<uint8_t>(d_->stale[n / FDCG_LEAF_NODES] & ~(1u << n % FDCG_LEAF_NODES));
}

template <class Real>
uint32_t Upkeep<Real>::longest_side(uint32_t n, uint32_t sides) const {
  uint32_t longest = FDCG_NONE;
  double length2 = -1;
  for (uint32_t k = 0; k < 3; ++k) {
    const Vec3<double> along = widen(point(node(n).sides[(k + 1) % 3].corner)) - widen(point(node(n).sides[k].corner));
    if ((sides >> k & 1) == 0 || !(dot(along, along) > length2)) continue;
    longest = k;
    length2 = dot(along, along);
  }
  return longest;
}

// Across the longest side that has a neighbour; where that is a sliver too, on through it.
template <class Real>
typename Upkeep<Real>::Lender Upkeep<Real>::plane_lender(uint32_t n) const {
  uint32_t from = FDCG_NONE;
  for (int hop = 0; hop < kMostHops; ++hop) {
    uint32_t sides = 0;
    for (uint32_t k = 0; k < 3; ++k)
      sides |= uint32_t{k != from && node(n).sides[k].across != FDCG_NONE} << k;
    const uint32_t k = longest_side(n, sides);
    if (k == FDCG_NONE) break;
    const uint32_t across = node(n).sides[k].across;
    from = side_across(n, k);
    n = across;
    if (!is_line(n)) return {n, from};
  }
  return {FDCG_NONE, 0};
}

// It stays stale, since it depends on its neighbour's corners too. If no neighbour has a plane it gets one through its line,
// which has no exact side.
template <class Real>
void Upkeep<Real>::compute_sliver(uint32_t n) const {
  Node& here = node(n);
  const Lender lender = plane_lender(n);
  if (lender.node != FDCG_NONE) {
    if ((d_->stale[lender.node / FDCG_LEAF_NODES] >> lender.node % FDCG_LEAF_NODES & 1) != 0) compute_node(lender.node);
    here.plane = node(lender.node).plane;
    here.flags = kSliver;
    return;
  }
  const uint32_t k = longest_side(n);
  const Vec3<double> start = widen(point(here.sides[k].corner));
  const Vec3<double> along = widen(point(here.sides[(k + 1) % 3].corner)) - start;
  const Vec3<double> most_across = absolute(along.x) <= absolute(along.y) && absolute(along.x) <= absolute(along.z)
                                       ? Vec3<double>{1, 0, 0}
                                   : absolute(along.y) <= absolute(along.z) ? Vec3<double>{0, 1, 0}
                                                                            : Vec3<double>{0, 0, 1};
  const Vec3<double> across = cross(along, most_across);
  const Vec3<double> normal = largest_of(across) > 0 ? unit_of(across) : Vec3<double>{0, 0, 1};
  const Plane<Real> plane = plane_with_normal<Real>(normal, start, start, start + along);
  here.plane = {{plane.normal.x, plane.normal.y, plane.normal.z}, plane.offset};
  here.flags = kSliver | FDCG_NODE_INEXACT;
}

template <class Real>
uint32_t Upkeep<Real>::apex(uint32_t n, uint32_t k) const {
  if (__builtin_expect(is_sliver(n), false)) {
    const Lender lender = plane_lender(n);
    if (lender.node != FDCG_NONE) n = lender.node, k = lender.side;
  }
  return node(n).sides[k == 0 ? 2 : k - 1].corner;
}

// Two faces that lie on one another exactly keep the type that the edge had: a knife or a slit, which their corners do not
// distinguish.
template <class Real>
uint8_t Upkeep<Real>::type(uint32_t connection) const {
  fdcg_connection& record = d_->connections[connection];
  const uint32_t a = record.node, k = record.side[0], b = node(a).sides[k].across;
  if (b == FDCG_NONE) return FDCG_BOUNDARY;
  const uint32_t left = apex(a, k), right = apex(b, record.side[1]);
  const Vec3<double> v0 = widen(point(node(a).sides[k].corner)), v1 = widen(point(node(a).sides[(k + 1) % 3].corner));
  const int sign = left == right ? 0 : orient3d_sign(v0, v1, widen(point(left)), widen(point(right)));
  if (sign == 0) {
    bring_up_to_date(a);
    bring_up_to_date(b);
    if (dot(vec(node(a).plane.normal), vec(node(b).plane.normal)) < 0) return record.type;
  }
  record.type = sign < 0 ? FDCG_CONVEX : sign > 0 ? FDCG_CONCAVE : FDCG_COPLANAR;
  record.flatness = FDCG_FLAT_EXACT;
  return record.type;
}

// The direction in which side k leaves its corner.
template <class Real>
Vec3<double> Upkeep<Real>::leaving(uint32_t n, uint32_t k) const {
  const fdcg_side* const sides = node(n).sides;
  const Vec3<Real> here = point(sides[k].corner), there = point(sides[(k + 1) % 3].corner);
  const bool runs_along = (sides[k].link & 1) == 0;
  const Vec3<double> e = widen((runs_along ? derive_edge_or_point(here, there) : derive_edge_or_point(there, here)).direction);
  return runs_along ? e : Vec3<double>{-e.x, -e.y, -e.z};
}

// The angle-weighted sum of the faces' normals, as fdcg compile adds it up.
template <class Real>
void Upkeep<Real>::bring_normal_up_to_date(uint32_t c) const {
  Corner& record = corner(c);
  const bool is_busy = (record.fan & ~FDCG_CORNER_OPEN) == 0, is_open = (record.fan & FDCG_CORNER_OPEN) != 0;
  uint32_t n = record.first, k = record.side, entries = record.fan & ~FDCG_CORNER_OPEN;
  if (is_busy) {
    const fdcg_busy_corner& busy = d_->graph.busy_corners[record.first];
    const uint32_t link = d_->graph.fans[busy.first_fan], which = link & 1;
    const fdcg_connection& first = d_->connections[link >> 1];
    n = which == 0 ? first.node : node(first.node).sides[first.side[0]].across;
    k = first.side[which];
    entries = busy.fan_count;
  }
  Vec3<double> sum = {0, 0, 0};
  for (uint32_t faces = entries - (is_open ? 1 : 0); faces > 0 && n != FDCG_NONE; --faces) {
    const uint32_t incoming = k == 0 ? 2 : k - 1;
    const Vec3<double> in = leaving(n, incoming), back = {-in.x, -in.y, -in.z};
    bring_up_to_date(n);
    sum = sum + widen(vec(node(n).plane.normal)) * angle_of(leaving(n, k), back);
    k = side_across(n, incoming);
    n = node(n).sides[incoming].across;
  }
  const Vec3<double> unit = unit_of(sum);
  record.normal[0] = static_cast<int16_t>(whole_below(FDCG_NORMAL_SCALE * unit.x + 0.5));
  record.normal[1] = static_cast<int16_t>(whole_below(FDCG_NORMAL_SCALE * unit.y + 0.5));
  record.normal[2] = static_cast<int16_t>(whole_below(FDCG_NORMAL_SCALE * unit.z + 0.5));
}

// What a leaf's box must hold: its corners, and where those of the tick at hand or to come have been. Such a box may shrink
// later.
template <class Real>
TreeBox Upkeep<Real>::leaf_box(uint32_t leaf, bool* may_shrink) const {
  TreeBox box = TreeBox::none();
  const uint32_t first = leaf * FDCG_LEAF_NODES, left = d_->header.node_count - first;
  const uint32_t count = left < FDCG_LEAF_NODES ? left : FDCG_LEAF_NODES;
  *may_shrink = false;
  for (uint32_t n = first; n < first + count; ++n) {
    for (const fdcg_side& side : node(n).sides) {
      box.add(TreeBox::of(in_tree(point(side.corner))));
      Place<Real>& here = place(side.corner);
      here.is_marked = 0;
      if (here.tick - d_->tick > 1) continue;  // neither the present tick nor the next
      box.add(TreeBox::of(in_tree(vec(was(here).point))));
      *may_shrink = true;
    }
  }
  return box;
}

// The boxes that are due anew, from what is below; the others as they are, but on a grid that has become much too large.
template <class Real>
void Upkeep<Real>::make_tight(int level, uint32_t index, uint32_t due) const {
  const BoxTree& tree = d_->tree;
  fdcg_box8& record = d_->boxes[tree.first[level] + index];
  uint8_t& loose = d_->loose[tree.first[level] + index];
  const uint32_t lanes = tree.lanes(level, index);
  uint32_t still_loose = 0;
  for (uint32_t left = due; left != 0; left &= left - 1) {
    const auto j = static_cast<uint32_t>(__builtin_ctz(left));
    const uint32_t below = index * FDCG_TREE_WAYS + j;
    bool may_shrink = false;
    spend(&d_->upkeep_left, level == 0 ? kRenewedLeafWork : kRenewedBoxWork);
    (void)set_lane(&record, lanes, j,
                   level == 0 ? leaf_box(below, &may_shrink)
                              : around(d_->boxes[tree.first[level - 1] + below], tree.lanes(level - 1, below)));
    still_loose |= uint32_t{may_shrink} << j;
  }
  loose = static_cast<uint8_t>((loose & ~due) | still_loose);
  const bool has_new_grid = has_finer_grid(&record, lanes);
  if (level + 1 == tree.levels) return;
  if (has_new_grid) hold(level + 1, index, around(record, lanes));  // rounded outwards on other places
  d_->loose[tree.first[level + 1] + index / FDCG_TREE_WAYS] |= static_cast<uint8_t>(1u << index % FDCG_TREE_WAYS);
}

template <class Real>
void Upkeep<Real>::mark(uint32_t c, Vec3<double> way) const {
  constexpr double kWaysAhead = 32, kMostRoom = 0.5;  // of the box
  const Vec3<double> at = in_tree(point(c));
  const double ahead[3] = {kWaysAhead * absolute(way.x), kWaysAhead * absolute(way.y), kWaysAhead * absolute(way.z)};
  Place<Real>& own = place(c);
  TreeBox shared = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
  const uint32_t* const end = d_->leaves + d_->leaf_first[c + 1];
  for (const uint32_t* entry = d_->leaves + d_->leaf_first[c]; entry < end; ++entry) {
    const uint32_t leaf = *entry >> FDCG_LEAF_NODES;
    d_->stale[leaf] = static_cast<uint8_t>(d_->stale[leaf] | (*entry & ((1u << FDCG_LEAF_NODES) - 1)));
    const fdcg_box8& record = d_->boxes[d_->tree.first[0] + leaf / FDCG_TREE_WAYS];
    TreeBox added = TreeBox::of(at);
    if (!holds_point(record, leaf % FDCG_TREE_WAYS, at)) {
      const TreeBox lane = lane_of(record, leaf % FDCG_TREE_WAYS);
      double size = 0;
      for (int k = 0; k < 3; ++k)
        size = greater_of(size, lane.high[k] - lane.low[k]);
      for (int k = 0; k < 3; ++k) {  // across its way none: leaves that lie side by side would come to overlap
        const double room = lesser_of(ahead[k], kMostRoom * size);
        added.low[k] -= room;
        added.high[k] += room;
      }
    }
    hold(0, leaf, added);
    const TreeBox lane = lane_of(record, leaf % FDCG_TREE_WAYS);
    d_->watched.give_up(lane, d_->per_tree_unit);
    for (int k = 0; k < 3; ++k) {
      shared.low[k] = greater_of(shared.low[k], lane.low[k]);
      shared.high[k] = lesser_of(shared.high[k], lane.high[k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    own.low[k] = float_above(shared.low[k]);
    own.high[k] = -float_above(-shared.high[k]);
  }
  own.is_marked = 1;
}

// Up to the first box that is loose already and holds the new part: the boxes around it are and do too.
template <class Real>
void Upkeep<Real>::hold(int first_level, uint32_t first_index, const TreeBox& added) const {
  const BoxTree& tree = d_->tree;
  TreeBox box = added;
  uint32_t index = first_index;
  for (int level = first_level; level < tree.levels; ++level, index /= FDCG_TREE_WAYS) {
    const uint32_t at = tree.first[level] + index / FDCG_TREE_WAYS, j = index % FDCG_TREE_WAYS;
    const bool was_loose = (d_->loose[at] >> j & 1) != 0;
    d_->loose[at] = static_cast<uint8_t>(d_->loose[at] | 1u << j);
    fdcg_box8& record = d_->boxes[at];
    TreeBox lane = lane_of(record, j);
    const bool holds = lane.holds(box);
    if (holds && was_loose) return;
    if (holds) continue;
    const uint32_t lanes = tree.lanes(level, index / FDCG_TREE_WAYS);
    lane.add(box);
    const bool has_new_grid = set_lane(&record, lanes, j, lane);
    box = has_new_grid ? around(record, lanes) : lane_of(record, j);
  }
}

#if FDCG_WITH_F64
template class Upkeep<double>;
#endif
#if FDCG_WITH_F32
template class Upkeep<float>;
#endif

}  // namespace fdcg
