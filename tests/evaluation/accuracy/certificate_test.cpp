// SPDX-License-Identifier: Apache-2.0
// The certificate says yes to the runtime's answers and no to planted wrong ones.
#include "certificate.hpp"

#include <cmath>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "ulp.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;
using Verdict = Certificate::Verdict;

namespace {

struct Certified {
  Hip hip;
  fdcg_contact contact;
};

// Contacts without friction that the certificate agrees to.
std::vector<Certified> certified_contacts(const fdcg_graph& graph, const PolygonSoup& soup, const Certificate& certificate,
                                          int ticks) {
  Contact contact(graph, contact_params(0, 0));
  HipWalk walk(soup, 5);
  std::vector<Certified> found;
  for (int i = 0; i < ticks; ++i) {
    const Hip hip = walk.next(contact.god_object());
    contact.step(hip);
    if (contact.state.state == FDCG_FREE) continue;
    if (certificate.check(hip, contact.state).verdict == Verdict::certified) found.push_back({hip, contact.state});
  }
  return found;
}

fdcg_contact placed(std::uint32_t state, std::uint32_t feature, const Hip& god_object) {
  fdcg_contact contact{};
  contact.state = state;
  contact.feature = feature;
  for (std::size_t k = 0; k < 3; ++k)
    contact.god_object[k] = god_object[k];
  return contact;
}

std::uint32_t corner_at(const fdcg_graph& graph, const Hip& point) {
  for (std::uint32_t v = 0; v < graph.header->corner_count; ++v) {
    const fdcg_corner_info corner = fdcg_get_corner(&graph, v);
    if (distance({corner.point[0], corner.point[1], corner.point[2]}, point) < 1e-12) return v;
  }
  FAIL("no such corner");
  return FDCG_NONE;
}

std::uint32_t edge_between(const fdcg_graph& graph, const Hip& a, const Hip& b) {
  const std::uint32_t v = corner_at(graph, a), w = corner_at(graph, b);
  for (std::uint32_t c = 0; c < graph.header->connection_count; ++c) {
    const fdcg_connection_info edge = fdcg_get_connection(&graph, c);
    if ((edge.corner[0] == v && edge.corner[1] == w) || (edge.corner[0] == w && edge.corner[1] == v)) return c;
  }
  FAIL("no such edge");
  return FDCG_NONE;
}

}  // namespace

TEST_CASE("the certificate agrees with contacts on every kind of feature") {
  for (const PolygonSoup& soup : {cube(), corner_pit(), cone_pit(12), saddle_block(), star_sphere(2, 0.3, 1)}) {
    const PlainGraph graph(soup, Precision::f64);
    const Certificate certificate(graph.view());
    const auto contacts = certified_contacts(graph.view(), soup, certificate, 2000);
    INFO(soup.name);
    CHECK(contacts.size() > 200);
    for (const Certified& c : contacts)
      CHECK(certificate.check(c.hip, c.contact).error_ulps <= 8);
  }
}

TEST_CASE("the certificate measures a planted displacement") {
  const PolygonSoup soup = star_sphere(2, 0.3, 1);
  const PlainGraph graph(soup, Precision::f64);
  const Certificate certificate(graph.view());
  const double ulp = ulp_of_extent(*graph.view().header);
  for (Certified c : certified_contacts(graph.view(), soup, certificate, 500)) {
    c.contact.god_object[1] += 1000 * ulp;
    const double error_ulps = certificate.check(c.hip, c.contact).error_ulps;
    CHECK(error_ulps > 990);
    CHECK(error_ulps < 1010);
  }
}

TEST_CASE("the certificate names the right feature where a neighbour's was planted") {
  const PolygonSoup soup = star_sphere(1, 0.3, 1);
  const PlainGraph graph(soup, Precision::f64);
  const Certificate certificate(graph.view());
  std::uint64_t planted = 0, named = 0;
  for (const Certified& c : certified_contacts(graph.view(), soup, certificate, 2000)) {
    if (c.contact.state != FDCG_FACE) continue;
    for (std::uint32_t f = 0; f < graph.view().header->node_count; ++f) {
      if (f == c.contact.feature) continue;
      const fdcg_node_info node = fdcg_get_node(&graph.view(), f);
      // another face whose plane the HIP is behind, with the god-object as good as may be
      const double side = node.normal[0] * c.hip[0] + node.normal[1] * c.hip[1] + node.normal[2] * c.hip[2] + node.offset;
      const Hip foot = {c.hip[0] - side * node.normal[0], c.hip[1] - side * node.normal[1], c.hip[2] - side * node.normal[2]};
      if (certificate.holds({FDCG_FACE, f}, c.hip)) continue;  // there may be several minima
      const Certificate::Answer answer = certificate.check(c.hip, placed(FDCG_FACE, f, foot));
      CHECK(answer.verdict != Verdict::certified);
      ++planted;
      if (answer.verdict == Verdict::refused) continue;
      CHECK(certificate.holds(answer.feature, c.hip));
      ++named;
    }
  }
  CHECK(planted > 5000);
  CHECK(named > 500);
}

TEST_CASE("a convex edge or corner holds no god-object") {
  const PlainGraph graph(cube(), Precision::f64);
  const Certificate certificate(graph.view());
  const std::uint32_t v = corner_at(graph.view(), {0.5, 0.5, 0.5});
  const std::uint32_t c = edge_between(graph.view(), {0.5, 0.5, 0.5}, {0.5, 0.5, -0.5});
  CHECK_FALSE(certificate.holds({FDCG_VERTEX, v}, {0.4, 0.4, 0.4}));
  CHECK_FALSE(certificate.holds({FDCG_VERTEX, v}, {0.6, 0.6, 0.6}));
  CHECK_FALSE(certificate.holds({FDCG_EDGE, c}, {0.4, 0.4, 0}));
  CHECK_FALSE(certificate.holds({FDCG_EDGE, c}, {0.6, 0.6, 0}));
}

