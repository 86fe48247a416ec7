// SPDX-License-Identifier: Apache-2.0
// Where images of heights lie: in f32 graphs, on repaired meshes, beyond borders that differ, and with many maps.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "gltf_writer.hpp"
#include "height_rig.hpp"
#include "meshes.hpp"
#include "png_writer.hpp"

using namespace fdcg::test;
using namespace fdcg;
using Wrap = bake::HeightImage::Wrap;

namespace {

fdcg_relief_place place_on(std::uint32_t node, const bake::Vec3& at) {
  return {{at.x, at.y, at.z}, {0, 0, 0}, node, 0};
}

bake::Vec3 corner_of(const Mapped& mesh, std::uint32_t node, std::uint32_t side) {
  const fdcg_corner_info corner = fdcg_get_corner(&mesh.graph, fdcg_get_side(&mesh.graph, node, side).corner);
  const double* const o = mesh.heights.origin;
  return {corner.point[0] + o[0], corner.point[1] + o[1], corner.point[2] + o[2]};
}

// The largest error of the places of a node's corners, in images. Whole images apart is the same.
double place_error(const Mapped& mesh, std::uint32_t node) {
  double worst = 0;
  const fdcg_node_info info = fdcg_get_node(&mesh.graph, node);
  for (std::uint32_t side = 0; side < info.side_count; ++side) {
    const bake::Vec3 at = corner_of(mesh, node, side);
    const auto expected = flat_uv(at);
    const double local[3] = {at.x - mesh.heights.origin[0], at.y - mesh.heights.origin[1], at.z - mesh.heights.origin[2]};
    for (int k = 0; k < 2; ++k) {
      const fdcg_node_place& place = mesh.heights.places[node];
      double found = place.offset[k];
      for (int axis = 0; axis < 3; ++axis)
        found += double{place.per_unit[k][axis]} * local[axis];
      const double off = found - expected[static_cast<std::size_t>(k)];
      worst = std::max(worst, std::fabs(off - std::round(off)));
    }
  }
  return worst;
}

// An image of noise with these borders.
bake::HeightImage bordered_image(std::array<Wrap, 2> wrap) {
  bake::HeightImage image = noise_image(20, 12, Wrap::repeat, 8);
  image.wrap = wrap;
  return image;
}

}  // namespace

TEST_CASE("heights of a graph of 32-bit numbers are those of the one of 64") {
  const bake::PolygonSoup soup =
      with_image(transformed(grid_box(3, 2, 2, {3, 2, 2}), random_rotation(5)), noise_image(32, 32, Wrap::repeat, 6), flat_uv);
  bake::CompileOptions options = felt_options(0.0002);
  const Mapped wide(soup, options);
  options.precision = bake::Precision::f32;
  const Mapped narrow(soup, options);
  REQUIRE(narrow.graph.header->real_bytes == 4);
  REQUIRE(narrow.heights.node_count == wide.heights.node_count);
  const fdcg_relief reliefs[2] = {fdcg_make_height_relief(&wide.heights), fdcg_make_height_relief(&narrow.heights)};
  CHECK(reliefs[1].most_m == Approx(reliefs[0].most_m));
  CHECK(reliefs[1].curvature_per_m == Approx(reliefs[0].curvature_per_m).epsilon(1e-3));
  double largest = 0;
  for (std::uint32_t n = 0; n < narrow.heights.node_count; ++n) {
    const fdcg_node_info info = fdcg_get_node(&narrow.graph, n), other = fdcg_get_node(&wide.graph, n);
    REQUIRE(info.normal[0] * other.normal[0] + info.normal[1] * other.normal[1] + info.normal[2] * other.normal[2] > 0.999);
    CHECK(place_error(narrow, n) < 1.0 / 32 / 64);
    for (std::uint32_t side = 0; side < info.side_count; ++side) {
      double slope[2][3];
      const bake::Vec3 at = corner_of(narrow, n, side);
      const double heights[2] = {height_at(reliefs[0], place_on(n, at), slope[0]),
                                 height_at(reliefs[1], place_on(n, at), slope[1])};
      CHECK(heights[1] == Approx(heights[0]).margin(0.002 * reliefs[0].most_m));
      largest = std::max(largest, std::fabs(heights[0]));
    }
  }
  CHECK(largest > 0.1 * reliefs[0].most_m);
}

