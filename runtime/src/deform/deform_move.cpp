// SPDX-License-Identifier: Apache-2.0
// Moving a deformable mesh's corners, and finding them. A move writes the new place, and marks what depends on it: nothing is
// computed here.
#include "base/config.hpp"
#include "base/message.hpp"
#include "deform/deform_upkeep.hpp"
#include "step/near_zero.hpp"

namespace fdcg {
namespace {

// The index of the move that is refused; FDCG_NONE: there is only one.
Message& say_which(Message& message, uint64_t move) {
  if (move != FDCG_NONE) message.say("move ", move, ": ");
  return message;
}

inline bool is_finite(double x) {
  return absolute(x) <= DBL_MAX;
}

// Of a place that is not finite, or, for a corner that is to be moved, outside. `corner`: FDCG_NONE where one is looked for.
[[gnu::cold, gnu::noinline]] fdcg_status refuse_place(const fdcg_deform& deform, uint64_t move, uint32_t corner,
                                                      const double position_m[3], fdcg_error* error) {
  const fdcg_header& header = deform.header;
  if (position_m == nullptr) return Message(error, FDCG_E_ARGUMENT).text("position: null pointer");
  Message message(error, FDCG_E_ARGUMENT);
  say_which(message, move);
  if (corner != FDCG_NONE) message.say("corner ", corner, ": ");
  message.text("position ");
  for (int k = 0; k < 3; ++k) {
    if (is_finite(position_m[k])) continue;
    message.say(k, " is ", position_m[k]);
    return message.text(" m; it must be finite: look at where it was computed");
  }
  for (int k = 0; k < 3; ++k) {
    const double low = (deform.low[k] + header.origin[k]) * header.metres_per_unit;
    const double high = (deform.high[k] + header.origin[k]) * header.metres_per_unit;
    if (position_m[k] >= low && position_m[k] <= high) continue;
    message.say(k, " is ", position_m[k], " m, allowed ", low, " to ");
    return message.say(high, "; create the deformable mesh with a larger margin_m");
  }
  return message.text("is at the very end of what the margin_m allows");
}

[[gnu::cold, gnu::noinline]] fdcg_status refuse_corner(const fdcg_deform& deform, uint64_t move, uint32_t corner,
                                                       fdcg_error* error) {
  Message message(error, FDCG_E_ARGUMENT);
  return say_which(message, move)
      .say("corner is ", corner, ", the mesh has ", deform.header.corner_count, "; fdcg_deform_find gives a vertex's corner");
}

// In the graph's frame; what the step takes for zero is zero here too. False for what is no number or outside.
[[gnu::always_inline]] inline bool to_local(const fdcg_deform& deform, const double position_m[3], Vec3<double>* local) {
  const fdcg_header& header = deform.header;
  Vec3<double> p = {position_m[0], position_m[1], position_m[2]};
  if (header.metres_per_unit != 1)
    p = {p.x / header.metres_per_unit, p.y / header.metres_per_unit, p.z / header.metres_per_unit};
  p = p - vec(header.origin);
  const int is_inside = static_cast<int>(p.x >= deform.low[0]) & static_cast<int>(p.x <= deform.high[0]) &
                        static_cast<int>(p.y >= deform.low[1]) & static_cast<int>(p.y <= deform.high[1]) &
                        static_cast<int>(p.z >= deform.low[2]) & static_cast<int>(p.z <= deform.high[2]);
  const double least = kLeastShare * header.extent;
  *local = {zero_below(least, p.x), zero_below(least, p.y), zero_below(least, p.z)};
  return is_inside != 0;
}

// A corner's place in the graph's numbers, rounded so that it is no further out than the one given.
template <class Real>
inline Vec3<Real> rounded_to(Vec3<double> p) {
  return {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)};
}

template <class Real>
[[gnu::always_inline]] inline void move(fdcg_deform* deform, uint32_t c, Vec3<double> local) {
  const Upkeep<Real> upkeep(*deform);
  const Vec3<Real> to = rounded_to<Real>(local), from = upkeep.point(c);
  if (to.x == from.x && to.y == from.y && to.z == from.z) return;
  Place<Real>& place = upkeep.place(c);
  const uint64_t coming = deform->tick + 1;
  Vec3<Real> old = from;
  if (place.tick != coming) {
    place.tick = coming;
    place.logged = deform->has_moved++;
    store(from, upkeep.was(place).point);
  } else {
    old = vec(upkeep.was(place).point);
  }
  store(to, place.point);
  const Vec3<double> way = widen(to) - widen(old);
  const double way2 = dot(way, way);
  if (way2 > deform->way2) deform->way2 = way2;
  const Vec3<double> at = upkeep.in_tree(to);
  const int is_marked = static_cast<int>(place.is_marked != 0) & static_cast<int>(at.x >= double{place.low[0]}) &
                        static_cast<int>(at.x <= double{place.high[0]}) & static_cast<int>(at.y >= double{place.low[1]}) &
                        static_cast<int>(at.y <= double{place.high[1]}) & static_cast<int>(at.z >= double{place.low[2]}) &
                        static_cast<int>(at.z <= double{place.high[2]});
  if (__builtin_expect(is_marked == 0, false)) upkeep.mark(c, way * deform->per_tree_unit);
}

// `which` of several, or FDCG_NONE. One copy for all: in a loop of its own it took longer.
template <class Real>
[[gnu::noinline]] fdcg_status move_corner(fdcg_deform* deform, uint64_t which, uint32_t corner, const double position_m[3],
                                          fdcg_error* error) {
  Vec3<double> local;
  if (corner >= deform->header.corner_count) return refuse_corner(*deform, which, corner, error);
  if (position_m == nullptr || !to_local(*deform, position_m, &local))
    return refuse_place(*deform, which, corner, position_m, error);
  move<Real>(deform, corner, local);
  return FDCG_OK;
}

// The corner nearest to a place among the leaves whose boxes reach within `reach` of it.
template <class Real>
uint32_t find(const fdcg_deform& deform, Vec3<double> at, double reach) {
  const Upkeep<Real> upkeep(const_cast<fdcg_deform&>(deform));
  const BoxTree& tree = deform.tree;
  const Vec3<double> p = at * deform.per_tree_unit;
  const double off = reach * deform.per_tree_unit;
  const TreeBox near = {{p.x - off, p.y - off, p.z - off}, {p.x + off, p.y + off, p.z + off}};
  uint32_t nearest = FDCG_NONE;
  double nearest2 = reach * reach;
  struct Item {
    uint32_t index;
    int level;
  } stack[(FDCG_TREE_WAYS - 1) * kMostTreeLevels + 1];
  int waiting = 0;
  stack[waiting++] = {0, tree.levels - 1};
  while (waiting > 0) {
    const Item item = stack[--waiting];
    const fdcg_box8& record = deform.boxes[tree.first[item.level] + item.index];
    const uint32_t lanes = tree.lanes(item.level, item.index);
    for (uint32_t j = 0; lanes >> j != 0; ++j) {
      const TreeBox box = lane_of(record, j);
      int is_apart = 0;
      for (int k = 0; k < 3; ++k)
        is_apart |= (box.high[k] < near.low[k]) | (box.low[k] > near.high[k]);
      if (is_apart != 0) continue;
      const uint32_t below = item.index * FDCG_TREE_WAYS + j;
      if (item.level > 0) {
        stack[waiting++] = {below, item.level - 1};
        continue;
      }
      const uint32_t first = below * FDCG_LEAF_NODES, end = first + FDCG_LEAF_NODES;
      for (uint32_t n = first; n < end && n < deform.header.node_count; ++n) {
        for (const fdcg_side& side : upkeep.node(n).sides) {
          const Vec3<double> gap = widen(upkeep.point(side.corner)) - at;
          const double gap2 = dot(gap, gap);
          if (gap2 > nearest2 || (gap2 == nearest2 && side.corner >= nearest)) continue;
          nearest = side.corner;
          nearest2 = gap2;
        }
      }
    }
  }
  return nearest;
}

}  // namespace
}  // namespace fdcg

