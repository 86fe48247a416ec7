// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {
using Faces = std::vector<std::vector<std::uint32_t>>;
using Lines = std::vector<std::string>;
const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
}  // namespace

TEST_CASE("OBJ: corners in all four forms name the same vertices") {
  const PolygonSoup soup =
      import_text(kPoints + "f 1 2 3\nf 1/7 2/8 3/9\nf 1//4 2//5 3//6\nf 1/1/1 2/2/2 3/3/3 4/4/4\nfo 1 3 4\n");
  check_invariants(soup);
  CHECK(soup.format == Format::obj);
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2, 3}, {0, 2, 3}});
  CHECK(soup.point_line == std::vector<std::uint32_t>{1, 2, 3, 4});
  CHECK(soup.face_line == std::vector<std::uint32_t>{5, 6, 7, 8, 9});
}

TEST_CASE("OBJ: negative numbers count back from the vertices so far") {
  CHECK(faces_of(import_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -1/-1/-1 -2 -3\nf -5 1 2\n")) ==
        Faces{{0, 1, 2}, {3, 2, 1}, {kInvalid, 0, 1}});
}

TEST_CASE("OBJ: a face may stand before its vertices; numbers that no vertex has are invalid") {
  const PolygonSoup soup = import_text("f 1 2 3\nf 0 1 5\nf 4294967296 4294967297 18446744073709551617\n" + kPoints);
  check_invariants(soup);
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {kInvalid, 0, kInvalid}, {kInvalid, kInvalid, kInvalid}});
}

TEST_CASE("OBJ: weights and colours after a vertex are ignored") {
  const PolygonSoup soup = import_text("v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0 1 0 0 1\nf 1 2 3\n");
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
}

TEST_CASE("OBJ: a backslash joins lines, in vertices and faces") {
  for (const std::string join : {"\\\n", "\\\r\n", " \\ \n \t"}) {
    const PolygonSoup soup =
        import_text("v 0 0 0\nv 1 " + join + " 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 " + join + " 3" + join + " 4\nf 1 3 4\n");
    check_invariants(soup);
    CHECK(faces_of(soup) == Faces{{0, 1, 2, 3}, {0, 2, 3}});
    CHECK(soup.face_line == std::vector<std::uint32_t>{6, 9});
  }
}

TEST_CASE("OBJ: a comment or a name that ends in a backslash does not swallow the next line") {
  CHECK(import_text("# made in C:\\models\\\nv 0 0 0\no C:\\models\\\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").points.size() == 3);
}

TEST_CASE("OBJ: statements that are no geometry are ignored") {
  const PolygonSoup soup = import_text(
      "# comment\nmtllib a b.mtl\no thing\ng one two\n" + kPoints +
      "vn 0 0 1\nvt 0 0\nvp 1\nusemtl v\ns off\nl 1 2\np 1\n\n   f 1 2 3 # face\ncurv 0 1 1 2\nend\nf  1\t3  4  \n");
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 2, 3}});
  CHECK(ignored_of(soup) == Lines{"line elements: 1", "point elements: 1", "free-form curves: 1"});
}

TEST_CASE("OBJ: unsupported geometry and unknown statements are counted by kind") {
  const PolygonSoup soup = import_text(kPoints +
                                       "l 1 2\nl 2 3\np 1 2 3\ncstype bezier\ncurv 0 1 1 2\ncurv2 1 2\nparm u 0 1\nend\n"
                                       "surf 0 1 0 1 1 2 3 4\nbzp 1 2\ncall more.obj\nfacet 1 2 3\nf 1 2 3\nL 1 2\n");
  CHECK(ignored_of(soup) == Lines{"line elements: 2", "point elements: 1", "free-form curves: 2", "free-form surfaces: 2",
                                  "calls of other files: 1", "unknown statements: 2"});
  CHECK(ignored_of(import_text("mtllib a\ns 1\nvn 0 0 1\nvt 0 0\nlod 1\n" + kPoints + "f 1 2 3\n")).empty());
}

TEST_CASE("OBJ: objects, groups and materials name parts, each from its first face on") {
  const std::string face = "f 1 2 3\n";
  const auto parts = [&](const std::string& text) { return parts_of(import_text(kPoints + text)); };
  CHECK(parts(face + face).empty());
  CHECK(parts("o body\n" + face) == Lines{"body@0"});
  CHECK(parts(face + "o body\n" + face + face + "g lid top\nusemtl steel\n" + face + "usemtl tin\n" + face + "o\n" + face) ==
        Lines{"body@1", "body/lid top/steel@3", "body/lid top/tin@4", "lid top/tin@5"});
  CHECK(parts("usemtl a\nusemtl b\n" + face + "usemtl b\ng\n" + face + "usemtl a\nusemtl b\n" + face + "usemtl c\n") ==
        Lines{"b@0"});
  CHECK(parts("g a\n" + face + "g\n" + face + "g a\n" + face) == Lines{"a@0", "@1", "a@2"});
  CHECK(parts("o  C:\\parts #1 \t\r\n" + face) == Lines{"C:\\parts #1@0"});
}

