// SPDX-License-Identifier: Apache-2.0
#include "exact/triangle_contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/vec3.hpp"
#include "exact/exact.hpp"

namespace fdcg::bake {
namespace {

using Corner = const Vec3*;
using Corners = std::array<Corner, 3>;
using Signs = std::array<int, 3>;

bool has(const Corners& corners, Corner p) {
  return p == corners[0] || p == corners[1] || p == corners[2];
}

// orient3d, with 0 returned at once where two points are the same: exact zeros are the slowest case of the predicate.
int orient(Corner a, Corner b, Corner c, Corner d) {
  if (a == c || a == d || b == c || b == d) return 0;
  return exact::orient3d(*a, *b, *c, *d);
}

// On which side of the plane of `a` the corners of `b` lie.
Signs sides_of(const Corners& a, const Corners& b) {
  Signs signs{};
  for (std::size_t i = 0; i < 3; ++i)
    signs[i] = has(a, b[i]) ? 0 : exact::orient3d(*a[0], *a[1], *a[2], *b[i]);
  return signs;
}

bool all_are(const Signs& signs, int sign) {
  return signs[0] == sign && signs[1] == sign && signs[2] == sign;
}

// The corner that the plane separates from the two others, each of which is on the other side or on the plane. The signs are
// neither all zero nor all equal.
struct Lone {
  std::size_t corner = 0;
  bool is_behind = false;
};
Lone lone_corner(const Signs& signs) {
  const auto only = [&](int sign) -> std::size_t {
    const auto first = std::find(signs.begin(), signs.end(), sign);
    if (first == signs.end() || std::find(first + 1, signs.end(), sign) != signs.end()) return 3;
    return static_cast<std::size_t>(first - signs.begin());
  };
  if (const std::size_t i = only(1); i < 3) return {i, false};
  if (const std::size_t i = only(-1); i < 3) return {i, true};
  const std::size_t zero = only(0);  // two are strictly on one side, the third on the plane
  return {zero, signs[(zero + 1) % 3] > 0};
}

// For a triangle that meets the plane of the other: whether its intersection with that plane lies in its interior. A side in
// the plane counts as interior where it is a seam; a single corner does not.
bool is_cut_inside(const Signs& signs, unsigned seams) {
  if (std::count(signs.begin(), signs.end(), 0) < 2)
    return *std::min_element(signs.begin(), signs.end()) < 0 && *std::max_element(signs.begin(), signs.end()) > 0;
  for (unsigned i = 0; i < 3; ++i) {
    if (signs[i] == 0 && signs[(i + 1) % 3] == 0) return (seams >> i & 1u) != 0;
  }
  return false;
}

bool is_seam(const ContactTriangle& t, Corner u, Corner v) {
  for (unsigned i = 0; i < 3; ++i) {
    const Corner from = t.corner[i], to = t.corner[(i + 1) % 3];
    if ((from == u && to == v) || (from == v && to == u)) return (t.seams >> i & 1u) != 0;
  }
  return false;
}

// The intersection line of the two planes meets both triangles, each in an interval. How the intervals lie: disjoint (-1), with
// a common end point only (0), overlapping (1).
int compare_intervals(const Corners& a, const Corners& b, const Signs& a_sides, const Signs& b_sides) {
  const Lone lone_a = lone_corner(a_sides), lone_b = lone_corner(b_sides);
  Corner p = a[lone_a.corner], q = a[(lone_a.corner + 1) % 3], r = a[(lone_a.corner + 2) % 3];
  Corner u = b[lone_b.corner], v = b[(lone_b.corner + 1) % 3], w = b[(lone_b.corner + 2) % 3];
  // Normalised so that p is in front of the plane of u, v, w, and u is in front of that of p, q, r.
  if (lone_a.is_behind) std::swap(v, w);
  if (lone_b.is_behind) std::swap(q, r);
  const int first = orient(p, q, u, v);
  if (first > 0) return -1;
  const int second = orient(p, r, w, u);
  if (second > 0) return -1;
  return first < 0 && second < 0 ? 1 : 0;
}

// Two coplanar triangles, projected along an axis along which their plane is not edge-on.
class FlatPair {
 public:
  FlatPair(const Corners& a, const Corners& b) : a_(a), b_(b) {
    while (axis_ < 2 && (turn_a_ = exact::orient2d(*a[0], *a[1], *a[2], axis_)) == 0)
      ++axis_;
    if (turn_a_ == 0) turn_a_ = exact::orient2d(*a[0], *a[1], *a[2], axis_);
    turn_b_ = exact::orient2d(*b[0], *b[1], *b[2], axis_);
  }

