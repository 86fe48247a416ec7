// SPDX-License-Identifier: Apache-2.0
// Each repair on its own, what it leaves, and all of them on meshes with random defects. Over 400 lines: small meshes by hand,
// one beside the other, in the order of the steps.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "random.hpp"
#include "soups.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::Random;
using fdcg::test::reversed;

namespace {

RepairOptions all_safe() {
  RepairOptions options;
  options.weld = Weld{};
  options.drop_degenerate_faces = options.drop_duplicate_faces = options.split_non_manifold_vertices = true;
  options.orient = options.reverse_inside_out = true;
  options.jobs = 1;
  return options;
}

Repaired repaired(const PolygonSoup& soup, const RepairOptions& options) {
  const Result<Repaired> result = repair(soup, options);
  INFO((result ? std::string() : result.error().message));
  REQUIRE(result);
  const Repaired& r = *result;
  REQUIRE(r.soup.face_first.size() >= 1);
  REQUIRE(r.soup.face_first.back() == r.soup.corners.size());
  for (const std::uint32_t c : r.soup.corners)
    REQUIRE((c < r.soup.points.size() || c == PolygonSoup::kInvalidVertex));
  for (const RepairAction& action : r.actions) {
    CHECK(action.elements.size() == std::min<std::uint64_t>(action.total, kListedElements));
    CHECK(action.left_elements.size() == std::min<std::uint64_t>(action.left, kListedElements));
    CHECK(action.left_message.empty() == (action.left == 0));
    CHECK_FALSE(action.message.empty());
  }
  return r;
}

const RepairAction& action(const Repaired& r, std::string_view name) {
  const auto found = std::find_if(r.actions.begin(), r.actions.end(), [&](const RepairAction& a) { return a.name == name; });
  REQUIRE(found != r.actions.end());
  return *found;
}

std::map<std::string, std::uint64_t> totals(const Report& report) {
  std::map<std::string, std::uint64_t> result;
  for (const Issue& issue : report.issues)
    result[issue.rule] = issue.total;
  return result;
}
using Totals = std::map<std::string, std::uint64_t>;

std::vector<std::uint32_t> faces_of(const std::vector<Element>& elements) {
  std::vector<std::uint32_t> faces;
  for (const Element& element : elements)
    faces.push_back(element.faces.at(0));
  return faces;
}
std::vector<std::uint32_t> vertices_of(const std::vector<Element>& elements) {
  std::vector<std::uint32_t> vertices;
  for (const Element& element : elements)
    vertices.push_back(element.vertices.at(0));
  return vertices;
}

// Faces as loops of coordinates that start at their least corner, sorted: equal whatever the numbering.
using Loop = std::vector<std::array<double, 3>>;
std::vector<Loop> geometry(const PolygonSoup& soup) {
  std::vector<Loop> loops;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    Loop& loop = loops.emplace_back();
    for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
      const Vec3& p = soup.points[soup.corners[c]];
      loop.push_back({p.x + 0.0, p.y + 0.0, p.z + 0.0});
    }
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

PolygonSoup from_faces(const std::vector<Vec3>& points, const fdcg::test::Faces& faces) {
  return make_soup(points, faces);
}
fdcg::test::Faces faces_in(const PolygonSoup& soup) {
  fdcg::test::Faces faces;
  for (std::size_t f = 0; f < soup.face_count(); ++f)
    faces.emplace_back(soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
  return faces;
}

}  // namespace

TEST_CASE("a repair without any step is refused") {
  const Result<Repaired> result = repair(cube(), {});
  REQUIRE_FALSE(result);
  CHECK(result.error().exit_code == 2);
}

TEST_CASE("a clean mesh is unchanged, and every step reports no repairs") {
  for (const PolygonSoup& soup : {cube(), bumpy_sphere(12, 16), joined(cube({}, 4), reversed(cube({}, 2)))}) {
    const Repaired r = repaired(soup, all_safe());
    CHECK(r.actions.size() == 6);
    for (const RepairAction& a : r.actions) {
      CHECK(a.total == 0);
      CHECK(a.left == 0);
    }
    CHECK(r.soup.points == soup.points);
    CHECK(r.soup.corners == soup.corners);
    CHECK(r.soup.face_first == soup.face_first);
    CHECK(r.read_with == Weld::Kind::exact);
    CHECK(r.after.issues.empty());
  }
}

TEST_CASE("weld joins vertices at equal coordinates, or within a distance, to the first of them") {
  PolygonSoup soup =
      make_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -0.0, 0}, {1, 1, 0}, {0, 1.001, 0}}, {{0, 1, 2}, {3, 4, 5}});
  RepairOptions options;
  options.weld = Weld{};
  Repaired r = repaired(soup, options);
  CHECK(action(r, "weld").total == 1);
  CHECK(vertices_of(action(r, "weld").elements) == std::vector<std::uint32_t>{3});
  CHECK(faces_in(r.soup) == fdcg::test::Faces{{0, 1, 2}, {1, 3, 4}});
  options.weld = Weld{Weld::Kind::distance, 0.01};
  r = repaired(soup, options);
  CHECK(vertices_of(action(r, "weld").elements) == std::vector<std::uint32_t>{3, 5});
  CHECK(faces_in(r.soup) == fdcg::test::Faces{{0, 1, 2}, {1, 3, 2}});
  CHECK(r.soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  options.weld = Weld{Weld::Kind::none, 0};
  r = repaired(soup, options);
  CHECK(action(r, "weld").total == 0);
  CHECK(r.soup.points.size() == 6);
  CHECK(r.read_with == Weld::Kind::none);
  CHECK(totals(r.after)["boundary-edge"] == 6);
}

