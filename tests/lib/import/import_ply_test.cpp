// SPDX-License-Identifier: Apache-2.0
// The PLY header and the text body; import_ply_binary_test.cpp has the binary bodies.
#include "import/import_ply.hpp"

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {
using Faces = std::vector<std::vector<std::uint32_t>>;

const std::string kVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "property list uchar int vertex_indices\n";
const std::string kPoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string ascii(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}
}  // namespace

TEST_CASE("PLY text: polygons keep their order, their corners and their lines") {
  const PolygonSoup soup = import_text(ascii(kVertices + "element face 2\n" + kFace, kPoints + "\n4 0 1 2 3\n3 0 2 3\n"));
  check_invariants(soup);
  CHECK((soup.format == Format::ply && soup.is_text));
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  CHECK(faces_of(soup) == Faces{{0, 1, 2, 3}, {0, 2, 3}});
  CHECK(soup.point_line == std::vector<std::uint32_t>{10, 11, 12, 13});
  CHECK(soup.face_line == std::vector<std::uint32_t>{15, 16});
}

TEST_CASE("PLY text: any properties, lists and elements around the geometry are skipped") {
  const PolygonSoup soup = import_text(
      ascii("comment by hand\nobj_info none\nelement camera 2\nproperty float f\nproperty list uchar int steps\n"
            "element vertex 3\nproperty uchar red\nproperty double z\nproperty list int float weights\nproperty float "
            "y\nproperty int x\n"
            "element face 2\nproperty uchar flag\nproperty list uchar uint vertex_index\nproperty list uchar float texcoord\n"
            "element edge 1\nproperty int a\nproperty int b\nelement nothing 7\n",
            "1.5 2 7 8\nnan 0\n255 3 0 2 1\n0 30 2 .5 .5 20 10\n1 31 1 1 21 11\n9 3 0 1 2 0\n9 3 2 1 0 2 .5 .5\n0 1\n"));
  check_invariants(soup);
  CHECK(soup.points == std::vector<Vec3>{{1, 2, 3}, {10, 20, 30}, {11, 21, 31}});
  CHECK(ignored_of(soup) == std::vector<std::string>{"'camera' elements: 2", "'edge' elements: 1"});
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {2, 1, 0}});
}

TEST_CASE("PLY text: faces may come before the vertices") {
  const PolygonSoup soup = import_text(ascii("element face 2\n" + kFace + kVertices, "3 0 1 2\n3 0 2 4\n" + kPoints));
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 2, kInvalid}});
}

TEST_CASE("PLY text: a number that no vertex has keeps its place as invalid") {
  const PolygonSoup soup =
      import_text(ascii(kVertices + "element face 3\n" + kFace, kPoints + "3 0 1 4\n3 -1 1 2\n2 3 99999999999999999999\n"));
  check_invariants(soup);
  CHECK(faces_of(soup) == Faces{{0, 1, kInvalid}, {kInvalid, 1, 2}, {3, kInvalid}});
}

TEST_CASE("PLY text: coordinates are read as decimals, whatever their declared type") {
  const PolygonSoup soup =
      import_text(ascii(kVertices + "element face 1\n" + kFace, "0.1 1e-3 +5\n" + kPoints.substr(6) + "3 0 1 2\n"));
  CHECK(soup.points[0] == Vec3{0.1, 1e-3, 5});
}

TEST_CASE("PLY text: triangle strips become triangles of one winding") {
  const std::string header =
      "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 2\nproperty list int int "
      "vertex_indices\n";
  const PolygonSoup soup = import_text(ascii(header,
                                             "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n"
                                             "5 0 2 1 3 4\n9 -1 0 2 1 -1 3 4 -1 9\n"));
  check_invariants(soup);
  CHECK(faces_of(soup) == Faces{{0, 2, 1}, {1, 2, 3}, {1, 3, 4}, {0, 2, 1}});
  CHECK(soup.face_line == std::vector<std::uint32_t>{16, 16, 16, 17});
}

