// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_heights.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/vec3.hpp"
#include "import/normal_image.hpp"

namespace fdcg::bake::gltf {
namespace {

// A texture, and what its faces tell of it.
struct Measured {
  TextureInfo texture;
  std::vector<std::size_t> materials;
  double area = 0;
  std::array<double, 2> logarithms{};  // of lengths of the whole image on the mesh, times area
};

class Measure {
 public:
  Measure(const PolygonSoup& soup, Measured& of)
      : soup_(soup), uv_(soup.appearance.height_uv.empty() ? soup.appearance.uv : soup.appearance.height_uv), of_(of) {}

  void add_face(std::size_t face) {
    const std::uint32_t first = soup_.face_first[face], end = soup_.face_first[face + 1];
    for (std::uint32_t i = first; i + 2 < end; ++i)
      add_triangle({first, i + 1, i + 2});
  }

 private:
  void add_triangle(const std::array<std::uint32_t, 3>& corners) {
    Vec3 at[3];
    double on[3][2]{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] >= uv_.size() || soup_.corners[corners[k]] == PolygonSoup::kInvalidVertex) return;
      at[k] = soup_.points[soup_.corners[corners[k]]];
      const auto& p = of_.texture.placing;
      const double u = double{uv_[corners[k]][0]}, v = double{uv_[corners[k]][1]};
      on[k][0] = p[0] * u + p[1] * v + p[2], on[k][1] = p[3] * u + p[4] * v + p[5];
    }
    const Vec3 first = at[1] - at[0], second = at[2] - at[0];
    const double u1 = on[1][0] - on[0][0], v1 = on[1][1] - on[0][1], u2 = on[2][0] - on[0][0], v2 = on[2][1] - on[0][1];
    const double turn = u1 * v2 - u2 * v1;
    if (turn == 0) return;
    const double share = 1 / turn, area = length(cross(first, second)) / 2;
    const double lengths[2] = {length(share * (v2 * first - v1 * second)), length(share * (u1 * second - u2 * first))};
    const double logarithms[2] = {std::log(lengths[0]), std::log(lengths[1])};
    if (!(area > 0) || !std::isfinite(area * logarithms[0] * logarithms[1])) return;  // no area, here or there; no numbers
    of_.area += area;
    for (std::size_t k = 0; k < 2; ++k)
      of_.logarithms[k] += area * logarithms[k];
  }

  const PolygonSoup& soup_;
  const std::vector<std::array<float, 2>>& uv_;
  Measured& of_;
};

std::vector<Measured> textures_of(const Document& document) {
  std::vector<Measured> all;
  std::map<TextureInfo, std::size_t> number_of;
  for (std::size_t m = 0; m < document.normal_textures.size(); ++m) {
    const std::optional<TextureInfo>& texture = document.normal_textures[m];
    if (!texture) continue;
    const auto [known, is_new] = number_of.emplace(*texture, all.size());
    if (is_new) all.push_back({*texture, {}, 0, {}});
    all[known->second].materials.push_back(m);
  }
  return all;
}

std::string_view jpeg_or_other(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8\xFF")) return "JPEG";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "WebP";
  if (bytes.starts_with("\xABKTX ")) return "KTX";
  return {};
}

HeightImage image_of(const Measured& measured, Buffers& buffers, const std::string& file) {
  const std::string place = "images[" + std::to_string(measured.texture.image) + "]";
  const std::string_view bytes = buffers.image(measured.texture.image);
  if (const std::string_view kind = jpeg_or_other(bytes); !kind.empty())
    throw Refusal{place + " is " + std::string(kind) +
                  "; images of normals are read as PNG alone: convert it, or export again"};
  HeightImage image;
  image.name = place;
  image.wrap = measured.texture.wrap;
  image.placing = measured.texture.placing;
  NormalImage how{measured.texture.scale, {}};
  for (std::size_t k = 0; k < 2; ++k)
    how.image_size[k] = std::exp(measured.logarithms[k] / measured.area);
  if (const auto failure = read_normal_image(bytes, how, image)) throw Refusal{failure->message};
  image.name = file + ": " + place;
  return image;
}

}  // namespace

void add_normal_heights(const Document& document, Buffers& buffers, PolygonSoup& soup) {
  constexpr std::size_t kMostImages = 256, kMostTexels = std::size_t{1} << 26;  // of all; the format holds as many images
  Appearance& look = soup.appearance;
  std::vector<Measured> textures = textures_of(document);
  std::vector<std::size_t> texture_of(look.materials.size(), textures.size());
  for (std::size_t i = 0; i < textures.size(); ++i)
    for (const std::size_t m : textures[i].materials)
      if (m < texture_of.size()) texture_of[m] = i;
  for (std::size_t f = 0; f < look.face_material.size(); ++f) {
    const std::size_t m = look.face_material[f];
    if (m < texture_of.size() && texture_of[m] < textures.size()) Measure(soup, textures[texture_of[m]]).add_face(f);
  }
  std::size_t texels = 0;
  for (const Measured& measured : textures) {
    if (!(measured.area > 0)) continue;  // no face is on it
    HeightImage image = image_of(measured, buffers, soup.name);
    texels += image.values.size();
    if (texels > kMostTexels || look.images.size() >= kMostImages)
      throw Refusal{"has more than 256 images of normals, or 67,108,864 texels in them; make them smaller, or leave some out"};
    if (image.range == 0) continue;
    for (const std::size_t m : measured.materials)
      if (m < look.materials.size()) look.materials[m].heights = static_cast<std::uint16_t>(look.images.size());
    look.images.push_back(std::move(image));
  }
}

}  // namespace fdcg::bake::gltf
