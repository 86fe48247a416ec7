// SPDX-License-Identifier: Apache-2.0
// Images as heights: the force against the formula, the band, value and slope, the energy, and hostile sections.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "height_rig.hpp"
#include "hip_loop.hpp"
#include "meshes.hpp"
#include "png_writer.hpp"
#include "relief_rig.hpp"
#include "scratch_folder.hpp"

using namespace fdcg::test;
using namespace fdcg;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double kTurn = 2 * std::numbers::pi, kHeight_m = 1e-4, kWave_m = 1e-3;

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A cube of side 1 m about the middle; its top has texture coordinates that are x and y in metres.
std::string block_obj(const std::string& library) {
  std::string text = "mtllib " + library + "\n";
  for (const char* const z : {"-0.5", "0.5"})
    for (const char* const xy : {"-0.5 -0.5", "0.5 -0.5", "0.5 0.5", "-0.5 0.5"})
      text += std::string("v ") + xy + " " + z + "\n";
  return text +
         "vt -0.5 -0.5\nvt 0.5 -0.5\nvt 0.5 0.5\nvt -0.5 0.5\nusemtl plain\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n"
         "f 4 1 5 8\nusemtl felt\nf 5/1 6/2 7/3\nf 5/1 7/3 8/4\n";
}

// `waves` sines of so many texels each across an image.
std::vector<std::uint16_t> sines(std::uint32_t waves, std::uint32_t texels, std::uint32_t rows) {
  std::vector<std::uint16_t> values;
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < waves * texels; ++x)
      values.push_back(static_cast<std::uint16_t>(std::lround(32767.5 * (1 + std::sin(kTurn * (x + 0.5) / texels)))));
  return values;
}

// The block with 32 waves of 1 mm to an image, from files.
const Mapped& wavy_block() {
  static const Mapped mapped = [] {
    const std::filesystem::path folder = scratch_folder();
    put(folder / "block.obj", block_obj("block.mtl"));
    put(folder / "block.mtl", "newmtl felt\nmap_bump -s 31.25 31.25 -bm 0.0002 waves 1.png\nnewmtl plain\n");
    put(folder / "waves 1.png", png_bytes(32 * 16, 8, 1, 16, sines(32, 16, 8)));
    bake::ImportOptions import;
    import.appearance = true;
    import.heights = "file";
    const auto soup = bake::import_mesh(folder / "block.obj", import);
    INFO((soup ? std::string() : soup.error().message));
    REQUIRE(soup.has_value());
    CHECK(soup->other_files.size() == 2);
    return Mapped(*soup, felt_options());
  }();
  return mapped;
}

std::string message_of(const bake::PolygonSoup& soup, const bake::CompileOptions& options) {
  const auto result = bake::compile(soup, options);
  return result ? std::string() : result.error().message;
}

}  // namespace

TEST_CASE("an image of a sine of 0.1 mm and 1 mm at 0.1 m/s is felt at 100 Hz with the analytic amplitude") {
  const Mapped& block = wavy_block();
  CHECK(block.graph.header->node_count == 6);  // two triangles with one linear function are one node
  const fdcg_relief relief = fdcg_make_height_relief(&block.heights);
  CHECK(relief.most_m == Approx(kHeight_m).epsilon(0.03));
  CHECK(relief.curvature_per_m == Approx(kHeight_m * kTurn * kTurn / (kWave_m * kWave_m)).epsilon(0.05));
  Felt felt(relief, block.graph, relief_params(0, 0));
  const std::vector<Hip> forces = stroke(felt, 0.1, 1000);
  const double normal_n = std::abs(amplitude_at(forces, 2, 100)), along_n = std::abs(amplitude_at(forces, 0, 100));
  CHECK(normal_n == Approx(kReliefStiffness * kHeight_m).epsilon(0.01));
  CHECK(along_n == Approx(kReliefStiffness * 0.0015 * kHeight_m * kTurn / kWave_m).epsilon(0.01));
  for (double hz = 10; hz < 500; hz += 10) {
    if (hz != 100) CHECK(std::abs(amplitude_at(forces, 2, hz)) < 0.01 * normal_n);
    CHECK(std::abs(amplitude_at(forces, 1, hz)) < 0.01 * along_n);
  }
  const Hip first = forces[0];
  const double x = -0.3 + 51 * 1e-4, load = kReliefStiffness * (0.0015 + kHeight_m * std::sin(kTurn * (x + 0.5) / kWave_m));
  CHECK(first[2] == Approx(load).epsilon(0.001));  // so the image lies where its coordinates say
}

