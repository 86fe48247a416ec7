// SPDX-License-Identifier: Apache-2.0
// Normal textures of glTF as heights: against the fields that the normals are made of, and what is refused.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"
#include "gltf_writer.hpp"
#include "import/normal_image.hpp"
#include "import/slope_integral.hpp"
#include "import_support.hpp"
#include "png_writer.hpp"
#include "random.hpp"
#include "scratch_folder.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Of a place on the image, 0 to 1 along each side, the second one downwards: a height, and its slopes along both.
struct Rise {
  double height = 0, along = 0, down = 0;
};
using Field = std::function<Rise(double u, double v)>;

Rise waves(double u, double v, int columns, int rows) {
  const double a = kTurn * columns * u, b = kTurn * rows * v + 0.3;
  return {std::sin(a) * std::cos(b), kTurn * columns * std::cos(a) * std::cos(b), -kTurn * rows * std::sin(a) * std::sin(b)};
}

// A hill that is steep at the borders.
Rise hill(double u, double v) {
  const double h = std::exp(-2 * (u - 0.4) * (u - 0.4) - (v - 0.2) * (v - 0.2));
  return {h, -4 * (u - 0.4) * h, -2 * (v - 0.2) * h};
}

double at_middle(std::size_t i, std::size_t count) {
  return (static_cast<double>(i) + 0.5) / static_cast<double>(count);
}

SlopeGrid slopes_of(const Field& field, std::size_t width, std::size_t height, bool repeats) {
  SlopeGrid grid;
  grid.width = width, grid.height = height;
  grid.repeats = {repeats, repeats};
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const Rise rise = field(at_middle(x, width), at_middle(y, height));
      grid.along.push_back(static_cast<float>(rise.along / static_cast<double>(width)));
      grid.down.push_back(static_cast<float>(rise.down / static_cast<double>(height)));
    }
  return grid;
}

// The largest difference of heights from a field, both about their mean, in the field's range.
template <class At>
double worst_share(const Field& field, std::size_t width, std::size_t height, const At& at) {
  double mean[2] = {0, 0}, least = INFINITY, most = -INFINITY, worst = 0;
  const auto count = static_cast<double>(width * height);
  for (std::size_t i = 0; i < width * height; ++i) {
    const double given = field(at_middle(i % width, width), at_middle(i / width, height)).height;
    mean[0] += given / count, mean[1] += at(i) / count;
    least = std::min(least, given), most = std::max(most, given);
  }
  for (std::size_t i = 0; i < width * height; ++i) {
    const double given = field(at_middle(i % width, width), at_middle(i / width, height)).height;
    worst = std::max(worst, std::fabs((at(i) - mean[1]) - (given - mean[0])));
  }
  return worst / (most - least);
}

double integral_error(const Field& field, std::size_t width, std::size_t height, bool repeats) {
  const std::vector<double> heights = integrate_slopes(slopes_of(field, width, height, repeats));
  return worst_share(field, width, height, [&](std::size_t i) { return heights[i]; });
}

// Normals of a field of metres on a surface of `size_m`, x to the right, y upwards, as numbers of so many bits.
std::string normals_png(const Field& field_m, std::uint32_t width, std::uint32_t height, std::array<double, 2> size_m,
                        int bits = 16, double scale = 1) {
  std::vector<std::uint16_t> values;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const Rise rise = field_m(at_middle(x, width), at_middle(y, height));
      const double n[3] = {-rise.along / size_m[0] / scale, rise.down / size_m[1] / scale, 1};
      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      for (const double part : n)
        values.push_back(static_cast<std::uint16_t>(std::lround((part / length + 1) / 2 * (bits == 16 ? 65535 : 255))));
    }
  return png_bytes(width, height, 3, bits, values);
}

Rise weave_m(double u, double v) {
  constexpr double kHeight_m = 2e-4;
  const Rise a = waves(u, v, 3, 2), b = waves(u, v, 1, 4);
  return {kHeight_m * (a.height + b.height / 2), kHeight_m * (a.along + b.along / 2), kHeight_m * (a.down + b.down / 2)};
}