TEST_CASE("on a repaired mesh what was in the file lies where its coordinates say, and a patch is flat") {
  bake::PolygonSoup box = grid_box(2, 2, 2, {2, 2, 2});
  // a face twice, one without area, and a hole where the last face was
  const auto add = [&box](std::initializer_list<std::uint32_t> corners) {
    box.corners.insert(box.corners.end(), corners);
    box.face_first.push_back(static_cast<std::uint32_t>(box.corners.size()));
  };
  const std::uint32_t last = box.face_first[box.face_count() - 1];
  const std::vector<std::uint32_t> gone(box.corners.begin() + last, box.corners.end());
  box.corners.resize(last);
  box.face_first.pop_back();
  const std::vector<std::uint32_t> first(box.corners.begin(), box.corners.begin() + box.face_first[1]);
  REQUIRE(first.size() == 4);
  add({first[0], first[1], first[2], first[3]});
  add({first[0], first[1], first[1]});
  const bake::PolygonSoup soup = with_image(box, noise_image(16, 16, Wrap::repeat, 3), flat_uv);
  bake::CompileOptions options = felt_options(0.0002);
  options.merge = false;
  options.repair = bake::RepairLevel::solid;
  const Mapped mesh(soup, options);
  double middle[3] = {0, 0, 0};
  for (const std::uint32_t corner : gone)
    middle[0] += soup.points[corner].x / 4, middle[1] += soup.points[corner].y / 4, middle[2] += soup.points[corner].z / 4;
  std::uint32_t flat = 0, placed = 0;
  for (std::uint32_t n = 0; n < mesh.heights.node_count; ++n) {
    if (mesh.heights.places[n].map != FDCG_NONE) {
      CHECK(place_error(mesh, n) < 1.0 / 16 / 64);
      ++placed;
      continue;
    }
    ++flat;
    const std::uint32_t sides = fdcg_get_node(&mesh.graph, n).side_count;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const bake::Vec3 at = corner_of(mesh, n, side);
      CHECK((std::fabs(at.x - middle[0]) < 0.51 && std::fabs(at.y - middle[1]) < 0.51 && std::fabs(at.z - middle[2]) < 0.51));
    }
  }
  CHECK((flat == 1 || flat == 2));
  CHECK(placed == mesh.heights.node_count - flat);
  CHECK(placed >= 23);
}

