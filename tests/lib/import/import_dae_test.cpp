// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

const std::string kSquare =
    "<source id='s'><float_array id='a' count='12'>0 0 0 1 0 0 1 1 0 0 1 .5</float_array><technique_common><accessor "
    "source='#a' "
    "count='4' stride='3'><param name='X'/><param name='Y'/><param name='Z'/></accessor></technique_common></source>"
    "<vertices id='v'><input semantic='POSITION' source='#s'/></vertices>";
const std::string kInput = "<input semantic='VERTEX' source='#v' offset='0'/>";
const std::string kTriangle = "<triangles count='1'>" + kInput + "<p>0 1 2</p></triangles>";

// A file with one geometry, 'g', and the nodes of its scene.
std::string dae(const std::string& mesh, const std::string& nodes = "<node><instance_geometry url='#g'/></node>",
                const std::string& more = "", const std::string& asset = "") {
  return "<COLLADA version='1.4.1'><asset>" + asset + "</asset>\n<library_geometries><geometry id='g'><mesh>" + mesh +
         "</mesh></geometry></library_geometries>" + more + "<library_visual_scenes><visual_scene id='w'>" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

std::vector<Vec3> placed(const std::string& transforms) {
  return import_text(dae(kSquare + kTriangle, "<node>" + transforms + "<instance_geometry url='#g'/></node>")).points;
}

std::vector<std::vector<std::uint32_t>> faces_with(const std::string& primitive) {
  return faces_of(import_text(dae(kSquare + primitive)));
}

}  // namespace

TEST_CASE("COLLADA: every kind of primitive that holds faces") {
  using Faces = std::vector<std::vector<std::uint32_t>>;
  CHECK(faces_with(kTriangle) == Faces{{0, 1, 2}});
  CHECK(faces_with("<polylist count='2'>" + kInput + "<vcount>3 4</vcount><p>0 1 2 0 1 2 3</p></polylist>") ==
        Faces{{0, 1, 2}, {0, 1, 2, 3}});
  CHECK(faces_with("<polygons count='2'>" + kInput + "<p>0 1 2</p><p>3 2 1 0</p></polygons>") ==
        Faces{{0, 1, 2}, {3, 2, 1, 0}});
  CHECK(faces_with("<trifans count='1'>" + kInput + "<p>0 1 2 3</p></trifans>") == Faces{{0, 1, 2}, {0, 2, 3}});
  CHECK(faces_with("<tristrips count='1'>" + kInput + "<p>0 1 2 3</p></tristrips>") == Faces{{0, 1, 2}, {1, 3, 2}});
  CHECK(faces_with("<triangles count='1'><input semantic='NORMAL' source='#s' offset='0'/><input semantic='VERTEX' source='#v' "
                   "offset='1'/><p>9 0 9 1 9 2</p></triangles>") == Faces{{0, 1, 2}});
}

TEST_CASE("COLLADA: a number beyond the points is an invalid corner, as in the other formats") {
  CHECK(faces_with("<triangles count='1'>" + kInput + "<p>0 1 4</p></triangles>") ==
        std::vector<std::vector<std::uint32_t>>{{0, 1, kInvalid}});
}

TEST_CASE("COLLADA: what is left out is counted") {
  const PolygonSoup soup = import_text(
      dae(kSquare + kTriangle + "<lines count='7'/><tristrips count='2'>" + kInput + "<p>0 1 1 2 3</p><p>0 1</p></tristrips>"));
  CHECK(ignored_of(soup) ==
        std::vector<std::string>{"line elements: 7", "strip joints: 2", "strips of fewer than three vertices: 1"});
}

TEST_CASE("COLLADA: unit and axis are the file's, and points keep their bits") {
  const PolygonSoup soup =
      import_text(dae(kSquare + kTriangle, "<node><translate>0 0 0</translate><instance_geometry url='#g'/></node>", "",
                      "<unit meter='0.0254'/><up_axis>Z_UP</up_axis>"));
  CHECK(soup.metres_per_unit == 0.0254);
  CHECK(soup.up_axis == 'z');
  CHECK(soup.format == Format::dae);
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}});
  const PolygonSoup plain = import_text(dae(kSquare + kTriangle));
  CHECK(plain.metres_per_unit == 1);
  CHECK(plain.up_axis == 'y');
}

TEST_CASE("COLLADA: transforms apply in their order, quarter turns exactly") {
  CHECK(placed("<rotate>0 0 1 90</rotate>")[1] == Vec3{0, 1, 0});
  CHECK(placed("<rotate>1 0 0 -90</rotate>")[3] == Vec3{0, 0.5, -1});
  CHECK(placed("<rotate>0 2 0 180</rotate>")[1] == Vec3{-1, 0, 0});
  CHECK(placed("<translate>5 0 0</translate><scale>2 2 2</scale>")[1] == Vec3{7, 0, 0});
  CHECK(placed("<scale>2 2 2</scale><translate>5 0 0</translate>")[1] == Vec3{12, 0, 0});
  CHECK(placed("<matrix>0 -1 0 3 1 0 0 4 0 0 1 5 0 0 0 1</matrix>")[1] == Vec3{3, 5, 5});
  const Vec3 turned = placed("<rotate>0 0 1 30</rotate>")[1];
  CHECK(turned.x == Approx(std::sqrt(3.0) / 2).epsilon(1e-15));
  CHECK(turned.y == Approx(0.5).epsilon(1e-15));
}

