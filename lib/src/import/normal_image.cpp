// SPDX-License-Identifier: Apache-2.0
#include "import/normal_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "import/png_image.hpp"
#include "import/slope_integral.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

constexpr double kFullScale = 65535;
constexpr double kLeastUpright = 0.1;  // of a normal of length 1: its part along the surface's

// Slopes to the right and upwards, of one texel's three numbers. `nothing`: what is nearer to 0 is 0.
std::array<double, 2> slopes_of(const std::uint16_t* texel, double nothing) {
  std::array<double, 3> n{};
  for (std::size_t k = 0; k < 3; ++k) {
    n[k] = 2 * (texel[k] / kFullScale) - 1;
    if (std::fabs(n[k]) <= nothing) n[k] = 0;
  }
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (length == 0) return {0, 0};
  const double upright = std::max(n[2], kLeastUpright * length);
  return {-n[0] / upright, -n[1] / upright};
}

SlopeGrid slopes_of(const PngImage& png, const NormalImage& how, const HeightImage& image) {
  const double steps = png.bits == 16 ? kFullScale : 255;
  const double nothing = (1 + 1e-9) / steps;  // half a step, of numbers from -1 to 1
  SlopeGrid grid;
  grid.width = png.width, grid.height = png.height;
  grid.step = {how.image_size[0] / png.width, how.image_size[1] / png.height};
  grid.along.reserve(grid.width * grid.height);
  grid.down.reserve(grid.width * grid.height);
  for (std::size_t i = 0; i < grid.width * grid.height; ++i) {
    const auto [right, up] = slopes_of(png.values.data() + 3 * i, nothing);
    grid.along.push_back(static_cast<float>(how.scale * right * grid.step[0]));
    grid.down.push_back(static_cast<float>(-how.scale * up * grid.step[1]));
  }
  for (std::size_t k = 0; k < 2; ++k)
    grid.repeats[k] = image.wrap[k] == HeightImage::Wrap::repeat;
  return grid;
}

}  // namespace

std::optional<Failure> read_normal_image(std::string_view png, const NormalImage& how, HeightImage& image) {
  std::vector<double> heights;
  {
    const Result<PngImage> read = read_png(png, image.name);
    if (!read) return read.error();
    if (read->channels != 3) return refuse(image.name, "is grey, and normals are in three colours; save it as PNG in colour");
    image.width = read->width;
    image.height = read->height;
    heights = integrate_slopes(slopes_of(*read, how, image));
  }
  const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
  const double low = *least, range = *most - low;
  if (!std::isfinite(range)) return refuse(image.name, "has slopes beyond all numbers; make the scale of its normals smaller");
  image.range = range;
  image.values.reserve(heights.size());
  for (const double height : heights)
    image.values.push_back(range > 0 ? static_cast<float>((height - low) / range) : 0.0f);
  return std::nullopt;
}

}  // namespace fdcg::bake
