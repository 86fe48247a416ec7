// SPDX-License-Identifier: Apache-2.0
#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {
const std::string kTriangle = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
}

TEST_CASE("OFF: polygons keep their order, their corners and their lines") {
  const PolygonSoup soup = import_text("OFF\n4 2 0\n\n0 0 0\n1 0 0\n# two more\n1 1 0\n0 1 0.5\n4 0 1 2 3\n\n3 0 2 1\n");
  check_invariants(soup);
  CHECK(soup.format == Format::off);
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}});
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3}, {0, 2, 1}});
  CHECK(soup.point_line == std::vector<std::uint32_t>{4, 5, 7, 8});
  CHECK(soup.face_line == std::vector<std::uint32_t>{9, 11});
}

TEST_CASE("OFF: the header may have counts on its line, comments, no edge count, no keyword") {
  for (const std::string header : {"OFF 3 1 3\n", "OFF\n3 1 3\n", "# first\n\nOFF # keyword\n# counts\n3 # v\n1 0\n",
                                   "OFF\n3 1\n", "OFF\r\n3 1 0\r\n", "\xEF\xBB\xBFOFF 3 1 0\n", "OFF 3 1 0 # end\n"}) {
    INFO(header);
    CHECK(faces_of(import_text(header + kTriangle)) == std::vector<std::vector<std::uint32_t>>{{0, 1, 2}});
  }
  CHECK(import_text("3 1 0\n" + kTriangle, Format::off).face_count() == 1);
  std::string points;
  for (int i = 0; i < 42; ++i)
    points += std::to_string(i) + " 0 0\n";
  CHECK(import_text("42 1 0\n" + points + "3 0 1 41\n", Format::off).points.size() == 42);
}

TEST_CASE("OFF: colours, normals and texture coordinates after a vertex or a face are ignored") {
  for (const std::string keyword : {"OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCNOFF", "NCSTOFF"}) {
    INFO(keyword);
    const PolygonSoup soup = import_text(
        keyword + "\n3 2 0\n0 0 0 255 0 0 1\n1 0 0 0.5 .5 .5\n0 1 0 1\n3 0 1 2 255 255 255\n3 2 1 0 0.1 0.2 0.3 1\n");
    CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 1, 2}, {2, 1, 0}});
  }
}

TEST_CASE("OFF: several vertices and faces may stand on one line") {
  const PolygonSoup soup = import_text("OFF 3 2 0 0 0 0 1 0 0 0 1 0 3 0 1 2 3 2 1 0");
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 1, 2}, {2, 1, 0}});
  CHECK(import_text("OFF\n3 2 0\n0 0 0 1 0 0\n0 1 0\n3 0 1 2 3 2 1 0\n").face_count() == 2);
  CHECK(import_text("OFF\n3 1 0\n0\n0\n0\n1 0 0\n0 1 0\n3\n0\n1 2\n").face_count() == 1);
}

TEST_CASE("OFF: a number that no vertex has keeps its place as invalid") {
  const PolygonSoup soup =
      import_text("OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n3 -1 1 2\n3 0 99999999999999999999 4294967295\n");
  check_invariants(soup);
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 1, kInvalid}, {kInvalid, 1, 2}, {0, kInvalid, kInvalid}});
}

TEST_CASE("OFF: faces of fewer than three corners are kept as they are") {
  const PolygonSoup soup = import_text("OFF\n3 4 0\n0 0 0\n1 0 0\n0 1 0\n0\n1 2\n2 0 1\n3 0 1 2\n");
  check_invariants(soup);
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{}, {2}, {0, 1}, {0, 1, 2}});
}

TEST_CASE("OFF: kinds that are not read are refused by name") {
  CHECK(refusal("OFF BINARY\n\0\0\0\3").find("binary OFF") != std::string::npos);
  CHECK(refusal("COFF BINARY\n\0\0\0\3").find("binary OFF") != std::string::npos);
  CHECK(refusal("C4nOFF 4\n1 1 0\n0 0 0 1\n1 0\n").find("'C4nOFF'") != std::string::npos);
  for (const std::string keyword : {"CCOFF", "XOFF", "COF", "off", "OFFC", "ST", "C"}) {
    INFO(keyword);
    CHECK(refusal(keyword + "\n3 1 0\n" + kTriangle, Format::off).find("'" + keyword + "' in place of the keyword OFF") !=
          std::string::npos);
  }
  CHECK(refusal("4OFF\n1 1 0\n0 0 0 1\n1 0\n").find("'4OFF'") != std::string::npos);
  CHECK(refusal("nOFF 4\n1 1 0\n0 0 0 1\n1 0\n").find("'nOFF'") != std::string::npos);
}

TEST_CASE("OFF: a refusal names the line, what was expected and what was found") {
  CHECK(refusal("OFF\n3 2 0\n" + kTriangle) ==
        "mesh: line 7: truncated: the header promises 2 faces, the file ends after 1; fetch or export it again");
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 0\n").find("line 5: truncated: the header promises 3 vertices, the file ends after 1") !=
        std::string::npos);
  CHECK(
      refusal("OFF\n3 1 0\n" + kTriangle + "3 0 1 2\n").find("line 7: the header promises 3 vertices and 1 faces, but data") !=
      std::string::npos);
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n").find("line 4: vertex 1: 'x' is not a number") !=
        std::string::npos);
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2.5\n").find("line 6: face 0: the vertex number '2.5'") !=
        std::string::npos);
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n").find("line 6: face 0: the corner count '-3'") !=
        std::string::npos);
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 0,5 0\n0 1 0\n3 0 1 2\n").find("'0,5' is not a number; write decimals with a point") !=
        std::string::npos);
  CHECK(refusal("OFF\n-3 1 0\n").find("the vertex count '-3'") != std::string::npos);
  CHECK(refusal("OFF\n3\n").find("before the face count") != std::string::npos);
  CHECK(refusal("OFF\n").find("before the vertex count") != std::string::npos);
  CHECK(refusal("COFF\n3 1 0\n0 0 0 1 1 1 1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n").find("several on a line") != std::string::npos);
  CHECK(refusal("hello\n", Format::off).find("'hello' in place of the keyword OFF") != std::string::npos);
}

TEST_CASE("OFF: a face of more corners than the limit is refused, one at the limit is kept") {
  const auto file = [](int corners) {
    std::string text = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" + std::to_string(corners);
    for (int i = 0; i < corners; ++i)
      text += " " + std::to_string(i % 3);
    return text + "\n";
  };
  CHECK(import_text(file(65'536)).corners.size() == 65'539);
  CHECK(refusal(file(65'537)) == "mesh: line 7: face 1 has 65537 corners; the limit is 65536: cut it into smaller polygons");
}

TEST_CASE("OFF: line numbers are right after CRLF, CR, comments and empty lines") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : std::string("# made by hand\nCOFF # colours\n\n3 # vertices\n1 0\n") + kTriangle)
      text += c == '\n' ? end : std::string(1, c);
    const PolygonSoup soup = import_text(text);
    CHECK(soup.point_line == std::vector<std::uint32_t>{6, 7, 8});
    CHECK(soup.face_line == std::vector<std::uint32_t>{9});
  }
}
