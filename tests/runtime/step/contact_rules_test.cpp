// SPDX-License-Identifier: Apache-2.0
// One test for each rule of the contact model that is easily implemented wrong; each fails when its rule is removed. The rule's
// name is the tag in brackets. Over 400 lines: the list of rules stays in one place, in the model's order.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "random.hpp"
#include "reference_walker.hpp"
#include "step/contact_internals.hpp"

using fdcg::internals_of;
using namespace fdcg::test;
using fdcg::bake::Precision;
namespace bake = fdcg::bake;

namespace {

const double kEps = std::numeric_limits<double>::epsilon();

// The face of a plain graph (numbered as in the soup) whose outward normal is nearest to a direction.
std::uint32_t face_towards(const PlainGraph& graph, const Hip& direction) {
  std::uint32_t best = 0;
  double best_dot = -2;
  for (std::uint32_t f = 0; f < graph.view().header->node_count; ++f) {
    const fdcg_node_info node = fdcg_get_node(&graph.view(), f);
    const double d = dot({node.normal[0], node.normal[1], node.normal[2]}, direction);
    if (d > best_dot) {
      best_dot = d;
      best = f;
    }
  }
  return best;
}

std::uint32_t corner_at(const PlainGraph& graph, const Hip& place) {
  for (std::uint32_t v = 0; v < graph.view().header->corner_count; ++v) {
    const fdcg_corner_info corner = fdcg_get_corner(&graph.view(), v);
    if (distance({corner.point[0], corner.point[1], corner.point[2]}, place) < 1e-9) return v;
  }
  FAIL("no corner there");
  return 0;
}

// A contact in a state of the test's choice.
fdcg_contact placed(std::uint32_t state, std::uint32_t feature, const Hip& god_object, const Hip& hip) {
  fdcg_contact c{};
  for (std::size_t k = 0; k < 3; ++k) {
    c.god_object[k] = god_object[k];
    c.hip[k] = hip[k];
  }
  c.started = 1;
  c.state = state;
  c.feature = feature;
  internals_of(c).seat_state = FDCG_FREE;
  internals_of(c).seat_feature = FDCG_NONE;
  return c;
}

PolygonSoup tilted(const PolygonSoup& soup, std::uint64_t seed) {
  return transformed(soup, random_rotation(seed));
}

}  // namespace

// ---- the tick: contact-model TICK-5 ----------------------------------------------------------------------------------------

TEST_CASE("no step cycles, with HIP exactly on features and god-objects on seams", "[met-again]") {
  std::uint64_t transitions = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const PolygonSoup shapes[] = {corner_pit(), subdivided(cube()), cone_pit(7), saddle_block(), grid_box(3, 3, 3, {1, 1, 1})};
    for (const PolygonSoup& shape : shapes) {
      const PolygonSoup soup = rounded_to_float(tilted(triangulated(shape, seed), seed));
      for (const Precision precision : {Precision::f64, Precision::f32}) {
        const PlainGraph graph(soup, precision);
        for (const double mu : {0.0, 0.4}) {
          Contact contact(graph.view(), contact_params(mu, mu));
          HipWalk walk(soup, seed);
          for (int i = 0; i < 600; ++i) {
            contact.step(walk.next(contact.god_object()));
            INFO(soup.name << " seed " << seed << " tick " << i << ": " << contact.describe());
            REQUIRE((contact.result.flags & FDCG_RESULT_TRANSITION_BOUND) == 0);
            transitions += contact.result.transitions;
          }
        }
      }
    }
  }
  CHECK(transitions > 10000);
}

// ---- crossings, planes, seats: contact-model FACE-1, FACE-5, FACE-6, SIDE-2 ------------------------------------------------

