// SPDX-License-Identifier: Apache-2.0
// Images of heights: PNG of every kind that is read, and paths that are no images.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "import_support.hpp"
#include "png_writer.hpp"
#include "scratch_folder.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using namespace fdcg::test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr const char* kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

const std::filesystem::path& folder() {
  static const std::filesystem::path path = scratch_folder();
  return path;
}

Result<PolygonSoup> with_heights(const std::filesystem::path& image) {
  ImportOptions options;
  options.appearance = true;
  options.heights = image.string();
  return import_memory(kTetrahedron, "mesh.obj", options);
}

}  // namespace

TEST_CASE("heights are the mean of a texel's colours, of 8 bits and of 16, whatever its opacity") {
  for (const int bits : {8, 16}) {
    const double white = bits == 8 ? 255 : 65535;
    for (std::uint32_t channels = 1; channels <= 4; ++channels) {
      INFO(bits << " bits, " << channels << " channels");
      constexpr std::uint32_t kWidth = 5, kHeight = 3;
      std::vector<std::uint16_t> values;
      for (std::uint32_t i = 0; i < kWidth * kHeight * channels; ++i)
        values.push_back(static_cast<std::uint16_t>(i * 7919u % (bits == 8 ? 256u : 65536u)));
      const std::filesystem::path path = folder() / "image.png";
      std::ofstream(path, std::ios::binary) << png_bytes(kWidth, kHeight, channels, bits, values);
      const auto soup = with_heights(path);
      INFO((soup ? std::string() : soup.error().message));
      REQUIRE(soup);
      REQUIRE(soup->appearance.images.size() == 1);
      CHECK(soup->appearance.all_heights == 0);
      CHECK(soup->other_files == std::vector<std::string>{path.string()});
      const HeightImage& image = soup->appearance.images[0];
      REQUIRE((image.width == kWidth && image.height == kHeight && image.values.size() == kWidth * kHeight));
      const std::uint32_t colours = channels <= 2 ? 1 : 3;
      for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        double sum = 0;
        for (std::uint32_t c = 0; c < colours; ++c)
          sum += values[i * channels + c];
        CHECK(double{image.values[i]} == Approx(sum / (colours * white)).margin(1e-7));
      }
    }
  }
}

TEST_CASE("a folder, a device and a missing file are no images, which is said of images") {
  const auto message = [](const std::filesystem::path& path) {
    const auto soup = with_heights(path);
    REQUIRE_FALSE(soup);
    CHECK(soup.error().exit_code == 3);
    CHECK(soup.error().message.find('\n') == std::string::npos);
    return soup.error().message;
  };
  CHECK(message(folder()) == folder().string() + ": is a directory; name an image in it");
  CHECK(message("/dev/zero") == "/dev/zero: is a device, which has no end; name an image");
  CHECK_THAT(message(folder() / "none.png"), ContainsSubstring("cannot be opened: No such file or directory"));
  std::ofstream(folder() / "text.png") << "no image";
  CHECK_THAT(message(folder() / "text.png"), ContainsSubstring("is no PNG image that can be read"));
}

TEST_CASE("an image's range and place are numbers, whatever its library says") {
  std::ofstream(folder() / "one.png", std::ios::binary) << png_bytes(2, 1, 1, 8, {0, 255});
  std::ofstream(folder() / "mesh.obj") << "mtllib mesh.mtl\nusemtl a\n" << kTetrahedron;
  const auto image_of = [](const std::string& options) {
    std::ofstream(folder() / "mesh.mtl") << "newmtl a\nmap_bump " << options << " one.png\n";
    ImportOptions looking;
    looking.appearance = true;
    looking.heights = "file";
    return import_mesh(folder() / "mesh.obj", looking);
  };
  const auto usual = image_of("-bm 0.5 -mm 0 1e100 -s 1e100 -1e100 -o 1e100");
  REQUIRE(usual);
  CHECK(usual->appearance.images.at(0).range == Approx(5e99));
  for (const double number : usual->appearance.images[0].placing)
    CHECK(std::isfinite(number));
  for (const char* const beyond : {"-bm 1e200 -mm 0 1e200", "-s 1 1e308 -o 0 1e308", "-bm 1e999", "-bm nan"}) {
    INFO(beyond);
    const auto refused = image_of(beyond);  // what is no number is the image's name
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, ContainsSubstring("one.png"));
  }
}
