// SPDX-License-Identifier: Apache-2.0
// What the tests of the import share.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake::test {

inline constexpr std::uint32_t kInvalid = PolygonSoup::kInvalidVertex;

inline PolygonSoup import_text(std::string_view text, std::optional<Format> format = std::nullopt) {
  Result<PolygonSoup> soup = import_memory(text, "mesh", {format, {}});
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup);
  return *soup;
}

// The message of a refusal; requires that there is one, with what a refusal promises.
inline std::string refusal(std::string_view text, std::optional<Format> format = std::nullopt) {
  const Result<PolygonSoup> soup = import_memory(text, "mesh", {format, {}});
  REQUIRE_FALSE(soup);
  const Failure& failure = soup.error();
  CHECK(failure.exit_code == 3);
  CHECK(failure.message.starts_with("mesh: "));
  CHECK(failure.message.find('\n') == std::string::npos);
  CHECK((failure.rule == "unreadable" || failure.rule == "empty-mesh"));
  return failure.message;
}

inline std::vector<std::vector<std::uint32_t>> faces_of(const PolygonSoup& soup) {
  std::vector<std::vector<std::uint32_t>> faces;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    faces.emplace_back(soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
  }
  return faces;
}

// "name@first_face", and "what: count".
inline std::vector<std::string> parts_of(const PolygonSoup& soup) {
  std::vector<std::string> parts;
  for (const Part& part : soup.parts)
    parts.push_back(part.name + "@" + std::to_string(part.first_face));
  return parts;
}
inline std::vector<std::string> ignored_of(const PolygonSoup& soup) {
  std::vector<std::string> lines;
  for (const Ignored& ignored : soup.ignored)
    lines.push_back(ignored.what + ": " + std::to_string(ignored.count));
  return lines;
}

// What every soup promises, whatever file it came from.
inline void check_invariants(const PolygonSoup& soup) {
  REQUIRE(soup.face_count() > 0);
  REQUIRE(soup.face_first.front() == 0);
  REQUIRE(soup.face_first.back() == soup.corners.size());
  bool is_ordered = true, is_in_range = true;
  for (std::size_t f = 0; f < soup.face_count(); ++f)
    is_ordered &= soup.face_first[f] <= soup.face_first[f + 1];
  for (const std::uint32_t c : soup.corners)
    is_in_range &= c == kInvalid || c < soup.points.size();
  REQUIRE(is_ordered);
  REQUIRE(is_in_range);
  REQUIRE(soup.point_line.size() == (soup.is_text ? soup.points.size() : 0));
  REQUIRE(soup.face_line.size() == (soup.is_text ? soup.face_count() : 0));
  REQUIRE((soup.relative_quantum == 0x1p-24 || soup.relative_quantum == 0x1p-53));
  REQUIRE(soup.absolute_quantum >= 0);
  REQUIRE(soup.sha256.size() == 64);
  for (std::size_t p = 0; p < soup.parts.size(); ++p) {
    REQUIRE(soup.parts[p].first_face < soup.face_count());
    REQUIRE((p == 0 || soup.parts[p - 1].first_face < soup.parts[p].first_face));
  }
  for (const Ignored& ignored : soup.ignored)
    REQUIRE((ignored.count > 0 && !ignored.what.empty()));
}

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

inline std::filesystem::path testdata() {
  return std::filesystem::path(FDCG_SOURCE_DIR) / "testdata";
}

// Real meshes: in the folder that FDCG_REAL_MESHES names, else in ../shared/meshes beside the project, else those of Debian's
// libcgal-demo as the build unpacked them, but for two that are no meshes. A test without any counts as skipped.
inline std::vector<std::filesystem::path> real_meshes() {
  const char* folder = std::getenv("FDCG_REAL_MESHES");
  std::filesystem::path root =
      folder != nullptr ? std::filesystem::path(folder) : std::filesystem::path(FDCG_SOURCE_DIR) / ".." / "shared" / "meshes";
  if (!std::filesystem::exists(root)) root = std::filesystem::path(FDCG_CGAL_DATA) / "data" / "meshes";
  std::vector<std::filesystem::path> meshes;
  for (const auto& path : files_in(root)) {
    std::string ending = path.extension().string();
    for (char& c : ending)
      c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    constexpr std::array kEndings = {".off", ".obj", ".ply", ".stl", ".gltf", ".glb", ".drc"};
    constexpr std::array kNoMeshes = {"b9.ply", "prim.off"};  // points alone; more faces than its header tells of
    const bool is_mesh = std::find(kNoMeshes.begin(), kNoMeshes.end(), path.filename()) == kNoMeshes.end();
    if (is_mesh && std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end()) meshes.push_back(path);
  }
  if (meshes.empty()) WARN("skipped: no real meshes at hand");
  return meshes;
}

// Appends the bytes of a scalar, least significant first or last.
template <class T>
void put(std::string& bytes, T value, bool is_big_endian = false) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  if (is_big_endian) std::reverse(raw.begin(), raw.end());
  bytes += raw;
}

}  // namespace fdcg::bake::test