TEST_CASE("OBJ: a part's name is short and on one line, cut between two characters") {
  const auto name = [](const std::string& o) { return import_text(kPoints + "o " + o + "\nf 1 2 3\n").parts.at(0).name; };
  CHECK(name("a\x01\tb\x7F") == "a??b?");
  CHECK(name(std::string(48, 'x')) == std::string(48, 'x'));
  CHECK(name(std::string(49, 'x')) == std::string(48, 'x') + "...");
  CHECK(name(std::string(47, 'x') + "\xC3\xA4") == std::string(47, 'x') + "...");
  CHECK(name(std::string(46, 'x') + "\xC3\xA4" + "y") == std::string(46, 'x') + "\xC3\xA4...");
}

TEST_CASE("OBJ: the number of parts is bounded, and reaching the bound is reported") {
  std::string text = kPoints;
  constexpr int kFaces = 20'000;
  for (int f = 0; f < kFaces; ++f)
    text += f % 2 == 0 ? "g\nf 1 2 3\n" : "g a\nf\n";
  const PolygonSoup soup = import_text(text);
  check_invariants(soup);
  CHECK(soup.face_count() == kFaces);
  CHECK(soup.parts.size() < 64 + 2 + text.size() / 16);
  CHECK(soup.parts.back().name == "(further parts)");
  REQUIRE(soup.ignored.size() == 1);
  // but the first face, whose empty name switches from nothing
  CHECK(soup.ignored[0].what == "further parts");
  CHECK(soup.ignored[0].count + soup.parts.size() == kFaces - 1);
}

TEST_CASE("OBJ: line numbers are right after CRLF, joined lines and comments") {
  const PolygonSoup soup =
      import_text("# one\r\nv 0 0 0\r\nv 1 \\\r\n  0 0\r\n\r\nv 1 1 0 # \\\r\nf 1 \\\r\n2 \\\r\n3\r\nf 1 2 3\r\n");
  CHECK(soup.point_line == std::vector<std::uint32_t>{2, 3, 6});
  CHECK(soup.face_line == std::vector<std::uint32_t>{7, 10});
  CHECK(refusal("v 0 0 0\r\nv 1 \\\r\n 0\r\n").find("mesh: line 2: a vertex needs three") == 0);
  CHECK(refusal("v 0 0 0\r\nv 1 \\\r\n x 0\r\n").find("mesh: line 3: the vertex coordinate 'x'") == 0);
}

TEST_CASE("OBJ: lines end in LF, CRLF or CR; the last line end is optional") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const PolygonSoup soup = import_text("v 0 0 0" + end + "v 1 0 0" + end + "v 1 1 0" + end + "f 1 2 3");
    CHECK(faces_of(soup) == Faces{{0, 1, 2}});
    CHECK(soup.face_line == std::vector<std::uint32_t>{4});
  }
}

TEST_CASE("OBJ: NaN and infinite points are kept") {
  const PolygonSoup soup = import_text("v nan 0 -1.#IND\nv +inf 0 1.#INF\nv -nan(ind) -Infinity 1e999\nf 1 2 3\n");
  check_invariants(soup);
  CHECK((std::isnan(soup.points[0].x) && std::isnan(soup.points[0].z) && std::isnan(soup.points[2].x)));
  CHECK(soup.points[1] == Vec3{HUGE_VAL, 0, HUGE_VAL});
  CHECK((soup.points[2].y == -HUGE_VAL && soup.points[2].z == HUGE_VAL));
}

TEST_CASE("OBJ: faces of fewer than three corners are kept as they are") {
  CHECK(faces_of(import_text(kPoints + "f\nf 1\nf 1 2\n")) == Faces{{}, {0}, {0, 1}});
}

TEST_CASE("OBJ: a refusal names the line and the token") {
  CHECK(refusal("v 0 0\nf 1 1 1\n") ==
        "mesh: line 1: a vertex needs three coordinates, but the line ends early; correct the file or export it again");
  CHECK(refusal(kPoints + "v 0,5 1 2\n") ==
        "mesh: line 5: the vertex coordinate '0,5' is not a number; write decimals with a point");
  CHECK(refusal(kPoints + "f 1 2 x\n").find("line 5: the face corner 'x'") != std::string::npos);
  CHECK(refusal(kPoints + "f 1 2.5 3\n").find("line 5: a face corner has '.5' after its vertex number") != std::string::npos);
  CHECK(refusal(kPoints + "f /1 2 3\n").find("line 5") != std::string::npos);
  CHECK(refusal(kPoints).find("holds no face, 4 vertices") != std::string::npos);
}

TEST_CASE("OBJ: a face of more corners than the limit is refused, one at the limit is kept") {
  const auto file = [](int corners) {
    std::string text = kPoints + "f 1 2 3\nf";
    for (int i = 0; i < corners; ++i)
      text += " " + std::to_string(i % 4 + 1);
    return text + "\n";
  };
  CHECK(import_text(file(65'536)).corners.size() == 65'539);
  CHECK(refusal(file(1'000'000)) ==
        "mesh: line 6: face 1 has 1000000 corners; the limit is 65536: cut it into smaller polygons");
}
