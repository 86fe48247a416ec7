// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_haptics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "base/vec3.hpp"
#include "import/png_image.hpp"
#include "shared/text.hpp"

namespace fdcg::bake::gltf {
namespace {

using json::Value;

constexpr std::string_view kExtension = "MPEG_haptic_material";

// The one of high resolution, else of low; those that refer to signals, and others, hold no values.
std::optional<TextureInfo> chosen(const Value& list, TextureReader& textures) {
  if (!list) return std::nullopt;
  constexpr std::size_t kNoItem = static_cast<std::size_t>(-1);
  std::array<std::size_t, 4> first = {kNoItem, kNoItem, kNoItem, kNoItem};
  for (std::size_t i = list.size(); i-- > 0;) {
    const Value item = list.item(i);
    first[static_cast<std::size_t>(item["type"].choice({"High_Resolution", "Low_Resolution", "Reference", "Other"}))] = i;
  }
  const std::size_t best = first[0] != kNoItem ? first[0] : first[1];
  if (best == kNoItem) return std::nullopt;
  const Value item = list.item(best);
  const Value info = item["texture"];
  TextureInfo texture = textures.texture(info);
  if (texture.tex_coord != 0) info.fail("lies by another set of texture coordinates than the first, which is not read");
  return texture;
}

// Grey, 0 to 1.
struct Values {
  PngImage png;
  std::array<HeightImage::Wrap, 2> wrap{};

  [[nodiscard]] double at(double u, double v) const {
    const std::size_t x = place(u, png.width, wrap[0]), y = place(v, png.height, wrap[1]);
    double sum = 0;
    for (std::uint32_t c = 0; c < png.channels; ++c)
      sum += png.values[(y * png.width + x) * png.channels + c];
    return sum / (65535.0 * png.channels);
  }

 private:
  static std::size_t place(double at, std::uint32_t side, HeightImage::Wrap wrap) {
    double in = at;
    if (wrap == HeightImage::Wrap::repeat) in -= std::floor(in);
    if (wrap == HeightImage::Wrap::mirror) in = std::fabs(in - 2 * std::round(in / 2));
    return static_cast<std::size_t>(std::clamp(std::floor(in * side), 0.0, static_cast<double>(side) - 1));
  }
};

class Sampler {
 public:
  Sampler(const PolygonSoup& soup, const TextureInfo& texture, const Values& values)
      : soup_(soup), texture_(texture), values_(values) {}

  void add_face(std::size_t face) {
    for (std::uint32_t i = soup_.face_first[face] + 1; i + 1 < soup_.face_first[face + 1]; ++i)
      add_triangle({soup_.face_first[face], i, i + 1});
  }
  [[nodiscard]] std::optional<HapticTexture> result() const {
    if (!(area_ > 0)) return std::nullopt;
    return HapticTexture{sum_ / area_, least_, most_};
  }

 private:
  void add_triangle(const std::array<std::uint32_t, 3>& corners) {
    const std::vector<std::array<float, 2>>& uv = soup_.appearance.uv;
    Vec3 at[3];
    double on[3][2]{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] >= uv.size() || soup_.corners[corners[k]] == PolygonSoup::kInvalidVertex) return;
      at[k] = soup_.points[soup_.corners[corners[k]]];
      const auto& p = texture_.placing;
      const double u = double{uv[corners[k]][0]}, v = double{uv[corners[k]][1]};
      on[k][0] = p[0] * u + p[1] * v + p[2], on[k][1] = p[3] * u + p[4] * v + p[5];
      constexpr double kFarthest = 1e6;
      if (!(std::fabs(on[k][0]) <= kFarthest && std::fabs(on[k][1]) <= kFarthest)) return;
    }
    const double area = length(cross(at[1] - at[0], at[2] - at[0])) / 2;
    if (!(area > 0) || !std::isfinite(area)) return;
    constexpr int kParts = 4;  // of a side: 16 triangles alike
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; j < 2 * (kParts - i) - 1; ++j)
        add_sample((i + (j % 2 == 0 ? 1.0 : 2.0) / 3) / kParts, (j / 2 + (j % 2 == 0 ? 1.0 : 2.0) / 3) / kParts, on,
                   area / (kParts * kParts));
  }
  void add_sample(double a, double b, const double (&on)[3][2], double area) {
    const double value =
        values_.at((1 - a - b) * on[0][0] + a * on[1][0] + b * on[2][0], (1 - a - b) * on[0][1] + a * on[1][1] + b * on[2][1]);
    area_ += area, sum_ += area * value;
    least_ = std::min(least_, value), most_ = std::max(most_, value);
  }

  const PolygonSoup& soup_;
  const TextureInfo& texture_;
  const Values& values_;
  double area_ = 0, sum_ = 0, least_ = 1, most_ = 0;
};

std::optional<HapticTexture> measured(const std::optional<TextureInfo>& texture, std::uint32_t material, Buffers& buffers,
                                      const std::vector<HapticRun>& runs, const PolygonSoup& soup) {
  const bool is_used =
      std::any_of(runs.begin(), runs.end(), [material](const HapticRun& run) { return run.material == material; });
  if (!texture || !is_used) return std::nullopt;
  Result<PngImage> png = read_png(buffers.image(texture->image), "images[" + std::to_string(texture->image) + "]");
  if (!png) throw Refusal{png.error().message};
  const Values values{std::move(*png), texture->wrap};
  Sampler sampler(soup, *texture, values);
  for (const HapticRun& run : runs) {
    if (run.material != material) continue;
    for (std::size_t f = run.first; f < run.end; ++f)
      sampler.add_face(f);
  }
  return sampler.result();
}

}  // namespace

std::vector<Haptic> read_haptics(const Value& root, TextureReader& textures) {
  constexpr std::size_t kMost = 256, kLongestName = 64;
  std::vector<Haptic> haptics;
  const Value extensions = root["extensions"];
  const Value mpeg = extensions ? extensions[kExtension] : extensions;
  if (!mpeg) return haptics;
  const Value list = mpeg["materials"];
  if (list.size() > kMost) list.fail("has more than 256 materials; leave some out");
  for (std::size_t m = 0; m < list.size(); ++m) {
    const Value item = list.item(m), name = item["name"];
    Haptic haptic;
    if (name) haptic.name = printable(name.string(), kLongestName);
    if (haptic.name.empty()) haptic.name = "haptic materials[" + std::to_string(m) + "]";
    haptic.stiffness = chosen(item["stiffness"], textures);
    haptic.friction = chosen(item["friction"], textures);
    haptics.push_back(std::move(haptic));
  }
  return haptics;
}

Index haptic_of_mesh(const Value& mesh, std::size_t count) {
  const Value extensions = mesh["extensions"];
  if (!extensions) return kNone;
  const Value mpeg = extensions[kExtension];
  if (!mpeg) return kNone;
  const Value index = mpeg["hapticMaterialIndex"];
  const auto number = static_cast<std::uint64_t>(index.integer(0, 0xFFFFFFFE));
  if (number >= count)
    index.fail("is " + std::to_string(number) + ", but the file has " + std::to_string(count) + " haptic materials");
  return static_cast<Index>(number);
}

void measure_haptics(const Document& document, Buffers& buffers, const std::vector<HapticRun>& runs, PolygonSoup& soup) {
  for (std::uint32_t m = 0; m < document.haptics.size(); ++m) {
    const Haptic& haptic = document.haptics[m];
    soup.physics.haptic_materials.push_back(
        {haptic.name, measured(haptic.stiffness, m, buffers, runs, soup), measured(haptic.friction, m, buffers, runs, soup)});
  }
}

}  // namespace fdcg::bake::gltf