TEST_CASE("a god-object on or within rounding error beyond a Voronoi plane still crosses it", "[crossing]") {
  const PlainGraph graph(cube(), Precision::f64);
  const std::uint32_t top = face_towards(graph, {0, 0, 1});
  for (const double beyond : {-kEps, 0.0, kEps, 4 * kEps}) {
    Contact contact(graph.view(), contact_params(0, 0));
    contact.state = placed(FDCG_FACE, top, {0.5 + beyond, 0.1, 0.5}, {0.5 + beyond, 0.1, 0.4});
    contact.step(0.7, 0.1, 0.4);
    INFO("beyond by " << beyond << ": " << contact.describe());
    CHECK(contact.result.state == FDCG_FREE);  // beside the cube
    CHECK(distance(contact.god_object(), {0.7, 0.1, 0.4}) == 0);
  }
  // A target exactly on the plane has crossed it.
  Contact contact(graph.view(), contact_params(0, 0));
  contact.state = placed(FDCG_FACE, top, {0.2, 0.1, 0.5}, {0.2, 0.1, 0.4});
  contact.step(0.5, 0.1, 0.4);
  CHECK(contact.result.state == FDCG_FREE);
}

TEST_CASE("the first Voronoi plane crossed along the way counts", "[first-crossing]") {
  // On the floor z = 0 towards a place behind both walls: the way meets the seam with y = 0 first, and friction holds there.
  const PlainGraph graph(corner_pit(), Precision::f64);
  Contact contact(graph.view(), contact_params(1.5, 1.5));
  contact.step(0.5, 0.1, 0.5);
  contact.step(0.5, 0.1, -0.01);
  REQUIRE(contact.result.state == FDCG_FACE);
  contact.step(-0.1, -0.4, -0.05);
  INFO(contact.describe());
  CHECK(contact.result.state == FDCG_EDGE);
  CHECK(contact.god_object()[0] > 0.3);
  CHECK(contact.god_object()[0] < 0.45);
}

// From a cube's corner the way down to a HIP on the diagonal runs along the middle of a face, where an edge between its two
// triangles may lie: by rounding it begins on or beyond that edge, and ends there.
TEST_CASE("a way along a side is not stopped where it begins", "[along-side]") {
  std::uint64_t stopped = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const PolygonSoup soup = rounded_to_float(transformed(triangulated(cube(), seed), random_rotation(seed)));
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      const PlainGraph graph(soup, precision);
      for (const bake::Vec3& v : soup.points) {
        Contact contact(graph.view(), contact_params(0, 0));
        contact.step(2 * v.x, 2 * v.y, 2 * v.z);
        const Hip hip = {-v.x / 2, -v.y / 2, -v.z / 2};
        contact.step(hip);
        stopped += distance(contact.god_object(), hip) > 0.75 + 1e-6;  // of the near faces; the corner is 1.3 away
      }
    }
  }
  CHECK(stopped == 0);
}

// A hand in the plane that stands on an edge: where the god-object ends on the edge's line, the next tick finds it there.
TEST_CASE("a god-object that slides to a side's plane rests where it does so in one tick", "[ends-on-plane]") {
  std::uint64_t held = 0, restless = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const PolygonSoup soup = rounded_to_float(tilted(triangulated(saddle_block()), seed));
    const PlainGraph graph(soup, Precision::f64);
    Random random(seed);
    for (std::uint32_t c = 0; c < graph.view().header->connection_count; ++c) {
      const fdcg_connection_info edge = fdcg_get_connection(&graph.view(), c);
      if (edge.type == FDCG_BOUNDARY) continue;
      const fdcg_node_info face = fdcg_get_node(&graph.view(), edge.node[random.below(2)]);
      const fdcg_corner_info corner = fdcg_get_corner(&graph.view(), edge.corner[0]);
      const auto beside = [&](double along, double above) {
        Hip x;
        for (std::size_t k = 0; k < 3; ++k)
          x[k] = corner.point[k] + along * edge.length * edge.direction[k] + above * face.normal[k];
        return x;
      };
      for (int i = 0; i < 40; ++i) {
        Contact contact(graph.view(), contact_params(0.6, 0.4));
        contact.step(beside(random.uniform(0.1, 0.9), 1e-3));
        const Hip hip = beside(random.uniform(0.1, 0.9), -random.uniform(0, 0.1));
        contact.step(hip);
        const Hip there = contact.god_object();
        held += contact.result.state != FDCG_FREE;
        contact.step(hip);
        restless += distance(there, contact.god_object()) > 1e-9;
      }
    }
  }
  CHECK(held > 10'000);
  CHECK(restless == 0);
}