  // Separating-axis test: disjoint convex polygons are separated by the line through a side of one of them.
  [[nodiscard]] Contact contact() const {
    bool are_apart = false, are_disjoint = false;
    for (std::size_t i = 0; i < 3 && !are_disjoint; ++i) {
      separate(a_[i], a_[(i + 1) % 3], turn_a_, b_, are_apart, are_disjoint);
      separate(b_[i], b_[(i + 1) % 3], turn_b_, a_, are_apart, are_disjoint);
    }
    return are_disjoint ? Contact::none : are_apart ? Contact::touching : Contact::crossing;
  }

  // Whether the directions from o to p and from o to q are equal.
  [[nodiscard]] bool is_same_way(Corner o, Corner p, Corner q) const {
    return exact::orient2d(*o, *p, *q, axis_) == 0 && exact::dot_sign(*o, *p, *q) > 0;
  }

  // Enumerates the corners of the intersection of the two triangles: calls visit(p) for the corners of one that lie in the
  // other, and cross(p, q, u, v) for the pairs of sides that cross properly.
  template <class Visit, class Cross>
  void for_each_common_corner(Visit visit, Cross cross) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (contains(b_, turn_b_, a_[i])) visit(*a_[i]);
      if (!has(a_, b_[i]) && contains(a_, turn_a_, b_[i])) visit(*b_[i]);
      for (std::size_t j = 0; j < 3; ++j) {
        const Corner p = a_[i], q = a_[(i + 1) % 3], u = b_[j], v = b_[(j + 1) % 3];
        if (turn(p, q, u) * turn(p, q, v) < 0 && turn(u, v, p) * turn(u, v, q) < 0) cross(*p, *q, *u, *v);
      }
    }
  }

 private:
  [[nodiscard]] int turn(Corner a, Corner b, Corner c) const {
    return c == a || c == b ? 0 : exact::orient2d(*a, *b, *c, axis_);
  }
  [[nodiscard]] bool contains(const Corners& t, int turn_t, Corner p) const {
    return turn(t[0], t[1], p) * turn_t >= 0 && turn(t[1], t[2], p) * turn_t >= 0 && turn(t[2], t[0], p) * turn_t >= 0;
  }
  void separate(Corner from, Corner to, int inner, const Corners& other, bool& are_apart, bool& are_disjoint) const {
    int outside = 0;
    for (const Corner p : other) {
      const int side = turn(from, to, p) * inner;
      if (side > 0) return;
      outside += side < 0;
    }
    are_apart = true;
    are_disjoint = are_disjoint || outside == 3;
  }

  const Corners &a_, &b_;
  int axis_ = 0, turn_a_ = 0, turn_b_ = 0;
};

// `shared` corners, at most two.
Contact flat_contact(const ContactTriangle& a, const ContactTriangle& b, const std::array<Corner, 3>& shared, int count) {
  const FlatPair pair(a.corner, b.corner);
  const Contact contact = pair.contact();
  if (contact != Contact::touching || count == 0) return contact;
  if (count == 2) {
    const bool is_common_side = !is_seam(a, shared[0], shared[1]) && !is_seam(b, shared[0], shared[1]);
    return is_common_side ? Contact::none : Contact::touching;
  }
  for (const Corner p : a.corner) {
    for (const Corner q : b.corner) {
      if (p != shared[0] && q != shared[0] && pair.is_same_way(shared[0], p, q)) return Contact::touching;
    }
  }
  return Contact::none;
}

int find_shared(const ContactTriangle& a, const ContactTriangle& b, std::array<Corner, 3>& shared) {
  int count = 0;
  for (const Corner p : a.corner) {
    if (has(b.corner, p)) shared[static_cast<std::size_t>(count++)] = p;
  }
  return count;
}

}  // namespace

