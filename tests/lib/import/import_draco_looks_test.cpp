// SPDX-License-Identifier: Apache-2.0
// Normals, texture coordinates and colours of Draco data, in files of its own and in glTF.
#include <cmath>
#include <string>

#include "catch.hpp"
#include "drc_writer.hpp"
#include "gltf_writer.hpp"
#include "import_support.hpp"
#include "meshes.hpp"
#include "png_writer.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;

namespace {

ImportOptions looking() {
  ImportOptions options;
  options.normals = options.appearance = true;
  return options;
}

// Of a place on the unit sphere; a second sheet of texture coordinates from x = 0 on, so that there is a seam.
std::array<float, 2> uv_of(const Vec3& p, bool is_far) {
  return {static_cast<float>((p.y + 1) / 2 + (is_far ? 2 : 0)), static_cast<float>((p.z + 1) / 2)};
}
Colour colour_of(const Vec3& p) {
  return {p.x > 0 ? 1.f : 0.2f, 0.4f, 0, p.y > 0 ? 1.f : 0.6f};
}

PolygonSoup ball() {
  PolygonSoup soup = ico_sphere(2);
  for (Vec3& p : soup.points)  // as floats, which Draco holds exactly
    p = {double{static_cast<float>(p.x)}, double{static_cast<float>(p.y)}, double{static_cast<float>(p.z)}};
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    double middle = 0;
    for (std::uint32_t i = soup.face_first[f]; i < soup.face_first[f + 1]; ++i)
      middle += soup.points[soup.corners[i]].x;
    for (std::uint32_t i = soup.face_first[f]; i < soup.face_first[f + 1]; ++i) {
      const Vec3& p = soup.points[soup.corners[i]];
      soup.corner_normals.push_back(p);
      soup.appearance.uv.push_back(uv_of(p, middle > 0.01));
      soup.appearance.colours.push_back(colour_of(p));
    }
  }
  return soup;
}

// The largest differences of what stands at the corners from what their places and faces say. `turned`: v upwards, as in files
// of Draco's own; `at`: from a place in the soup to that of ball().
struct Differences {
  double normal = 0, uv = 0, colour = 0;
};
template <class At>
Differences differences(const PolygonSoup& soup, bool is_gltf, const At& at) {
  Differences most;
  REQUIRE(soup.corner_normals.size() == soup.corners.size());
  REQUIRE(soup.appearance.uv.size() == soup.corners.size());
  REQUIRE(soup.appearance.colours.size() == soup.corners.size());
  const auto raise = [](double& to, double by) { to = std::max(to, std::fabs(by)); };
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    double middle = 0;
    for (std::uint32_t i = soup.face_first[f]; i < soup.face_first[f + 1]; ++i)
      middle += at(soup.points[soup.corners[i]]).x;
    for (std::uint32_t i = soup.face_first[f]; i < soup.face_first[f + 1]; ++i) {
      const Vec3 p = at(soup.points[soup.corners[i]]), n = at(soup.corner_normals[i]);
      raise(most.normal, n.x - p.x), raise(most.normal, n.y - p.y), raise(most.normal, n.z - p.z);
      const auto uv = uv_of(p, middle > 0.01), found = soup.appearance.uv[i];
      raise(most.uv, double{found[0]} - uv[0]);
      raise(most.uv, double{is_gltf ? found[1] : 1 - found[1]} - uv[1]);
      const Colour colour = colour_of(p);
      for (std::size_t k = 0; k < 4; ++k) {
        const double share = double{colour[k]};
        const double screen = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
        raise(most.colour, double{soup.appearance.colours[i][k]} - (is_gltf || k == 3 ? share : screen));
      }
    }
  }
  return most;
}

Vec3 as_it_is(const Vec3& p) {
  return p;
}

PolygonSoup imported(const std::string& bytes, const ImportOptions& options = looking()) {
  auto soup = import_memory(bytes, "ball", options);
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup);
  return *soup;
}

// One primitive with Draco data that has these members of `attributes`, of both.
std::string glb_of(const std::string& draco, const std::string& attributes, const std::string& node = "",
                   const std::string& more = "") {
  std::string of_primitive, of_draco;
  std::size_t number = 0;
  for (std::size_t at = 0; at < attributes.size(); ++number) {
    const std::size_t end = std::min(attributes.find(' ', at), attributes.size());
    const std::string item = attributes.substr(at, end - at);  // NAME=id
    const std::string name = item.substr(0, item.find('=')), id = item.substr(item.find('=') + 1);
    of_primitive += (number == 0 ? "\"" : ",\"") + name + "\":" +
                    std::to_string(name.starts_with("TEX") ? 1
                                   : name == "COLOR_0"     ? 2
                                                           : 0);
    of_draco += (number == 0 ? "\"" : ",\"") + name + "\":" + id;
    at = end + 1;
  }
  return glb_container(
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0)" + node +
          R"(}],"meshes":[{"primitives":[{"material":0,"attributes":{)" + of_primitive +
          R"(},"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{)" + of_draco +
          R"(}}}}]}],"accessors":[{"componentType":5126,"type":"VEC3","count":9},{"componentType":5126,"type":"VEC2","count":9},)"
          R"({"componentType":5121,"normalized":true,"type":"VEC4","count":9}],"bufferViews":[{"buffer":0,"byteLength":)" +
          std::to_string(draco.size()) + R"(}],"buffers":[{"byteLength":)" + std::to_string(draco.size()) +
          R"(}],"extensionsUsed":["KHR_draco_mesh_compression"])" + more + "}",
      draco);
}

}  // namespace

