// SPDX-License-Identifier: Apache-2.0
// Self-intersections against CGAL: its self_intersections on manifold triangle meshes, its box_self_intersection_d with its
// exact predicates elsewhere, and the exactly constructed intersection of each pair for how the two meet. FDCG_PAIR_SEEDS sets
// how many random soups are tried (default 300), FDCG_PAIR_BYTES up to which size real files are (default 1,000,000).
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/parallel.hpp"
#include "catch.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "real_files.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"
#include "validate/self_intersection.hpp"

using namespace fdcg::bake;
using fdcg::test::Random;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Pairs = std::vector<Pair>;
using Triple = std::array<std::uint32_t, 3>;

std::uint64_t setting(const char* name, std::uint64_t otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? std::strtoull(value, nullptr, 10) : otherwise;
}

// A welded mesh with what the search needs to know of it.
struct Subject {
  Mesh mesh;
  FaceGeometry geometry;
  Topology topology;
  explicit Subject(const PolygonSoup& soup, Weld weld = {})
      : mesh(weld_points(soup, weld, Precision::f64, 1)), geometry(mesh, face_states(mesh)), topology(pair_halfedges(mesh)) {}

  [[nodiscard]] SelfIntersections found(unsigned jobs = 2) const {
    const SelfIntersections plain = find_self_intersections(mesh, geometry, {kAllElements, jobs, {}});
    SelfIntersections found = find_self_intersections(mesh, geometry, {kAllElements, jobs, {}, &topology});
    const auto is_same = [](const MeetingFaces& p, const MeetingFaces& q) {
      return p.a == q.a && p.b == q.b && p.contact == q.contact;
    };
    CHECK(std::equal(plain.listed.begin(), plain.listed.end(), found.listed.begin(), found.listed.end(), is_same));
    CHECK(std::pair(plain.crossing, plain.touching) == std::pair(found.crossing, found.touching));
    return found;
  }
  [[nodiscard]] bool takes_part(std::uint32_t f) const {
    return geometry.is_finite(FaceId{f}) && !geometry.is_degenerate(FaceId{f});
  }
  [[nodiscard]] Triple corners(std::uint32_t f) const {
    const std::uint32_t h = mesh.face_first[f];
    return {+mesh.corners[h], +mesh.corners[h + 1], +mesh.corners[h + 2]};
  }
  template <class K>
  [[nodiscard]] typename K::Point_3 point(std::uint32_t v) const {
    return {mesh.points[v].x, mesh.points[v].y, mesh.points[v].z};
  }
  template <class K>
  [[nodiscard]] typename K::Triangle_3 triangle(std::uint32_t f) const {
    const Triple c = corners(f);
    return {point<K>(c[0]), point<K>(c[1]), point<K>(c[2])};
  }
};

Pairs pairs_of(const SelfIntersections& found) {
  Pairs pairs;
  for (const MeetingFaces& pair : found.listed)
    pairs.emplace_back(+pair.a, +pair.b);
  return pairs;
}

// ---- CGAL's self_intersections

// None where the mesh is not manifold and so cannot be had as a surface.
std::optional<Surface> surface_of(const Subject& subject) {
  Surface surface;
  for (std::uint32_t v = 0; v < subject.mesh.points.size(); ++v) {
    const Vec3& p = subject.mesh.points[v];
    surface.add_vertex(std::isfinite(p.x + p.y + p.z) ? subject.point<Kernel>(v) : Kernel::Point_3(0, 0, 0));
  }
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (!subject.takes_part(f)) return std::nullopt;  // the numbers of the faces must stay
    const Triple c = subject.corners(f);
    if (surface.add_face(Surface::Vertex_index(c[0]), Surface::Vertex_index(c[1]), Surface::Vertex_index(c[2])) ==
        Surface::null_face())
      return std::nullopt;
  }
  return surface;
}

