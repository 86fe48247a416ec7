// SPDX-License-Identifier: Apache-2.0
// Defects planted in clean meshes, written to a file, read and validated: every rule's findings are exactly those planted, with
// their places. FDCG_SEEDED_CASES sets how many random meshes (default 150), FDCG_SEEDED_FACES up to how many faces (20,000).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>

#include "catch.hpp"
#include "clean_mesh.hpp"
#include "fdcg/bake.hpp"
#include "mesh_files.hpp"
#include "seeder.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

std::uint32_t setting(const char* name, std::uint32_t otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? static_cast<std::uint32_t>(std::strtoul(value, nullptr, 10)) : otherwise;
}

std::string to_text(const Place& place) {
  std::string text = "faces";
  for (const std::uint32_t f : place.faces)
    text += " " + std::to_string(f);
  text += " vertices";
  for (const std::uint32_t v : place.vertices)
    text += " " + std::to_string(v);
  return text;
}

Place place_of(const Issue& issue, const Element& element) {
  std::set<std::uint32_t> faces(element.faces.begin(), element.faces.end());
  std::set<std::uint32_t> vertices(element.vertices.begin(), element.vertices.end());
  if (issue.rule != "not-orientable") {  // there the edge depends on how the patch is searched
    for (const auto& [u, v] : element.edges)
      vertices.insert({u, v});
  }
  return {{faces.begin(), faces.end()}, {vertices.begin(), vertices.end()}};
}

bool is_near(double a, double b) {
  return a == b || std::abs(a - b) < 1e-6 * (1 + std::abs(a)) || (std::isnan(a) && std::isnan(b));
}
bool is_near(const Vec3& a, const Vec3& b) {
  return is_near(a.x, b.x) && is_near(a.y, b.y) && is_near(a.z, b.z);
}

// The point and the line are those of what is named.
void check_element(const PolygonSoup& soup, const MeshFile& file, const Issue& issue, const Element& element) {
  const bool is_at_edge = issue.rule != "not-orientable";  // of a patch: at a corner of its first face
  if (element.vertices.size() == 1 && element.edges.empty() && element.faces.empty()) {
    REQUIRE(element.point.has_value());
    CHECK(is_near(*element.point, soup.points[element.vertices[0]]));
    if (!file.point_line.empty()) CHECK(element.line == file.point_line[element.vertices[0]]);
  }
  if (!element.faces.empty() && !file.face_line.empty()) CHECK(element.line == file.face_line[element.faces[0]]);
  if (file.face_line.empty()) CHECK_FALSE(element.line.has_value());
  if (is_at_edge && element.edges.size() == 1 && element.vertices.empty() && element.point) {
    const Vec3 &u = soup.points[element.edges[0][0]], &v = soup.points[element.edges[0][1]];
    CHECK(is_near(*element.point, {u.x / 2 + v.x / 2, u.y / 2 + v.y / 2, u.z / 2 + v.z / 2}));
  }
}

void check_findings(const Report& report, Findings expected) {
  std::set<std::string> rules(report.checks.begin(), report.checks.end());
  std::map<std::string, const Issue*> issues;
  for (const Issue& issue : report.issues)
    issues[issue.rule] = &issue;
  for (const auto& [rule, places] : expected)
    rules.insert(rule);
  for (const std::string& rule : rules) {
    if (std::find(report.checks.begin(), report.checks.end(), rule) == report.checks.end()) continue;
    INFO(rule);
    std::multiset<Place> found;
    if (issues.count(rule) != 0) {
      for (const Element& element : issues[rule]->elements)
        found.insert(place_of(*issues[rule], element));
      CHECK(issues[rule]->total == expected[rule].size());
    } else {
      CHECK(expected[rule].empty());
    }
    std::string missing, surplus;
    for (const Place& place : expected[rule])
      if (found.count(place) != expected[rule].count(place)) missing += to_text(place) + "; ";
    for (const Place& place : found)
      if (found.count(place) != expected[rule].count(place)) surplus += to_text(place) + "; ";
    CHECK(missing.substr(0, 1000) == "");
    CHECK(surplus.substr(0, 1000) == "");
  }
}

void check_file(const SeededMesh& seeded, FileKind kind, bool welds, bool comments) {
  const MeshFile file = write_mesh(seeded.soup, kind, comments);
  const Result<PolygonSoup> soup = import_memory(file.bytes, "seeded");
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup.has_value());
  CHECK(soup->points.size() == seeded.soup.points.size());
  CHECK((soup->corners == seeded.soup.corners));
  ValidateOptions options;
  options.max_elements = kAllElements;
  options.weld.kind = welds ? Weld::Kind::exact : Weld::Kind::none;
  const Report report = validate(*soup, options);
  check_findings(report, seeded.findings);
  CHECK(report.faces == seeded.soup.face_count());
  CHECK(report.vertices == seeded.vertices);
  CHECK(report.components == seeded.components);
  CHECK(report.kept_faces == seeded.kept_faces);
  for (const Issue& issue : report.issues) {
    INFO(issue.rule);
    for (const Element& element : issue.elements)
      check_element(seeded.soup, file, issue, element);
  }
}

