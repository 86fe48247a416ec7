// SPDX-License-Identifier: Apache-2.0
// Friction in a concave corner: the loads of its faces are the non-negative numbers whose sum of normals comes nearest to what
// presses (least squares), friction bears what is left, up to mu times the sum of the loads. The reference solves for them over
// all the faces at once, by the active set of Lawson and Hanson (1974), in long double; the runtime goes by face, edge, apex.
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"
#include "random.hpp"
#include "vector.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

using Wide = long double;
using Point = Vector<Wide>;

Point wide(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Point wide(const Hip& v) {
  return {v[0], v[1], v[2]};
}

// The unit normals of the faces that have the origin as a corner.
std::vector<Point> normals_at_origin(const PolygonSoup& soup) {
  std::vector<Point> normals;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t first = soup.face_first[f], count = soup.face_first[f + 1] - first;
    for (std::uint32_t k = 0; k < count; ++k) {
      const auto corner = [&](std::uint32_t i) { return wide(soup.points[soup.corners[first + (k + i) % count]]); };
      if (length(corner(0)) != 0) continue;
      const Point n = cross(corner(1), corner(count - 1));
      normals.push_back(n * (1 / length(n)));
    }
  }
  return normals;
}

struct Decomposition {
  Wide load = 0;  // the sum
  Point borne;    // by friction: what no face presses against, along the surface
};

// Least squares of -t over three columns at most, by the normal equations; false where they are dependent.
bool solve(const std::vector<Point>& n, const std::vector<std::size_t>& set, const Point& t, Wide* load) {
  const std::size_t m = set.size();
  Wide a[3][4];
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j)
      a[i][j] = dot(n[set[i]], n[set[j]]);
    a[i][m] = -dot(n[set[i]], t);
  }
  for (std::size_t i = 0; i < m; ++i) {
    if (a[i][i] < 1e-15L) return false;
    for (std::size_t r = 0; r < m; ++r) {
      if (r == i) continue;
      const Wide factor = a[r][i] / a[i][i];
      for (std::size_t c = i; c <= m; ++c)
        a[r][c] -= factor * a[i][c];
    }
  }
  for (std::size_t i = 0; i < m; ++i)
    load[i] = a[i][m] / a[i][i];
  return true;
}

Decomposition decompose(const std::vector<Point>& n, const Point& t) {
  std::vector<std::size_t> set;
  std::vector<Wide> load;
  const auto rest_of = [&] {
    Point rest = t;
    for (std::size_t i = 0; i < set.size(); ++i)
      rest = rest + n[set[i]] * load[i];
    return rest;
  };
  for (int round = 0; round < 1000; ++round) {
    const Point rest = rest_of();
    std::size_t deepest = 0;
    for (std::size_t i = 1; i < n.size(); ++i)
      deepest = dot(n[i], rest) < dot(n[deepest], rest) ? i : deepest;
    if (!(dot(n[deepest], rest) < -1e-17L * length(t)) || set.size() == 3) break;
    set.push_back(deepest);
    load.push_back(0);
    while (true) {
      Wide next[3];
      if (!solve(n, set, t, next)) {
        set.pop_back();
        load.pop_back();
        round = 1000;
        break;
      }
      Wide step = 1;
      std::size_t leaves = set.size();
      for (std::size_t i = 0; i < set.size(); ++i) {
        if (next[i] > 0 || load[i] - next[i] <= 0) continue;
        const Wide at = load[i] / (load[i] - next[i]);
        if (at < step) step = at, leaves = i;
      }
      for (std::size_t i = 0; i < set.size(); ++i)
        load[i] += step * (next[i] - load[i]);
      if (leaves == set.size()) break;
      set.erase(set.begin() + static_cast<std::ptrdiff_t>(leaves));
      load.erase(load.begin() + static_cast<std::ptrdiff_t>(leaves));
    }
  }
  Decomposition found;
  for (const Wide l : load)
    found.load += l;
  found.borne = rest_of();
  return found;
}