TEST_CASE("PLY text: triangles that join strips are counted and no faces; strips without a triangle are counted") {
  const auto strips = [](const std::string& type, const std::string& list) {
    return import_text(ascii(kVertices + "element tristrips 1\nproperty list int " + type + " vertex_index\n", kPoints + list));
  };
  // 0 1 2 2 3 3 1 0: the four triangles with a repeated corner turn the winding over
  const PolygonSoup joined = strips("int", "8 0 1 2 2 3 3 1 0\n");
  check_invariants(joined);
  CHECK(faces_of(joined) == Faces{{0, 1, 2}, {1, 3, 0}});
  CHECK(ignored_of(joined) == std::vector<std::string>{"strip joints: 4"});
  CHECK(joined.face_line == std::vector<std::uint32_t>{14, 14});
  // numbers of no vertex are no joints, but a defect to be seen
  CHECK(faces_of(strips("int", "4 9 9 1 2\n")) == Faces{{kInvalid, kInvalid, 1}, {1, kInvalid, 2}});
  const PolygonSoup broken = strips("int", "12 0 -1 1 2 -1 -1 0 1 2 -1 3 -1\n");
  CHECK(faces_of(broken) == Faces{{0, 1, 2}});
  CHECK(ignored_of(broken) == std::vector<std::string>{"strips of fewer than three vertices: 3"});
  CHECK(ignored_of(strips("int", "5 0 1 2 -1 3\n")) == std::vector<std::string>{"strips of fewer than three vertices: 1"});
  // parity counts from each strip's own start, joints included
  CHECK(faces_of(strips("int", "9 0 1 2 3 -1 0 1 2 3\n")) == Faces{{0, 1, 2}, {2, 1, 3}, {0, 1, 2}, {2, 1, 3}});
  for (const auto& [type, minus_one] : std::vector<std::pair<std::string, std::string>>{{"char", "-1"},
                                                                                        {"uchar", "255"},
                                                                                        {"ushort", "65535"},
                                                                                        {"uint", "4294967295"},
                                                                                        {"float", "-1.0"},
                                                                                        {"double", "-1"}}) {
    INFO(type);
    CHECK(faces_of(strips(type, "7 0 1 2 " + minus_one + " 0 2 3\n")) == Faces{{0, 1, 2}, {0, 2, 3}});
  }
}

TEST_CASE("PLY text: whole numbers may be written as reals where the header says float") {
  const auto face = [](const std::string& type, const std::string& row) {
    return ascii(kVertices + "element face 1\nproperty list uchar " + type + " vertex_index\n", kPoints + row);
  };
  CHECK(faces_of(import_text(face("float", "3 0.0 1 2.\n"))) == Faces{{0, 1, 2}});
  CHECK(faces_of(import_text(face("double", "3 1e0 -1.0 1e300\n"))) == Faces{{1, kInvalid, kInvalid}});
  CHECK(refusal(face("int", "3 0.0 1 2\n")).find("'0.0' is not a whole number") != std::string::npos);
  CHECK(refusal(face("float", "3 0.5 1 2\n")).find("'0.5' is not a whole number") != std::string::npos);
  CHECK(refusal(face("float", "3 nan 1 2\n")).find("'nan' is not a whole number") != std::string::npos);
}

TEST_CASE("PLY: a byte order mark before the header is skipped") {
  const std::string text = "\xEF\xBB\xBF" + ascii(kVertices + "element face 1\n" + kFace, kPoints + "3 0 1 2\n");
  CHECK(import_text(text).face_line == std::vector<std::uint32_t>{14});
  CHECK(import_text(text, Format::ply).face_count() == 1);
}

TEST_CASE("PLY text: rows may run over several lines, but not share one") {
  CHECK(import_text(ascii(kVertices + "element face 1\n" + kFace, "0 0\n0\n1 0 0\n1 1 0\n0 1 0\n3\n0 1\n2\n")).face_count() ==
        1);
  CHECK(refusal(ascii(kVertices + "element face 1\n" + kFace, "0 0 0 1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"))
            .find("line 10: row 0 of 4 of element 'vertex' has more values than the header lists, from '1' on") !=
        std::string::npos);
}

TEST_CASE("PLY: the header's lines end in LF, CRLF or CR") {
  const std::string unix_text = ascii(kVertices + "element face 1\n" + kFace, kPoints + "3 0 1 2\n");
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : unix_text)
      text += c == '\n' ? end : std::string(1, c);
    const PolygonSoup soup = import_text(text);
    check_invariants(soup);
    CHECK(soup.face_line == std::vector<std::uint32_t>{14});
  }
}