extern "C" fdcg_status fdcg_deform_move(fdcg_deform* deform, uint32_t corner, const double position_object_m[3],
                                        fdcg_error* error) {
  if (deform == nullptr || position_object_m == nullptr)
    return fdcg::Message(error, FDCG_E_ARGUMENT).text("deform or position: null pointer");
  return fdcg::with_real_of(deform->header, [&](auto real) {
    return fdcg::move_corner<decltype(real)>(deform, FDCG_NONE, corner, position_object_m, error);
  });
}

extern "C" fdcg_status fdcg_deform_move_corners(fdcg_deform* deform, const uint32_t* corners, const double* positions_object_m,
                                                uint64_t count, fdcg_error* error) {
  if (count == 0) return FDCG_OK;
  if (deform == nullptr || corners == nullptr || positions_object_m == nullptr)
    return fdcg::Message(error, FDCG_E_ARGUMENT).text("deform, corners or positions: null pointer");
  return fdcg::with_real_of(deform->header, [&](auto real) {
    using Place = fdcg::Place<decltype(real)>;
    constexpr uint64_t kAhead = 8;  // prefetch distance: scattered corners are in the cache when they are moved
    fdcg_status status = FDCG_OK;
    for (uint64_t i = 0; i < count && status == FDCG_OK; ++i) {
      if (i + kAhead < count && corners[i + kAhead] < deform->header.corner_count)
        __builtin_prefetch(static_cast<Place*>(deform->places) + corners[i + kAhead], 1);
      status = fdcg::move_corner<decltype(real)>(deform, i, corners[i], positions_object_m + 3 * i, error);
    }
    return status;
  });
}

