// SPDX-License-Identifier: Apache-2.0
#include "../../support/import_support.hpp"
#include "../../support/zip_writer.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

const std::string kMesh =
    "<mesh><vertices><vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0.25'/><vertex x='0' y='1' z='0'/></vertices>"
    "<triangles><triangle v1='0' v2='1' v3='2'/></triangles></mesh>";

std::string model(const std::string& resources, const std::string& items, const std::string& attributes = "") {
  return "<model " + attributes + "><resources>" + resources + "</resources>\n<build>" + items + "</build></model>";
}
std::string package(const std::string& root, const std::string& second = "") {
  std::vector<std::pair<std::string, std::string>> parts = {{"3D/3dmodel.model", root}};
  if (!second.empty()) parts.emplace_back("3D/b.model", second);
  return fdcg::test::stored_zip(parts);
}
std::string one(const std::string& mesh, const std::string& item = "<item objectid='1'/>", const std::string& attributes = "") {
  return package(model("<object id='1'>" + mesh + "</object>", item, attributes));
}

}  // namespace

TEST_CASE("3MF: points and unit are the file's") {
  const PolygonSoup soup = import_text(one(kMesh));
  CHECK(soup.format == Format::threemf);
  CHECK(soup.metres_per_unit == 1e-3);
  CHECK(soup.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0.25}, {0, 1, 0}});
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 1, 2}});
  CHECK(parts_of(soup) == std::vector<std::string>{"object 1@0"});
  for (const auto& [unit, metres] :
       {std::pair("micron", 1e-6), {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1.0}})
    CHECK(import_text(one(kMesh, "<item objectid='1'/>", "unit='" + std::string(unit) + "'")).metres_per_unit == metres);
}

TEST_CASE("3MF: build and component transforms, and what is not built") {
  const std::string parts =
      "<object id='1' name='tooth'>" + kMesh +
      "</object><object id='2' name='gear'><components><component objectid='1' transform='0 1 0 -1 0 0 0 0 "
      "1 5 0 0'/></components></object><object id='3'>" +
      kMesh + "</object>";
  const PolygonSoup soup = import_text(package(model(parts, "<item objectid='2' transform='1 0 0 0 1 0 0 0 1 0 0 7'/>")));
  CHECK(soup.points == std::vector<Vec3>{{5, 0, 7}, {5, 1, 7.25}, {4, 0, 7}});
  CHECK(parts_of(soup) == std::vector<std::string>{"gear/tooth@0"});
  CHECK(ignored_of(soup) == std::vector<std::string>{"objects that are not built: 1"});
  const PolygonSoup mirrored = import_text(package(model(parts, "<item objectid='1' transform='-1 0 0 0 1 0 0 0 1 0 0 0'/>")));
  CHECK(faces_of(mirrored) == std::vector<std::vector<std::uint32_t>>{{0, 2, 1}});
}

TEST_CASE("3MF: objects in other parts of the package (production extension)") {
  const std::string root = model(
      "<object id='2'><components><component p:path='/3D/b.model' objectid='1'/></components></object>", "<item objectid='2'/>",
      "xmlns:p='http://schemas.microsoft.com/3dmanufacturing/production/2015/06' requiredextensions='p'");
  CHECK(import_text(package(root, model("<object id='1'>" + kMesh + "</object>", ""))).face_count() == 1);
  CHECK(refusal(package(root, model("<object id='1'>" + kMesh + "</object>", "", "unit='inch'"))).find("whose unit") !=
        std::string::npos);
  CHECK(refusal(package(root)).find("names the part '3D/b.model'") != std::string::npos);
}

TEST_CASE("3MF: materials, and the properties that triangles refer to") {
  const std::string group = "<basematerials id='5'><base name='steel'/><base name='rubber'/></basematerials>";
  const auto with = [&](const std::string& triangles) {
    std::string mesh = kMesh;
    mesh.insert(mesh.find("</triangles>"), triangles);
    return package(model(group + "<object id='1' pid='5' pindex='1'>" + mesh + "</object>", "<item objectid='1'/>"));
  };
  const PolygonSoup soup = import_text(with("<triangle v1='2' v2='1' v3='0' pid='5' p1='0'/>"));
  CHECK(soup.materials == std::vector<std::string>{"rubber", "steel"});
  CHECK(soup.face_material == std::vector<std::uint16_t>{0, 1});
  CHECK(refusal(with("<triangle v1='2' v2='1' v3='0' pid='5' p1='0' p3='2'/>"))
            .find("line 1: <triangle> names property 2 of resource '5', which has 2") != std::string::npos);
  CHECK(refusal(with("<triangle v1='2' v2='1' v3='0' pid='6' p1='0'/>")).find("the properties '6'") != std::string::npos);
}

TEST_CASE("3MF: refusals name element, value and remedy") {
  const auto says = [](const std::string& bytes, const std::string& words) {
    const std::string message = refusal(bytes);
    INFO(message);
    CHECK(message.find(words) != std::string::npos);
  };
  says(one(kMesh, "<item objectid='9'/>"), "<item> names the object '9', and the model has none of this id");
  says(one(kMesh, "<item objectid='1' transform='1 0 0'/>"), "has a transform of 3 numbers, not 12");
  says(one("<components><component objectid='1'/></components>"), "perhaps itself");
  says(one(kMesh, "<item objectid='1'/>", "unit='mile'"), "has the unit 'mile'");
  says(one("<mesh><vertices><vertex x='0' y='a' z='0'/></vertices></mesh>"), "has y='a', which is not a number");
  says(one("<mesh><vertices/><triangles><triangle v1='0' v2='1'/></triangles></mesh>"), "has no attribute 'v3'");
  says(one("<mesh><vertices/><triangles><triangle v1='0' v2='1' v3='-1'/></triangles></mesh>"), "v3='-1'");
  says(one(kMesh, "<item objectid='1'/>",
           "xmlns:b='http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02' requiredextensions='b'"),
       "requires the extension 'http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02'");
  says(fdcg::test::stored_zip({{"a.txt", "a"}}), "holds no 3MF model");
  says(std::string("PK\x03\x04") + std::string(40, 'x'), "cannot be opened");
  std::string damaged = one(kMesh);
  damaged[damaged.find("0.25")] = '1';
  says(damaged, "is damaged");
}

TEST_CASE("3MF: a corner without a vertex stays one; without a mesh there is no face") {
  CHECK(faces_of(import_text(one("<mesh><vertices><vertex x='0' y='0' z='0'/></vertices><triangles><triangle v1='0' v2='1' "
                                 "v3='2'/></triangles></mesh>"))) ==
        std::vector<std::vector<std::uint32_t>>{{0, kInvalid, kInvalid}});
  CHECK(refusal(one("")).find("holds no face") != std::string::npos);
}

TEST_CASE("3MF: an archive with a COLLADA scene is read as that") {
  const std::string dae = read_bytes(testdata() / "meshes" / "good" / "cube_quads.dae");
  const PolygonSoup soup = import_text(fdcg::test::stored_zip({{"manifest.xml", "<dae_root/>"}, {"cube.dae", dae}}));
  CHECK(soup.format == Format::dae);
  CHECK(soup.face_count() == 6);
}