Pairs pairs_by_surface(const Surface& surface) {
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> out;
  CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(surface, std::back_inserter(out));
  Pairs pairs;
  for (const auto& [a, b] : out) {
    if (a != b) pairs.push_back(std::minmax<std::uint32_t>(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// ---- any soup of triangles, by boxes and predicates

std::vector<std::uint32_t> shared_corners(const Triple& a, const Triple& b) {
  std::vector<std::uint32_t> shared;
  for (const std::uint32_t v : a) {
    if (std::find(b.begin(), b.end(), v) != b.end()) shared.push_back(v);
  }
  return shared;
}

bool meet_by_predicates(const Subject& subject, std::uint32_t f, std::uint32_t g) {
  const Triple a = subject.corners(f), b = subject.corners(g);
  const std::vector<std::uint32_t> shared = shared_corners(a, b);
  const auto others = [&](const Triple& t) {
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t v : t) {
      if (std::find(shared.begin(), shared.end(), v) == shared.end()) rest.push_back(v);
    }
    return rest;
  };
  const auto point = [&](std::uint32_t v) { return subject.point<Kernel>(v); };
  if (shared.size() == 3) return true;
  if (shared.size() == 2) {
    const auto u = point(shared[0]), v = point(shared[1]), p = point(others(a)[0]), q = point(others(b)[0]);
    return CGAL::coplanar(u, v, p, q) && CGAL::coplanar_orientation(u, v, p, q) == CGAL::POSITIVE;
  }
  const auto s = subject.triangle<Kernel>(f), t = subject.triangle<Kernel>(g);
  if (shared.empty()) return CGAL::do_intersect(s, t);
  const Kernel::Segment_3 in_s(point(others(a)[0]), point(others(a)[1])), in_t(point(others(b)[0]), point(others(b)[1]));
  return CGAL::do_intersect(s, in_t) || CGAL::do_intersect(t, in_s);
}

Pairs pairs_by_boxes(const Subject& subject) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
  std::vector<Box> boxes;
  for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
    if (subject.takes_part(f)) boxes.emplace_back(subject.triangle<Kernel>(f).bbox(), f);
  }
  Pairs pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    if (meet_by_predicates(subject, a.info(), b.info())) pairs.push_back(std::minmax(a.info(), b.info()));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// ---- how two triangles meet, by constructing what they have in common

bool is_strictly_inside(const Exact::Triangle_3& t, const Exact::Point_3& p) {
  const Exact::Vector_3 n = CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
  for (int i = 0; i < 3; ++i) {
    if (CGAL::cross_product(t[i + 1] - t[i], p - t[i]) * n <= 0) return false;
  }
  return true;
}

#if CGAL_VERSION_MAJOR >= 6
using std::get_if;
#else
template <class Shape, class Variant>
const Shape* get_if(const Variant* variant) {
  return boost::get<Shape>(variant);
}
#endif

struct Corners {
  std::vector<Exact::Point_3> points;
  void operator()(const Exact::Point_3& p) { points = {p}; }
  void operator()(const Exact::Segment_3& s) { points = {s.source(), s.target()}; }
  void operator()(const Exact::Triangle_3& t) { points = {t[0], t[1], t[2]}; }
  void operator()(const std::vector<Exact::Point_3>& polygon) { points = polygon; }
};

Contact contact_by_construction(const Subject& subject, std::uint32_t f, std::uint32_t g) {
  const auto s = subject.triangle<Exact>(f), t = subject.triangle<Exact>(g);
  const auto common = CGAL::intersection(s, t);
  if (!common) return Contact::none;
  Corners corners;
  if (const auto* p = get_if<Exact::Point_3>(&*common)) corners(*p);
  if (const auto* p = get_if<Exact::Segment_3>(&*common)) corners(*p);
  if (const auto* p = get_if<Exact::Triangle_3>(&*common)) corners(*p);
  if (const auto* p = get_if<std::vector<Exact::Point_3>>(&*common)) corners(*p);
  Exact::Vector_3 sum(0, 0, 0);
  bool all_shared = corners.points.size() <= 2;
  const std::vector<std::uint32_t> shared = shared_corners(subject.corners(f), subject.corners(g));
  for (const Exact::Point_3& p : corners.points) {
    sum = sum + (p - CGAL::ORIGIN);
    all_shared =
        all_shared && std::any_of(shared.begin(), shared.end(), [&](std::uint32_t v) { return subject.point<Exact>(v) == p; });
  }
  if (all_shared) return Contact::none;
  const Exact::Point_3 middle = CGAL::ORIGIN + sum / static_cast<double>(corners.points.size());
  return is_strictly_inside(s, middle) && is_strictly_inside(t, middle) ? Contact::crossing : Contact::touching;
}

void check_kinds(const Subject& subject, const SelfIntersections& found, std::size_t most) {
  std::uint64_t crossing = 0;
  const std::size_t stride = found.listed.size() / most + 1;
  for (std::size_t i = 0; i < found.listed.size(); ++i) {
    const MeetingFaces& pair = found.listed[i];
    crossing += pair.contact == Contact::crossing;
    if (i % stride != 0) continue;
    INFO("faces " << +pair.a << " and " << +pair.b);
    CHECK(pair.contact == contact_by_construction(subject, +pair.a, +pair.b));
  }
  CHECK(found.crossing == crossing);
  CHECK(found.crossing + found.touching == found.listed.size());
}

// Few and small whole coordinates, so that corners lie on edges, edges on edges and faces in one plane again and again.
PolygonSoup random_soup(Random& random) {
  const std::uint32_t points = 6 + random.below(12), faces = 4 + random.below(20), side = 2 + random.below(4);
  const bool is_flat = random.chance(0.2);
  std::vector<Vec3> coordinates;
  for (std::uint32_t i = 0; i < points; ++i) {
    coordinates.push_back({static_cast<double>(random.below(side)), static_cast<double>(random.below(side)),
                           is_flat ? 0.0 : static_cast<double>(random.below(side))});
  }
  std::vector<fdcg::test::Polygon> loops;
  for (std::uint32_t f = 0; f < faces; ++f)
    loops.push_back({random.below(points), random.below(points), random.below(points)});
  return fdcg::test::make_soup("random", coordinates, loops);
}

}  // namespace

TEST_CASE("self-intersection: pairs and contact types on random soups equal an exact construction") {
  const std::uint64_t seeds = setting("FDCG_PAIR_SEEDS", 300);
  std::map<Contact, std::size_t> seen;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const Subject subject(random_soup(random), {random.chance(0.8) ? Weld::Kind::exact : Weld::Kind::none, 0});
    std::map<Pair, Contact> expected;
    for (std::uint32_t f = 0; f < subject.mesh.face_count(); ++f) {
      for (std::uint32_t g = f + 1; g < subject.mesh.face_count(); ++g) {
        if (!subject.takes_part(f) || !subject.takes_part(g)) continue;
        const Contact contact = contact_by_construction(subject, f, g);
        ++seen[contact];
        if (contact != Contact::none) expected[{f, g}] = contact;
      }
    }
    std::map<Pair, Contact> found;
    for (const MeetingFaces& pair : subject.found().listed)
      found[{+pair.a, +pair.b}] = pair.contact;
    CHECK(found == expected);
  }
  for (const Contact contact : {Contact::none, Contact::touching, Contact::crossing})
    CHECK(seen[contact] > seeds);
}