extern "C" fdcg_status fdcg_deform_place(const fdcg_deform* deform, uint32_t corner, double position_object_m[3],
                                         fdcg_error* error) {
  using fdcg::widen;
  if (deform == nullptr || position_object_m == nullptr)
    return fdcg::Message(error, FDCG_E_ARGUMENT).text("deform or position: null pointer");
  if (corner >= deform->header.corner_count) return fdcg::refuse_corner(*deform, FDCG_NONE, corner, error);
  fdcg::with_real_of(deform->header, [&](auto real) {
    const fdcg::Upkeep<decltype(real)> upkeep(const_cast<fdcg_deform&>(*deform));
    const fdcg::Vec3<double> p =
        (widen(upkeep.point(corner)) + fdcg::vec(deform->header.origin)) * deform->header.metres_per_unit;
    position_object_m[0] = p.x, position_object_m[1] = p.y, position_object_m[2] = p.z;
  });
  return FDCG_OK;
}

extern "C" fdcg_status fdcg_deform_find(const fdcg_deform* deform, const double position_object_m[3], uint32_t* corner,
                                        fdcg_error* error) {
  constexpr double kNear = 0x1p-20;  // of the extent: more than the rounding of a float or of a change of units
  if (deform == nullptr || corner == nullptr || position_object_m == nullptr)
    return fdcg::Message(error, FDCG_E_ARGUMENT).text("deform, position or corner: null pointer");
  *corner = FDCG_NONE;
  fdcg::Vec3<double> local;
  for (int k = 0; k < 3; ++k)
    if (!fdcg::is_finite(position_object_m[k]))
      return fdcg::refuse_place(*deform, FDCG_NONE, FDCG_NONE, position_object_m, error);
  const double reach = kNear * deform->header.extent;
  if (fdcg::to_local(*deform, position_object_m, &local))  // no corner has ever been beyond
    *corner = fdcg::with_real_of(deform->header, [&](auto real) { return fdcg::find<decltype(real)>(*deform, local, reach); });
  if (*corner != FDCG_NONE) return FDCG_OK;
  return fdcg::Message(error, FDCG_E_ABSENT)
      .say("no corner within ", reach * deform->header.metres_per_unit, " m of ", position_object_m[0], ", ",
           position_object_m[1], ", ", position_object_m[2],
           "; positions are metres in the object's frame: the file's coordinates times the unit scale");
}