TEST_CASE("an image that is mirrored along one axis and clamped along the other") {
  for (const bool mirrors_rows : {false, true}) {
    const std::array<Wrap, 2> wrap = {mirrors_rows ? Wrap::mirror : Wrap::clamp, mirrors_rows ? Wrap::clamp : Wrap::mirror};
    const auto uv = [](const bake::Vec3& p) { return std::array<double, 2>{p.x, p.y + 0.001 * p.z}; };
    const Mapped mesh(with_image(cube(), bordered_image(wrap), uv));
    const fdcg_relief relief = fdcg_make_height_relief(&mesh.heights);
    std::uint32_t top = 0;
    while (fdcg_get_node(&mesh.graph, top).normal[2] < 0.9)
      ++top;
    const fdcg_node_place& place = mesh.heights.places[top];
    // the place of the plane z = 0.5 or so where the image is at (u, v)
    const auto height = [&](double u, double v) {
      bake::Vec3 at = {0, 0, corner_of(mesh, top, 0).z};
      const double local_z = at.z - mesh.heights.origin[2];
      const double base[2] = {place.offset[0] + double{place.per_unit[0][2]} * local_z,
                              place.offset[1] + double{place.per_unit[1][2]} * local_z};
      const double a = place.per_unit[0][0], b = place.per_unit[0][1], c = place.per_unit[1][0], d = place.per_unit[1][1];
      const double x = u - base[0], y = v - base[1], turn = a * d - b * c;
      at.x = (d * x - b * y) / turn + mesh.heights.origin[0];
      at.y = (a * y - c * x) / turn + mesh.heights.origin[1];
      double slope[3];
      return height_at(relief, place_on(top, at), slope);
    };
    const std::size_t mirrored = mirrors_rows ? 0 : 1;
    const auto at = [&](double along_mirrored, double along_clamped) {
      double on[2];
      on[mirrored] = along_mirrored, on[1 - mirrored] = along_clamped;
      return height(on[0], on[1]);
    };
    double differs = 0, varies = 0;
    Random random(4);
    for (int i = 0; i < 200; ++i) {
      const double m = random.uniform(0, 1), c = random.uniform(0, 1);
      CHECK(at(-m, c) == Approx(at(m, c)).margin(1e-9));
      CHECK(at(2 - m, c) == Approx(at(m, c)).margin(1e-9));
      CHECK(at(m + 2, c) == Approx(at(m, c)).margin(1e-9));
      CHECK(at(m, 1.2 + c) == Approx(at(m, 9)).margin(1e-12));
      CHECK(at(m, -0.2 - c) == Approx(at(m, -9)).margin(1e-12));
      CHECK(at(-m, 5) == Approx(at(m, 9)).margin(1e-9));
      differs = std::max(differs, std::fabs(at(m, 9) - at(m, -9)));
      varies = std::max(varies, std::fabs(at(m, c) - at(1 - m, c)));
    }
    CHECK(differs > 1e-5);
    CHECK(varies > 1e-5);
  }
}

TEST_CASE("with many maps each is bounded by its own nodes") {
  constexpr std::size_t kMaps = 70;
  bake::PolygonSoup box = with_image(grid_box(12, 1, 1, {12, 1, 1}), noise_image(8, 8, Wrap::repeat, 1), flat_uv);
  REQUIRE(box.face_count() >= 50);
  box.appearance.all_heights = bake::LookMaterial::kNoImage;
  box.appearance.images.clear();
  for (std::size_t m = 0; m < kMaps; ++m) {
    bake::HeightImage image = noise_image(8, 8, Wrap::repeat, static_cast<std::uint32_t>(100 + m));
    image.range = m == 47 ? 0.002 : 0.0001;  // of the second batch of maps
    box.appearance.images.push_back(image);
    box.appearance.materials.push_back({"m" + std::to_string(m), {1, 1, 1, 1}, static_cast<std::uint16_t>(m)});
  }
  for (std::size_t f = 0; f < box.face_count(); ++f)
    box.appearance.face_material.push_back(static_cast<std::uint16_t>(f % kMaps));
  bake::CompileOptions options = felt_options();
  options.merge = false;
  const Mapped mesh(box, options);
  const std::size_t used = std::min<std::size_t>(kMaps, box.face_count());
  REQUIRE(mesh.heights.map_count == used);
  const fdcg_relief relief = fdcg_make_height_relief(&mesh.heights);
  // the second derivative along the faces, by differences, at many places of every node
  Random random(12);
  double most = 0;
  for (std::uint32_t n = 0; n < mesh.heights.node_count; ++n) {
    const fdcg_node_info info = fdcg_get_node(&mesh.graph, n);
    REQUIRE(mesh.heights.places[n].map < used);
    for (int i = 0; i < 300; ++i) {
      const bake::Vec3 at = corner_of(mesh, n, 0), way = random.direction();
      const double out = way.x * info.normal[0] + way.y * info.normal[1] + way.z * info.normal[2], step = 1e-4;
      const bake::Vec3 along = {way.x - out * info.normal[0], way.y - out * info.normal[1], way.z - out * info.normal[2]};
      const double length = std::sqrt(along.x * along.x + along.y * along.y + along.z * along.z);
      if (length < 0.1) continue;
      const double from = random.uniform(-1, 1), by = step / length;
      double slope[3], heights[3];
      for (int k = 0; k < 3; ++k) {
        const double t = from + (k - 1) * by;
        heights[k] = height_at(relief, place_on(n, {at.x + t * along.x, at.y + t * along.y, at.z + t * along.z}), slope);
        REQUIRE(std::fabs(heights[k]) <= relief.most_m * (1 + 1e-9));
      }
      most = std::max(most, std::fabs(heights[0] - 2 * heights[1] + heights[2]) / (step * step));
    }
  }
  CHECK(most <= relief.curvature_per_m * (1 + 1e-3));
  CHECK(most > 0.1 * relief.curvature_per_m);
}