TEST_CASE("on generated meshes the pairs are those of CGAL's self_intersections") {
  const auto check = [](const PolygonSoup& soup, bool has_pairs) {
    INFO(soup.name);
    const Subject subject(soup);
    const auto surface = surface_of(subject);
    REQUIRE(surface.has_value());
    const SelfIntersections found = subject.found();
    CHECK(pairs_of(found) == pairs_by_surface(*surface));
    CHECK(found.listed.empty() != has_pairs);
    check_kinds(subject, found, 300);
  };
  check(fdcg::test::ico_sphere(5), false);
  check(fdcg::test::star_sphere(5, 0.3, 3), false);
  check(fdcg::test::torus(200, 60), false);
  check(fdcg::test::torus(60, 40, 1.2), true);  // a tube too thick for its ring
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    PolygonSoup soup = fdcg::test::ico_sphere(4);
    Random random(seed);
    for (Vec3& p : soup.points)
      p = {p.x + random.uniform(-0.1, 0.1), p.y + random.uniform(-0.1, 0.1), p.z + random.uniform(-0.1, 0.1)};
    check(soup, true);
  }
}

TEST_CASE("on real triangle meshes the pairs are those of CGAL") {
  const std::uintmax_t largest = setting("FDCG_PAIR_BYTES", 1'000'000);
  std::size_t manifold = 0, others = 0, pairs = 0;
  for (const std::filesystem::path& path : fdcg::test::real_mesh_files()) {
    if (std::filesystem::file_size(path) > largest) continue;
    const auto soup = import_mesh(path);
    if (!soup) continue;
    const Subject subject(*soup);
    if (!subject.geometry.has_triangles_only()) continue;
    INFO(path);
    const SelfIntersections found = subject.found();
    const auto surface = surface_of(subject);
    const Pairs expected = surface ? pairs_by_surface(*surface) : pairs_by_boxes(subject);
    CHECK((pairs_of(found) == expected));
    CHECK(found.listed.size() == expected.size());
    check_kinds(subject, found, 200);
    ++(surface ? manifold : others);
    pairs += expected.size();
  }
  WARN(manifold << " manifold meshes and " << others << " others found, " << pairs << " pairs");
}
