// SPDX-License-Identifier: Apache-2.0
// Any bytes as an image of heights give levels of the promised sizes or a refusal. Run: fdcg_fuzz_heights testdata/fuzz/heights
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "../../lib/src/graph/height_levels.hpp"
#include "../../lib/src/import/png_image.hpp"

using namespace fdcg::bake;

namespace {

void promise(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::uint64_t kMostTexels = 1 << 16, kMostInLevels = 1 << 10;
  const auto read = read_png({reinterpret_cast<const char*>(data), size}, "fuzz", kMostTexels);
  if (!read) {
    promise(read.error().exit_code == 3 && read.error().message.find('\n') == std::string::npos, "a refusal is one line");
    return 0;
  }
  const std::uint64_t texels = std::uint64_t{read->width} * read->height;
  promise(texels > 0 && texels <= kMostTexels, "the size is bounded");
  promise(read->values.size() == texels * read->channels, "each texel has its channels");
  if (texels > kMostInLevels) return 0;
  HeightImage image;
  image.width = read->width, image.height = read->height;
  for (std::uint64_t i = 0; i < texels; ++i)
    image.values.push_back(static_cast<float>(read->values[i * read->channels]) / 65535);
  image.wrap = {static_cast<HeightImage::Wrap>(size % 3), static_cast<HeightImage::Wrap>(size / 3 % 3)};
  const HeightLevels levels = height_levels(image, 1e-3, 1);
  std::uint64_t expected = texels;
  std::uint64_t width = image.width, height = image.height;
  for (std::uint32_t k = 1; k < levels.map.level_count; ++k, width = (width + 1) / 2, height = (height + 1) / 2)
    expected += width * height;
  promise(levels.map.level_count >= 1 && levels.map.level_count <= FDCG_MAX_HEIGHT_LEVELS, "levels are few");
  promise(levels.texels.size() == expected, "each level has its texels");
  promise(levels.map.metres_per_step >= 0 && levels.map.metres_per_step < 1e-3, "heights are within their range");
  return 0;
}
