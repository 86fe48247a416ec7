// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {
using Faces = std::vector<std::vector<std::uint32_t>>;
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

TEST_CASE("OBJ: everything that is no geometry is ignored") {
  const PolygonSoup soup = import_text(
      "# comment\nmtllib a b.mtl\no thing\ng one two\n" + kPoints +
      "vn 0 0 1\nvt 0 0\nvp 1\nusemtl v\ns off\nl 1 2\np 1\n\n   f 1 2 3 # face\ncurv 0 1 1 2\nend\nf  1\t3  4  \n");
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("OBJ: lines end in LF, CRLF or CR, the last one perhaps in nothing") {
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
  CHECK(refusal("v 0 0\nf 1 1 1\n") == "mesh: line 1: a vertex needs three coordinates; the line ends early");
  CHECK(refusal(kPoints + "v 0,5 1 2\n") == "mesh: line 5: the vertex coordinate '0,5' is not a number");
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