TEST_CASE("of an image nothing is felt that passes faster than half the tick rate, and all that passes at a tenth") {
  const Mapped& block = wavy_block();
  const fdcg_relief relief = fdcg_make_height_relief(&block.heights);
  for (const double speed : {0.003, 0.01, 0.03, 0.05, 0.07, 0.09, 0.1, 0.5, 0.55, 0.6, 0.7, 0.9, 1.0, 1.3, 2.0, 5.0}) {
    Felt felt(relief, block.graph, relief_params(0, 0));
    const std::vector<Hip> forces = stroke(felt, speed, speed > 1 ? 100 : 400);
    const double hz = speed / kWave_m;
    double most = 0, worst = 0, x = -0.3 + 50 * speed * kReliefTick_s;
    for (const Hip& force : forces) {
      x += speed * kReliefTick_s;
      const double wave = kReliefStiffness * kHeight_m * std::sin(kTurn * (x + 0.5) / kWave_m);
      most = std::max(most, std::fabs(force[2] - 1.5));
      worst = std::max(worst, std::fabs(force[2] - 1.5 - wave));
    }
    INFO(speed << " m/s");
    if (hz >= 500) CHECK(most < 0.005 * kReliefStiffness * kHeight_m);
    if (hz <= 100) CHECK(worst < 0.01 * kReliefStiffness * kHeight_m);
  }
}

TEST_CASE("a spline goes through the texels, and its slope is that of its height, at every level and border") {
  using Wrap = bake::HeightImage::Wrap;
  std::uint32_t seed = 1;
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
    const bake::HeightImage image = noise_image(37, 21, wrap, ++seed);
    const Mapped block(with_image(transformed(cube(), random_rotation(seed)), image, flat_uv));
    const fdcg_relief relief = fdcg_make_height_relief(&block.heights);
    double mean = 0;
    for (const float value : image.values)
      mean += double{value} / static_cast<double>(image.values.size());
    Random random(seed);
    double worst_slope = 0, steepest = 0;
    int on_texels = 0;
    for (int i = 0; i < 20'000; ++i) {
      const std::uint32_t node = static_cast<std::uint32_t>(i) % block.heights.node_count;
      const fdcg_node_info face = fdcg_get_node(&block.graph, node);
      Hip place = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
      fdcg_relief_place at = {{place[0], place[1], place[2]}, {0, 0, 0}, node, 0};
      double slope[3], beside[3];
      for (const double way : {0.0, 0.01, 0.05, 0.2, 0.6, 3.0}) {
        at.way_m[0] = way;
        const double height = height_at(relief, at, slope);
        REQUIRE(std::fabs(height) <= relief.most_m * (1 + 1e-9));
        // along the face: the slope has no part across it
        const Hip side = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double step = 1e-6, out = side[0] * face.normal[0] + side[1] * face.normal[1] + side[2] * face.normal[2];
        fdcg_relief_place next = at;
        double expected = 0;
        for (int k = 0; k < 3; ++k) {
          const double by = step * (side[static_cast<std::size_t>(k)] - out * face.normal[k]);
          next.place_m[k] += by;
          expected += by * slope[k];
        }
        const double rise = height_at(relief, next, beside) - height;
        worst_slope = std::max(worst_slope, std::fabs(rise - expected) / step);
        steepest = std::max(steepest, std::fabs(expected) / step);
      }
      // the texel under the place, where it is inside the image
      const fdcg_node_place& map = block.heights.places[node];
      double on[2];
      for (int k = 0; k < 2; ++k) {
        on[k] = map.offset[k];
        for (int axis = 0; axis < 3; ++axis)
          on[k] += double{map.per_unit[k][axis]} * place[static_cast<std::size_t>(axis)];
      }
      if (!(on[0] > 0 && on[0] < 1 && on[1] > 0 && on[1] < 1)) continue;
      const double texel[2] = {std::floor(on[0] * 37), std::floor(on[1] * 21)};
      // moved along both gradients, which span the face, to the texel's middle
      const auto& g = map.per_unit;
      double uu = 0, uv = 0, vv = 0;
      for (int k = 0; k < 3; ++k)
        uu += double{g[0][k]} * g[0][k], uv += double{g[0][k]} * g[1][k], vv += double{g[1][k]} * g[1][k];
      const double du = (texel[0] + 0.5) / 37 - on[0], dv = (texel[1] + 0.5) / 21 - on[1], det = uu * vv - uv * uv;
      const double a = (vv * du - uv * dv) / det, b = (uu * dv - uv * du) / det;
      for (int k = 0; k < 3; ++k)
        at.place_m[k] = place[static_cast<std::size_t>(k)] + a * double{g[0][k]} + b * double{g[1][k]};
      at.way_m[0] = 0;
      const double value = double{image.values[static_cast<std::size_t>(texel[1] * 37 + texel[0])]};
      CHECK(height_at(relief, at, slope) == Approx(0.0002 * (value - mean)).margin(2e-8));
      ++on_texels;
    }
    CHECK(on_texels > 100);
    CHECK(steepest > 1e-3);
    CHECK(worst_slope <= relief.curvature_per_m * 2e-6);
  }
}