TEST_CASE("a normal texture of glTF is felt as the heights that its normals are made of, in metres") {
  // ridges of 0.1 mm and 20 mm along x of a sheet of 0.2 m by 0.1 m, whose image has a row of texels for 16 a wave
  constexpr double kHeight_m = 1e-4, kLength_m = 0.2, kTurn = 2 * std::numbers::pi;
  constexpr std::uint32_t kWaves = 10, kWidth = 16 * kWaves;
  std::vector<std::uint16_t> values;
  for (std::uint32_t i = 0; i < kWidth; ++i) {
    const double slope = kHeight_m * kTurn * kWaves / kLength_m * std::cos(kTurn * kWaves * (i + 0.5) / kWidth);
    const double length = std::sqrt(1 + slope * slope);
    for (const double part : {-slope / length, 0.0, 1 / length})
      values.push_back(static_cast<std::uint16_t>(std::lround((part + 1) / 2 * 65535)));
  }
  std::string buffer;
  const auto put = [&buffer](auto value) { buffer.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const float c : {0.f, 0.f, 0.f, 0.2f, 0.f, 0.f, 0.2f, 0.1f, 0.f, 0.f, 0.1f, 0.f, 0.f, 1.f, 1.f, 1.f, 1.f, 0.f, 0.f, 0.f})
    put(c);
  for (const std::uint16_t i : {0, 1, 2, 0, 2, 3})
    put(i);
  const std::string json =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"material":0,"indices":2,"attributes":)"
      R"({"POSITION":0,"TEXCOORD_0":1}}]}],"materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}],)"
      R"("images":[{"uri":"data:image/png;base64,)" +
      base64(png_bytes(kWidth, 1, 3, 16, values)) +
      R"("}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
      R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":48},)"
      R"({"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,"byteLength":12}],)"
      R"("buffers":[{"byteLength":92,"uri":"data:;base64,)" +
      base64(buffer) + R"("}]})";
  bake::ImportOptions import;
  import.appearance = true;
  import.heights = "file";
  const auto soup = bake::import_memory(json, "sheet.gltf", import);
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup);
  const Mapped mesh(*soup, felt_options());
  const fdcg_relief relief = fdcg_make_height_relief(&mesh.heights);
  CHECK(relief.most_m == Approx(kHeight_m).epsilon(0.03));
  double worst = 0, slope[3];
  for (double x = 0.0005; x < kLength_m; x += 0.001) {
    const double height = height_at(relief, place_on(0, {x, 0.04, 0}), slope);
    worst = std::max(worst, std::fabs(height - kHeight_m * std::sin(kTurn * kWaves * x / kLength_m)));
    CHECK(slope[0] == Approx(kHeight_m * kTurn * kWaves / kLength_m * std::cos(kTurn * kWaves * x / kLength_m)).margin(2e-4));
  }
  CHECK(worst < 2e-3 * kHeight_m);
}