TEST_CASE("without a weld, equal vertices count as one but are written separately") {
  PolygonSoup soup = make_soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {9, 9, 9}},
                               {{0, 1, 2}, {3, 5, 4}, {0, 3, 5}});
  RepairOptions options;
  options.drop_duplicate_faces = options.orient = true;
  const Repaired r = repaired(soup, options);
  CHECK(action(r, "drop-duplicates").total == 1);
  CHECK(action(r, "orient").total == 1);
  CHECK(r.soup.points.size() == 7);  // all have faces still, but the last, which never had any
  CHECK(totals(r.after) == Totals{{"boundary-edge", 4}, {"isolated-vertex", 1}, {"duplicate-vertex", 2}});
  CHECK(r.read_with == Weld::Kind::exact);
}

TEST_CASE("faces that name a vertex twice are dropped, and polygons with spikes lose the spike") {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 5, 5}, {0.5, 0.5, 0}};
  RepairOptions options;
  options.drop_degenerate_faces = true;
  const auto faces_after = [&](const fdcg::test::Faces& faces) {
    const Repaired r = repaired(make_soup(points, faces), options);
    CHECK(action(r, "drop-degenerate").left == 0);
    CHECK(totals(r.after).count("degenerate-face") == 0);
    return geometry(r.soup);
  };
  const std::vector<Loop> square = geometry(make_soup(points, {{0, 1, 2, 3}}));
  CHECK(faces_after({{0, 1, 2, 3}, {0, 1, 1}, {0, 0, 0}, {4, 0, 4}, {2, 3}, {1}, {}}) == square);
  CHECK(faces_after({{0, 1, 1, 2, 3}}) == square);
  CHECK(faces_after({{0, 0, 1, 2, 3, 0}}) == square);
  CHECK(faces_after({{0, 1, 4, 1, 2, 3}}) == square);
  CHECK(faces_after({{4, 0, 1, 2, 3, 0}}) == square);
  CHECK(faces_after({{0, 4, 0, 1, 2, 3}}) == square);
  CHECK(faces_after({{0, 1, 4, 5, 4, 1, 2, 3}}) == square);
  CHECK(faces_after({{0, 1, 2, 3}, {0, 4, 0, 4}}) == square);
  // What only dropped faces had goes with them; what never had a face stays.
  const Repaired r = repaired(make_soup(points, {{0, 1, 2, 3}, {0, 4, 4}}), options);
  CHECK(r.soup.points.size() == 5);
  CHECK(totals(r.after)["isolated-vertex"] == 1);
}