TEST_CASE("over closed loops an image gives the step's work, and no more beyond it than its account allows") {
  const double kSize = 0.05;
  const auto round_uv = [](const bake::Vec3& p) { return std::array<double, 2>{2 * std::atan2(p.y, p.x), 60 * p.z}; };
  const auto boxed_uv = [&](const bake::Vec3& p) { return std::array<double, 2>{40 * p.x + 7 * p.z, 40 * p.y + 9 * p.z}; };
  const bake::HeightImage image = noise_image(24, 24, bake::HeightImage::Wrap::repeat, 5);
  const Mapped meshes[3] = {Mapped(with_image(scaled(cube(), kSize), image, boxed_uv)),
                            Mapped(with_image(scaled(ico_sphere(3), kSize), image, round_uv)),  // with a seam
                            Mapped(with_image(scaled(saddle_block(), 0.5 * kSize), image, boxed_uv))};
  Random random(9);
  double most = -1;
  for (int loop = 0; loop < 100'000; ++loop) {
    const Mapped& mesh = meshes[loop / 6 % 3];
    const fdcg_relief relief = fdcg_make_height_relief(&mesh.heights);
    const std::vector<Hip> hips = elliptic_loop(random, kSize, 40 + loop % 60);
    Felt felt(relief, mesh.graph, relief_params(loop % 3 * 0.25, loop % 3 * 0.2));
    Hip held{}, last = hips[0];
    double longest_m = 0, strongest_n = 0;
    for (const Hip& hip : hips) {
      longest_m = std::max(longest_m, norm(difference(hip, last)));
      held = felt.at(hip);
      strongest_n = std::max(strongest_n, norm(held));
      last = hip;
    }
    const double allowed = relief.reserve_j + relief.power_w * kReliefTick_s * static_cast<double>(hips.size());
    INFO("loop " << loop);
    REQUIRE(felt.state.given_j <= allowed + 2 * strongest_n * longest_m);
    most = std::max(most, felt.state.given_j);
  }
  CHECK(most > 0);
}

TEST_CASE("an image that is off, or not asked for, changes no bit of the step") {
  const Mapped& block = wavy_block();
  fdcg_relief relief = fdcg_make_height_relief(&block.heights);
  relief.is_off = 1;
  const CompiledMesh bare(cube());
  Felt off(relief, block.graph, relief_params(0.4, 0.3));
  Contact plain(block.graph, relief_params(0.4, 0.3)), other(bare.view(), relief_params(0.4, 0.3));
  Random random(3);
  Hip hip = {0, 0, 0.5};
  for (int i = 0; i < 5000; ++i) {
    hip = {std::clamp(hip[0] + random.uniform(-0.01, 0.01), -0.6, 0.6),
           std::clamp(hip[1] + random.uniform(-0.01, 0.01), -0.6, 0.6),
           std::clamp(hip[2] + random.uniform(-0.001, 0.001), 0.495, 0.503)};
    off.at(hip);
    const fdcg_result& expected = plain.step(hip);
    REQUIRE(std::memcmp(off.force.data(), expected.force_n, sizeof expected.force_n) == 0);
    REQUIRE(std::memcmp(other.step(hip).force_n, expected.force_n, sizeof expected.force_n) == 0);
  }
}

