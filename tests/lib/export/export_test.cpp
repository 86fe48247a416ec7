// SPDX-License-Identifier: Apache-2.0
// What is written reads back as it was: by our readers to the bit, by OpenMesh to the float.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../../support/import_support.hpp"
#include "../../support/random.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using fdcg::test::Random;

namespace {

constexpr std::array<ExportOptions, 6> kEveryFormat = {{{Format::off, true},
                                                        {Format::obj, true},
                                                        {Format::ply, false},
                                                        {Format::ply, true},
                                                        {Format::stl, false},
                                                        {Format::stl, true}}};

std::string bytes_of(const PolygonSoup& soup, ExportOptions options) {
  const Result<std::string> bytes = export_mesh(soup, options);
  INFO((bytes ? std::string() : bytes.error().message));
  REQUIRE(bytes);
  return *bytes;
}

std::string refusal_of(const PolygonSoup& soup, ExportOptions options) {
  const Result<std::string> bytes = export_mesh(soup, options);
  REQUIRE_FALSE(bytes);
  CHECK(bytes.error().exit_code == 2);
  CHECK(bytes.error().message.starts_with(soup.name + ": "));
  CHECK(bytes.error().message.find('\n') == std::string::npos);
  return bytes.error().message;
}

// To the bit, but that every NaN is one.
bool is_same(double a, double b) {
  return std::isnan(a) ? std::isnan(b) : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool is_same(const Vec3& a, const Vec3& b) {
  return is_same(a.x, b.x) && is_same(a.y, b.y) && is_same(a.z, b.z);
}

// The soup with points of its own for each corner, as STL has it.
PolygonSoup cornerwise(PolygonSoup soup) {
  std::vector<Vec3> points;
  for (std::uint32_t& corner : soup.corners) {
    points.push_back(soup.points[corner]);
    corner = static_cast<std::uint32_t>(points.size() - 1);
  }
  soup.points = std::move(points);
  return soup;
}

void check_same(const PolygonSoup& expected, const PolygonSoup& found) {
  check_invariants(found);
  CHECK(found.face_first == expected.face_first);
  CHECK(found.corners == expected.corners);
  REQUIRE(found.points.size() == expected.points.size());
  std::size_t different = 0;
  for (std::size_t v = 0; v < found.points.size(); ++v)
    different += !is_same(expected.points[v], found.points[v]);
  CHECK(different == 0);
}

enum class Numbers { floats, doubles, special };

double random_number(Random& random, Numbers numbers) {
  if (numbers == Numbers::special && random.chance(0.2)) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::array<double, 6> kSpecial = {-0.0, kInfinity, -kInfinity, std::nan(""), 5e-324, -1.7976931348623157e308};
    return kSpecial[random.below(6)];
  }
  if (numbers == Numbers::floats) return std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
  if (random.chance(0.5)) return random.uniform(-10, 10);
  return std::bit_cast<double>(random.bits());
}

PolygonSoup random_soup(Random& random, Numbers numbers, bool is_stl) {
  PolygonSoup soup;
  soup.name = "made in code";
  const std::uint32_t points = 3 + random.below(60), faces = 1 + random.below(80);
  for (std::uint32_t v = 0; v < points; ++v)
    soup.points.push_back({random_number(random, numbers), random_number(random, numbers), random_number(random, numbers)});
  soup.face_first.push_back(0);
  for (std::uint32_t f = 0; f < faces; ++f) {
    const std::uint32_t most = random.chance(0.02) ? 700 : 6;
    const std::uint32_t corners = is_stl ? 3 : random.chance(0.5) ? 3 : random.below(most);
    for (std::uint32_t k = 0; k < corners; ++k)
      soup.corners.push_back(!is_stl && random.chance(0.02) ? kInvalid : random.below(points));
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  return is_stl ? cornerwise(soup) : soup;
}

PolygonSoup square() {
  PolygonSoup soup;
  soup.name = "square.obj";
  soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.face_first = {0, 3, 6};
  soup.corners = {0, 1, 2, 0, 2, 3};
  return soup;
}

}  // namespace

TEST_CASE("a random soup written in any format reads back bit for bit") {
  for (const ExportOptions& options : kEveryFormat) {
    const bool is_stl = options.format == Format::stl;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      Random random(seed);
      const bool is_binary_stl = is_stl && !options.is_text;
      const Numbers numbers = is_binary_stl || random.chance(0.3) ? Numbers::floats
                              : random.chance(0.5)                ? Numbers::doubles
                                                                  : Numbers::special;
      const PolygonSoup soup = random_soup(random, numbers, is_stl);
      INFO("seed " << seed << ", format " << static_cast<int>(options.format) << ", text " << options.is_text);
      const std::string bytes = bytes_of(soup, options);
      const PolygonSoup found = import_text(bytes);  // known by its content
      CHECK(found.format == options.format);
      CHECK(found.is_text == (options.is_text || options.format == Format::off || options.format == Format::obj));
      check_same(soup, found);
      CHECK(bytes == bytes_of(found, options));
    }
  }
}