// A tick that drags the god-object across hundreds of needles places it on as many edges, each time rounded.
TEST_CASE("rounding errors do not accumulate over a tick across hundreds of faces") {
  const PolygonSoup soup = needle_strip(500, 0.2, 3);
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const PlainGraph graph(soup, precision);
    const ReferenceSurface<long double> surface(graph.view());
    const double ulp = std::ldexp(1.0, std::ilogb(graph.view().header->extent) - (precision == Precision::f64 ? 52 : 23));
    Contact contact(graph.view(), contact_params(1, 1));
    Random random(2);
    std::vector<double> ulps;  // of the long ticks
    for (int i = 0; i < 400; ++i) {
      ReferenceWalker<long double> walker(surface, {1, 1});
      walker.resynchronise(contact.state);
      const Hip hip = {random.uniform(-0.45, 0.45), random.uniform(-0.45, 0.45), i == 0 ? 0.5 : random.uniform(-0.1, 0)};
      contact.step(hip);
      walker.step(surface.local(hip.data()));
      const fdcg_contact& own = contact.state;
      const bool is_same = own.state == walker.contact.state && own.feature == walker.contact.feature;
      if (!is_same || contact.result.transitions < 300) continue;
      const auto& go = walker.contact.god_object;
      const Vector<long double> at = {own.god_object[0], own.god_object[1], own.god_object[2]};
      ulps.push_back(static_cast<double>(length(go - at)) / ulp);
    }
    std::sort(ulps.begin(), ulps.end());
    INFO("f" << (precision == Precision::f64 ? 64 : 32));
    REQUIRE(ulps.size() > 50);
    CHECK(ulps[ulps.size() * 9 / 10] <= 4);  // the rest cross an edge at a flat angle
  }
}

TEST_CASE("a point on a plane is outside", "[on-plane]") {
  const PlainGraph graph(cube(), Precision::f64);
  for (const double mu : {0.0, 1.0}) {
    Contact contact(graph.view(), contact_params(mu, mu));
    SECTION("of a face, mu " + std::to_string(mu)) {
      contact.step(0.1, 0.1, 1);
      contact.step(0.1, 0.1, 0.4);
      REQUIRE(contact.result.state == FDCG_FACE);
      contact.step(0.1, 0.1, 0.5);
      CHECK(contact.result.state == FDCG_FREE);
      CHECK(norm(contact.force()) == 0);
      contact.step(0.1, 0.1, 0.5);
      CHECK(contact.result.state == FDCG_FREE);
      CHECK(contact.result.transitions == 0);
      contact.step(0.1, 0.1, 0.5 - kEps);  // and a rounding below it is inside
      CHECK(contact.result.state == FDCG_FACE);
    }
    SECTION("of one face at a convex edge, mu " + std::to_string(mu)) {
      const std::uint32_t top = face_towards(graph, {0, 0, 1}), right = face_towards(graph, {1, 0, 0});
      for (std::uint32_t c = 0; c < graph.view().header->connection_count; ++c) {
        const fdcg_connection_info connection = fdcg_get_connection(&graph.view(), c);
        const std::uint32_t* const n = connection.node;
        if (!((n[0] == top && n[1] == right) || (n[0] == right && n[1] == top))) continue;
        contact.state = placed(FDCG_EDGE, c, {0.5, 0.1, 0.5}, {0.45, 0.1, 0.45});
        contact.step(0.5, 0.1, 0.3);
        INFO(contact.describe());
        CHECK(contact.result.state == FDCG_FREE);
      }
    }
    SECTION("of both faces at a concave edge, mu " + std::to_string(mu)) {
      const PlainGraph pit(corner_pit(), Precision::f64);
      Contact seam(pit.view(), contact_params(mu, mu));
      seam.step(0.5, 0.5, 0.5);
      seam.step(0.5, -0.1, -0.1);
      REQUIRE(seam.result.state == FDCG_EDGE);
      seam.step(0.5, 0, 0);
      CHECK(seam.result.state == FDCG_FREE);
      CHECK(seam.result.transitions == 1);
      seam.step(0.5, 0, 0);
      CHECK(seam.result.transitions == 0);
    }
    SECTION("of all faces at a concave corner, mu " + std::to_string(mu)) {
      const PlainGraph pit(corner_pit(), Precision::f64);
      Contact corner(pit.view(), contact_params(mu, mu));
      corner.step(0.5, 0.5, 0.5);
      corner.step(-0.1, -0.1, -0.1);
      REQUIRE(corner.result.state == FDCG_VERTEX);
      corner.step(0, 0, 0);
      CHECK(corner.result.state == FDCG_FREE);
      CHECK(corner.result.transitions == 1);
    }
  }
}

