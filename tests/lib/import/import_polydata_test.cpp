// SPDX-License-Identifier: Apache-2.0
// VTK's polydata, legacy and XML, and X3D. The cubes of testdata hold what is usual; here is what is not.
#include <cmath>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

using Faces = std::vector<std::vector<std::uint32_t>>;

std::string vtk(const std::string& cells) {
  return "# vtk DataFile Version 4.2\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0 1 0 0\n1 1 0 0 1 0.5\n" + cells;
}
std::string vtp(const std::string& polys, const std::string& piece = "NumberOfPoints='3'") {
  return "<VTKFile type='PolyData'><PolyData><Piece " + piece +
         "><Points><DataArray format='ascii'>0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>" + polys +
         "</Polys></Piece></PolyData></VTKFile>";
}
std::string x3d(const std::string& scene) {
  return "<X3D><Scene>" + scene + "</Scene></X3D>";
}
const std::string kFace =
    "<Shape DEF='s'><IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate point='0 0 0, 1 0 0, 0 1 0'/></IndexedFaceSet></Shape>";

void says(const std::string& text, const std::string& words) {
  const std::string message = refusal(text);
  INFO(message);
  CHECK(message.find(words) != std::string::npos);
}

}  // namespace

TEST_CASE("legacy VTK: polygons and strips, with their lines") {
  const PolygonSoup soup =
      import_text(vtk("POLYGONS 2 9\n3 0 1 2\n4 0 1 2 3\nTRIANGLE_STRIPS 1 6\n5 0 1 2 3 3\nLINES 1 3\n2 0 1\n"
                      "METADATA\nINFORMATION 0\n\nPOINT_DATA 4\nrubbish"));
  CHECK(soup.format == Format::vtk);
  CHECK(faces_of(soup) == Faces{{0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2}, {1, 3, 2}});
  CHECK(soup.points[3] == Vec3{0, 1, 0.5});
  CHECK(soup.face_line == std::vector<std::uint32_t>{9, 10, 12, 12});
  CHECK(soup.point_line == std::vector<std::uint32_t>{6, 6, 7, 7});
  CHECK(ignored_of(soup) == std::vector<std::string>{"strip joints: 1", "line elements: 1"});
}

TEST_CASE("legacy VTK: refusals") {
  says(vtk("POLYGONS 1 5\n3 0 1 2\n"), "does not fit the 5 numbers that are promised");
  says(vtk("POLYGONS 1 4\n3 0 1 x\n"), "'x' is not a whole number");
  says(vtk("POLYGONS 9 4000000000\n3 0 1 2\n"), "truncated: 4000000000 numbers are promised");
  says(vtk("CELLS 1 4\n"), "'cells' is no part of polydata");
  says("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n", "extract its surface");
  says("# vtk DataFile Version 3.0\nt\nHEX\n", "is neither ASCII nor BINARY");
}

TEST_CASE("VTK in XML: polygons, and refusals") {
  const std::string corners = "<DataArray Name='connectivity' format='ascii'>0 1 2</DataArray>";
  CHECK(faces_of(import_text(vtp(corners + "<DataArray Name='offsets' format='ascii'>3</DataArray>"))) == Faces{{0, 1, 2}});
  says(vtp(corners), "needs the arrays 'connectivity' and 'offsets'");
  says(vtp(corners + "<DataArray Name='offsets' format='ascii'>4</DataArray>"), "ends cell 0 at 4");
  says(vtp(corners + "<DataArray Name='offsets' format='hex'>AAAA</DataArray>"), "there are ascii, binary and appended");
  says(vtp("", "NumberOfPoints='4'"), "holds 9 coordinates, and its piece promises 4 points");
  says("<VTKFile type='UnstructuredGrid'/>", "no PolyData");
}

TEST_CASE("X3D: face sets in transforms, uses and windings") {
  const PolygonSoup soup = import_text(
      x3d("<Transform translation='1 2 3' scale='-2 2 2'>" + kFace + "</Transform><Shape USE='s'/><Shape><Box/></Shape>"));
  CHECK(soup.metres_per_unit == 1);
  CHECK(faces_of(soup) == Faces{{0, 2, 1}, {3, 4, 5}});
  CHECK(soup.points[1] == Vec3{-1, 2, 3});
  CHECK(soup.points[4] == Vec3{1, 0, 0});
  CHECK(ignored_of(soup) == std::vector<std::string>{"shapes of the kind Box: 1"});
  const PolygonSoup turned =
      import_text(x3d("<Transform rotation='0 0 1 1.5707963267948966' center='1 0 0'>" + kFace + "</Transform>"));
  CHECK(std::fabs(turned.points[0].x - 1) < 1e-15);
  CHECK(turned.points[0].y == -1);
  CHECK(faces_of(import_text(x3d("<Shape><IndexedTriangleSet index='0 1 2 2 1'><Coordinate point='0 0 0 1 0 0 0 1 "
                                 "0'/></IndexedTriangleSet></Shape>"))) == Faces{{0, 1, 2}});
}

TEST_CASE("X3D: refusals") {
  says(x3d("<Shape USE='t'/>"), "uses 't', and no node of the file has this name");
  says(x3d("<Group DEF='a'><Group USE='a'/></Group>"), "perhaps itself");
  says(x3d("<Transform scale='1 2'>" + kFace + "</Transform>"), "has 2 numbers in 'scale', not 3");
  says(x3d("<Shape><TriangleSet><Coordinate point='0 0'/></TriangleSet></Shape>"), "no multiple of three");
  says("<html><body/></html>", "with the root <html>");
  says("<robot name='r'/>", "description of a robot");
}