// Two triangles of a rectangle of 0.2 m by 0.1 m, from (0, 0) to (0.2, 0.1), the image upright on it; `more`: members of the
// document; `info`: of normalTexture; `set`: of its texture coordinates.
struct Sheet {
  std::string more, info = R"("index":0)", set = "TEXCOORD_0", node;
  std::array<float, 8> uv = {0, 1, 1, 1, 1, 0, 0, 0};  // v downwards
  std::string binary = {};                             // after the sheet's 92 bytes, at 96

  [[nodiscard]] std::string json(const std::string& uri) const {
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0)" + node +
           R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,")" + set +
           R"(":1},"indices":2,"material":0}]}],"materials":[{"normalTexture":{)" + info +
           R"(}}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
           R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},)"
           R"({"buffer":0,"byteOffset":80,"byteLength":12},{"buffer":0,"byteOffset":96,"byteLength":)" +
           std::to_string(binary.size()) + R"(}],"buffers":[{"byteLength":)" + std::to_string(96 + binary.size()) + uri + "}]" +
           more + "}";
  }
  [[nodiscard]] std::string buffer() const {
    std::string bytes;
    for (const float c : {0.f, 0.f, 0.f, 0.2f, 0.f, 0.f, 0.2f, 0.1f, 0.f, 0.f, 0.1f, 0.f})
      put(bytes, c);
    for (const float c : uv)
      put(bytes, c);
    for (const std::uint16_t i : {0, 1, 2, 0, 2, 3})
      put(bytes, i);
    bytes.resize(96, '\0');
    return bytes + binary;
  }
  [[nodiscard]] std::string gltf() const { return json(R"(,"uri":"data:;base64,)" + base64(buffer()) + '"'); }
  [[nodiscard]] std::string glb() const { return glb_container(json(""), buffer()); }
};

ImportOptions felt() {
  ImportOptions options;
  options.appearance = true;
  options.heights = "file";
  return options;
}

std::string with_image(const std::string& png, const std::string& sampler = "") {
  return R"(,"textures":[{"source":0)" + std::string(sampler.empty() ? "" : R"(,"sampler":0)") +
         R"(}],"images":[{"mimeType":"image/png","uri":"data:image/png;base64,)" + base64(png) + R"("}])" +
         (sampler.empty() ? "" : R"(,"samplers":[{)" + sampler + "}]");
}

PolygonSoup imported(const std::string& bytes) {
  auto soup = import_memory(bytes, "sheet.gltf", felt());
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup);
  return *soup;
}

std::string refused(const std::string& bytes) {
  CHECK(import_memory(bytes, "sheet.gltf"));  // the mesh alone is sound
  const auto soup = import_memory(bytes, "sheet.gltf", felt());
  REQUIRE_FALSE(soup);
  CHECK(soup.error().exit_code == 3);
  CHECK(soup.error().message.starts_with("sheet.gltf: "));
  CHECK(soup.error().message.find('\n') == std::string::npos);
  return soup.error().message;
}

double sheet_error(const PolygonSoup& soup, const Field& field_m) {
  REQUIRE(soup.appearance.images.size() == 1);
  const HeightImage& image = soup.appearance.images[0];
  REQUIRE(soup.appearance.materials.at(0).heights == 0);
  return worst_share(field_m, image.width, image.height, [&](std::size_t i) { return image.range * double{image.values[i]}; });
}

}  // namespace