TEST_CASE("PLY: a header that contradicts itself is refused with the reason") {
  const auto header = [](const std::string& elements) { return refusal(ascii(elements, kPoints + "3 0 1 2\n")); };
  CHECK(refusal("ply\nelement vertex 1\nend_header\n").find("no 'format' line") != std::string::npos);
  CHECK(refusal("ply\nformat binary_middle_endian 1.0\nend_header\n").find("line 2: the PLY format is none of") !=
        std::string::npos);
  CHECK(refusal("ply\nformat ascii 2.0\nend_header\n").find("version") != std::string::npos);
  CHECK(refusal("ply\nformat ascii 1.0\nelement vertex 4\n").find("no line 'end_header'") != std::string::npos);
  CHECK(header("property float x\n").find("before the first element") != std::string::npos);
  CHECK(header("element vertex\n").find("has no count") != std::string::npos);
  CHECK(header("element vertex -4\n").find("has no count") != std::string::npos);
  CHECK(header("element vertex 4\nproperty half x\n").find("line 4: a property has the unknown type 'half'") !=
        std::string::npos);
  CHECK(header("element vertex 4\nproperty float\n").find("has no name") != std::string::npos);
  CHECK(header("element face 1\nproperty list text int vertex_indices\n").find("count of unknown type") != std::string::npos);
  CHECK(header(kVertices + kVertices).find("declared twice") != std::string::npos);
  CHECK(header(kVertices + "property float x\n").find("property 'x' twice") != std::string::npos);
  CHECK(header("element vertex 4\nproperty float x\nproperty float y\n").find("lacks one of") != std::string::npos);
  CHECK(header("element vertex 4\nproperty list uchar float x\n").find("must not be a list") != std::string::npos);
  CHECK(header(kVertices + "element face 1\nproperty int vertex_indices\n").find("must be a list") != std::string::npos);
  CHECK(header(kVertices + "element face 1\nproperty int flags\n").find("no list property vertex_indices") !=
        std::string::npos);
  CHECK(
      header(kVertices + "element face 1\n" + kFace + "property list uchar int vertex_index\n").find("two lists of vertices") !=
      std::string::npos);
  std::string elements;
  for (int i = 0; i < 10'000; ++i)
    elements += "element e" + std::to_string(i) + " 1\n";
  CHECK(header(elements).find("line 259: the PLY header declares more than 256 elements") != std::string::npos);
  CHECK(header(kVertices + "texture a.png\n").find("a line that starts with 'texture'") != std::string::npos);
  CHECK(refusal("plyx\n", Format::ply).find("does not start with 'ply'") != std::string::npos);
  CHECK(refusal("solid\n", Format::ply).find("does not start with 'ply'") != std::string::npos);
}

TEST_CASE("PLY text: a refusal names the line, what was expected and what was found") {
  const auto body = [](const std::string& rows) { return refusal(ascii(kVertices + "element face 1\n" + kFace, rows)); };
  CHECK(body(kPoints + "3 0 1\n") ==
        "mesh: line 15: truncated: the file ends in row 0 of 1 of element 'face'; fetch or export it again");
  CHECK(body("0 0 0\n1 0\n").find("the header promises 4 rows of element 'vertex'") != std::string::npos);
  CHECK(body("0 0 0\n1 a 0\n1 1 0\n0 1 0\n3 0 1 2\n").find("line 11: row 1 of 4 of element 'vertex': 'a' is not a number") !=
        std::string::npos);
  CHECK(body(kPoints + "3 0 1 2.5\n").find("the vertex number '2.5' is not a whole number") != std::string::npos);
  CHECK(body(kPoints + "-3 0 1 2\n").find("the list's count '-3'") != std::string::npos);
  CHECK(body(kPoints + "3 0 1 2\n3 2 1 0\n").find("line 15: data follows the last row") != std::string::npos);
  CHECK(body(kPoints + "65537 0 1 2\n") ==
        "mesh: line 14: face 0 has 65537 corners; the limit is 65536: cut it into smaller polygons");
}

TEST_CASE("PLY text: a list of more values than the file has bytes is refused at once") {
  // A control character was taken for a value of no length, 2^62 times over.
  const std::string vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  for (const std::string count : {"4611686018427387904", "99999999999999999999", "1000"}) {
    INFO(count);
    CHECK(refusal(ascii(vertex + "property list int int a\nelement face 1\n" + kFace, "0 0 0 " + count + " \x01 0\n3 0 0 0\n"))
              .find("line 11: truncated: row 0 of 1 of element 'vertex' has a list of ") != std::string::npos);
  }
  CHECK(import_text(ascii(vertex + "property list int int a\nelement face 1\n" + kFace, "0 0 0 2 \x01 0\n3 0 0 0\n"))
            .face_count() == 1);
}

TEST_CASE("a strip of n vertices holds n - 2 triangles, wound alike") {
  fdcg::bake::ply::StripDecoder strip;
  CHECK_FALSE(strip.add(1));
  CHECK_FALSE(strip.add(2));
  CHECK(strip.add(3));
  CHECK(strip.corners() == std::array<std::uint32_t, 3>{1, 2, 3});
  CHECK(strip.add(4));
  CHECK(strip.corners() == std::array<std::uint32_t, 3>{3, 2, 4});
  CHECK(strip.add(5));
  CHECK(strip.corners() == std::array<std::uint32_t, 3>{3, 4, 5});
  strip.restart();
  CHECK_FALSE(strip.add(6));
  CHECK_FALSE(strip.add(7));
}