TEST_CASE("tremor in a concave corner never falls through, in any orientation", "[seat]") {
  int contact_ticks = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const PolygonSoup soup = transformed(triangulated(corner_pit(), seed), tilt, 0.1);  // 0.2 m across
    const PlainGraph graph(soup, Precision::f64);
    Contact contact(graph.view(), contact_params(0.6, 0.4));
    const Hip opening = point_of(rotated(tilt, {1, 1, 1}));
    Random random(seed);
    contact.step({0.05 * opening[0], 0.05 * opening[1], 0.05 * opening[2]});
    for (int i = 0; i < 4000; ++i) {
      // Around a point 0.1 mm behind the corner, by 0.2 mm: in front of one face and behind another all the time.
      const Hip d = point_of(random.direction());
      const double tremor = 2e-4 * random.unit();
      Hip hip;
      for (std::size_t k = 0; k < 3; ++k)
        hip[k] = -6e-5 * opening[k] + tremor * d[k];
      contact.step(hip);
      contact_ticks += contact.result.state != FDCG_FREE;
      if (contact.result.state != FDCG_FREE) continue;
      INFO("orientation " << seed << ", tick " << i << ": " << contact.describe());
      // In the body's frame: a free HIP lies in the opening, in front of all three faces.
      const Hip local = {dot(hip, point_of(rotated(tilt, {1, 0, 0}))), dot(hip, point_of(rotated(tilt, {0, 1, 0}))),
                         dot(hip, point_of(rotated(tilt, {0, 0, 1})))};
      REQUIRE(std::min({local[0], local[1], local[2]}) > -1e-15);
    }
  }
  CHECK(contact_ticks > 100000);
}

TEST_CASE("a seam held by friction releases only by its own rule", "[seat]") {
  // GO on the seam, the floor active, HIP in front of the floor but behind the wall: without the seat a rounding decides.
  int held = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const PlainGraph graph(transformed(triangulated(corner_pit(), seed), tilt), Precision::f64);
    Contact contact(graph.view(), contact_params(0.9, 0.9));
    const auto at = [&](double x, double y, double z) { return point_of(rotated(tilt, {x, y, z})); };
    contact.step(at(0.5, 0.4, 0.4));
    contact.step(at(0.5, -0.05, -0.05));  // on the seam y = z = 0
    contact.step(at(0.5, 0.01, -0.05));   // behind the floor z = 0 alone: the floor becomes active, GO stays
    contact.step(at(0.5, -0.02, 0.01));   // in front of the floor, behind the wall y = 0
    INFO("orientation " << seed << ": " << contact.describe());
    REQUIRE(contact.result.state != FDCG_FREE);
    ++held;
  }
  CHECK(held == 400);
}

// ---- free space: contact-model FREE-1 to FREE-4, LEAVE-1 -------------------------------------------------------------------

TEST_CASE("an object that moves onto a still HIP is met", "[last-tick-segment]") {
  const PlainGraph graph(thin_plate(1e-3), Precision::f64);
  for (const double speed : {1e-4, 1e-2, 0.5}) {  // metres a tick: from within the plate to far through it
    Contact contact(graph.view(), contact_params(0.3, 0.3));
    const Hip world = {0.1, 0.2, 0.0};
    bool is_met = false;
    for (int tick = 0; tick < 30000 && !is_met; ++tick) {
      const double object_z = -1.0 + speed * tick;  // rises; the hand rests
      contact.step(world[0], world[1], world[2] - object_z);
      is_met = contact.result.state != FDCG_FREE;
      if (world[2] - object_z < -0.6) break;
    }
    INFO("speed " << speed);
    CHECK(is_met);
    CHECK(contact.force()[2] > 0);
  }
}