TEST_CASE("a polygon with a bridge to its hole, or of two lobes, is left and reported") {
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}};
  RepairOptions options;
  options.drop_degenerate_faces = true;
  for (const auto& face : fdcg::test::Faces{{0, 1, 2, 3, 0, 4, 5, 6, 7, 4}, {0, 1, 2, 0, 4, 5}}) {
    const Repaired r = repaired(make_soup(points, {face}), options);
    CHECK(action(r, "drop-degenerate").total == 0);
    CHECK(faces_of(action(r, "drop-degenerate").left_elements) == std::vector<std::uint32_t>{0});
    CHECK(faces_in(r.soup) == fdcg::test::Faces{face});
    CHECK(totals(r.after)["degenerate-face"] == 1);
  }
}

TEST_CASE("a triangle without area between two faces is removed, and the opposite face is split") {
  // a 0, c 1, b 4 on the edge 0-1; faces below on the halves, above across the whole.
  const std::vector<Vec3> points{{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, -2, 0}, {1, 0, 0}};
  RepairOptions options;
  options.drop_degenerate_faces = true;
  for (const bool is_turned : {false, true}) {
    const std::vector<std::uint32_t> flat =
        is_turned ? std::vector<std::uint32_t>{1, 4, 0} : std::vector<std::uint32_t>{4, 1, 0};
    const Repaired r = repaired(make_soup(points, {{0, 1, 2}, flat, {0, 3, 4}, {4, 3, 1}}), options);
    const RepairAction& a = action(r, "drop-degenerate");
    CHECK(faces_of(a.elements) == std::vector<std::uint32_t>{1});
    CHECK(a.left == 0);
    CHECK(geometry(r.soup) == geometry(make_soup(points, {{4, 1, 2}, {0, 4, 2}, {0, 3, 4}, {4, 3, 1}})));
    CHECK(totals(r.after) == Totals{{"boundary-edge", 4}});
  }
  // A polygon gets the corner in its edge.
  const std::vector<Vec3> more{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}, {1, -2, 0}};
  const Repaired r = repaired(make_soup(more, {{0, 1, 2, 3}, {0, 4, 1}, {0, 5, 4}, {4, 5, 1}}), options);
  CHECK(geometry(r.soup) == geometry(make_soup(more, {{0, 4, 1, 2, 3}, {0, 5, 4}, {4, 5, 1}})));
  CHECK(totals(r.after) == Totals{{"boundary-edge", 5}});
}

TEST_CASE("chains and pairs of triangles without area are removed") {
  // Vertices 0 .. 4 on a line; a strip below on its four parts, one triangle above on the whole.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {2, 4, 0}, {2, -4, 0}};
  const fdcg::test::Faces below{{0, 6, 1}, {1, 6, 2}, {2, 6, 3}, {3, 6, 4}};
  RepairOptions options;
  options.drop_degenerate_faces = true;
  for (const auto& flat : std::vector<fdcg::test::Faces>{
           {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}}, {{2, 3, 4}, {0, 1, 4}, {1, 2, 4}}, {{0, 1, 2}, {0, 2, 4}, {2, 3, 4}}}) {
    fdcg::test::Faces faces = below;
    faces.insert(faces.end(), flat.begin(), flat.end());
    faces.push_back({0, 4, 5});
    const Repaired r = repaired(make_soup(points, faces), options);
    CHECK(action(r, "drop-degenerate").total == 3);
    CHECK(action(r, "drop-degenerate").left == 0);
    CHECK(totals(r.after) == Totals{{"boundary-edge", 4}});
  }
  // Two back to back: 1 and 3 on either side of the edge 0-4.
  const fdcg::test::Faces pair{{0, 6, 1}, {1, 6, 4}, {0, 1, 4}, {0, 4, 3}, {0, 3, 5}, {3, 4, 5}};
  const Repaired r = repaired(make_soup(points, pair), options);
  CHECK(action(r, "drop-degenerate").total == 2);
  CHECK(action(r, "drop-degenerate").left == 0);
  CHECK(totals(r.after) == Totals{{"boundary-edge", 4}, {"isolated-vertex", 1}});
}

