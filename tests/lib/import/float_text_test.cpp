// SPDX-License-Identifier: Apache-2.0
// Text that holds floats: its quantum is that of a float, however many digits were printed.
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/format.h"

using namespace fdcg::bake;

namespace {

constexpr double kFloat = 0x1p-24, kDouble = 0x1p-53;
constexpr const char* kFaces[] = {"0 2 1", "0 3 2", "4 5 6", "4 6 7", "0 1 5", "0 5 4",
                                  "1 2 6", "1 6 5", "2 3 7", "2 7 6", "3 0 4", "3 4 7"};

using Print = std::function<std::string(double)>;

std::string shortest(double value) {
  std::array<char, 64> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(value)).ptr};
}
Print formatted(const char* format) {
  return [format](double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return std::string(text.data());
  };
}

// The corners of a cube that was turned about an axis of its own and then stored as floats.
std::array<Vec3, 8> turned_cube() {
  std::array<Vec3, 8> corners{};
  const double a = 0.7, b = 0.4;
  for (std::size_t i = 0; i < 8; ++i) {
    const double x = i % 4 == 1 || i % 4 == 2, y = i % 4 >= 2, z = i >= 4;
    const double u = x * std::cos(a) - y * std::sin(a), v = x * std::sin(a) + y * std::cos(a);
    const double w = v * std::cos(b) - z * std::sin(b), q = v * std::sin(b) + z * std::cos(b);
    corners[i] = {static_cast<float>(u + 3.3), static_cast<float>(w + 3.3), static_cast<float>(q + 3.3)};
  }
  return corners;
}

std::string vertices(const Print& print, const char* start) {
  std::string text;
  for (const Vec3& p : turned_cube())
    text += start + print(p.x) + " " + print(p.y) + " " + print(p.z) + "\n";
  return text;
}
std::string ply(const Print& print, const std::string& type) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 8\n";
  for (const char* axis : {"x", "y", "z"})
    text += "property " + type + " " + axis + "\n";
  text += "element face 12\nproperty list uchar int vertex_indices\nend_header\n" + vertices(print, "");
  for (const char* face : kFaces)
    text += std::string("3 ") + face + "\n";
  return text;
}
std::string off(const Print& print) {
  std::string text = "OFF\n8 12 0\n" + vertices(print, "");
  for (const char* face : kFaces)
    text += std::string("3 ") + face + "\n";
  return text;
}

PolygonSoup read(const std::string& text) {
  Result<PolygonSoup> soup = import_memory(text, "cube");
  REQUIRE(soup.has_value());
  return *soup;
}
std::uint32_t nodes(const PolygonSoup& soup) {
  const Result<Compiled> compiled = compile(soup, {});
  REQUIRE(compiled.has_value());
  REQUIRE_FALSE(compiled->bytes.empty());
  fdcg_header header;
  std::memcpy(&header, compiled->bytes.data(), sizeof header);
  return header.node_count;
}

}  // namespace

TEST_CASE("a turned cube of floats has six nodes, whatever text it went through") {
  const Print nine = formatted("%.9g"), full = formatted("%.17g");
  for (const std::string& text : {ply(nine, "float"), ply(shortest, "float"), ply(full, "float"), ply(nine, "double"),
                                  ply(shortest, "double"), off(nine), off(shortest), off(full)}) {
    INFO(text);
    const PolygonSoup soup = read(text);
    CHECK(soup.relative_quantum == kFloat);
    CHECK(nodes(soup) == 6);
  }
}

TEST_CASE("text of doubles, and of numbers typed with few digits, keeps its own quantum") {
  const auto moved = [](double value) { return formatted("%.17g")(value + 1e-9); };
  CHECK(read(off(moved)).relative_quantum == kDouble);
  const auto nine_of_a_double = [](double value) { return formatted("%.9g")(value + 3e-8); };
  CHECK(read(off(nine_of_a_double)).relative_quantum == kDouble);
  CHECK(read(off(formatted("%.5g"))).relative_quantum == kDouble);
  CHECK(read(ply(moved, "double")).relative_quantum == kDouble);
  CHECK(read(ply(moved, "float")).relative_quantum == kFloat);  // as the header says
}

TEST_CASE("a coordinate that is no number says nothing about the others' precision") {
  std::string text = off(formatted("%.9g"));
  text.replace(text.find("8 12 0"), 6, "9 12 0");
  text.insert(text.find("3 0 2 1"), "nan inf 00000000000000000000e0\n");
  CHECK(read(text).relative_quantum == kFloat);
}
