// SPDX-License-Identifier: Apache-2.0
#include "fdcg/robot.hpp"

#include <unistd.h>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
namespace fs = std::filesystem;

namespace {

// A folder for one test, removed at its end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("fdcg_robot_" + std::to_string(::getpid()))) { fs::create_directories(path_); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<NamedMesh> meshes_of(const fs::path& path) {
  const auto meshes = meshes_of_robot(path);
  REQUIRE(meshes);
  return *meshes;
}

}  // namespace

TEST_CASE("a URDF file's meshes: once each, with scale, found upward by package") {
  const Folder folder;
  folder.write("arm_description/meshes/a.stl", "x");
  folder.write("checkout/package.xml", "<package><name>hand</name></package>");
  folder.write("checkout/b.stl", "x");
  const fs::path urdf = folder.write(
      "checkout/urdf/robot.urdf",
      "<robot><link name='base'><visual><geometry><mesh filename='package://arm_description/meshes/a.stl' scale='0.001 0.001 "
      "0.001'/></geometry></visual><collision><geometry><mesh filename='package://arm_description/meshes/a.stl' scale='0.001 "
      "0.001 "
      "0.001'/></geometry></collision></link><link name='tip'><visual><geometry><mesh "
      "filename='package://hand/b.stl'/></geometry>"
      "</visual><visual><geometry><mesh filename='../b.stl' scale='-1 1 1'/></geometry></visual><collision><geometry><mesh "
      "filename='package://none/c.stl'/></geometry></collision></link></robot>");
  const std::vector<NamedMesh> meshes = meshes_of(urdf);
  REQUIRE(meshes.size() == 4);
  CHECK(fs::equivalent(meshes[0].file, folder.path() / "arm_description/meshes/a.stl"));
  CHECK(meshes[0].scale == Vec3{0.001, 0.001, 0.001});
  CHECK(meshes[0].link == "base");
  CHECK(fs::equivalent(meshes[1].file, folder.path() / "checkout/b.stl"));
  CHECK(fs::equivalent(meshes[2].file, folder.path() / "checkout/b.stl"));
  CHECK(meshes[2].scale == Vec3{-1, 1, 1});
  CHECK(meshes[3].problem.find("package 'none'") != std::string::npos);
}

TEST_CASE("an SDF file's meshes") {
  const Folder folder;
  folder.write("cup/meshes/cup.dae", "x");
  const std::vector<NamedMesh> meshes =
      meshes_of(folder.write("cup/model.sdf",
                             "<sdf version='1.6'><model name='cup'><link name='l'><visual "
                             "name='v'><geometry><mesh><uri>model://cup/meshes/cup.dae</uri>"
                             "<scale>2 2 2</scale></mesh></geometry></visual><collision "
                             "name='c'><geometry><mesh><uri>http://example.com/a.stl</uri></mesh>"
                             "</geometry></collision><collision name='d'><geometry><box><size>1 1 "
                             "1</size></box></geometry></collision></link></model></sdf>"));
  REQUIRE(meshes.size() == 2);
  CHECK(fs::equivalent(meshes[0].file, folder.path() / "cup/meshes/cup.dae"));
  CHECK(meshes[0].scale == Vec3{2, 2, 2});
  CHECK(meshes[1].problem.find("server") != std::string::npos);
}

TEST_CASE("a robot's description that is damaged is refused with its line") {
  const Folder folder;
  for (const char* const text :
       {"<robot>\n<link>", "<robot>\n<link name='a'><visual><geometry><mesh/></geometry></visual></link></robot>",
        "<robot>\n<link><visual><geometry><mesh filename='a' scale='1 0 1'/></geometry></visual></link></robot>"}) {
    const auto meshes = meshes_of_robot(folder.write("r.urdf", text));
    REQUIRE_FALSE(meshes);
    CHECK(meshes.error().exit_code == 3);
    CHECK(meshes.error().message.find("line 2: ") != std::string::npos);
  }
}

TEST_CASE("a scaled mesh: points, quanta, and the outside of a mirrored one") {
  PolygonSoup soup = import_text("OFF 3 1 0\n1 0 0\n0 0.125 0\n0 0 2\n3 0 1 2\n");
  const double quantum = soup.absolute_quantum;
  scale_soup(soup, {1, 1, 1});
  CHECK(soup.absolute_quantum == quantum);
  scale_soup(soup, {-0.5, 0.5, 0.5});
  CHECK(soup.points == std::vector<Vec3>{{-0.5, 0, 0}, {0, 0.0625, 0}, {0, 0, 1}});
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 2, 1}});
  CHECK(soup.absolute_quantum >= quantum / 2);
  CHECK(soup.absolute_quantum <= quantum / 2 + 1e-15);
}