TEST_CASE("a god-object on its face's rim is told, and how far off the model allows it to be there") {
  const PlainGraph graph(cube(), Precision::f64);
  const Certificate certificate(graph.view());
  const double ulp = ulp_of_extent(*graph.view().header);
  const std::uint32_t c = edge_between(graph.view(), {0.5, 0.5, 0.5}, {0.5, 0.5, -0.5});
  const std::uint32_t face = fdcg_get_connection(&graph.view(), c).node[0];
  const auto rim_ulps = [&](double deep, double off) {  // of the HIP below both faces, of the god-object from their edge
    const Hip hip = {0.5 - deep * ulp, 0.5 - deep * ulp, 0}, god_object = {0.5 - off * ulp, 0.5 - off * ulp, 0};
    const Certificate::Answer answer = certificate.check(hip, placed(FDCG_FACE, face, god_object));
    CHECK(answer.verdict == Verdict::certified);
    return answer.rim_ulps;
  };
  CHECK(std::abs(rim_ulps(5, 0) - 12) < 1e-9);  // 4 eps (1 + 0.5)
  CHECK(rim_ulps(13, 0) == 0);
  CHECK(rim_ulps(5, 13) == 0);
}

TEST_CASE("a concave corner holds what is behind all of its faces") {
  const PlainGraph graph(corner_pit(), Precision::f64);  // the octant of positive coordinates is outside
  const Certificate certificate(graph.view());
  const std::uint32_t v = corner_at(graph.view(), {0, 0, 0});
  CHECK(certificate.holds({FDCG_VERTEX, v}, {-0.1, -0.2, -0.3}));
  CHECK_FALSE(certificate.holds({FDCG_VERTEX, v}, {0.1, -0.2, -0.3}));     // an edge leads down
  CHECK_FALSE(certificate.holds({FDCG_VERTEX, v}, {0.1, 0.1, -0.3}));      // a face does
  CHECK_FALSE(certificate.holds({FDCG_VERTEX, v}, {0.1, 0.1, 0.1}));       // outside
  CHECK_FALSE(certificate.holds({FDCG_VERTEX, v}, {-0.1, -0.2, 1e-300}));  // by however little
  CHECK(certificate.holds({FDCG_VERTEX, v}, {-0.1, -0.2, -1e-300}));
}

TEST_CASE("a concave edge holds what is behind it and on neither face's side") {
  const PlainGraph graph(corner_pit(), Precision::f64);
  const Certificate certificate(graph.view());
  const std::uint32_t c = edge_between(graph.view(), {0, 0, 0}, {1, 0, 0});
  CHECK(certificate.holds({FDCG_EDGE, c}, {0.5, -0.1, -0.2}));
  CHECK_FALSE(certificate.holds({FDCG_EDGE, c}, {0.5, 0.1, -0.2}));
  CHECK_FALSE(certificate.holds({FDCG_EDGE, c}, {0.5, 0.1, 0.2}));
  CHECK_FALSE(certificate.holds({FDCG_EDGE, c}, {-0.1, -0.1, -0.2}));  // past its end
  CHECK_FALSE(certificate.holds({FDCG_EDGE, c}, {1.5, -0.1, -0.2}));
}

TEST_CASE("a far feature with a far god-object is refused") {
  const PolygonSoup soup = ico_sphere(3);
  const PlainGraph graph(soup, Precision::f64);
  const Certificate certificate(graph.view());
  const auto contacts = certified_contacts(graph.view(), soup, certificate, 500);
  REQUIRE(!contacts.empty());
  const Certified& first = contacts.front();
  std::uint64_t refused = 0;
  for (std::uint32_t f = 0; f < graph.view().header->node_count; ++f) {
    const Certificate::Answer answer = certificate.check(first.hip, placed(FDCG_FACE, f, {0, 0, 1}));
    refused += answer.verdict == Verdict::refused;
    if (answer.verdict == Verdict::certified) CHECK(certificate.holds({FDCG_FACE, f}, first.hip));
  }
  CHECK(refused > graph.view().header->node_count / 2);
}

TEST_CASE("at a needle's tip a HIP within rounding of its face is found") {
  PolygonSoup needle = cone(8);
  for (fdcg::bake::Vec3& p : needle.points)
    p.z *= 1000;
  const PlainGraph graph(needle, Precision::f64);
  const Certificate certificate(graph.view());
  const std::uint32_t tip = corner_at(graph.view(), {0, 0, 1000});
  for (std::uint32_t f = 0; f < graph.view().header->node_count; ++f) {
    bool is_at_tip = false;
    for (std::uint32_t k = 0; k < fdcg_get_node(&graph.view(), f).side_count; ++k)
      is_at_tip = is_at_tip || fdcg_get_side(&graph.view(), f, k).corner == tip;
    if (!is_at_tip) continue;
    const fdcg_contact contact = placed(FDCG_FACE, f, {0, 0, 1000});
    CHECK(certificate.check({0, 0, 1000 + 0x1p-43}, contact).verdict == Verdict::wrong_feature);  // the floor
    CHECK(certificate.holds_nearby({0, 0, 1000 + 0x1p-43}, contact, 64));
    CHECK_FALSE(certificate.holds_nearby({0, 0, 1000.001}, contact, 64));
  }
}
