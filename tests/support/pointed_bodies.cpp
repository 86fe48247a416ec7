// SPDX-License-Identifier: Apache-2.0
#include "pointed_bodies.hpp"

#include <cmath>
#include <utility>

#include "contact_rig.hpp"

namespace fdcg::test {
namespace {

constexpr double kPi = 3.14159265358979323846, kPeriod_s = 1e-3;

PolygonSoup stretched(PolygonSoup soup, double across, double up) {
  for (Vec3& p : soup.points)
    p = {p.x * across, p.y * across, p.z * up};
  return soup;
}

// Its foot's centre at the origin.
PolygonSoup spike(int sides, double radius, double height) {
  return stretched(moved(triangulated(cone(sides)), {0, 0, 1}), radius, height / 2);
}

void append(PolygonSoup& all, const PolygonSoup& part) {
  std::vector<Polygon> faces;
  for (std::size_t f = 0; f < all.face_count(); ++f)
    faces.push_back(face_corners(all, f));
  const auto first = static_cast<std::uint32_t>(all.points.size());
  for (std::size_t f = 0; f < part.face_count(); ++f) {
    Polygon face = face_corners(part, f);
    for (std::uint32_t& corner : face)
      corner += first;
    faces.push_back(std::move(face));
  }
  std::vector<Vec3> points = all.points;
  points.insert(points.end(), part.points.begin(), part.points.end());
  all = make_soup(all.name, std::move(points), faces);
}

Hip unit_of(const Hip& a) {
  const double length = norm(a);
  return {a[0] / length, a[1] / length, a[2] / length};
}
Hip plus(const Hip& a, const Hip& b, double factor) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
Hip across(const Hip& axis, Random& random) {
  const Hip any = point_of(random.direction());
  return unit_of(plus(any, axis, -dot(any, axis)));
}

PointedBody with_tip_at(PolygonSoup soup, const Vec3& tip) {
  return {std::move(soup), {{point_of(tip), {0, 0, 1}}}};
}

PointedBody many(int needles, int sides, bool is_ring) {
  PointedBody body;
  std::vector<PolygonSoup> parts;
  const double height = 0.02, radius = is_ring ? 2e-4 : 4e-4;
  for (int i = 0; i < needles; ++i) {
    const double angle = is_ring ? 2 * kPi * i / needles : 0, lean = is_ring ? 0.5 : 0;
    const double c = std::cos(angle), s = std::sin(angle), cl = std::cos(lean), sl = std::sin(lean);
    const Rotation leaning = {Vec3{c * cl, -s, c * sl}, Vec3{s * cl, c, s * sl}, Vec3{-sl, 0, cl}};
    const Vec3 foot = is_ring ? Vec3{0.03 * c, 0.03 * s, 0} : Vec3{1e-3 * (i - 0.5 * needles), 0, 0};
    parts.push_back(moved(transformed(spike(sides, radius, height), leaning), foot));
    const Vec3 up = rotated(leaning, {0, 0, 1});
    body.tips.push_back({{foot.x + height * up.x, foot.y + height * up.y, foot.z + height * up.z}, point_of(up)});
  }
  while (parts.size() > 1) {  // two by two: each point is copied a few times only
    std::vector<PolygonSoup> pairs;
    for (std::size_t i = 0; i < parts.size(); i += 2) {
      pairs.push_back(std::move(parts[i]));
      if (i + 1 < parts.size()) append(pairs.back(), parts[i + 1]);
    }
    parts = std::move(pairs);
  }
  body.soup = std::move(parts.front());
  return body;
}

PointedBody upright(PointedKind kind, int sides) {
  switch (kind) {
    case PointedKind::cone:
      return with_tip_at(spike(sides, 0.025, 0.1), {0, 0, 0.1});
    case PointedKind::needle:
      return with_tip_at(spike(sides, 2e-4, 0.04), {0, 0, 0.04});
    case PointedKind::flat:
      return with_tip_at(spike(sides, 0.025, 2e-3), {0, 0, 2e-3});
    case PointedKind::crown:
      return with_tip_at(stretched(triangulated(fan_block(sides + sides % 2, 1, -0.2, -0.6)), 0.02, 0.02), {0, 0, 0.02});
    case PointedKind::ring:
      return many(sides / 40 + 1, 40, true);
    case PointedKind::wall:
      break;
  }
  return many(sides / 4, 4, false);
}

}  // namespace

const char* name_of(PointedKind kind) {
  constexpr const char* kNames[] = {"cone", "needle", "flat", "crown", "ring", "wall"};
  return kNames[static_cast<std::size_t>(kind)];
}
const char* name_of(Approach approach) {
  constexpr const char* kNames[] = {"along-axis", "past-axis", "sideways", "slanting", "by-steps"};
  return kNames[static_cast<std::size_t>(approach)];
}

PointedBody pointed_body(PointedKind kind, int sides, const Rotation& turn) {
  PointedBody body = upright(kind, sides);
  for (PointedBody::Tip& tip : body.tips) {
    // The corner of the turned mesh, to the bit: what a hand aims at.
    const Vec3 at = vec_of(tip.point), turned = rotated(turn, at);
    tip.outwards = point_of(rotated(turn, vec_of(tip.outwards)));
    tip.point = point_of(turned);
  }
  body.soup = transformed(body.soup, turn);
  for (PointedBody::Tip& tip : body.tips) {
    Hip nearest = point_of(body.soup.points.front());
    for (const Vec3& p : body.soup.points) {
      if (distance(point_of(p), tip.point) < distance(nearest, tip.point)) nearest = point_of(p);
    }
    tip.point = nearest;
  }
  return body;
}

std::vector<Hip> hand_way(const PointedBody::Tip& tip, Approach approach, double metres_per_second, Random& random) {
  constexpr double kBefore_m = 3e-3, kBeyond_m = 4e-3;
  Hip aim = tip.point, along = {-tip.outwards[0], -tip.outwards[1], -tip.outwards[2]};
  if (approach == Approach::past_axis) {
    aim = plus(aim, across(tip.outwards, random), 1e-4 * random.unit());
    along = unit_of(plus(along, across(tip.outwards, random), 0.1 * random.unit()));
  } else if (approach == Approach::sideways) {
    along = unit_of(plus(across(tip.outwards, random), tip.outwards, random.uniform(-0.3, 0.3)));
    aim = plus(aim, tip.outwards, -2e-3 * random.unit());
  } else if (approach == Approach::slanting) {
    along = unit_of(plus(along, across(tip.outwards, random), 0.8 * random.unit()));
  }
  const double step = metres_per_second * kPeriod_s;
  const double first = approach == Approach::by_steps ? std::ceil(kBefore_m / step) * step : kBefore_m + step * random.unit();
  std::vector<Hip> way;
  double at = -first;
  for (int i = 0; at < kBeyond_m; ++i, at = i * step - first)
    way.push_back(plus(aim, along, std::abs(at) < step / 2 && approach == Approach::by_steps ? 0 : at));
  for (int i = 0; i < static_cast<int>(kBeyond_m / step / 2); ++i)
    way.push_back(plus(aim, along, at - i * step));
  return way;
}

}  // namespace fdcg::test
