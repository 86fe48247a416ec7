// SPDX-License-Identifier: Apache-2.0
// Small files of every format that assimp or lib3mf read too: the same faces, in the same places, in the same unit.
#include <fstream>

#include "../../support/import_support.hpp"
#include "../../support/judge_scene.hpp"
#include "../../support/zip_writer.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;

namespace {

// A file in the tests' scratch folder.
class Scratch {
 public:
  Scratch(const std::string& name, const std::string& bytes)
      : path_(std::filesystem::temp_directory_path() / ("fdcg-judge-" + std::to_string(getpid()) + "-" + name)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~Scratch() { std::filesystem::remove(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void check_agreement(const std::filesystem::path& path, const JudgeScene& judge, std::size_t faces, double unit) {
  INFO(path);
  INFO(judge.trouble);
  REQUIRE(judge.trouble.empty());
  const Result<PolygonSoup> soup = import_mesh(path);
  REQUIRE(soup);
  const std::vector<PlacedFace> ours = faces_in_place(*soup);
  CHECK(ours.size() == faces);
  CHECK(judge.faces.size() == faces);
  const FaceDifference difference = compare_faces(ours, judge.faces, 0x1p-20 * extent_of(ours));
  for (const std::size_t f : difference.ours)
    UNSCOPED_INFO("ours alone: face " << f << ' ' << shown(ours[f]));
  for (const std::size_t f : difference.theirs)
    UNSCOPED_INFO("theirs alone: face " << f << ' ' << shown(judge.faces[f]));
  CHECK(difference.ours.empty());
  CHECK(difference.theirs.empty());
  CHECK(difference.turned == 0);
  if (unit > 0) {
    CHECK(soup->metres_per_unit == unit);
    CHECK(judge.metres_per_unit == Approx(unit).epsilon(1e-6));
  }
}

const std::string kTetrahedron =
    "<source id='s'><float_array id='a' count='12'>0 0 0 1.25 0 0 0 2.5 0 0 0 3</float_array><technique_common><accessor "
    "source='#a' count='4' stride='3'><param name='X' type='float'/><param name='Y' type='float'/><param name='Z' "
    "type='float'/></accessor></technique_common></source><vertices id='v'><input semantic='POSITION' source='#s'/></vertices>"
    "<triangles count='4'><input semantic='VERTEX' source='#v' offset='0'/><p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles>";

std::string dae(const std::string& transforms, const std::string& asset) {
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><asset>" + asset +
         "</asset><library_geometries><geometry id='g' name='g'><mesh>" + kTetrahedron +
         "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id='w' name='w'><node id='n' name='n'>" +
         transforms +
         "<instance_geometry url='#g'/><node id='m' name='m'><translate>0 0 9</translate><rotate>0 1 0 30</rotate>"
         "<instance_geometry url='#g'/></node></node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url='#w'/></scene></COLLADA>";
}

void check_dae(const std::string& transforms, const std::string& asset, double unit) {
  const Scratch file("scene.dae", dae(transforms, asset));
  CAPTURE(transforms, asset);
  check_agreement(file.path(), read_with_assimp(file.path()), 8, unit);
}

constexpr const char* kTypes =
    "<?xml version='1.0'?><Types xmlns='http://schemas.openxmlformats.org/package/2006/content-types'><Default "
    "Extension='rels' ContentType='application/vnd.openxmlformats-package.relationships+xml'/><Default Extension='model' "
    "ContentType='application/vnd.ms-package.3dmanufacturing-3dmodel+xml'/></Types>";
constexpr const char* kRelationships =
    "<?xml version='1.0'?><Relationships xmlns='http://schemas.openxmlformats.org/package/2006/relationships'><Relationship "
    "Target='/3D/3dmodel.model' Id='rel0' Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/>"
    "</Relationships>";

// Two objects, one of them of components; `build` shows them.
std::string package(const std::string& unit, const std::string& build) {
  const std::string mesh =
      "<mesh><vertices><vertex x='0' y='0' z='0'/><vertex x='1.25' y='0' z='0'/><vertex x='0' y='2.5' z='0'/><vertex x='0' "
      "y='0' z='3'/></vertices><triangles><triangle v1='0' v2='2' v3='1'/><triangle v1='0' v2='1' v3='3'/><triangle v1='1' "
      "v2='2' v3='3'/><triangle v1='0' v2='3' v3='2'/></triangles></mesh>";
  const std::string model =
      "<?xml version='1.0' encoding='UTF-8'?><model" + (unit.empty() ? "" : " unit='" + unit + "'") +
      " xml:lang='en-US' xmlns='http://schemas.microsoft.com/3dmanufacturing/core/2015/02'><resources><object id='1' "
      "type='model'>" +
      mesh +
      "</object><object id='2' type='model'><components><component objectid='1'/><component objectid='1' transform='0 1 0 -1 0 "
      "0 0 0 1 10 0 0.5'/></components></object></resources><build>" +
      build + "</build></model>";
  return stored_zip({{"[Content_Types].xml", kTypes}, {"_rels/.rels", kRelationships}, {"3D/3dmodel.model", model}});
}

// Files that assimp reads in a way of its own.
bool is_other(const std::string& name) {
  return name == "cube_draco.glb" ||         // Debian's has no Draco
         name == "cube_package.3mf" ||       // lib3mf is the judge
         name == "cube_colours.off" ||       // loses the last face where there are colours
         name == "cube_double_extra.ply" ||  // "File corrupted", of what follows its faces
         name == "square_strip.ply" ||       // takes the first triangle of a strip alone
         name == "mirrored_bytes.gltf";      // takes positions of bytes for floats
}

}  // namespace

TEST_CASE("COLLADA: transforms and units are assimp's") {
  check_dae("", "", 1);
  // axes of length 1: assimp does not make them so
  check_dae("<translate>1 2 3</translate><scale>2 2 2</scale>", "<unit meter='0.001' name='mm'/>", 0.001);
  check_dae("<rotate>0.6 0 0.8 40</rotate><scale>1 2 0.5</scale>", "<unit meter='0.0254' name='inch'/><up_axis>Z_UP</up_axis>",
            0.0254);
  check_dae("<matrix>0 -1 0 3 1 0 0 4 0 0 1 5 0 0 0 1</matrix>", "<up_axis>X_UP</up_axis>", 1);
  check_dae("<scale>-1 1 1</scale>", "<unit meter='1' name='meter'/>", 1);
  check_dae("<lookat>1 2 3 4 -5 3 0 0 1</lookat>", "", 1);  // skew is not read there; import_dae_test.cpp has it
}

TEST_CASE("3MF: components, build transforms and every unit are lib3mf's") {
  const std::string build =
      "<item objectid='2'/><item objectid='1' transform='2 0 0 0 2 0 0 0 2 -20 5 0.25'/><item objectid='2' transform='0 0 1 1 "
      "0 "
      "0 0 1 0 0 0 -9'/>";
  const std::pair<const char*, double> kUnits[] = {{"", 1e-3},           {"micron", 1e-6}, {"millimeter", 1e-3},
                                                   {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048},
                                                   {"meter", 1}};
  for (const auto& [unit, metres] : kUnits) {
    CAPTURE(unit);
    const Scratch file("package.3mf", package(unit, build));
    const JudgeScene judge = read_with_lib3mf(file.path());
    if (judge.trouble == kNoJudge) {
      WARN("skipped: " << kNoJudge);
      return;
    }
    check_agreement(file.path(), judge, 20, metres);
  }
}

TEST_CASE("the good meshes are assimp's, in the formats that it reads") {
  int judged = 0;
  for (const auto& path : files_in(testdata() / "meshes" / "good")) {
    const std::string ending = path.extension().string();
    const bool is_alien = ending == ".drc" || ending == ".vtk" || ending == ".vtp" ||  // formats that assimp does not read
                          is_other(path.filename().string());
    if (is_alien) continue;
    const Result<PolygonSoup> soup = import_mesh(path);
    REQUIRE(soup);
    check_agreement(path, read_with_assimp(path), soup->face_count(), 0);
    ++judged;
  }
  CHECK(judged >= 12);
}
