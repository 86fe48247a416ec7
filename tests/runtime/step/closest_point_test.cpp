// SPDX-License-Identifier: Apache-2.0
// A convex body without friction, HIP shallow: the god-object is the exact closest point of the surface.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"

using namespace fdcg::test;

namespace {

// Inside a convex body the distance to the surface has a local minimum wherever HIP's projection on a face falls inside it.
std::vector<Hip> local_minima(const PolygonSoup& soup, const Hip& hip) {
  std::vector<Hip> minima;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const Polygon face = face_corners(soup, f);
    PolygonSoup alone = make_soup("face", soup.points, {face});
    const Hip nearest = closest_point(alone, hip);
    const Hip a = point_of(soup.points[face[0]]), b = point_of(soup.points[face[1]]), c = point_of(soup.points[face[2]]);
    const Hip u = difference(b, a), v = difference(c, a), w = difference(nearest, hip);
    if (std::abs(dot(u, w)) <= 1e-9 * norm(u) * norm(w) && std::abs(dot(v, w)) <= 1e-9 * norm(v) * norm(w)) {
      minima.push_back(nearest);
    }
  }
  return minima;
}

// Slides over the body, HIP at depths up to `depth`, and compares each god-object with the closest point. Near an edge there
// are two minima, and which of them holds the god-object depends on the way; there it must be one of them.
void check_closest(const PolygonSoup& soup, fdcg::bake::Precision precision, double depth, double tolerance) {
  const PlainGraph graph(soup, precision);
  Contact contact(graph.view(), contact_params(0, 0));
  Random random(3);
  Hip surface = closest_point(soup, {2.5, 1.5, 2});
  contact.step(2.5, 1.5, 2);
  int contacts = 0, unique = 0;
  for (int i = 0; i < 3000; ++i) {
    const fdcg::bake::Vec3 d = random.direction();
    const double reach = depth * random.unit(), inwards = 1 - (random.chance(0.2) ? -1 : 1) * 0.5 * depth;
    const Hip hip = {(surface[0] + reach * d.x) * inwards, (surface[1] + reach * d.y) * inwards,
                     (surface[2] + reach * d.z) * inwards};
    contact.step(hip);
    const Hip closest = closest_point(soup, hip);
    surface = closest;
    if (contact.result.state == FDCG_FREE) continue;
    ++contacts;
    const std::vector<Hip> minima = local_minima(soup, hip);
    double off = distance(contact.god_object(), closest);
    const auto near = std::count_if(minima.begin(), minima.end(), [&](const Hip& m) { return distance(m, hip) < 4 * depth; });
    unique += near <= 1;
    if (near > 1) {
      for (const Hip& m : minima)
        off = std::min(off, distance(contact.god_object(), m));
    }
    INFO(soup.name << " step " << i << ", " << near << " minima: " << contact.describe());
    REQUIRE(off <= tolerance * extent(soup));
  }
  CHECK(contacts > 1000);
  CHECK(unique > 400);
}

}  // namespace

TEST_CASE("convex, frictionless, shallow: the god-object is the closest point") {
  using fdcg::bake::Precision;
  const Rotation tilt = random_rotation(9);
  // Shallow: well below the distance from any face to the body's middle planes.
  check_closest(cube(), Precision::f64, 0.05, 1e-14);
  check_closest(transformed(triangulated(cube()), tilt), Precision::f64, 0.05, 1e-14);
  check_closest(ico_sphere(2), Precision::f64, 0.02, 1e-13);
  check_closest(cone(12), Precision::f64, 0.02, 1e-13);
  check_closest(prism(40), Precision::f64, 0.02, 1e-13);
  check_closest(rounded_to_float(ico_sphere(1)), Precision::f32, 0.02, 1e-5);
}