TEST_CASE("slopes of waves are integrated to the waves, as near as their length says") {
  for (const auto& [texels, bound] : {std::pair{4, 0.09}, {8, 6.5e-3}, {16, 4e-4}, {32, 3e-5}}) {
    const auto field = [](double u, double v) { return waves(u, v, 3, 0); };
    const auto turned = [](double u, double v) {
      const Rise rise = waves(v, u, 5, 0);
      return Rise{rise.height, rise.down, rise.along};
    };
    const auto both = [](double u, double v) { return waves(u, v, 3, 5); };
    INFO("waves of " << texels << " texels");
    const auto n = static_cast<std::size_t>(texels);
    CHECK(integral_error(field, 3 * n, 7, true) < bound);
    CHECK(integral_error(turned, 7, 5 * n, true) < bound);
    CHECK(integral_error(both, 3 * n, 5 * n, true) < bound);
    CHECK(integral_error(field, 3 * n, 7, true) > bound / 10);  // so the bound says something
  }
}

TEST_CASE("where the grid does not repeat, no border is taken for another") {
  for (const std::size_t width : {16, 61, 128})
    for (const std::size_t height : {17, 64}) {
      INFO(width << " x " << height);
      const auto least = static_cast<double>(std::min(width, height));
      CHECK(integral_error(hill, width, height, false) < 2 / (least * least * least));
    }
  // a ramp is a ramp, to rounding; on a grid that repeats there is none
  const auto ramp = [](double u, double v) { return Rise{u - 2 * v, 1, -2}; };
  CHECK(integral_error(ramp, 37, 11, false) < 1e-6);
  for (const double height : integrate_slopes(slopes_of(ramp, 37, 11, true)))
    CHECK(std::fabs(height) < 1e-9);
}

TEST_CASE("slopes on grids of one row, one column, one and two places") {
  const auto ramp = [](double u, double) { return Rise{u, 1, 0}; };
  for (const bool repeats : {false, true})
    for (const std::size_t width : {1, 2, 3})
      for (const std::size_t height : {1, 2, 3}) {
        const std::vector<double> heights = integrate_slopes(slopes_of(ramp, width, height, repeats));
        REQUIRE(heights.size() == width * height);
        for (std::size_t i = 0; i < heights.size(); ++i) {
          const double expected = repeats ? 0 : at_middle(i % width, width) - 0.5;
          CHECK(heights[i] == Approx(expected).margin(1e-6));
        }
      }
}

TEST_CASE("slopes that are no gradients give the heights whose slopes are nearest") {
  // noise and a field: the noise's own integral is what is added, since the integral is linear
  Random random(4);
  SlopeGrid noise = slopes_of([](double, double) { return Rise{}; }, 24, 18, false), sum = slopes_of(hill, 24, 18, false);
  for (std::size_t i = 0; i < noise.along.size(); ++i) {
    noise.along[i] = static_cast<float>(random.uniform(-0.01, 0.01));
    noise.down[i] = static_cast<float>(random.uniform(-0.01, 0.01));
    sum.along[i] += noise.along[i], sum.down[i] += noise.down[i];
  }
  const auto a = integrate_slopes(noise), b = integrate_slopes(sum), c = integrate_slopes(slopes_of(hill, 24, 18, false));
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(b[i] - a[i] == Approx(c[i]).margin(1e-6));
    largest = std::max(largest, std::fabs(a[i]));
  }
  CHECK(largest < 0.05);  // of slopes that go nowhere
}

