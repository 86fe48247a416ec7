// SPDX-License-Identifier: Apache-2.0
// Where a finding is, in the source's own terms, and what stays of it when the file changes elsewhere.
#include "validate/findings.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "catch.hpp"
#include "soups.hpp"
#include "validate/validate.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::Faces;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::reversed;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Report full(const PolygonSoup& soup, const ValidateOptions& changed = {}) {
  ValidateOptions options = changed;
  options.max_elements = kAllElements;
  return validate(soup, options);
}

const Issue* find(const Report& report, const std::string& rule) {
  const auto found = std::find_if(report.issues.begin(), report.issues.end(), [&](const Issue& i) { return i.rule == rule; });
  return found == report.issues.end() ? nullptr : &*found;
}

using Prints = std::map<std::string, std::multiset<std::uint64_t>>;

Prints fingerprints(const Report& report) {
  Prints prints;
  for (const Issue& issue : report.issues)
    for (const Element& element : issue.elements)
      prints[issue.rule].insert(element.fingerprint);
  return prints;
}

// One finding of nearly every rule.
PolygonSoup defective() {
  PolygonSoup soup = joined(bumpy_sphere(6, 8), reversed(cube({5, 0, 0})));
  const auto push_face = [&](std::vector<std::uint32_t> face) {
    soup.corners.insert(soup.corners.end(), face.begin(), face.end());
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  };
  push_face({3, 4, 4});
  push_face({soup.corners[0], soup.corners[1], soup.corners[2]});
  push_face({1, 9, PolygonSoup::kInvalidVertex});
  push_face({2, 10, 20});
  push_face({2, 10, 30});
  soup.points.push_back({kNan, 1, 2});
  soup.points.push_back({-0.0, 20, 2});
  soup.points.push_back({0.0, 20, 2});
  soup.points.push_back({1, 20, 2});
  soup.points.push_back({0, 21, 2.5});
  soup.points.push_back({1, 21, 2});
  const auto last = static_cast<std::uint32_t>(soup.points.size() - 1);
  push_face({last - 5, last, last - 1});
  push_face({last - 4, last - 2, last, last - 1});
  return soup;
}

// The same faces in another order on points in another order, every loop starting elsewhere.
PolygonSoup renumbered(const PolygonSoup& soup, std::mt19937& rng) {
  std::vector<std::uint32_t> point(soup.points.size()), face(soup.face_count());
  for (std::uint32_t i = 0; i < point.size(); ++i)
    point[i] = i;
  for (std::uint32_t i = 0; i < face.size(); ++i)
    face[i] = i;
  std::shuffle(point.begin(), point.end(), rng);
  std::shuffle(face.begin(), face.end(), rng);
  std::vector<Vec3> points(soup.points.size());
  for (std::size_t i = 0; i < point.size(); ++i)
    points[point[i]] = soup.points[i];
  Faces faces;
  for (const std::uint32_t f : face) {
    auto& loop = faces.emplace_back();
    for (std::uint32_t h = soup.face_first[f]; h < soup.face_first[f + 1]; ++h)
      loop.push_back(soup.corners[h] == PolygonSoup::kInvalidVertex ? soup.corners[h] : point[soup.corners[h]]);
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(rng() % loop.size()), loop.end());
  }
  return make_soup(std::move(points), faces);
}

}  // namespace

TEST_CASE("fingerprints do not change when a file is renumbered") {
  const Prints before = fingerprints(full(defective()));
  CHECK(before.size() >= 9);
  std::mt19937 rng(20);
  for (int round = 0; round < 50; ++round) {
    CAPTURE(round);
    CHECK(fingerprints(full(renumbered(defective(), rng))) == before);
  }
}

TEST_CASE("fingerprints do not change when a file changes elsewhere, and distinguish findings") {
  const Prints before = fingerprints(full(defective()));
  const Prints after = fingerprints(full(joined(defective(), cube({100, 0, 0}))));
  CHECK(after == before);
  PolygonSoup moved = defective();
  for (Vec3& p : moved.points)
    p.y += 0x1p-10;
  for (const auto& [rule, prints] : fingerprints(full(moved))) {
    CAPTURE(rule);
    for (const std::uint64_t print : prints)
      CHECK(before.at(rule).count(print) == 0);
  }
  std::set<std::uint64_t> distinct;  // rules at the same place do not share one
  for (const auto& [rule, prints] : before)
    for (const std::uint64_t print : std::set<std::uint64_t>(prints.begin(), prints.end()))
      CHECK(distinct.insert(print).second);
}

TEST_CASE("a fingerprint is the same on every machine") {
  CHECK(Fingerprint("boundary-edge").value() != Fingerprint("empty-mesh").value());
  Fingerprint a("boundary-edge"), b("boundary-edge");
  a.add({1, -0.0, kNan});
  a.add({2, 0.5, -3});
  b.add({2, 0.5, -3});
  b.add({1, 0.0, -kNan});
  CHECK(a.value() == b.value());
  CHECK(a.value() == 0x2821FCEF8F1EE1FBULL);
  b.add_missing_corner();
  CHECK(a.value() != b.value());
}