TEST_CASE("a HIP that passes an edge or a corner exactly is not caught", "[exact-feature]") {
  const PlainGraph graph(cube(), Precision::f64);
  const struct {
    Hip from, to;
  } passes[] = {
      {{0.5, 0, 1}, {0.5, 0, 0}},              // down a side, in its plane, through the edge
      {{0.5, 0.5, 1}, {0.5, 0.5, 0}},          // through a corner, along an edge
      {{0.25, 0, 0.75}, {0.75, 0, 0.25}},      // across an edge
      {{0.25, 0.5, 0.75}, {0.75, 0.5, 0.25}},  // across a corner
      {{0.25, 0.25, 1}, {0.75, 0.75, 0}},      // into a corner from above, out beside it
  };
  for (const auto& pass : passes) {
    for (const double mu : {0.0, 0.5, 5.0}) {
      Contact contact(graph.view(), contact_params(mu, mu));
      contact.step(pass.from);
      contact.step(pass.to);
      INFO("mu " << mu << ": " << contact.describe());
      CHECK(contact.result.state == FDCG_FREE);
      CHECK(distance(contact.god_object(), pass.to) == 0);
    }
  }
}

TEST_CASE("no segment passes between faces, at edges and corners in any orientation", "[watertight]") {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const PolygonSoup soup = tilted(seed % 2 == 0 ? ico_sphere(1) : star_sphere(1, 0.3, seed), seed);
    const PlainGraph graph(soup, Precision::f64);
    Random random(seed);
    for (int i = 0; i < 3000; ++i) {
      const Polygon face = face_corners(soup, random.below(static_cast<std::uint32_t>(soup.face_count())));
      const Hip a = point_of(soup.points[face[0]]), b = point_of(soup.points[face[1]]);
      const double part = random.below(9) / 8.0;
      Hip aim, from, to;
      for (std::size_t k = 0; k < 3; ++k) {
        aim[k] = a[k] + part * (b[k] - a[k]);
        from[k] = aim[k] * (i % 3 == 0 ? 2.0 : 1 + 0.3 * random.unit());
        to[k] = aim[k] * (i % 2 == 0 ? 0.0 : 0.9);
      }
      if (i % 5 == 0) from = {aim[0] * (1 + 4 * kEps), aim[1] * (1 + 4 * kEps), aim[2] * (1 + 4 * kEps)};
      if (winding_number(soup, from) > 1e-3) continue;  // rounding put the start inside
      Contact contact(graph.view(), contact_params(0.5, 0.5));
      contact.step(from);
      contact.step(to);
      INFO("orientation " << seed << ", segment " << i << ": " << contact.describe());
      REQUIRE(contact.result.state != FDCG_FREE);
    }
  }
}

TEST_CASE("where contact was lost the feature's own faces do not catch HIP again", "[leave-out]") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const PlainGraph graph(transformed(triangulated(corner_pit(), seed), tilt), Precision::f64);
    const auto at = [&](double x, double y, double z) { return point_of(rotated(tilt, {x, y, z})); };
    for (const double lift : {1e-3, 1e-9, 1e-13}) {
      for (const double mu : {0.0, 0.8}) {
        Contact contact(graph.view(), contact_params(mu, mu));
        const struct {
          Hip in, out;
        } ways[] = {{at(0.5, 0.4, -0.05), at(0.45, 0.3, lift)},        // floor
                    {at(0.5, -0.05, -0.05), at(0.45, lift, lift)},     // seam
                    {at(-0.05, -0.05, -0.05), at(lift, lift, lift)}};  // corner
        for (const auto& way : ways) {
          contact.step(at(0.5, 0.5, 0.5));
          contact.step(way.in);
          REQUIRE(contact.result.state != FDCG_FREE);
          contact.step(way.out);
          INFO("orientation " << seed << ", lift " << lift << ": " << contact.describe());
          REQUIRE(contact.result.state == FDCG_FREE);
          REQUIRE(contact.result.transitions <= 2);
        }
      }
    }
  }
}

TEST_CASE("over a convex edge and out is out: neither of its faces catches HIP again", "[leave-out]") {
  Random random(7);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const PlainGraph graph(transformed(cube(), tilt), Precision::f64);
    const auto at = [&](double x, double y, double z) { return point_of(rotated(tilt, {x, y, z})); };
    Contact contact(graph.view(), contact_params(0, 0));
    const double y = 0.8 * (random.unit() - 0.5), out = random.unit();
    contact.step(at(0.3, y, 0.7));
    contact.step(at(0.3, y, 0.45));
    REQUIRE(contact.result.state == FDCG_FACE);
    contact.step(at(0.5 + out, y + 0.1 * out, 0.45));  // below the top, beside the body
    INFO("orientation " << seed << ": " << contact.describe());
    REQUIRE(contact.result.state == FDCG_FREE);
    REQUIRE(contact.result.transitions == 2);
  }
}