TEST_CASE("COLLADA: a skew leans its axis by its angle towards the shift") {
  const auto near = [](const Vec3& a, const Vec3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) < 1e-15; };
  const std::vector<Vec3> along_x = placed("<skew>45 0 2 0 3 0 0</skew>");  // y leans towards x
  CHECK(near(along_x[1], {1, 0, 0}));
  CHECK(near(along_x[2], {2, 1, 0}));
  CHECK(near(along_x[3], {1, 1, 0.5}));
  // an axis that is not at right angles to the shift: x + y goes to the direction 30 degrees nearer to y
  const Vec3 leaning = placed("<skew>30 1 1 0 0 1 0</skew>")[2];
  CHECK(leaning.x == Approx(1).epsilon(1e-15));
  CHECK(leaning.y == Approx(std::tan(75 * 3.14159265358979323846 / 180)).epsilon(1e-14));
  CHECK(placed("<skew>0 0 1 0 1 0 0</skew>")[2] == Vec3{1, 1, 0});
}

TEST_CASE("COLLADA: what looks at a point has its -z there, and up above") {
  const std::vector<Vec3> points = placed("<lookat>5 0 0 5 0 -9 0 2 0</lookat>");  // as a camera stands without a turn
  CHECK(points[1] == Vec3{6, 0, 0});
  CHECK(points[3] == Vec3{5, 1, 0.5});
  const std::vector<Vec3> turned = placed("<lookat>0 0 0 7 0 0 1 0 3</lookat>");  // 'up' leans towards the point
  CHECK(turned[1] == Vec3{0, -1, 0});
  CHECK(turned[2] == Vec3{0, -1, 1});
  CHECK(turned[3] == Vec3{-0.5, 0, 1});
}

TEST_CASE("COLLADA: what a transform adds to the rounding is in the quantum") {
  const std::string digits = kSquare.substr(0, kSquare.find(".5")) + "0.125" + kSquare.substr(kSquare.find(".5") + 2);
  const PolygonSoup still = import_text(dae(digits + kTriangle));
  CHECK(still.absolute_quantum == 1e-5);  // 5e-4 of the three decimals, but at most 1e-5 of the extent
  const PolygonSoup moved = import_text(
      dae(digits + kTriangle, "<node><scale>3 3 3</scale><translate>100 0 0</translate><instance_geometry url='#g'/></node>"));
  CHECK(moved.relative_quantum == 0x1p-53);
  CHECK(moved.absolute_quantum >= 3e-5);
  CHECK(moved.absolute_quantum < 3.1e-5);
}

TEST_CASE("COLLADA: numbers that were floats before they were printed have a float's quantum, moved or not") {
  std::string floats = kSquare;
  floats.replace(floats.find(".5"), 2, "0.70710677");
  CHECK(import_text(dae(floats + kTriangle)).relative_quantum == 0x1p-24);
  const PolygonSoup moved =
      import_text(dae(floats + kTriangle, "<node><rotate>0 0 1 45</rotate><instance_geometry url='#g'/></node>"));
  CHECK(moved.relative_quantum == 0x1p-53);
  CHECK(moved.absolute_quantum >= 0x1p-24);
  CHECK(moved.absolute_quantum < 0x1p-22);
}

TEST_CASE("COLLADA: a mirrored node keeps its outside") {
  const PolygonSoup soup =
      import_text(dae(kSquare + kTriangle, "<node><scale>-1 1 1</scale><instance_geometry url='#g'/></node>"));
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 2, 1}});
  CHECK(soup.points[1] == Vec3{-1, 0, 0});
}

TEST_CASE("COLLADA: nodes are instanced, each with the parts that it shows") {
  const PolygonSoup soup = import_text(
      dae(kSquare + kTriangle,
          "<node name='a'><translate>0 0 1</translate><node name='b'><instance_geometry url='#g'/></node><instance_node "
          "url='#n'/></node>",
          "<library_nodes><node id='n'><translate>0 0 2</translate><instance_geometry url='#g'/></node></library_nodes>"));
  CHECK(parts_of(soup) == std::vector<std::string>{"b/g/primitive 0@0", "n/g/primitive 0@1"});
  REQUIRE(soup.points.size() == 8);
  CHECK(soup.points[0] == Vec3{0, 0, 1});
  CHECK(soup.points[4] == Vec3{0, 0, 3});
  CHECK(faces_of(soup)[1] == std::vector<std::uint32_t>{4, 5, 6});
}