TEST_CASE("PLY stores floats where that is exact, else doubles") {
  PolygonSoup soup = square();
  CHECK(bytes_of(soup, {Format::ply, false}).find("property float x") != std::string::npos);
  CHECK(bytes_of(soup, {Format::ply, true}).find("property float x") != std::string::npos);
  soup.points[3].z = 0.1;
  CHECK(bytes_of(soup, {Format::ply, false}).find("property double x") != std::string::npos);
  soup.points[3].z = 1e300;
  CHECK(bytes_of(soup, {Format::ply, false}).find("property double x") != std::string::npos);
  soup.points[3].z = std::nan("");
  CHECK(bytes_of(soup, {Format::ply, false}).find("property float x") != std::string::npos);
}

TEST_CASE("OBJ and text STL name the parts where they start") {
  PolygonSoup soup = square();
  soup.parts = {{"left wing\n", 0, 0}, {"right", 1, 0}};
  CHECK(bytes_of(soup, {Format::obj, true}).find("o left wing \nf 1 2 3\no right\nf 1 3 4\n") != std::string::npos);
  const std::string stl = bytes_of(soup, {Format::stl, true});
  CHECK(stl.starts_with("solid left wing \nfacet normal 0 0 1\n"));
  CHECK(stl.find("endsolid left wing \nsolid right\n") != std::string::npos);
  CHECK(stl.ends_with("endsolid right\n"));
  check_same(cornerwise(soup), import_text(stl));
  soup.parts = {{"tail", 1, 0}};
  CHECK(bytes_of(soup, {Format::obj, true}).find("f 1 2 3\no tail\nf 1 3 4\n") != std::string::npos);
  CHECK(bytes_of(soup, {Format::stl, true}).starts_with("solid \nfacet"));
}

TEST_CASE("STL refuses what it cannot represent, with place and remedy") {
  const auto check_words = [](const PolygonSoup& soup, std::initializer_list<const char*> words) {
    for (const bool is_text : {false, true}) {
      const std::string message = refusal_of(soup, {Format::stl, is_text});
      INFO(message);
      for (const char* word : words)
        CHECK(message.find(word) != std::string::npos);
      CHECK(message.find("write OFF, OBJ or PLY") != std::string::npos);
    }
  };
  PolygonSoup soup = square();
  soup.face_first = {0, 3, 5, 6};
  soup.face_line = {7, 8, 9};
  check_words(soup, {"face 1 (line 8) has 2 corners"});
  soup = square();
  soup.points.push_back({5, 5, 5});
  soup.point_line = {1, 2, 3, 4, 5};
  check_words(soup, {"vertex 4 (line 5) belongs to no face"});
  soup = square();
  soup.corners[4] = kInvalid;
  check_words(soup, {"face 1 names a vertex that there is not"});
}

TEST_CASE("binary STL refuses coordinates that are no floats, text STL keeps them") {
  for (const double y : {0.1, 4e38, 1e-300}) {
    PolygonSoup soup = square();
    soup.points[2].y = y;
    const std::string message = refusal_of(soup, {Format::stl, false});
    INFO(message);
    CHECK(message.find("vertex 2 has the coordinate ") != std::string::npos);
    CHECK(message.find("is no 32-bit float") != std::string::npos);
    CHECK(message.find("text STL (--ascii)") != std::string::npos);
    check_same(cornerwise(soup), import_text(bytes_of(soup, {Format::stl, true})));
  }
}

TEST_CASE("formats that are only read are refused by name") {
  CHECK(refusal_of(square(), {Format::gltf, false}).find("OFF, OBJ, PLY or STL") != std::string::npos);
  CHECK(refusal_of(square(), {Format::drc, false}).find("OFF, OBJ, PLY or STL") != std::string::npos);
}