TEST_CASE("a HIP that leaves contact towards a nearby wall does not pass through it", "[no-distance-tolerance]") {
  // A slit 1e-9 wide at its top: HIP leaves one wall and in the same tick is deep behind the other.
  const PlainGraph graph(v_groove(2e-9), Precision::f64);
  Contact contact(graph.view(), contact_params(0.2, 0.2));
  const double z = 0.25;  // walls at y = +-2.5e-10
  contact.step(0, 0, z);
  contact.step(0, -0.01, z);
  REQUIRE(contact.result.state != FDCG_FREE);
  contact.step(0, 0.01, z);
  INFO(contact.describe());
  CHECK(contact.result.state != FDCG_FREE);
  CHECK(std::abs(contact.god_object()[1]) < 1e-8);
}

// ---- friction: contact-model FRIC-2, FRIC-3, FRIC-5, FACE-3, FACE-6 --------------------------------------------------------

TEST_CASE("dynamic friction holds in the tick of breakaway", "[slip-at-once]") {
  const PlainGraph graph(plane_quad(), Precision::f64);
  Contact contact(graph.view(), contact_params(0.8, 0.3));
  contact.step(-0.3, 0, 0.1);
  contact.step(-0.3, 0, -0.1);
  contact.step(-0.3 + 0.081, 0, -0.1);
  CHECK(contact.result.slipping == 1);
  CHECK(std::abs((-0.3 + 0.081 - contact.god_object()[0]) - 0.03) < 1e-15);
}

TEST_CASE("slip ends only well within the dynamic circle", "[stick-factor]") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Rotation tilt = random_rotation(seed);
    const PlainGraph graph(transformed(plane_grid(1, 1), tilt), Precision::f64);
    const auto at = [&](double x, double y, double z) { return point_of(rotated(tilt, {x, y, z})); };
    Contact contact(graph.view(), contact_params(0.5, 0.3));
    contact.step(at(-0.3, 0.05, 0.1));
    contact.step(at(-0.3, 0.05, -0.1));
    contact.step(at(0, 0.07, -0.1));
    REQUIRE(contact.result.slipping == 1);
    const Hip slid = contact.god_object();
    for (int tick = 0; tick < 200; ++tick) {  // exactly on the circle: no coin is tossed
      contact.step(at(0, 0.07, -0.1));
      INFO("orientation " << seed << ", tick " << tick << ": " << contact.describe());
      REQUIRE(contact.result.slipping == 1);
      REQUIRE(distance(contact.god_object(), slid) < 1e-15);
    }
    contact.step(at(0, 0.07, -0.1 - 1e-8));  // the circle is larger by 1e-7 of itself: not yet
    CHECK(contact.result.slipping == 1);
    contact.step(at(0, 0.07, -0.1 - 1e-6));
    CHECK(contact.result.slipping == 0);
    contact.step(at(0.01, 0.07, -0.1 - 1e-6));  // sticks: 0.5, not 0.3, holds it now
    CHECK(contact.result.slipping == 0);
  }
}

TEST_CASE("the slip flag survives changes of feature and is reset by a free tick", "[slip-flag]") {
  const PlainGraph graph(plane_grid(8, 8), Precision::f64);
  Contact contact(graph.view(), contact_params(0.9, 0.2));
  contact.step(-0.3, 0.011, 0.1);
  contact.step(-0.3, 0.011, -0.1);
  contact.step(-0.15, 0.011, -0.1);
  REQUIRE(contact.result.slipping == 1);
  // Slow motion over several triangles: were the flag lost at an edge, static friction would hold it there.
  std::uint32_t crossings = 0;
  for (int i = 1; i <= 400; ++i) {
    const double x = -0.15 + 0.001 * i;
    contact.step(x, 0.011, -0.1);
    crossings += contact.result.transitions > 0;
    INFO("tick " << i << ": " << contact.describe());
    REQUIRE(contact.result.slipping == 1);
    REQUIRE(std::abs(x - contact.god_object()[0] - 0.02) < 1e-14);
  }
  CHECK(crossings > 4);
  contact.step(0.25, 0.011, 0.1);
  CHECK(contact.result.state == FDCG_FREE);
  CHECK(contact.state.slipping == 0);
  contact.step(0.25, 0.011, -0.1);
  const double x = contact.god_object()[0];
  contact.step(0.25 + 0.08, 0.011, -0.1);  // below mu_s: holds
  CHECK(contact.god_object()[0] == x);
}

