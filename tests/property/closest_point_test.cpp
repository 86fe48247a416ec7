// SPDX-License-Identifier: Apache-2.0
// A convex body without friction, HIP shallow: the god-object is the exact closest point of the surface.
#include <catch2/catch.hpp>

#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"

using namespace fdcg::test;

namespace {

// Slides over the body at depths up to `depth`, always inside; each tick's god-object is compared with the closest point.
void check_closest(const PolygonSoup& soup, fdcg::bake::Precision precision, double depth, double tolerance) {
  const PlainGraph graph(soup, precision);
  Contact contact(graph.view(), contact_params(0, 0));
  Random random(3);
  contact.step(2.5, 1.5, 2);
  std::uint64_t inside = 0;
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    Hip hip = contact.god_object();
    const fdcg::bake::Vec3 d = random.direction();
    const double reach = depth * random.unit();
    hip = {hip[0] + reach * d.x, hip[1] + reach * d.y, hip[2] + reach * d.z};
    if (contact.result.state == FDCG_FREE) {  // back towards the body
      for (double& c : hip)
        c *= 1 - 0.3 * random.unit();
    }
    contact.step(hip);
    if (contact.result.state == FDCG_FREE) continue;
    const Hip closest = closest_point(soup, hip);
    // The closest point is unique, and the way there one of descent, only near the surface.
    if (distance(closest, hip) > depth) {
      contact.step(2.5, 1.5, 2);
      continue;
    }
    ++inside;
    worst = std::max(worst, distance(closest, hip) - distance(contact.god_object(), hip));
    INFO(soup.name << " step " << i << ": " << contact.describe());
    REQUIRE(std::abs(distance(contact.god_object(), hip) - distance(closest, hip)) <= tolerance * extent(soup));
    REQUIRE(distance(contact.god_object(), closest) <= tolerance * extent(soup));
  }
  CHECK(inside > 500);
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