TEST_CASE("the normals of STL are of unit length, and zero where the triangle has none") {
  PolygonSoup soup = square();
  const std::string bytes = bytes_of(soup, {Format::stl, false});
  REQUIRE(bytes.size() == 84 + 2 * 50);
  std::array<float, 3> normal{};
  std::memcpy(normal.data(), bytes.data() + 84, sizeof normal);
  CHECK(normal == std::array<float, 3>{0, 0, 1});
  soup.points[2] = {2, 0, 0};
  const std::string flat = bytes_of(soup, {Format::stl, false});
  std::memcpy(normal.data(), flat.data() + 84, sizeof normal);
  CHECK(normal == std::array<float, 3>{0, 0, 0});
}

TEST_CASE("every available mesh survives every format that can represent it") {
  std::size_t meshes = 0, written = 0, refused = 0;
  auto paths = files_in(testdata() / "meshes");
  for (const auto& path : real_meshes())
    paths.push_back(path);
  for (const auto& path : paths) {
    const Result<PolygonSoup> soup = import_mesh(path);
    if (!soup || soup->points.size() > 60'000) continue;
    ++meshes;
    INFO(path);
    for (const ExportOptions& options : kEveryFormat) {
      if (options.format == Format::stl && !export_mesh(*soup, options)) {
        ++refused;
        continue;
      }
      ++written;
      check_same(options.format == Format::stl ? cornerwise(*soup) : *soup, import_text(bytes_of(*soup, options)));
    }
  }
  CAPTURE(meshes, written, refused);
  CHECK(meshes >= 10);
  CHECK(written >= 4 * meshes);
  CHECK(written + refused == 6 * meshes);
}

TEST_CASE("OpenMesh reads the files that are written") {
  using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;
  PolygonSoup soup;  // a grid with steps, triangles only so that every format holds it
  soup.name = "grid";
  constexpr std::uint32_t kSide = 12;
  for (std::uint32_t i = 0; i <= kSide; ++i) {
    for (std::uint32_t j = 0; j <= kSide; ++j)
      soup.points.push_back({i * 0.5, j * 0.25, (i * i + j) * 0.125});
  }
  soup.face_first.push_back(0);
  for (std::uint32_t i = 0; i < kSide; ++i) {
    for (std::uint32_t j = 0; j < kSide; ++j) {
      const std::uint32_t a = i * (kSide + 1) + j, b = a + kSide + 1;
      soup.corners.insert(soup.corners.end(), {a, b, b + 1, a, b + 1, a + 1});
      soup.face_first.push_back(soup.face_first.back() + 3);
      soup.face_first.push_back(soup.face_first.back() + 3);
    }
  }
  constexpr std::array<const char*, 6> kEndings = {".off", ".obj", ".ply", ".ply", ".stl", ".stl"};
  for (std::size_t i = 0; i < kEveryFormat.size(); ++i) {
    INFO(kEndings[i] << ", text " << kEveryFormat[i].is_text);
    std::istringstream stream(bytes_of(soup, kEveryFormat[i]));
    Mesh mesh;
    OpenMesh::IO::Options options = kEveryFormat[i].is_text ? OpenMesh::IO::Options::Default : OpenMesh::IO::Options::Binary;
    REQUIRE(OpenMesh::IO::read_mesh(mesh, stream, kEndings[i], options));
    CHECK(mesh.n_vertices() == soup.points.size());  // of STL, OpenMesh welds what it reads
    REQUIRE(mesh.n_faces() == soup.face_count());
    std::size_t f = 0, different = 0;
    for (const auto face : mesh.faces()) {
      std::uint32_t corner = soup.face_first[f++];
      std::array<std::array<double, 3>, 3> expected{}, found{};
      std::size_t k = 0;
      for (const auto vertex : mesh.fv_range(face)) {
        const Vec3& p = soup.points[soup.corners[corner + k]];
        const auto& q = mesh.point(vertex);
        expected[k] = {p.x, p.y, p.z};
        found[k] = {q[0], q[1], q[2]};
        if (++k == 3) break;
      }
      std::sort(expected.begin(), expected.end());
      std::sort(found.begin(), found.end());
      different += expected != found;
    }
    CHECK(different == 0);
  }
}