TEST_CASE("at rest the god-object does not change", "[rest-untouched]") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const PlainGraph graph(tilted(triangulated(cube()), seed), Precision::f64);
    Contact contact(graph.view(), contact_params(0.6, 0.4));
    Random random(seed);
    const Hip out = point_of(random.direction());
    contact.step({2 * out[0], 2 * out[1], 2 * out[2]});
    contact.step({0.3 * out[0], 0.3 * out[1], 0.3 * out[2]});
    REQUIRE(contact.result.state != FDCG_FREE);
    contact.step({0.3 * out[0], 0.3 * out[1], 0.3 * out[2]});
    const Hip rest = contact.god_object();
    for (int tick = 0; tick < 500; ++tick) {  // HIP trembles well inside the circle
      const Hip d = point_of(random.direction());
      contact.step({0.3 * out[0] + 1e-6 * d[0], 0.3 * out[1] + 1e-6 * d[1], 0.3 * out[2] + 1e-6 * d[2]});
      if (contact.result.slipping != 0) break;
      REQUIRE(distance(contact.god_object(), rest) == 0);
    }
  }
}

TEST_CASE("a move that lands on an edge's end activates the corner", "[lands-on-vertex]") {
  for (const double off : {0.0, 1e-17, -1e-17}) {
    const PlainGraph graph(corner_pit(), Precision::f64);
    Contact contact(graph.view(), contact_params(0, 0));
    contact.step(0.5, 0.5, 0.5);
    contact.step(0.3, 0.3, -0.1);
    REQUIRE(contact.result.state == FDCG_FACE);
    contact.step(-0.1 + off, -0.1, -0.2);  // over the floor's diagonal into the corner
    INFO("off by " << off << ": " << contact.describe());
    CHECK(contact.result.state == FDCG_VERTEX);
    CHECK(distance(contact.god_object(), {0, 0, 0}) == 0);
    CHECK((contact.result.flags & FDCG_RESULT_TRANSITION_BOUND) == 0);
  }
  // Within 8 eps (|v| + length) of the end counts as the end, from the edge as well.
  const PlainGraph graph(corner_pit(), Precision::f64);
  Contact contact(graph.view(), contact_params(0, 0));
  contact.step(0.5, 0.5, 0.5);
  contact.step(0.5, -0.1, -0.1);
  REQUIRE(contact.result.state == FDCG_EDGE);
  contact.step(4 * kEps, -0.1, -0.1);
  CHECK(contact.result.state == FDCG_VERTEX);
  CHECK(distance(contact.god_object(), {0, 0, 0}) == 0);
}

// ---- edges: contact-model EDGE-2 -------------------------------------------------------------------------------------------

TEST_CASE("behind both faces of a convex edge the steeper descent is taken", "[steeper-face]") {
  const PlainGraph graph(wedge(2.0), Precision::f64);  // obtuse knife along x at y = z = 0
  for (std::uint32_t c = 0; c < graph.view().header->connection_count; ++c) {
    const fdcg_connection_info connection = fdcg_get_connection(&graph.view(), c);
    const fdcg_corner_info from = fdcg_get_corner(&graph.view(), connection.corner[0]);
    const fdcg_corner_info to = fdcg_get_corner(&graph.view(), connection.corner[1]);
    const double *v0 = from.point, *v1 = to.point;
    if (std::abs(v0[1]) + std::abs(v0[2]) + std::abs(v1[1]) + std::abs(v1[2]) > 0) continue;
    for (const double z : {0.02, -0.02}) {
      Contact contact(graph.view(), contact_params(0, 0));
      contact.state = placed(FDCG_EDGE, c, {0.1, 0, 0}, {0.1, 0.01, 0});
      contact.step(0.1, 0.1, z);
      INFO(contact.describe());
      REQUIRE(contact.result.state == FDCG_FACE);
      CHECK(contact.god_object()[2] * z > 0);  // out by the face on HIP's side
    }
  }
}