TEST_CASE("a Draco file's normals, texture coordinates and colours stand at its corners") {
  for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker}) {
    const PolygonSoup exact = imported(write_drc_with_looks(ball(), {method, 0}));
    CHECK(exact.face_count() == 320);
    const Differences none = differences(exact, false, as_it_is);
    CHECK(none.normal < 1e-6);
    CHECK(none.uv < 1e-6);
    CHECK(none.colour < 1e-6);
    const Differences few = differences(imported(write_drc_with_looks(ball(), {method, 16})), false, as_it_is);
    CHECK(few.normal < 0.01);
    CHECK((few.uv < 1e-3 && few.uv > 1e-6));
  }
  const PolygonSoup bare = imported(write_drc_with_looks(ball()), {});
  CHECK(bare.corner_normals.empty());
  CHECK(bare.appearance.uv.empty());
  const PolygonSoup without = imported(write_drc(ico_sphere(1)));
  CHECK(without.corner_normals.empty());
  CHECK(without.appearance.uv.empty());
  CHECK(without.appearance.colours.empty());
}

TEST_CASE("the same of Draco data in glTF, in the frame of the scene") {
  const std::string draco = write_drc_with_looks(ball()), all = "POSITION=0 NORMAL=1 TEXCOORD_0=2 COLOR_0=3";
  const PolygonSoup plain = imported(glb_of(draco, all));
  const Differences none = differences(plain, true, as_it_is);
  CHECK(none.normal < 1e-6);
  CHECK(none.uv < 1e-6);
  CHECK(none.colour < 1e-6);
  // a quarter turn about z: what was x is y
  const PolygonSoup turned = imported(glb_of(draco, all, R"(,"rotation":[0,0,0.7071067811865476,0.7071067811865476])"));
  const auto back = [](const Vec3& p) { return Vec3{p.y, -p.x, p.z}; };
  CHECK(differences(turned, true, back).normal < 1e-6);
  CHECK(differences(turned, true, back).uv < 1e-6);
  // only what the file names
  const PolygonSoup some = imported(glb_of(draco, "POSITION=0 TEXCOORD_0=2"));
  CHECK(some.corner_normals.empty());
  CHECK(some.appearance.colours.empty());
  CHECK(some.appearance.uv == plain.appearance.uv);
  // and says where it is not there
  const PolygonSoup missing = imported(glb_of(draco, "POSITION=0 NORMAL=7 TEXCOORD_0=1"));
  CHECK(missing.corner_normals.empty());
  CHECK(missing.appearance.uv.empty());
  CHECK(ignored_of(missing) ==
        std::vector<std::string>{"primitives whose Draco data has not the normals, texture coordinates or colours that "
                                 "they promise: 2"});
  CHECK_FALSE(import_memory(glb_of(draco, "POSITION=0 NORMAL=-1"), "ball", looking()));
  CHECK_FALSE(import_memory(glb_of(draco, "POSITION=0 NORMAL=4294967296"), "ball", looking()));
}

TEST_CASE("a normal texture lies on Draco data by the set of texture coordinates that it names") {
  std::vector<std::uint16_t> values;
  for (int i = 0; i < 8 * 8; ++i)
    values.insert(values.end(), {static_cast<std::uint16_t>(i % 8 < 4 ? 100 : 156), 128, 250});
  const std::string texture = R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)" +
                              base64(png_bytes(8, 8, 3, 8, values)) + R"("}],"materials":[{"normalTexture":{"index":0)";
  ImportOptions options = looking();
  options.heights = "file";
  const std::string draco = write_drc_with_looks(ball());
  const PolygonSoup first = imported(glb_of(draco, "POSITION=0 TEXCOORD_0=2", "", texture + "}}]"), options);
  REQUIRE(first.appearance.images.size() == 1);
  CHECK(first.appearance.height_uv.empty());
  const PolygonSoup second = imported(glb_of(draco, "POSITION=0 TEXCOORD_1=2", "", texture + R"(,"texCoord":1}}])"), options);
  REQUIRE(second.appearance.images.size() == 1);
  CHECK(second.appearance.uv.empty());
  CHECK(second.appearance.height_uv == first.appearance.uv);
  CHECK(second.appearance.images[0].range == first.appearance.images[0].range);
}
