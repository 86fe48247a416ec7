// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {
using Faces = std::vector<std::vector<std::uint32_t>>;

const std::string kFacet =
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0.5\n  endloop\n endfacet\n";

std::string binary(const std::string& title, std::uint32_t promised, std::uint32_t triangles) {
  std::string bytes = title;
  bytes.resize(80, ' ');
  put(bytes, promised);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (int i = 0; i < 12; ++i)
      put(bytes, i < 3 ? 0.0F : static_cast<float>(t) * 10.0F + 0.1F * static_cast<float>(i));
    put<std::uint16_t>(bytes, 0xABCD);
  }
  return bytes;
}
}  // namespace

TEST_CASE("STL text: each facet keeps its three points and its line") {
  const PolygonSoup soup = import_text("solid part one\n" + kFacet + kFacet + "endsolid part one\n");
  check_invariants(soup);
  CHECK((soup.format == Format::stl && soup.is_text));
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}});
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {3, 4, 5}});
  CHECK(soup.point_line == std::vector<std::uint32_t>{4, 5, 6, 11, 12, 13});
  CHECK(soup.face_line == std::vector<std::uint32_t>{2, 9});
}

TEST_CASE("STL text: several solids, any names, either case, any line ends") {
  std::string text = "solid facet normal\n" + kFacet + "endsolid\nsolid\nendsolid\nSOLID x\n" + kFacet + "ENDSOLID x y";
  CHECK(import_text(text).face_count() == 2);
  std::string upper = "solid\n" + kFacet + "endsolid\n";
  for (char& c : upper)
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  CHECK(import_text(upper).face_count() == 1);
  for (const std::string end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text)
      other += c == '\n' ? end : std::string(1, c);
    CHECK(import_text(other).face_count() == 2);
  }
}

TEST_CASE("STL text: named solids are parts") {
  const auto parts = [](const std::string& text) { return parts_of(import_text(text)); };
  using Lines = std::vector<std::string>;
  CHECK(parts("solid\n" + kFacet + "endsolid\n").empty());
  CHECK(parts("solid  left foot \t\r\n" + kFacet + "endsolid left foot\nsolid none\nendsolid\nsolid right\n" + kFacet + kFacet +
              "endsolid\nsolid\n" + kFacet + "endsolid\nsolid right\n" + kFacet + "endsolid\n") ==
        Lines{"left foot@0", "right@1", "@3", "right@4"});
  CHECK(parts("solid\n" + kFacet + "endsolid\nsolid b\n" + kFacet + "endsolid\nsolid b\n" + kFacet + "endsolid\n") ==
        Lines{"b@1", "b@2"});
  CHECK(parts("\xEF\xBB\xBFSolid  a\n" + kFacet + "EndSolid\n") == Lines{"a@0"});
}

TEST_CASE("STL text: any blanks between words, also without line ends") {
  CHECK(import_text(
            "  solid a\n\tfacet\tnormal 0 0 1\n\n outer\n loop vertex 0\v0\f0\nvertex 1 0\n0 VERTEX 0 1 0 endloop endfacet "
            "endsolid")
            .face_count() == 1);
}

TEST_CASE("STL text: a normal that is no number does not matter") {
  CHECK(import_text("solid\nfacet normal -nan(ind) x\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                    "0\nendloop\nendfacet\nendsolid\n")
            .face_count() == 1);
}

TEST_CASE("STL text: loops of other than three vertices are kept as they are") {
  CHECK(faces_of(import_text(
            "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nouter loop\nvertex 0 0 0\n"
            "vertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n")) == Faces{{0, 1}, {2, 3, 4, 5}});
}

TEST_CASE("STL text: a refusal names the line") {
  CHECK(refusal("solid a\n" + kFacet) ==
        "mesh: line 9: truncated: the file ends after 1 facets where 'endsolid' was due; fetch or export it again");
  CHECK(refusal("solid a\n" + kFacet.substr(0, kFacet.find("0.5"))).find("line 6: truncated: the file ends after 0 facets") !=
        std::string::npos);
  CHECK(refusal("solid a\nfacet normal 0 0 1\nvertex 0 0 0\n").find("line 3: found 'vertex' where 'outer' was due") !=
        std::string::npos);
  CHECK(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n").find("line 4: the vertex coordinate 'zero'") !=
        std::string::npos);
  CHECK(refusal("solid a\r\nfacet normal 0 0 1\r\nouter loop\r\nvertex 0 0,5 0\r\n") ==
        "mesh: line 4: the vertex coordinate '0,5' is not a number; write decimals with a point");
  CHECK(refusal("solid a\nendsolid\nrubbish\n").find("line 3: found 'rubbish' where 'solid' was due") != std::string::npos);
  CHECK(refusal("solid a\nendsolid\n").find("holds no face") != std::string::npos);
}

TEST_CASE("STL binary: triangles keep their float coordinates") {
  for (const std::string title : {"", "solid sphere", "solid\n facet", "OFF", "ply\n"}) {
    INFO(title);
    const PolygonSoup soup = import_text(binary(title, 600, 600));
    check_invariants(soup);
    CHECK((soup.format == Format::stl && !soup.is_text));
    CHECK(soup.relative_quantum == 0x1p-24);
    REQUIRE(soup.points.size() == 1'800);
    bool is_same = true;
    for (std::uint32_t c = 0; c < 1'800; ++c) {
      const auto at = [c](std::uint32_t k) {
        return double{static_cast<float>(c / 3) * 10.0F + 0.1F * static_cast<float>(3 + 3 * (c % 3) + k)};
      };
      is_same = is_same && soup.points[c] == Vec3{at(0), at(1), at(2)} && soup.corners[c] == c;
    }
    CHECK(is_same);
    CHECK(soup.face_first[600] == 1'800);
  }
}

TEST_CASE("STL binary: a size contradicting the count is refused, padding of less than a triangle is not") {
  CHECK(refusal(binary("solid a", 4, 3)).find("promises 4 triangles") != std::string::npos);  // its zero bytes give it away
  CHECK(refusal(binary("a", 4, 3), Format::stl) ==
        "mesh: truncated: the header promises 4 triangles (284 bytes), the file has 234 bytes; fetch or export it again");
  CHECK(refusal(binary("a", 4'294'967'295, 3), Format::stl).find("promises 4294967295 triangles (214748364834 bytes)") !=
        std::string::npos);
  CHECK(refusal(binary("a", 2, 3), Format::stl).find("contradicts itself: the header promises 2 triangles") !=
        std::string::npos);
  CHECK(refusal("short", Format::stl).find("the file has 5") != std::string::npos);
  CHECK(import_text(binary("a", 3, 3) + std::string(49, '\0'), Format::stl).face_count() == 3);
}

TEST_CASE("STL binary: a header with \"solid\" is not mistaken for text") {
  for (const std::string title :
       {"solid", "solid ascii", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "SOLID x"}) {
    INFO(title);
    CHECK_FALSE(import_text(binary(title, 3, 3)).is_text);
    CHECK_FALSE(import_text(binary(title, 3, 3) + std::string(2, '\0')).is_text);  // padded
    CHECK(refusal(binary(title, 3, 3) + std::string(120, 'x')).find("contradicts itself: the header promises 3") !=
          std::string::npos);
    CHECK(refusal(binary(title, 0, 3)).find("contradicts itself: the header promises 0 triangles (84 bytes)") !=
          std::string::npos);
    CHECK(refusal(binary(title, 0, 0)).find("holds no face") != std::string::npos);
    CHECK(refusal(binary(title, 4'294'967'295, 3)).find("truncated: the header promises 4294967295") != std::string::npos);
  }
}
