// SPDX-License-Identifier: Apache-2.0
// The meshes and fuzz finds under testdata: the good ones agree, each bad one has the defect in its name, and all truncations
// and single-byte changes give a soup or a refusal (with the sanitizers this excludes memory errors for these bytes).
#include <algorithm>
#include <cmath>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

constexpr Format kFormats[] = {Format::off, Format::obj, Format::ply,     Format::stl, Format::gltf,
                               Format::drc, Format::dae, Format::threemf, Format::vtk, Format::x3d};

// Either a valid soup or a refusal with its message.
void check_any(std::string_view bytes, std::optional<Format> format, bool looks = false) {
  ImportOptions options{format, {}};
  options.normals = options.appearance = looks;
  const Result<PolygonSoup> soup = import_memory(bytes, "mesh", options);
  if (soup) {
    check_invariants(*soup);
  } else {
    REQUIRE(soup.error().exit_code == 3);
    REQUIRE(soup.error().message.size() > 6);
    REQUIRE(soup.error().message.find('\n') == std::string::npos);
  }
}

double signed_volume(const PolygonSoup& soup) {
  double sum = 0;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const auto corner = [&](std::uint32_t i) { return soup.points[soup.corners[soup.face_first[f] + i]]; };
    for (std::uint32_t k = 1; k + 1 < soup.face_first[f + 1] - soup.face_first[f]; ++k) {
      const Vec3 a = corner(0), b = corner(k), c = corner(k + 1);
      sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
    }
  }
  return sum / 6;
}

}  // namespace

TEST_CASE("every good cube is the unit cube, outward, whatever its format") {
  int cubes = 0;
  for (const auto& path : files_in(testdata() / "meshes" / "good")) {
    if (!path.filename().string().starts_with("cube_")) continue;
    INFO(path);
    const Result<PolygonSoup> soup = import_mesh(path);
    REQUIRE(soup);
    check_invariants(*soup);
    CHECK(signed_volume(*soup) == Approx(1));
    CHECK(soup->absolute_quantum == 0);
    ++cubes;
  }
  CHECK(cubes >= 10);
}

TEST_CASE("every good mesh is read") {
  for (const auto& path : files_in(testdata() / "meshes" / "good")) {
    INFO(path);
    const Result<PolygonSoup> soup = import_mesh(path);
    REQUIRE(soup);
    check_invariants(*soup);
    CHECK(std::count(soup->corners.begin(), soup->corners.end(), kInvalid) == 0);
  }
}

TEST_CASE("a bad mesh is refused under the rule in its name, or has the defect in its name") {
  int refused = 0, defective = 0;
  for (const auto& path : files_in(testdata() / "meshes" / "bad")) {
    INFO(path);
    const std::string name = path.filename().string();
    const Result<PolygonSoup> soup = import_mesh(path);
    if (name.starts_with("unreadable") || name.starts_with("empty-mesh")) {
      REQUIRE_FALSE(soup);
      CHECK(soup.error().exit_code == 3);
      CHECK(name.starts_with(soup.error().rule));
      ++refused;
      continue;
    }
    REQUIRE(soup);
    check_invariants(*soup);
    const bool has_invalid = std::count(soup->corners.begin(), soup->corners.end(), kInvalid) > 0;
    CHECK(has_invalid == name.starts_with("index-out-of-range"));
    const bool has_non_finite = std::any_of(soup->points.begin(), soup->points.end(), [](const Vec3& p) {
      return !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    });
    CHECK(has_non_finite == name.starts_with("non-finite-coordinate"));
    ++defective;
  }
  CHECK(refused >= 20);
  CHECK(defective >= 5);
}

TEST_CASE("a truncated mesh is refused or sound, at every byte") {
  for (const auto& path : files_in(testdata() / "meshes")) {
    const std::string bytes = read_bytes(path);
    if (bytes.size() > 4096) continue;
    INFO(path);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      // A copy of exactly this size on the heap: the address sanitizer sees a read beyond it.
      const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      check_any({cut.data(), cut.size()}, std::nullopt);
      const Result<PolygonSoup> whole = import_mesh(path);
      if (whole) check_any({cut.data(), cut.size()}, whole->format);
    }
  }
}

TEST_CASE("every truncation of a file with counts is refused, but for its last blanks") {
  for (const char* name :
       {"cube_quads.off", "cube_ascii.ply", "cube_little.ply", "cube_big.ply", "cube_double_extra.ply", "cube_solid_binary.stl",
        "cube_binary.glb", "cube_package.3mf", "cube_legacy.vtk", "cube_binary.vtk", "cube_draco.glb", "cube_sequential.drc"}) {
    INFO(name);
    const std::string bytes = read_bytes(testdata() / "meshes" / "good" / name);
    const Format format = import_text(bytes).format;
    // Cut in its last word, a text may still be whole: "10" is a number, and so is "1".
    const std::size_t last_word = bytes.find_last_of(" \n", bytes.size() - 2);
    const std::size_t end = import_text(bytes).is_text ? last_word : bytes.size();
    for (std::size_t size = 0; size < end; ++size)
      refusal(bytes.substr(0, size), format);
  }
}

TEST_CASE("a single changed byte leads to a soup or a refusal") {
  for (const auto& path : files_in(testdata() / "meshes" / "good")) {
    std::string bytes = read_bytes(path);
    if (bytes.size() > 4096) continue;
    const Format format = import_text(bytes).format;
    INFO(path);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const char kept = bytes[i];
      for (const int change : {1, 0x80, 0xFF, kept ^ '\n', kept ^ ' ', kept ^ '9', kept ^ '-', kept ^ '#'}) {
        bytes[i] = static_cast<char>(kept ^ change);
        check_any(bytes, format);
      }
      bytes[i] = kept;
    }
  }
}

TEST_CASE("every fuzz find is a soup or a refusal in every format, with and without how it looks") {
  int finds = 0;
  for (const auto& path : files_in(testdata() / "fuzz")) {
    if (path.parent_path().filename().string().find("import") == std::string::npos) continue;
    INFO(path);
    const std::string bytes = read_bytes(path);
    for (const bool looks : {false, true}) {
      for (const Format format : kFormats)
        check_any(bytes, format, looks);
      check_any(bytes, std::nullopt, looks);
    }
    ++finds;
  }
  CHECK(finds > 0);
}

TEST_CASE("real meshes are read, if available") {
  const auto meshes = real_meshes();
  WARN(meshes.size() << " real meshes found");
  for (const auto& path : meshes) {
    INFO(path);
    const Result<PolygonSoup> soup = import_mesh(path);
    REQUIRE(soup);
    check_invariants(*soup);
    CHECK(std::count(soup->corners.begin(), soup->corners.end(), kInvalid) == 0);
  }
}