TEST_CASE("faces are merged where one linear function places them, and kept where none does") {
  const bake::HeightImage image = noise_image(16, 16, bake::HeightImage::Wrap::repeat, 2);
  const bake::PolygonSoup box = grid_box(4, 3, 2, {4, 3, 2});
  CHECK(Mapped(with_image(box, image, flat_uv)).graph.header->node_count == 6);
  const auto bent = [](const bake::Vec3& p) { return std::array<double, 2>{0.1 * p.x * p.x, 0.1 * p.y + 0.05 * p.z}; };
  const Mapped kept(with_image(box, image, bent));
  CHECK(kept.graph.header->node_count > 60);
  // and each triangle lies where its corners say
  for (std::uint32_t n = 0; n < kept.graph.header->node_count; ++n) {
    const fdcg_node_info info = fdcg_get_node(&kept.graph, n);
    REQUIRE(kept.heights.places[n].map == 0);
    for (std::uint32_t side = 0; side < info.side_count; ++side) {
      const fdcg_corner_info corner = fdcg_get_corner(&kept.graph, fdcg_get_side(&kept.graph, n, side).corner);
      const bake::Vec3 at = {corner.point[0] + kept.heights.origin[0], corner.point[1] + kept.heights.origin[1],
                             corner.point[2] + kept.heights.origin[2]};
      const auto expected = bent(at);
      for (int k = 0; k < 2; ++k) {
        double found = kept.heights.places[n].offset[k];
        for (int axis = 0; axis < 3; ++axis)
          found += double{kept.heights.places[n].per_unit[k][axis]} * corner.point[axis];
        const double off = found - expected[static_cast<std::size_t>(k)];
        CHECK(off - std::round(off) == Approx(0).margin(1.0 / 1024));  // whole images apart is the same
      }
    }
  }
}