// ---- corners: contact-model CORNER-1, CORNER-4, CORNER-5 -------------------------------------------------------------------

TEST_CASE("open corners: free beyond the border, in contact beneath the patch", "[open-corner]") {
  const PlainGraph graph(plane_quad(), Precision::f64);
  const std::uint32_t corner = corner_at(graph, {0.5, 0.5, 0});
  const struct {
    Hip hip;
    std::uint32_t state;
  } cases[] = {{{0.7, 0.7, -0.1}, FDCG_FREE},  // the apex wins
               {{0.0, 0.5, -0.1}, FDCG_FREE},  // along the border, exactly below it
               {{0.0, 0.6, -0.1}, FDCG_FREE},  // a border edge wins, HIP beyond it
               {{0.0, 0.4, -0.1}, FDCG_FACE},  // beneath the patch
               {{0.4, 0.4, 0.1}, FDCG_FREE}};  // above it
  for (const double mu : {0.0, 0.5, 50.0}) {
    for (const auto& c : cases) {
      Contact contact(graph.view(), contact_params(mu, mu));
      contact.state = placed(FDCG_VERTEX, corner, {0.5, 0.5, 0}, {0.5, 0.5, -0.1});
      internals_of(contact.state).seat_state = FDCG_VERTEX;
      internals_of(contact.state).seat_feature = corner;
      contact.step(c.hip);
      INFO("mu " << mu << ": " << contact.describe());
      CHECK(contact.result.state == c.state);
    }
  }
}

// The pit is the cube's inside turned out: what is free of the one corner is behind the other.
TEST_CASE("at a corner the way to the HIP is free or not, whatever is nearest", "[free-at-vertex]") {
  struct Body {
    PolygonSoup soup;
    Hip corner;
    bool is_pit;
  };
  const Body bodies[] = {{moved(cube(), {-0.5, -0.5, -0.5}), {0, 0, 0}, false}, {corner_pit(), {0, 0, 0}, true}};
  Random random(4);
  for (const Body& body : bodies) {
    const PlainGraph graph(body.soup, Precision::f64);
    const std::uint32_t corner = corner_at(graph, body.corner);
    for (int i = 0; i < 500; ++i) {
      const Hip d = point_of(random.direction());
      const Hip hip = {0.05 * d[0], 0.05 * d[1], 0.05 * d[2]};
      const bool is_inside = winding_number(body.soup, hip) > 0.5;
      Contact contact(graph.view(), contact_params(0, 0));
      contact.state = placed(FDCG_VERTEX, corner, body.corner, {0, 0, 0});
      contact.step(hip);
      INFO((body.is_pit ? "pit" : "cube") << ": " << contact.describe());
      REQUIRE((contact.result.state != FDCG_FREE) == is_inside);
    }
  }
}

TEST_CASE("at a corner the steepest descent is chosen, saddles included", "[steepest-at-vertex]") {
  const PolygonSoup soup = saddle_block();
  const PlainGraph graph(soup, Precision::f64);
  const ReferenceSurface<HighPrecision> surface(graph.view());
  const std::uint32_t apex = corner_at(graph, {0, 0, 0});
  Random random(8);
  int faces = 0, edges = 0;
  for (int i = 0; i < 4000; ++i) {
    const Hip d = point_of(random.direction());
    const Hip hip = {0.05 * d[0], 0.05 * d[1], 0.05 * d[2]};
    // The nearest point of the fan around the apex: by all its faces and edges.
    const Hip nearest = closest_point(soup, hip);
    if (winding_number(soup, hip) < 0.5) continue;
    Contact contact(graph.view(), contact_params(0, 0));
    contact.state = placed(FDCG_VERTEX, apex, {0, 0, 0}, {0, 0, -0.01});
    contact.step(hip);
    INFO(contact.describe());
    // Without friction the first feature already leads to the nearest point: the longest projection is the nearest.
    REQUIRE(contact.result.state != FDCG_FREE);
    REQUIRE(std::abs(distance(contact.god_object(), hip) - distance(nearest, hip)) < 1e-15);
    faces += contact.result.state == FDCG_FACE;
    edges += contact.result.state == FDCG_EDGE;
  }
  CHECK(faces > 500);
  CHECK(edges > 50);
}