TEST_CASE("a normal texture of a known field comes back as its heights, repeated, clamped and mirrored") {
  const std::array<double, 2> size = {0.2, 0.1};
  const std::string png = normals_png(weave_m, 96, 80, size);
  Sheet sheet;
  sheet.more = with_image(png);
  const PolygonSoup repeated = imported(sheet.gltf());
  CHECK(sheet_error(repeated, weave_m) < 1e-3);
  CHECK(repeated.appearance.images[0].wrap[0] == HeightImage::Wrap::repeat);
  CHECK(repeated.appearance.images[0].name == "sheet.gltf: images[0]");

  const auto hill_m = [](double u, double v) {
    const Rise h = hill(u, v);
    return Rise{0.01 * h.height, 0.01 * h.along, 0.01 * h.down};
  };
  sheet.more = with_image(normals_png(hill_m, 70, 50, size), R"("wrapS":33071,"wrapT":33648)");
  const PolygonSoup clamped = imported(sheet.gltf());
  CHECK(sheet_error(clamped, hill_m) < 1e-3);
  CHECK(clamped.appearance.images[0].wrap[0] == HeightImage::Wrap::clamp);
  CHECK(clamped.appearance.images[0].wrap[1] == HeightImage::Wrap::mirror);
  CHECK(clamped.appearance.images[0].range == Approx(0.01 * (1 - std::exp(-2 * 0.36 - 0.64))).epsilon(0.03));

  // of 8 bits a slope is known to within 1/255
  const auto steep_m = [](double u, double v) {
    const Rise w = weave_m(u, v);
    return Rise{10 * w.height, 10 * w.along, 10 * w.down};
  };
  sheet.more = with_image(normals_png(steep_m, 96, 80, size, 8));
  CHECK(sheet_error(imported(sheet.gltf()), steep_m) < 0.01);
}

TEST_CASE("scale, a mirrored image, the node's size and the transform of texture coordinates") {
  const std::array<double, 2> size = {0.2, 0.1};
  Sheet sheet;
  sheet.info = R"("index":0,"scale":2.5)";
  sheet.more = with_image(normals_png(weave_m, 96, 80, size, 16, 2.5));
  CHECK(sheet_error(imported(sheet.gltf()), weave_m) < 1e-3);
  const PolygonSoup plain = imported(sheet.gltf());

  // the image's left is the sheet's right: its directions on the surface are mirrored, its heights are not
  sheet.uv = {1, 1, 0, 1, 0, 0, 1, 0};
  CHECK(sheet_error(imported(sheet.gltf()), weave_m) < 1e-3);
  sheet.uv = {0, 1, 1, 1, 1, 0, 0, 0};

  sheet.node = R"(,"scale":[3,3,-3])";
  CHECK(imported(sheet.gltf()).appearance.images[0].range == Approx(3 * plain.appearance.images[0].range).epsilon(1e-6));
  sheet.node = "";

  // half of the image on the sheet, along each side: texels are twice as large there, and so are heights
  sheet.info = R"("index":0,"scale":2.5,"extensions":{"KHR_texture_transform":{"scale":[0.5,-0.5],"offset":[0.25,7]}})";
  const PolygonSoup half = imported(sheet.gltf());
  CHECK(half.appearance.images[0].range == Approx(2 * plain.appearance.images[0].range).epsilon(1e-6));
  CHECK(half.appearance.images[0].placing == std::array<double, 6>{0.5, 0, 0.25, 0, -0.5, 7});

  // the example of the extension's text: the lower left quarter, turned
  sheet.info =
      R"("index":0,"extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]}})";
  const auto placing = imported(sheet.gltf()).appearance.images[0].placing;
  const double expected[6] = {0, 0.5, 0, -0.5, 0, 1};
  for (std::size_t k = 0; k < 6; ++k)
    CHECK(placing[k] == Approx(expected[k]).margin(1e-9));
}

TEST_CASE("texels that are not square on the mesh") {
  const std::array<double, 2> size = {0.2, 0.1};
  for (const auto& [width, height] : {std::pair{200u, 40u}, {60u, 160u}}) {
    Sheet sheet;
    sheet.more = with_image(normals_png(weave_m, width, height, size));
    CHECK(sheet_error(imported(sheet.gltf()), weave_m) < 2e-2);  // waves of ten texels along the coarse side
  }
}