TEST_CASE("every face is kept or listed") {
  std::mt19937 rng(21);
  const auto below = [&](std::size_t n) { return static_cast<std::uint32_t>(rng() % n); };
  std::uint64_t lost = 0;
  for (int round = 0; round < 500; ++round) {
    CAPTURE(round);
    std::vector<Vec3> points(4 + below(6));
    for (Vec3& p : points)
      p = {double(below(3)), double(below(2)), below(12) == 0 ? kNan : double(below(2))};
    Faces faces(1 + below(12));
    for (auto& face : faces) {
      face.resize(2 + below(4));
      for (auto& corner : face)
        corner = below(25) == 0 ? PolygonSoup::kInvalidVertex : below(points.size());
    }
    const PolygonSoup soup = make_soup(points, faces);
    const Report report = full(soup);
    std::set<std::uint32_t> listed;
    for (const char* rule : {"degenerate-face", "index-out-of-range", "duplicate-face"}) {
      if (const Issue* const issue = find(report, rule))
        for (const Element& element : issue->elements)
          listed.insert(element.faces[0]);
    }
    if (const Issue* const issue = find(report, "non-finite-coordinate")) {
      std::set<std::uint32_t> bad;
      for (const Element& element : issue->elements)
        bad.insert(element.vertices[0]);
      for (std::uint32_t f = 0; f < faces.size(); ++f)
        if (std::any_of(faces[f].begin(), faces[f].end(), [&](std::uint32_t v) { return bad.count(v) != 0; })) listed.insert(f);
    }
    CHECK(report.kept_faces + listed.size() == report.faces);
    lost += listed.size();
    ValidateOptions silent;
    for (const Rule& rule : rules())
      silent.severities[std::string(rule.name)] = std::nullopt;
    CHECK(full(soup, silent).kept_faces == report.kept_faces);
  }
  CHECK(lost > 500);
  CHECK(full(cube()).kept_faces == 6);
}

TEST_CASE("findings name the part of their first face") {
  PolygonSoup soup = joined(joined(cube(), reversed(cube({5, 0, 0}))), reversed(cube({10, 0, 0})));
  soup.parts = {{"left", 6, 8}, {"right", 12, 16}};
  const Issue inside_out = *find(full(soup), "inside-out");
  REQUIRE(inside_out.total == 2);
  CHECK(inside_out.elements[0].part == "left");
  CHECK(inside_out.elements[1].part == "right");
  soup.corners[0] = PolygonSoup::kInvalidVertex;  // of a face before the first part
  CHECK(find(full(soup), "index-out-of-range")->elements[0].part.empty());
}

TEST_CASE("an edge of many faces lists 32 of them and counts the rest") {
  std::vector<Vec3> points{{0, 0, 0}, {0, 0, 1}};
  Faces faces;
  for (std::uint32_t i = 0; i < 50; ++i) {
    points.push_back({double(i), 1, 0});
    faces.push_back({0, 1, i + 2});
  }
  const Report report = full(make_soup(points, faces));
  const Element& element = find(report, "non-manifold-edge")->elements[0];
  CHECK(element.faces.size() == 32);
  CHECK(element.more_faces == 18);
  CHECK(report_text(report, false).find("faces 0 1 2 3 4 5 ... (50 in all)") != std::string::npos);
  CHECK(report_json({report}).find("\"more_faces\": 18") != std::string::npos);
}

TEST_CASE("severities: a rule runs with the given severity or not at all") {
  ValidateOptions options;
  options.severities = {{"boundary-edge", Severity::error}, {"inside-out", Severity::note}, {"isolated-vertex", std::nullopt}};
  PolygonSoup soup = joined(reversed(cube()), make_soup({{9, 9, 9}, {8, 9, 9}, {9, 8, 9}, {7, 7, 7}}, {{0, 1, 2}}));
  const Report report = full(soup, options);
  CHECK(find(report, "boundary-edge")->severity == Severity::error);
  CHECK(find(report, "inside-out")->severity == Severity::note);
  CHECK(report.issues[0].rule == "boundary-edge");
  CHECK(find(report, "isolated-vertex") == nullptr);
  CHECK(std::count(report.checks.begin(), report.checks.end(), "isolated-vertex") == 0);
  CHECK(report.checks.size() + 1 == full(soup).checks.size());
  CHECK_FALSE(report.passes());
  options.severities["boundary-edge"] = Severity::warning;
  CHECK(full(soup, options).passes());
  options.fail_on = Severity::warning;
  CHECK_FALSE(full(soup, options).passes());
  options.allow = {"boundary-edge"};
  CHECK(full(soup, options).passes());
  options.fail_on = std::nullopt;
  options.allow.clear();
  CHECK(full(soup, options).passes());
}

TEST_CASE("the report does not depend on the number of threads") {
  ValidateOptions one, many;
  one.jobs = 1;
  many.jobs = 7;
  CHECK(report_json({full(defective(), one)}) == report_json({full(defective(), many)}));
  CHECK(fingerprints(full(defective(), one)) == fingerprints(full(defective(), many)));
}