TEST_CASE("a face without area at the border is removed unless it alone connects its neighbours") {
  const std::vector<Vec3> points{{0, 0, 0}, {2, 0, 0}, {1, -2, 0}, {1, 0, 0}, {0, -2, 0}, {2, -2, 0}};
  RepairOptions options;
  options.drop_degenerate_faces = true;
  const Repaired whole = repaired(make_soup(points, {{0, 2, 3}, {3, 2, 1}, {0, 3, 1}}), options);
  CHECK(action(whole, "drop-degenerate").total == 1);
  CHECK(totals(whole.after) == Totals{{"boundary-edge", 4}, {"isolated-vertex", 2}});
  const Repaired bridge = repaired(make_soup(points, {{0, 4, 3}, {3, 5, 1}, {0, 3, 1}}), options);
  CHECK(action(bridge, "drop-degenerate").total == 0);
  CHECK(faces_of(action(bridge, "drop-degenerate").left_elements) == std::vector<std::uint32_t>{2});
  CHECK(totals(bridge.after).count("non-manifold-vertex") == 0);
}

TEST_CASE("a face without area at an edge of three faces is left and reported, until a copy is dropped") {
  const std::vector<Vec3> points{{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0, 2}, {1, -2, 0}, {1, 0, 0}};
  const fdcg::test::Faces faces{{0, 1, 2}, {0, 1, 3}, {0, 5, 1}, {0, 4, 5}, {5, 4, 1}};
  RepairOptions options;
  options.drop_degenerate_faces = true;
  Repaired r = repaired(make_soup(points, faces), options);
  CHECK(action(r, "drop-degenerate").total == 0);
  CHECK(action(r, "drop-degenerate").left == 1);
  fdcg::test::Faces doubled = faces;
  doubled[1] = {1, 0, 2};
  r = repaired(make_soup(points, doubled), options);
  CHECK(action(r, "drop-degenerate").left == 1);
  options.drop_duplicate_faces = true;
  r = repaired(make_soup(points, doubled), options);
  CHECK(action(r, "drop-degenerate").total == 1);
  CHECK(action(r, "drop-degenerate").left == 0);
  CHECK(action(r, "drop-duplicates").total == 1);
  CHECK(totals(r.after) == Totals{{"boundary-edge", 4}, {"isolated-vertex", 1}});
}

TEST_CASE("of duplicate faces the first is kept; polygons in another order are left and reported") {
  PolygonSoup soup = cube();
  const fdcg::test::Faces clean = faces_in(soup);
  fdcg::test::Faces faces = clean;
  faces.push_back({2, 3, 1, 0});  // rotated
  faces.push_back({6, 7, 5, 4});  // reversed
  faces.push_back({0, 5, 1, 4});  // face 2's vertices, crossing
  faces.push_back({5, 1, 4, 0});  // that again
  RepairOptions options;
  options.drop_duplicate_faces = true;
  const Repaired r = repaired(from_faces(soup.points, faces), options);
  CHECK(faces_of(action(r, "drop-duplicates").elements) == std::vector<std::uint32_t>{6, 7, 9});
  CHECK(faces_of(action(r, "drop-duplicates").left_elements) == std::vector<std::uint32_t>{8});
  fdcg::test::Faces expected = clean;
  expected.push_back({0, 5, 1, 4});
  CHECK(faces_in(r.soup) == expected);
}

TEST_CASE("each fan gets its own vertex, and the file must then be read without a weld") {
  // Three cubes in a row that meet at corners, their vertices given separately.
  const PolygonSoup soup = joined(joined(cube({0, 0, 0}), cube({2, 2, 2})), cube({4, 4, 4}));
  RepairOptions options;
  options.split_non_manifold_vertices = true;
  const Repaired r = repaired(soup, options);
  CHECK(action(r, "weld").total == 2);  // implied
  CHECK(vertices_of(action(r, "split-non-manifold-vertices").elements) == std::vector<std::uint32_t>{7, 15});
  CHECK(r.soup.points.size() == 24);
  CHECK(geometry(r.soup) == geometry(soup));
  CHECK(r.read_with == Weld::Kind::none);
  CHECK(r.after.passes());
  Totals after = totals(r.after);
  after.erase("self-intersection");  // the parts still touch there
  CHECK(after.empty());
  CHECK(totals(r.before) == Totals{{"non-manifold-vertex", 2}, {"duplicate-vertex", 2}});
  // The same, of vertices that are one in the file.
  PolygonSoup pinched = joined(cube({0, 0, 0}), cube({2, 2, 2}));
  for (std::uint32_t& c : pinched.corners)
    if (c == 8) c = 7;
  CHECK(action(repaired(pinched, options), "split-non-manifold-vertices").total == 1);
}