TEST_CASE("a second set of texture coordinates places the heights, and the first what is seen") {
  Sheet sheet;
  sheet.more = with_image(normals_png(weave_m, 96, 80, {0.2, 0.1}));
  sheet.info = R"("index":0,"texCoord":1)";
  sheet.set = "TEXCOORD_1";
  const PolygonSoup soup = imported(sheet.gltf());
  CHECK(soup.appearance.uv.empty());
  REQUIRE(soup.appearance.height_uv.size() == soup.corners.size());
  CHECK(soup.appearance.height_uv[1] == std::array<float, 2>{1, 1});
  CHECK(sheet_error(soup, weave_m) < 1e-3);

  sheet.info = R"("index":0,"extensions":{"KHR_texture_transform":{"texCoord":1}})";
  CHECK(sheet_error(imported(sheet.gltf()), weave_m) < 1e-3);
  sheet.info = R"("index":0,"texCoord":2)";  // which the primitive has not
  CHECK(imported(sheet.gltf()).appearance.images.empty());
}

TEST_CASE("images in the binary chunk, and in files beside the mesh") {
  Sheet sheet;
  sheet.binary = normals_png(weave_m, 96, 80, {0.2, 0.1});
  sheet.more = R"(,"textures":[{"source":0}],"images":[{"mimeType":"image/png","bufferView":3}])";
  CHECK(sheet_error(imported(sheet.glb()), weave_m) < 1e-3);

  const std::filesystem::path folder = scratch_folder();
  std::filesystem::create_directories(folder / "images");
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  write("images/the normals.png", sheet.binary);
  sheet.binary.clear();
  sheet.more = R"(,"textures":[{"source":0}],"images":[{"uri":"images/the%20normals.png"}])";
  write("sheet.gltf", sheet.gltf());
  const auto soup = import_mesh(folder / "sheet.gltf", felt());
  INFO((soup ? std::string() : soup.error().message));
  REQUIRE(soup);
  CHECK(sheet_error(*soup, weave_m) < 1e-3);
  CHECK(soup->other_files == std::vector<std::string>{(folder / "images/the normals.png").string()});
  CHECK(import_mesh(folder / "sheet.gltf")->other_files.empty());
  std::filesystem::remove(folder / "images/the normals.png");
  CHECK_THAT(import_mesh(folder / "sheet.gltf", felt()).error().message, ContainsSubstring("images[0].uri: the file"));
  CHECK_THAT(refused(sheet.gltf()), ContainsSubstring("is a file of its own"));
  sheet.more = R"(,"textures":[{"source":0}],"images":[{"uri":"../normals.png"}])";
  CHECK_THAT(refused(sheet.gltf()), ContainsSubstring("is no file in or beneath the folder"));
}

TEST_CASE("a texture that is flat is no image, whatever its numbers round to") {
  Sheet sheet;
  for (const int bits : {8, 16})
    for (const int below : {0, 1}) {
      const auto middle = static_cast<std::uint16_t>((bits == 8 ? 128 : 32768) - below);
      const auto white = static_cast<std::uint16_t>(bits == 8 ? 255 : 65535);
      std::vector<std::uint16_t> values;
      for (int i = 0; i < 4 * 4; ++i)
        values.insert(values.end(), {middle, middle, white});
      for (const char* const sampler : {"", R"("wrapS":33071,"wrapT":33071)"}) {
        sheet.more = with_image(png_bytes(4, 4, 3, bits, values), sampler);
        const PolygonSoup soup = imported(sheet.gltf());
        CHECK(soup.appearance.images.empty());
        CHECK(soup.appearance.materials.at(0).heights == LookMaterial::kNoImage);
      }
    }
}

TEST_CASE("normals that point inward, lie flat or are none give heights all the same") {
  std::vector<std::uint16_t> values;
  Random random(11);
  for (int i = 0; i < 16 * 16; ++i) {
    constexpr std::uint16_t kCases[][3] = {{0, 0, 0}, {65535, 32768, 0}, {32768, 65535, 32768}, {32768, 32768, 32768}};
    const auto& n = kCases[static_cast<std::size_t>(random.uniform(0, 3.999))];
    values.insert(values.end(), std::begin(n), std::end(n));
  }
  Sheet sheet;
  sheet.more = with_image(png_bytes(16, 16, 3, 16, values));
  const PolygonSoup soup = imported(sheet.gltf());
  REQUIRE(soup.appearance.images.size() == 1);
  const HeightImage& image = soup.appearance.images[0];
  CHECK((image.range > 0 && image.range < 10 * (0.2 + 0.1)));
  for (const float value : image.values)
    REQUIRE((value >= 0 && value <= 1));
}