TEST_CASE("what an image needs and has not is said") {
  const bake::HeightImage image = noise_image(8, 8, bake::HeightImage::Wrap::repeat, 2);
  const bake::PolygonSoup sound = with_image(cube(), image, flat_uv);
  CHECK(message_of(sound, felt_options(0.0001)).empty());
  CHECK_THAT(message_of(sound, felt_options()), ContainsSubstring("noise: nothing says how high white is above black"));
  CHECK_THAT(message_of(cube(), felt_options(0.0001)), ContainsSubstring("names no image of heights"));
  bake::PolygonSoup bare = sound;
  bare.appearance.uv.clear();
  CHECK_THAT(message_of(bare, felt_options(0.0001)), ContainsSubstring("holds no texture coordinates"));
  bake::PolygonSoup level = sound;
  std::fill(level.appearance.images[0].values.begin(), level.appearance.images[0].values.end(), 0.5f);
  CHECK_THAT(message_of(level, felt_options(0.0001)), ContainsSubstring("of one height"));
  bake::PolygonSoup nowhere = sound;
  nowhere.appearance.all_heights = bake::LookMaterial::kNoImage;
  CHECK_THAT(message_of(nowhere, felt_options(0.0001)), ContainsSubstring("no face is on an image"));
  fdcg_heights heights;
  fdcg_error error{};
  const CompiledMesh without(cube());
  CHECK(fdcg_get_heights(&without.view(), &heights, &error) == FDCG_E_ABSENT);
  CHECK_THAT(error.message, ContainsSubstring("--heights"));
  CHECK(fdcg_get_heights(nullptr, &heights, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_get_heights(&without.view(), nullptr, &error) == FDCG_E_ARGUMENT);
}

TEST_CASE("hostile sections of heights are refused, each with what is wrong") {
  const Mapped sound(with_image(cube(), noise_image(8, 4, bake::HeightImage::Wrap::repeat, 2), flat_uv));
  const auto said = [&](const std::function<void(AlignedBytes&, fdcg_section*)>& damage) {
    AlignedBytes file = sound.file;
    damage(file, reinterpret_cast<fdcg_section*>(file.data() + sizeof(fdcg_header)));
    seal(file);
    fdcg_graph graph;
    fdcg_heights heights;
    fdcg_error error{};
    if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, &error) != FDCG_OK)
      return std::string(error.message);
    if (fdcg_get_heights(&graph, &heights, &error) == FDCG_OK) return std::string();
    CHECK(heights.places == nullptr);
    return std::string(error.message);
  };
  const auto find = [](AlignedBytes& file, fdcg_section* sections, std::uint32_t id) {
    for (std::uint32_t i = 0; i < file.header().section_count; ++i)
      if (sections[i].id == id) return sections + i;
    FAIL("no section " << id);
    return sections;
  };
  const auto place = [&](const std::function<void(fdcg_node_place&)>& damage) {
    return said([&](AlignedBytes& file, fdcg_section* sections) {
      damage(reinterpret_cast<fdcg_node_place*>(file.data() + find(file, sections, FDCG_SECTION_NODE_PLACES)->offset)[3]);
    });
  };
  const auto map = [&](const std::function<void(fdcg_height_map&)>& damage) {
    return said([&](AlignedBytes& file, fdcg_section* sections) {
      damage(*reinterpret_cast<fdcg_height_map*>(file.data() + find(file, sections, FDCG_SECTION_HEIGHT_MAPS)->offset));
    });
  };
  CHECK(said([](AlignedBytes&, fdcg_section*) {}).empty());
  CHECK_THAT(place([](fdcg_node_place& p) { p.map = 1; }), ContainsSubstring("place of node 3: map out of range"));
  CHECK(place([](fdcg_node_place& p) { p.map = FDCG_NONE; }).empty());
  CHECK_THAT(place([](fdcg_node_place& p) { p.offset[1] = NAN; }), ContainsSubstring("too far away"));
  CHECK_THAT(place([](fdcg_node_place& p) { p.offset[0] = 1e7; }), ContainsSubstring("too far away"));
  CHECK_THAT(place([](fdcg_node_place& p) { p.per_unit[0][2] = NAN; }), ContainsSubstring("too small"));
  CHECK_THAT(place([](fdcg_node_place& p) { p.per_unit[1][0] = INFINITY; }), ContainsSubstring("too small"));
  CHECK_THAT(place([](fdcg_node_place& p) { p.reserved = 1; }), ContainsSubstring("reserved"));
  for (const auto& damage : std::vector<std::function<void(fdcg_height_map&)>>{
           [](fdcg_height_map& m) { m.width = 0; }, [](fdcg_height_map& m) { m.height = 0xFFFFFFFF; },
           [](fdcg_height_map& m) { m.width = FDCG_MAX_HEIGHT_SIDE + 1; }, [](fdcg_height_map& m) { m.level_count = 0; },
           [](fdcg_height_map& m) { m.level_count = FDCG_MAX_HEIGHT_LEVELS + 1; }})
    CHECK_THAT(map(damage), ContainsSubstring("its size is out of range"));
  for (const auto& damage : std::vector<std::function<void(fdcg_height_map&)>>{
           [](fdcg_height_map& m) { m.width = FDCG_MAX_HEIGHT_SIDE; }, [](fdcg_height_map& m) { m.level_count -= 1; },
           [](fdcg_height_map& m) { m.first = 1; }, [](fdcg_height_map& m) { m.first = 0xFFFFFFFF; },
           [](fdcg_height_map& m) { m.height = 3; }})
    CHECK_THAT(map(damage), ContainsSubstring("texels do not follow"));
  CHECK_THAT(map([](fdcg_height_map& m) { m.metres_per_step = NAN; }), ContainsSubstring("unit is out of range"));
  CHECK_THAT(map([](fdcg_height_map& m) { m.metres_per_step = 2; }), ContainsSubstring("unit is out of range"));
  CHECK_THAT(map([](fdcg_height_map& m) { m.wrap[1] = 3; }), ContainsSubstring("unknown wrap"));
  CHECK_THAT(map([](fdcg_height_map& m) { m.reserved[1] = 3; }), ContainsSubstring("reserved"));
  for (std::uint32_t id = FDCG_SECTION_NODE_PLACES; id <= FDCG_SECTION_HEIGHT_TEXELS; ++id)
    CHECK_THAT(said([&](AlignedBytes& file, fdcg_section* sections) {
                 auto* s = find(file, sections, id);
                 s->record_bytes /= 2, s->record_count *= 2;
               }),
               ContainsSubstring("wrong size"));
}