TEST_CASE("orient repairs mixed winding only, reverse-inside-out whole patches only") {
  PolygonSoup soup = joined(cube({0, 0, 0}), reversed(cube({9, 0, 0})));
  std::reverse(soup.corners.begin() + 4, soup.corners.begin() + 8);  // face 1
  RepairOptions orient_only, reverse_only;
  orient_only.orient = true;
  reverse_only.reverse_inside_out = true;
  const Repaired a = repaired(soup, orient_only);
  CHECK(faces_of(action(a, "orient").elements) == std::vector<std::uint32_t>{1});
  CHECK(totals(a.after) == Totals{{"inside-out", 1}});
  const Repaired b = repaired(soup, reverse_only);
  CHECK(faces_of(action(b, "reverse-inside-out").elements) == std::vector<std::uint32_t>{6});
  CHECK(totals(b.after) == Totals{{"winding-inconsistent", 4}});
  const Repaired both = repaired(soup, all_safe());
  CHECK(both.after.issues.empty());
  // A cavity is no part inside out.
  CHECK(action(repaired(joined(cube({}, 4), reversed(cube({}, 2))), all_safe()), "reverse-inside-out").total == 0);
}

TEST_CASE("a patch that cannot be made consistent is left and reported") {
  std::vector<Vec3> points;
  for (int i = 0; i < 5; ++i)
    points.push_back({i * 1.0, i * i * 1.0, i * i * i * 1.0});
  const PolygonSoup strip = make_soup(points, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}});
  const Repaired r = repaired(strip, all_safe());
  CHECK(action(r, "orient").total == 0);
  CHECK(faces_of(action(r, "orient").left_elements) == std::vector<std::uint32_t>{0});
  CHECK(r.soup.corners == strip.corners);
  CHECK_FALSE(r.after.passes());
}

TEST_CASE("parts keep their faces, and elements their lines and parts") {
  PolygonSoup soup = joined(cube({0, 0, 0}), cube({9, 0, 0}));
  fdcg::test::Faces faces = faces_in(soup);
  faces.insert(faces.begin() + 3, {0, 1, 1});
  faces.insert(faces.begin() + 8, {3, 1, 0, 2});  // face 0 again
  soup = make_soup(soup.points, faces);
  soup.is_text = true;
  for (std::uint32_t f = 0; f < soup.face_count(); ++f)
    soup.face_line.push_back(100 + f);
  soup.parts = {{"first", 0, 0}, {"second", 7, 0}};
  const Repaired r = repaired(soup, all_safe());
  REQUIRE(r.soup.parts.size() == 2);
  CHECK(r.soup.parts[0].first_face == 0);
  CHECK(r.soup.parts[1].first_face == 6);
  const RepairAction& dropped = action(r, "drop-duplicates");
  REQUIRE(dropped.elements.size() == 1);
  CHECK(dropped.elements[0].faces == std::vector<std::uint32_t>{8});
  CHECK(dropped.elements[0].line == 108);
  CHECK(dropped.elements[0].part == "second");
  CHECK(r.soup.face_line.empty());
  CHECK_FALSE(r.soup.is_text);
}

TEST_CASE("defects that no step repairs are kept: NaN, missing vertices, edges of three faces") {
  PolygonSoup soup = cube();
  soup.points.push_back({std::nan(""), 0, 0});
  fdcg::test::Faces faces = faces_in(soup);
  faces.push_back({0, 1, PolygonSoup::kInvalidVertex});
  faces.push_back({8, 0, 1});
  soup = make_soup(soup.points, faces);
  const Repaired r = repaired(soup, all_safe());
  CHECK(faces_in(r.soup) == faces);
  CHECK(totals(r.after) == totals(r.before));
  CHECK_FALSE(r.after.passes());
}

// ---- random defects