TEST_CASE("what is wrong with a normal texture is said, and only where heights are asked for") {
  const std::string png = normals_png(weave_m, 8, 8, {0.2, 0.1});
  const auto said = [&](const std::string& info, const std::string& more) {
    Sheet sheet;
    sheet.info = info;
    sheet.more = more;
    return refused(sheet.gltf());
  };
  const std::string index = R"("index":0)", source = R"(,"textures":[{"source":0}])";
  CHECK_THAT(said(index, ""), ContainsSubstring("normalTexture.index is 0, but the file has 0 textures"));
  CHECK_THAT(said(R"("scale":1)", ""), ContainsSubstring("normalTexture.index is missing"));
  CHECK_THAT(said(R"("index":-1)", with_image(png)), ContainsSubstring("normalTexture.index is -1"));
  CHECK_THAT(said(R"("index":1)", with_image(png)), ContainsSubstring("normalTexture.index is 1, but the file has 1 textures"));
  CHECK_THAT(said(R"("index":0,"scale":"big")", with_image(png)), ContainsSubstring("normalTexture.scale is \"big\""));
  CHECK_THAT(said(R"("index":0,"scale":1e300)", with_image(png)), ContainsSubstring("normalTexture.scale is"));
  CHECK_THAT(said(R"("index":0,"texCoord":1e9)", with_image(png)), ContainsSubstring("normalTexture.texCoord is"));
  CHECK_THAT(said(R"("index":0,"extensions":{"KHR_texture_transform":{"scale":[1]}})", with_image(png)),
             ContainsSubstring("KHR_texture_transform.scale"));
  CHECK_THAT(said(index, R"(,"textures":[{}])"), ContainsSubstring("textures[0] names no image that is read"));
  CHECK_THAT(said(index, source), ContainsSubstring("textures[0].source is 0, but the file has 0 images"));
  CHECK_THAT(said(index, source + R"(,"images":[{}])"), ContainsSubstring("images[0] has neither a uri nor a bufferView"));
  CHECK_THAT(said(index, source + R"(,"images":[{"bufferView":9}])"), ContainsSubstring("images[0].bufferView is 9"));
  CHECK_THAT(said(index, source + R"(,"images":[{"uri":"data:image/png;base64,!"}])"),
             ContainsSubstring("its data is damaged"));
  CHECK_THAT(said(index, source + R"(,"images":[{"uri":7}])"), ContainsSubstring("images[0].uri"));
  CHECK_THAT(said(index, with_image(png, R"("wrapS":7)")), ContainsSubstring("samplers[0].wrapS is 7; it is 10497"));
  CHECK_THAT(said(index, R"(,"textures":[{"source":0,"sampler":3}],"images":[{"uri":"data:,"}])"),
             ContainsSubstring("textures[0].sampler is 3, but the file has 0 samplers"));
  CHECK_THAT(said(index, with_image("\xFF\xD8\xFF\xE0 JFIF")),
             ContainsSubstring("images[0] is JPEG; images of normals are read"));
  CHECK_THAT(said(index, with_image(std::string("RIFF\1\0\0\0WEBPVP8 ", 16))), ContainsSubstring("images[0] is WebP"));
  CHECK_THAT(said(index, with_image("")), ContainsSubstring("images[0]: is no PNG image that can be read"));
  for (std::size_t cut = 1; cut < png.size(); cut += 7)
    CHECK_THAT(said(index, with_image(png.substr(0, cut))), ContainsSubstring("images[0]: is no PNG image that can be read"));
  CHECK_THAT(said(index, with_image(png_bytes(4, 4, 1, 8, std::vector<std::uint16_t>(16, 9)))), ContainsSubstring("is grey"));
}