Seeder::Setting setting_for(FileKind kind, Random& random) {
  Seeder::Setting setting;
  setting.has_vertices = holds_vertices(kind);
  setting.has_bad_indices = holds_bad_indices(kind);
  setting.triangles_only = !holds_polygons(kind);
  setting.welds = !holds_vertices(kind) || random.chance(0.75);
  return setting;
}

// Log-uniform from 100 on.
std::uint32_t draw_faces(Random& random, std::uint32_t most) {
  return static_cast<std::uint32_t>(100 * std::pow(most / 100.0, random.unit()));
}

}  // namespace

TEST_CASE("clean meshes have no finding in any format") {
  for (int i = 0; i < 66; ++i) {
    Random random(1000 + static_cast<std::uint64_t>(i));
    const FileKind kind = kFileKinds[static_cast<std::size_t>(i) % kFileKinds.size()];
    INFO("case " << i << ", " << name_of(kind));
    Seeder::Setting setting = setting_for(kind, random);
    const CleanMesh clean = random_clean_mesh(random, draw_faces(random, 5000), setting.triangles_only);
    Seeder seeder(clean, setting, random);
    const SeededMesh seeded = seeder.finish();
    for (const auto& [rule, places] : seeded.findings)
      CHECK(rule == "duplicate-vertex");
    CHECK(seeded.kept_faces == clean.soup.face_count());
    check_file(seeded, kind, setting.welds, random.chance(0.5));
  }
}

TEST_CASE("a single defect of each kind is found in its place, and nothing else") {
  for (const std::string& defect : Seeder::kinds()) {
    int planted = 0;
    for (int i = 0; i < 33; ++i) {
      Random random(77 * static_cast<std::uint64_t>(i) + 5);
      const FileKind kind = kFileKinds[static_cast<std::size_t>(i) % kFileKinds.size()];
      Seeder::Setting setting = setting_for(kind, random);
      const CleanMesh clean = random_clean_mesh(random, draw_faces(random, 1500), setting.triangles_only);
      Seeder seeder(clean, setting, random);
      if (!seeder.plant(defect)) continue;
      ++planted;
      INFO(defect << ", case " << i << ", " << name_of(kind) << (setting.welds ? "" : ", weld none"));
      check_file(seeder.finish(), kind, setting.welds, random.chance(0.5));
    }
    INFO(defect);
    CHECK(planted >= 4);
  }
}

TEST_CASE("many separate defects give exactly the sum of their findings") {
  const std::uint32_t cases = setting("FDCG_SEEDED_CASES", 150), most_faces = setting("FDCG_SEEDED_FACES", 20'000);
  std::map<std::string, int> planted;
  for (std::uint32_t i = 0; i < cases; ++i) {
    const std::uint64_t seed = 31'000'003ull + i;
    Random random(seed);
    const FileKind kind = kFileKinds[i % kFileKinds.size()];
    Seeder::Setting setting = setting_for(kind, random);
    const CleanMesh clean = random_clean_mesh(random, draw_faces(random, most_faces), setting.triangles_only);
    Seeder seeder(clean, setting, random);
    if (random.chance(0.3)) seeder.reverse_shell();
    if (random.chance(0.15)) seeder.flip_many(random.chance(0.3) ? 1 : random.unit());
    if (random.chance(0.15)) seeder.delete_many(random.unit() * random.unit());
    const std::uint32_t defects = random.chance(0.2) ? 1 : random.below(60);
    for (std::uint32_t k = 0; k < defects; ++k)
      seeder.plant();
    const SeededMesh seeded = seeder.finish();
    INFO("seed " << seed << ", " << name_of(kind) << (setting.welds ? "" : ", weld none") << ", " << seeded.soup.face_count()
                 << " faces");
    for (const auto& [defect, count] : seeded.planted)
      planted[defect] += count;
    check_file(seeded, kind, setting.welds, random.chance(0.5));
  }
  std::string text;
  for (const auto& [defect, count] : planted)
    text += " " + defect + " " + std::to_string(count);
  for (const std::string& defect : Seeder::kinds()) {
    INFO(defect);
    CHECK(planted[defect] > static_cast<int>(cases / 10));
  }
  WARN(cases << " meshes; planted:" << text);
}