namespace {

// Coordinates on a grid, so that the middle of an edge lies on it exactly.
PolygonSoup on_grid(PolygonSoup soup) {
  for (Vec3& p : soup.points)
    p = {std::round(p.x * 0x1p20) * 0x1p-20, std::round(p.y * 0x1p20) * 0x1p-20, std::round(p.z * 0x1p20) * 0x1p-20};
  return soup;
}

struct Injected {
  PolygonSoup soup;
  std::vector<Loop> expected;  // the geometry that repair gives
  std::uint64_t unwelded = 0, flat = 0, repeated = 0, copies = 0, pinched = 0;
  bool is_mixed = false, is_reversed = false;
};

class Injector {
 public:
  Injector(const PolygonSoup& clean, Random& random) : random_(random), points_(clean.points), faces_(faces_in(clean)) {}

  Injected run() {
    is_touched_.assign(points_.size(), false);
    pinch(random_.below(4));
    insert_flat_faces(random_.below(6));
    out_.expected = geometry(make_soup(points_, expected_faces()));
    reverse_some();
    for (std::uint32_t n = random_.below(5); n > 0; --n)
      copy_face();
    for (std::uint32_t n = random_.below(5); n > 0; --n)
      repeat_corner();
    for (std::size_t i = faces_.size(); i > 1; --i)
      std::swap(faces_[i - 1], faces_[random_.below(static_cast<std::uint32_t>(i))]);
    unweld();
    out_.soup = make_soup(points_, faces_);
    return std::move(out_);
  }

 private:
  std::set<std::uint32_t> neighbours(std::uint32_t v) const {
    std::set<std::uint32_t> result;
    for (const auto& face : faces_) {
      if (std::find(face.begin(), face.end(), v) != face.end()) result.insert(face.begin(), face.end());
    }
    return result;
  }
  bool is_free(const std::set<std::uint32_t>& vertices) const {
    return std::none_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) { return is_touched_[v]; });
  }
  void touch(const std::set<std::uint32_t>& vertices) {
    for (const std::uint32_t v : vertices)
      is_touched_[v] = true;
  }

  // Moves a vertex onto another that has no neighbour in common, and makes them one.
  void pinch(std::uint32_t count) {
    for (std::uint32_t attempt = 0; attempt < 50 && out_.pinched < count; ++attempt) {
      const std::uint32_t v = random_.below(static_cast<std::uint32_t>(points_.size()));
      const std::uint32_t w = random_.below(static_cast<std::uint32_t>(points_.size()));
      std::set<std::uint32_t> both = neighbours(v);  // empty of one that was moved onto another
      const std::set<std::uint32_t> other = neighbours(w);
      const bool are_apart = std::none_of(other.begin(), other.end(), [&](std::uint32_t n) { return both.count(n) != 0; });
      const bool is_alone = both.empty() || other.empty();
      both.insert(other.begin(), other.end());
      if (v == w || is_alone || !are_apart || !is_free(both)) continue;
      touch(both);
      for (auto& face : faces_)
        std::replace(face.begin(), face.end(), v, w);
      ++out_.pinched;
    }
  }

  // Cuts a triangle at the middle of an edge, and fills the slit to the other side with a triangle of no area.
  void insert_flat_faces(std::uint32_t count) {
    for (std::uint32_t attempt = 0; attempt < 50 && out_.flat < count; ++attempt) {
      const auto f = random_.below(static_cast<std::uint32_t>(faces_.size()));
      const std::uint32_t a = faces_[f][0], c = faces_[f][1], d = faces_[f][2];
      std::uint32_t across = 0, apex = 0;
      for (std::uint32_t g = 0; g < faces_.size(); ++g) {
        for (std::size_t k = 0; k < 3; ++k) {
          if (faces_[g][k] != c || faces_[g][(k + 1) % 3] != a) continue;
          across = g;
          apex = faces_[g][(k + 2) % 3];
        }
      }
      std::set<std::uint32_t> used{a, c, d, apex};
      if (!is_free(used)) continue;
      touch(used);
      const auto b = static_cast<std::uint32_t>(points_.size());
      const Vec3 &p = points_[a], &q = points_[c];
      points_.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
      is_touched_.push_back(true);
      faces_[f] = {a, b, d};
      faces_.push_back({b, c, d});
      faces_.push_back({a, c, b});
      cut_.push_back({across, {c, b, apex}, {b, a, apex}, static_cast<std::uint32_t>(faces_.size() - 1)});
      ++out_.flat;
    }
  }
  struct Cut {
    std::uint32_t face;  // that repair is to cut in two
    std::vector<std::uint32_t> first, second;
    std::uint32_t flat;
  };
  fdcg::test::Faces expected_faces() const {
    fdcg::test::Faces faces = faces_;
    for (const Cut& cut : cut_) {
      faces[cut.face] = cut.first;
      faces[cut.flat] = cut.second;
    }
    return faces;
  }

  void reverse_some() {
    out_.is_reversed = random_.chance(0.3);
    if (out_.is_reversed) {
      for (auto& face : faces_)
        std::reverse(face.begin(), face.end());
    }
    for (std::uint32_t n = random_.below(8); n > 0; --n) {
      auto& face = faces_[random_.below(static_cast<std::uint32_t>(faces_.size()))];
      std::reverse(face.begin(), face.end());
      out_.is_mixed = true;
    }
  }
  void copy_face() {
    auto face = faces_[random_.below(static_cast<std::uint32_t>(faces_.size()))];
    std::rotate(face.begin(), face.begin() + random_.below(3), face.end());
    if (random_.chance(0.5)) {
      std::reverse(face.begin(), face.end());
      out_.is_mixed = true;  // it may come to stand first, and is kept then
    }
    faces_.push_back(face);
    ++out_.copies;
  }
  void repeat_corner() {
    const std::uint32_t a = faces_[random_.below(10)][0], b = faces_[random_.below(10)][1];
    faces_.push_back({a, b, random_.chance(0.5) ? a : b});
    ++out_.repeated;
  }
  void unweld() {
    for (auto& face : faces_) {
      for (std::uint32_t& corner : face) {
        if (!random_.chance(0.02)) continue;
        points_.push_back(Vec3(points_[corner]));
        corner = static_cast<std::uint32_t>(points_.size() - 1);
        ++out_.unwelded;
      }
    }
  }

  Random& random_;
  std::vector<Vec3> points_;
  fdcg::test::Faces faces_;
  std::vector<bool> is_touched_;
  std::vector<Cut> cut_;
  Injected out_;
};

}  // namespace

