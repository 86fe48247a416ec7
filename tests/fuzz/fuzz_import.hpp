// SPDX-License-Identifier: Apache-2.0
// Any bytes give a sound soup or a refusal, the same each time, in memory that a small multiple of the bytes bounds. Run for as
// long as is wanted, each reader with the words of its format:
//   fdcg_fuzz_import_ply -dict=tests/fuzz/import_ply.dict -max_len=1024 -timeout=20 FOLDER testdata/fuzz/import_ply
#pragma once

#include <sanitizer/allocator_interface.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// The heap's growth since reset(), at its highest.
class HeapPeak {
 public:
  static void reset() {
    static const bool is_installed = install();
    if (!is_installed) std::abort();
    live_ = peak_ = 0;
  }
  static std::ptrdiff_t bytes() { return peak_; }

 private:
  static bool install() {
    import_memory("OFF 1 1 0\n0 0 0\n1 0\n", "first");  // libraries that it calls allocate once and for all
    return __sanitizer_install_malloc_and_free_hooks(&on_malloc, &on_free) > 0;
  }
  static void on_malloc(const volatile void*, std::size_t size) {
    const std::ptrdiff_t live = live_ += static_cast<std::ptrdiff_t>(size);
    if (live > peak_) peak_ = live;  // of two threads at once one may be missed: the large arrays are the importing thread's
  }
  static void on_free(const volatile void* memory) {
    live_ -= static_cast<std::ptrdiff_t>(__sanitizer_get_allocated_size(const_cast<const void*>(memory)));
  }
  static inline std::atomic<std::ptrdiff_t> live_ = 0, peak_ = 0;
};

inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

inline void require_sound(const PolygonSoup& soup) {
  require(soup.face_count() > 0, "a soup has faces");
  require(soup.face_first.front() == 0 && soup.face_first.back() == soup.corners.size(), "faces span the corners");
  require(std::is_sorted(soup.face_first.begin(), soup.face_first.end()), "faces ascend");
  for (const std::uint32_t corner : soup.corners)
    require(corner == PolygonSoup::kInvalidVertex || corner < soup.points.size(), "corners are vertices or invalid");
  require(soup.point_line.size() == (soup.is_text ? soup.points.size() : 0), "each point of a text has a line");
  require(soup.face_line.size() == (soup.is_text ? soup.face_count() : 0), "each face of a text has a line");
  for (std::size_t p = 0; p < soup.parts.size(); ++p) {
    require(soup.parts[p].first_face < soup.face_count(), "a part has faces");
    require(p == 0 || soup.parts[p - 1].first_face < soup.parts[p].first_face, "parts ascend");
  }
  for (const Ignored& ignored : soup.ignored)
    require(ignored.count > 0 && !ignored.what.empty(), "what is ignored has a name and a number");
  require(soup.ignored.size() <= 300, "what is ignored is a short list");
}

// Of a soup that was asked how it looks. A library of OBJ may leave the range of its images open, 0, and may turn it, below 0.
inline void require_sound_look(const PolygonSoup& soup, bool any_range = false) {
  const Appearance& look = soup.appearance;
  const auto fits = [](std::size_t have, std::size_t wanted) { return have == 0 || have == wanted; };
  require(fits(soup.corner_normals.size(), soup.corners.size()) && fits(look.uv.size(), soup.corners.size()) &&
              fits(look.colours.size(), soup.corners.size()),
          "each corner has what others have");
  require(fits(look.face_material.size(), soup.face_count()), "each face has a material, or none has");
  for (const std::uint16_t material : look.face_material)
    require(material == Appearance::kNoMaterial || material < look.materials.size(), "materials are there");
  require(fits(look.height_uv.size(), soup.corners.size()), "each corner has what others have");
  for (const HeightImage& image : look.images) {
    require(image.width > 0 && image.height > 0 && image.values.size() == std::size_t{image.width} * image.height,
            "images have their texels");
    for (const float value : image.values)
      require(value >= 0 && value <= 1, "heights are shares");
    require(any_range ? std::isfinite(image.range) : image.range > 0 && image.range <= 1e300, "heights have a range");
    for (const double number : image.placing)
      require(std::isfinite(number), "images have a place");
  }
  for (const HapticMaterial& material : soup.physics.haptic_materials)
    for (const auto& texture : {material.stiffness, material.friction})
      require(!texture || (texture->least >= 0 && texture->least <= texture->most && texture->most <= 1),
              "textures hold shares");
  for (const Colour& colour : look.colours)
    for (const float share : colour)
      require(share >= 0 && share <= 1, "colours are shares");
  for (const LookMaterial& material : look.materials) {
    require(material.heights == LookMaterial::kNoImage || material.heights < look.images.size(), "images are there");
    for (const float share : material.base_colour)
      require(share >= 0 && share <= 1, "base colours are shares");
  }
}

inline bool same_points(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0);
}

inline void require_same(const PolygonSoup& a, const PolygonSoup& b) {
  require(same_points(a.points, b.points) && a.corners == b.corners && a.face_first == b.face_first, "the same mesh twice");
  require(a.point_line == b.point_line && a.face_line == b.face_line, "the same lines twice");
  require(a.relative_quantum == b.relative_quantum && a.absolute_quantum == b.absolute_quantum, "the same quanta twice");
  require(a.parts.size() == b.parts.size() && a.ignored.size() == b.ignored.size() && a.sha256 == b.sha256,
          "the same names twice");
}

// Triangle strips of one-byte numbers cost most: 16 bytes of soup for each, in arrays that double.
inline constexpr std::size_t kMultiple = 64;
// A scene may show a mesh many times: 16 points and 16 corners for each byte, in arrays that double.
inline constexpr std::size_t kSceneMultiple = 1024;

inline constexpr std::size_t kMessages = std::size_t{1} << 16;  // bytes of heap that cost nothing

inline int fuzz_import(Format format, const unsigned char* data, std::size_t size, std::size_t multiple = kMultiple,
                       std::size_t free_bytes = kMessages) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  HeapPeak::reset();
  const Result<PolygonSoup> soup = import_memory(bytes, "fuzz", {format, {}});
  require(HeapPeak::bytes() <= static_cast<std::ptrdiff_t>(multiple * size + free_bytes), "memory is a multiple of the file");
  if (soup) {
    require_sound(*soup);
  } else {
    require(soup.error().exit_code == 3 && soup.error().message.find('\n') == std::string::npos, "a refusal is one line");
    require(soup.error().message.size() < 1000, "a refusal is short");
  }
  if (size % 4 == 2) {
    ImportOptions looking{format, {}};
    looking.normals = looking.appearance = looking.haptic_materials = true;
    looking.heights = "file";
    const Result<PolygonSoup> seen = import_memory(bytes, "fuzz", looking);
    require(soup.has_value() || !seen.has_value(), "what is seen may refuse a file, not admit it");
    if (seen) require_sound(*seen), require_sound_look(*seen);
  }
  if (size % 4 != 1) return 0;  // the second reading costs as much as the first
  const Result<PolygonSoup> again = import_memory(bytes, "fuzz", {format, {}});
  require(soup.has_value() == again.has_value(), "the same verdict twice");
  if (soup) {
    require_same(*soup, *again);
  } else {
    require(soup.error().message == again.error().message, "the same refusal twice");
  }
  return 0;
}

}  // namespace fdcg::bake