Contact contact_of(const ContactTriangle& a, const ContactTriangle& b) {
  std::array<Corner, 3> shared{};
  const int count = find_shared(a, b, shared);
  if (count == 3) return Contact::crossing;
  const Signs b_sides = sides_of(a.corner, b.corner);
  if (all_are(b_sides, 1) || all_are(b_sides, -1)) return Contact::none;
  if (all_are(b_sides, 0)) return flat_contact(a, b, shared, count);
  if (count == 2) {  // different planes: the intersection is the shared side
    const bool in_a = is_seam(a, shared[0], shared[1]), in_b = is_seam(b, shared[0], shared[1]);
    return in_a && in_b ? Contact::crossing : in_a || in_b ? Contact::touching : Contact::none;
  }
  const Signs a_sides = sides_of(b.corner, a.corner);
  if (all_are(a_sides, 1) || all_are(a_sides, -1)) return Contact::none;
  const int overlap = compare_intervals(a.corner, b.corner, a_sides, b_sides);
  // Both intervals end in the shared corner: they have another common point only if they overlap.
  if (overlap < 0 || (overlap == 0 && count == 1)) return Contact::none;
  const bool is_inside = is_cut_inside(a_sides, a.seams) && is_cut_inside(b_sides, b.seams);
  return overlap > 0 && is_inside ? Contact::crossing : Contact::touching;
}

namespace {

// The point where the side from p to q crosses the plane, given their distances from it.
Vec3 between(const Vec3& p, const Vec3& q, double p_distance, double q_distance) {
  const double whole = std::fabs(p_distance) + std::fabs(q_distance);
  return p + (whole > 0 ? std::fabs(p_distance) / whole : 0.5) * (q - p);
}

struct Interval {
  Vec3 ends[2];
  int count = 0;
  void add(const Vec3& p) {
    if (count < 2) ends[count] = p;
    ++count;
  }
};

// The intersection of a triangle with the plane through `o`. The signs are exact, the points are rounded.
Interval cut(const std::array<Vec3, 3>& t, const Signs& signs, const Vec3& o, const Vec3& normal) {
  Interval interval;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (signs[i] == 0) interval.add(t[i]);
    if (signs[i] * signs[j] < 0) interval.add(between(t[i], t[j], dot(normal, t[i] - o), dot(normal, t[j] - o)));
  }
  if (interval.count == 1) interval.add(interval.ends[0]);
  return interval;
}

// Approximate midpoint of the intersection of two intervals on a line along `direction`.
Vec3 middle_of_overlap(Interval a, Interval b, const Vec3& direction) {
  for (Interval* i : {&a, &b}) {
    if (dot(direction, i->ends[1] - i->ends[0]) < 0) std::swap(i->ends[0], i->ends[1]);
  }
  const Vec3& low = dot(direction, b.ends[0] - a.ends[0]) > 0 ? b.ends[0] : a.ends[0];
  const Vec3& high = dot(direction, b.ends[1] - a.ends[1]) < 0 ? b.ends[1] : a.ends[1];
  return 0.5 * (low + high);
}

Vec3 flat_meeting_point(const ContactTriangle& a, const ContactTriangle& b, double scale) {
  Vec3 sum;
  double count = 0;
  const auto add = [&](const Vec3& p) {
    sum = sum + p;
    ++count;
  };
  FlatPair(a.corner, b.corner)
      .for_each_common_corner([&](const Vec3& p) { add(scale * p); },
                              [&](const Vec3& p, const Vec3& q, const Vec3& u, const Vec3& v) {
                                const Vec3 along = scale * q - scale * p, side = scale * v - scale * u;
                                const Vec3 normal = cross(along, side), wall = cross(side, normal);
                                const Vec3 from_wall = scale * p - scale * u;
                                const double p_distance = dot(wall, from_wall);
                                add(between(scale * p, scale * q, p_distance, p_distance + dot(wall, along)));
                              });
  return 1 / (scale * count) * sum;
}

}  // namespace

Vec3 meeting_point(const ContactTriangle& a, const ContactTriangle& b) {
  // Scaled to about unit size by a power of two, so that no product overflows.
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    largest = std::max({largest, largest_component(*a.corner[i]), largest_component(*b.corner[i])});
  const double scale = std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1020, 1020));
  const Signs b_sides = sides_of(a.corner, b.corner);
  if (all_are(b_sides, 0)) return flat_meeting_point(a, b, scale);
  const Signs a_sides = sides_of(b.corner, a.corner);
  std::array<Vec3, 3> p, q;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = scale * *a.corner[i];
    q[i] = scale * *b.corner[i];
  }
  const Vec3 a_normal = cross(p[1] - p[0], p[2] - p[0]), b_normal = cross(q[1] - q[0], q[2] - q[0]);
  const Interval in_a = cut(p, a_sides, q[0], b_normal), in_b = cut(q, b_sides, p[0], a_normal);
  return 1 / scale * middle_of_overlap(in_a, in_b, cross(a_normal, b_normal));
}

}  // namespace fdcg::bake
