// SPDX-License-Identifier: Apache-2.0
// Any bytes give a sound soup or a refusal.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

inline int fuzz_import(Format format, const unsigned char* data, std::size_t size) {
  const Result<PolygonSoup> soup = import_memory({reinterpret_cast<const char*>(data), size}, "fuzz", {format, {}});
  const auto require = [](bool condition) {
    if (!condition) std::abort();
  };
  if (!soup) {
    require(soup.error().exit_code == 3 && soup.error().message.find('\n') == std::string::npos);
    return 0;
  }
  require(soup->face_count() > 0 && soup->face_first.front() == 0 && soup->face_first.back() == soup->corners.size());
  for (std::size_t f = 0; f < soup->face_count(); ++f)
    require(soup->face_first[f] <= soup->face_first[f + 1]);
  for (const std::uint32_t corner : soup->corners)
    require(corner == PolygonSoup::kInvalidVertex || corner < soup->points.size());
  require(soup->point_line.size() == (soup->is_text ? soup->points.size() : 0));
  require(soup->face_line.size() == (soup->is_text ? soup->face_count() : 0));
  return 0;
}

}  // namespace fdcg::bake