TEST_CASE("random defects are undone, counted, and nothing else changes") {
  const char* asked = std::getenv("FDCG_REPAIR_ROUNDS");
  const int rounds = asked != nullptr ? std::atoi(asked) : 150;
  std::uint64_t flat = 0, pinched = 0;
  for (int round = 0; round < rounds; ++round) {
    Random random(static_cast<std::uint64_t>(round));
    INFO("round " << round);
    const PolygonSoup clean = on_grid(bumpy_sphere(6 + random.below(10), 8 + random.below(12)));
    const Injected injected = Injector(clean, random).run();
    flat += injected.flat;
    pinched += injected.pinched;
    const Repaired r = repaired(injected.soup, all_safe());
    // A vertex that only copies named has been joined all the same; one that a pinch left alone stays.
    CHECK(action(r, "weld").total == injected.unwelded);
    CHECK(action(r, "drop-degenerate").total + action(r, "drop-duplicates").total ==
          injected.flat + injected.repeated + injected.copies);
    CHECK(action(r, "drop-degenerate").total >= injected.flat + injected.repeated);
    CHECK(action(r, "split-non-manifold-vertices").total == injected.pinched);
    if (!injected.is_mixed) CHECK(action(r, "reverse-inside-out").total == (injected.is_reversed ? 1 : 0));
    for (const RepairAction& a : r.actions)
      CHECK(a.left == 0);
    CHECK(geometry(r.soup) == injected.expected);
    CHECK(r.read_with == (injected.pinched > 0 ? Weld::Kind::none : Weld::Kind::exact));
    CHECK(r.after.passes());
    CHECK(totals(r.after).count("boundary-edge") == 0);
  }
  CHECK(flat > static_cast<std::uint64_t>(rounds));
  CHECK(pinched > static_cast<std::uint64_t>(rounds) / 2);
}
