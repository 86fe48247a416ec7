// SPDX-License-Identifier: Apache-2.0
// PNG images as numbers, by libpng.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

struct PngImage {
  std::uint32_t width = 0, height = 0;
  std::uint32_t channels = 0;         // 1: grey, 3: red, green, blue. Opacity is left out
  std::uint32_t bits = 8;             // of a number in the file: 8 (or fewer), or 16
  std::vector<std::uint16_t> values;  // row by row from the top, the channels of a texel together; 65535 is 1
};

// Numbers as the file has them, without regard to any gamma or profile; 16 bits stay 16 bits. Fails with exit code 3 on what is
// no PNG, is damaged, or has more than `most_texels` texels or 16384 on a side.
[[nodiscard]] Result<PngImage> read_png(std::string_view bytes, const std::string& name,
                                        std::uint64_t most_texels = std::uint64_t{1} << 24);

}  // namespace fdcg::bake