// A funnel that is squeezed and sheared: its corner at the origin stays concave all round.
PolygonSoup sheared(PolygonSoup soup, Random& random) {
  const double a = random.uniform(0.5, 1.5), b = random.uniform(-0.5, 0.5), c = random.uniform(-0.3, 0.3),
               d = random.uniform(-0.3, 0.3), e = random.uniform(0.4, 2);
  for (Vec3& p : soup.points)
    p = {a * p.x + b * p.y + c * p.z, p.y + d * p.z, e * p.z};
  return soup;
}

}  // namespace

TEST_CASE("in a concave corner of any number of faces friction is Coulomb's by the sum of their loads") {
  Random random(8);
  int held = 0, slid = 0, at_faces = 0, at_edges = 0, at_apex = 0;
  for (const int faces : {3, 4, 5, 8, 16, 10000}) {
    for (int shape = 0; shape < (faces > 100 ? 1 : 6); ++shape) {
      const PolygonSoup soup = sheared(faces == 3 ? transformed(corner_pit(), random_rotation(1)) : cone_pit(faces), random);
      const std::vector<Point> normals = normals_at_origin(soup);
      REQUIRE(normals.size() >= static_cast<std::size_t>(faces));
      const PlainGraph graph(soup, Precision::f64);
      Point up = {0, 0, 0};
      for (const Point& n : normals)
        up = up + n * (1 / static_cast<Wide>(normals.size()));
      const Hip inward = {double(up.x), double(up.y), double(up.z)};
      const double mu_s = 0.5, mu_d = 0.3, size = 0.05;
      Contact landed(graph.view(), contact_params(mu_s, mu_d));
      landed.step(size * inward[0], size * inward[1], size * inward[2]);
      landed.step(-size * inward[0], -size * inward[1], -size * inward[2]);
      REQUIRE(landed.result.state == FDCG_VERTEX);
      REQUIRE(norm(landed.god_object()) == 0);
      for (int trial = 0; trial < (faces > 100 ? 200 : 400); ++trial) {
        // Pressed by a few of the faces, and pulled somewhere.
        Point t = {0, 0, 0};
        for (int k = 0; k < 3; ++k)
          t = t - normals[random.below(static_cast<std::uint32_t>(normals.size()))] *
                      Wide(random.uniform(0, size) * (trial % 3 == 0 && k > 1 ? 0 : 1));
        t = t + wide(point_of(random.direction())) * Wide(random.uniform(0, size));
        Decomposition reference = decompose(normals, t);
        const Wide pull = length(reference.borne);
        if (reference.load < 1e-4L) continue;
        // Half of the trials close to where slip begins.
        if (trial % 2 == 0 && pull > 1e-6L) {
          const Wide wanted = Wide(mu_s) * reference.load * (trial % 4 == 0 ? 1 - 1e-8L : 1 + 1e-8L);
          t = t + reference.borne * (wanted / pull - 1);
          reference.borne = reference.borne * (wanted / pull);
        }
        const Wide r = length(reference.borne);
        Contact contact = landed;
        contact.step(double(t.x), double(t.y), double(t.z));
        INFO(soup.name << ", trial " << trial << ": load " << double(reference.load) << ", pull " << double(r) << "; "
                       << contact.describe());
        (contact.result.state == FDCG_FACE ? at_faces : contact.result.state == FDCG_EDGE ? at_edges : at_apex) += 1;
        if (r <= Wide(mu_s) * reference.load) {
          ++held;
          REQUIRE(contact.result.slipping == 0);
          REQUIRE(norm(contact.god_object()) == 0);
          continue;
        }
        ++slid;
        const Point expected = reference.borne * (1 - Wide(mu_d) * reference.load / r);
        REQUIRE(contact.result.slipping == 1);
        REQUIRE(double(length(wide(contact.god_object()) - expected)) < 1e-11);
      }
    }
  }
  CHECK(held > 3000);
  CHECK(slid > 1500);
  CHECK(at_faces > 1000);
  CHECK(at_edges > 1000);
  CHECK(at_apex > 500);
}
