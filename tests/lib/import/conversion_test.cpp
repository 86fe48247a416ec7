// SPDX-License-Identifier: Apache-2.0
// A mesh of triangles whose coordinates are floats' values, without isolated vertices, gets the same verdict in every format,
// however often it was converted. FDCG_CONVERSION_CASES sets the number of random meshes (default 15).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "clean_mesh.hpp"
#include "fdcg/bake.hpp"
#include "mesh_files.hpp"
#include "real_files.hpp"
#include "seeder.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

// What a rule found: fingerprints are of coordinates, so that they do not depend on numbers, which formats change.
using Verdict = std::map<std::string, std::multiset<std::uint64_t>>;

Verdict verdict_of(const PolygonSoup& soup) {
  ValidateOptions options;
  options.max_elements = kAllElements;
  const Report report = validate(soup, options);
  Verdict verdict;
  for (const Issue& issue : report.issues) {
    if (issue.rule == "duplicate-vertex") continue;  // how often a format repeats a vertex is its own affair
    for (const Element& element : issue.elements)
      verdict[issue.rule].insert(element.fingerprint);
    CHECK(issue.total == issue.elements.size());
  }
  verdict["components"].insert(report.components);
  verdict["vertices"].insert(report.vertices);
  verdict["faces"].insert(report.faces);
  verdict["kept faces"].insert(report.kept_faces);
  return verdict;
}

PolygonSoup read_back(const std::string& bytes) {
  Result<PolygonSoup> soup = import_memory(bytes, "converted");
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup.has_value());
  return *soup;
}

// By the library's own writer, where it has one for the format.
PolygonSoup converted(const PolygonSoup& soup, FileKind kind) {
  ExportOptions options;
  switch (kind) {
    case FileKind::off:
      options.format = Format::off;
      break;
    case FileKind::obj:
      options.format = Format::obj;
      break;
    case FileKind::ply_text:
    case FileKind::ply_little:
      options.format = Format::ply;
      options.is_text = kind == FileKind::ply_text;
      break;
    case FileKind::stl_text:
    case FileKind::stl_binary:
      options.format = Format::stl;
      options.is_text = kind == FileKind::stl_text;
      break;
    case FileKind::ply_big:
    case FileKind::gltf:
    case FileKind::glb:
    case FileKind::glb_draco:
    case FileKind::drc:
      return read_back(write_mesh(soup, kind).bytes);
  }
  const Result<std::string> bytes = export_mesh(soup, options);
  INFO((bytes ? std::string() : bytes.error().message));
  REQUIRE(bytes.has_value());
  return read_back(*bytes);
}

// From each format into each.
void check_all_pairs(const PolygonSoup& soup) {
  const Verdict expected = verdict_of(soup);
  for (const FileKind from : kFileKinds) {
    INFO("from " << name_of(from));
    const PolygonSoup first = converted(soup, from);
    CHECK((verdict_of(first) == expected));
    for (const FileKind to : kFileKinds) {
      INFO("to " << name_of(to));
      CHECK((verdict_of(converted(first, to)) == expected));
    }
  }
}

std::uint32_t case_count() {
  const char* value = std::getenv("FDCG_CONVERSION_CASES");
  return value != nullptr ? static_cast<std::uint32_t>(std::strtoul(value, nullptr, 10)) : 15;
}

// Triangles of floats and no vertex without a face: what all formats hold.
bool is_common(const PolygonSoup& soup) {
  std::vector<bool> is_used(soup.points.size(), false);
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    if (soup.face_first[f + 1] - soup.face_first[f] != 3) return false;
  }
  for (const std::uint32_t c : soup.corners) {
    if (c >= soup.points.size()) return false;
    is_used[c] = true;
  }
  const auto is_float = [](double c) { return std::isfinite(c) && static_cast<double>(static_cast<float>(c)) == c; };
  return std::find(is_used.begin(), is_used.end(), false) == is_used.end() &&
         std::all_of(soup.points.begin(), soup.points.end(),
                     [&](const Vec3& p) { return is_float(p.x) && is_float(p.y) && is_float(p.z); });
}

}  // namespace

TEST_CASE("clean and seeded meshes keep their verdict through every pair of formats") {
  for (std::uint32_t i = 0; i < case_count(); ++i) {
    const std::uint64_t seed = 52'000 + i;
    INFO("seed " << seed);
    Random random(seed);
    Seeder::Setting setting;
    setting.has_vertices = false;  // as STL has it: then no vertex is without a face
    setting.triangles_only = true;
    setting.has_non_finite = false;
    setting.has_bad_indices = false;
    const CleanMesh clean = random_clean_mesh(random, 100 + random.below(600), true);
    Seeder seeder(clean, setting, random);
    if (random.chance(0.3)) seeder.reverse_shell();
    if (random.chance(0.2)) seeder.flip_many(random.unit());
    if (random.chance(0.2)) seeder.delete_many(random.unit());
    for (std::uint32_t defects = i % 5 == 0 ? 0 : random.below(20); defects > 0; --defects)
      seeder.plant();
    check_all_pairs(seeder.finish().soup);
  }
}

TEST_CASE("real meshes keep their verdict through every pair of formats") {
  constexpr std::uintmax_t kMostBytes = 100'000;
  std::size_t found = 0;
  for (const auto& path : real_mesh_files()) {
    if (std::filesystem::file_size(path) > kMostBytes) continue;
    const Result<PolygonSoup> soup = import_mesh(path);
    if (!soup || !is_common(*soup)) continue;
    ++found;
    INFO(path.string());
    const PolygonSoup plain = read_back(write_mesh(*soup, FileKind::ply_little).bytes);
    check_all_pairs(plain);
  }
  WARN(found << " real files converted");
}