TEST_CASE("COLLADA: materials by the names that the scene binds") {
  const std::string bound =
      "<node><instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='m' "
      "target='#steel'/></technique_common></bind_material></instance_geometry></node>";
  const std::string named = "<triangles count='1' material='m'>" + kInput + "<p>0 1 2</p></triangles>";
  const PolygonSoup soup = import_text(
      dae(kSquare + named, bound, "<library_materials><material id='steel' name='Steel &amp; co'/></library_materials>"));
  CHECK(soup.materials == std::vector<std::string>{"Steel & co"});
  CHECK(import_text(dae(kSquare + named)).materials == std::vector<std::string>{"m"});
}

TEST_CASE("COLLADA: skins are shown at rest, decimal commas and UTF-16 are read") {
  const std::string controller =
      "<library_controllers><controller id='c'><skin source='#g'/></controller></library_controllers>";
  const std::string text =
      dae(kSquare + kTriangle, "<node><translate>1,5 0 0</translate><instance_controller url='#c'/></node>", controller);
  const PolygonSoup soup = import_text(text);
  CHECK(soup.points[0] == Vec3{1.5, 0, 0});
  CHECK(ignored_of(soup) == std::vector<std::string>{"skins (shown at rest): 1"});
  std::string wide = "\xFF\xFE";
  for (const char c : text)
    wide += std::string{c, '\0'};
  CHECK(import_text(wide).points == soup.points);
}

TEST_CASE("COLLADA: without a scene every geometry is shown once") {
  std::string text = dae(kSquare + kTriangle);
  text.erase(text.find("<library_visual"));
  CHECK(import_text(text + "</COLLADA>").face_count() == 1);
}

TEST_CASE("COLLADA: refusals name line, element, value and remedy") {
  const auto says = [](const std::string& text, const std::string& words) {
    const std::string message = refusal(text);
    INFO(message);
    CHECK(message.find(words) != std::string::npos);
  };
  says(dae(kSquare + "<polygons count='1'>" + kInput + "<ph><p>0 1 2</p><h>1 2 3</h></ph></polygons>"),
       "line 2: <ph> of geometry 'g' is a polygon with holes, which is not read; triangulate on export");
  says(dae(kSquare + "<triangles count='2'>" + kInput + "<p>0 1 2</p></triangles>"),
       "is truncated: it promises 2 triangles and holds 1");
  says(dae(kSquare + "<triangles count='1'>" + kInput + "<p>0 1 x</p></triangles>"),
       "has 'x' as value 2, which is not a whole number");
  says(dae(kSquare + "<polylist count='1'>" + kInput + "<vcount>65537</vcount><p>0</p></polylist>"),
       "has 65537 corners; the limit is 65536");
  says(dae(kSquare + kTriangle, "<node id='n'><instance_node url='#n'/></node>"), "perhaps itself");
  says(dae(kSquare + kTriangle, "<node><instance_geometry url='#h'/></node>"), "the file has none of this id");
  const auto refuses = [&says](const std::string& transform, const std::string& words) {
    says(dae(kSquare + kTriangle, "<node>" + transform + "<instance_geometry url='#g'/></node>"), words);
  };
  refuses("<lookat>0</lookat>", "has 1 numbers, not 9");
  refuses("<lookat>1 2 3 1 2 3 0 1 0</lookat>", "looks at its own place");
  refuses("<lookat>0 0 0 0 5 0 0 1 0</lookat>", "looks straight up");
  refuses("<skew>30 0 1 0 0 2 0</skew>", "skews an axis along itself");
  refuses("<skew>90 1 0 0 0 1 0</skew>", "reaches the axis of the shift");
  says(dae(kSquare + kTriangle, "<node><matrix>1 2</matrix></node>"), "has 2 numbers, not 16");
  says("<COLLADA version='1.3.0'/>", "version '1.3.0'");
  says("<COLLADA><asset></COLLADA>", "no well-formed XML");
  std::string entity = dae(kSquare + "<triangles count='1'>" + kInput + "<p>&a; 1 2</p></triangles>");
  says("<!DOCTYPE COLLADA [<!ENTITY a '0'>]>" + entity, "'&a;'");  // never expanded
}

TEST_CASE("COLLADA: instances of instances stop at a limit") {
  std::string nodes;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<instance_node url='#n" + std::to_string(i + 1) + "'/>";
    nodes += "<node id='n" + std::to_string(i) + "'>" + next + next + "</node>";
  }
  const std::string library = "<library_nodes>" + nodes + "<node id='n40'><instance_geometry url='#g'/></node></library_nodes>";
  CHECK(refusal(dae(kSquare + kTriangle, "<node><instance_node url='#n0'/></node>", library))
            .find("the limit for a file of this size") != std::string::npos);
}
