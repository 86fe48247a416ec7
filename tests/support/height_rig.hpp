// SPDX-License-Identifier: Apache-2.0
// Meshes with images of heights, compiled and opened.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/heights.h"
#include "random.hpp"
#include "sealed_bytes.hpp"

namespace fdcg::test {

inline bake::CompileOptions felt_options(double range_m = 0) {
  bake::CompileOptions options;
  options.heights = true;
  options.height_range_m = range_m;
  return options;
}

struct Mapped {
  AlignedBytes file;
  fdcg_graph graph{};
  fdcg_heights heights{};
  fdcg_error error{};
  fdcg_status status = FDCG_OK;

  explicit Mapped(const bake::PolygonSoup& soup, const bake::CompileOptions& options = felt_options(0.0002))
      : file(compiled(soup, options)) {
    REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
    status = fdcg_get_heights(&graph, &heights, &error);
    INFO(error.message);
    REQUIRE(status == FDCG_OK);
  }
  static std::vector<std::byte> compiled(const bake::PolygonSoup& soup, const bake::CompileOptions& options) {
    auto result = bake::compile(soup, options);
    INFO((result ? bake::report_text(result->report, false) : result.error().message));
    REQUIRE(result.has_value());
    REQUIRE(!result->bytes.empty());
    return result->bytes;
  }
};

// An image of noise on every face of a soup, by these texture coordinates.
inline bake::HeightImage noise_image(std::uint32_t width, std::uint32_t height, bake::HeightImage::Wrap wrap,
                                     std::uint32_t seed) {
  bake::HeightImage image;
  image.name = "noise";
  image.width = width, image.height = height;
  Random random(seed);
  for (std::uint32_t i = 0; i < width * height; ++i)
    image.values.push_back(static_cast<float>(random.uniform(0, 1)));
  image.wrap = {wrap, wrap};
  return image;
}

inline bake::PolygonSoup with_image(bake::PolygonSoup soup, const bake::HeightImage& image,
                                    const std::function<std::array<double, 2>(const bake::Vec3&)>& uv) {
  soup.appearance.images = {image};
  soup.appearance.all_heights = 0;
  for (const std::uint32_t corner : soup.corners) {
    const auto at = uv(soup.points[corner]);
    soup.appearance.uv.push_back({static_cast<float>(at[0]), static_cast<float>(at[1])});
  }
  return soup;
}

inline std::array<double, 2> flat_uv(const bake::Vec3& p) {
  return {3 * p.x + 0.2 * p.y + 0.1 * p.z, 2 * p.y - p.z};
}

inline double height_at(const fdcg_relief& relief, const fdcg_relief_place& place, double (&slope)[3]) {
  double height = 0;
  relief.law(&relief, &place, &height, slope);
  return height;
}

}  // namespace fdcg::test
