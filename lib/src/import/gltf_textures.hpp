// SPDX-License-Identifier: Apache-2.0
// Textures that a glTF document's materials name: what is stated of them, without the images.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fdcg/appearance.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::bake::gltf {

// Where the bytes of an image are: one of the two.
struct Image {
  std::optional<std::string> uri;
  std::optional<std::uint32_t> view;
};

struct TextureInfo {
  std::uint32_t image = 0;      // in Document::images
  std::uint32_t tex_coord = 0;  // of TEXCOORD_n
  double scale = 1;             // of the slopes of normals
  std::array<HeightImage::Wrap, 2> wrap = {HeightImage::Wrap::repeat, HeightImage::Wrap::repeat};
  std::array<double, 6> placing = {1, 0, 0, 0, 1, 0};  // as HeightImage has it, by KHR_texture_transform

  friend auto operator<=>(const TextureInfo&, const TextureInfo&) = default;
};

// The texture, its sampler and its image are looked up where a material is asked for. `images` has an entry for each of the
// file's; `use_view` takes a reference to a bufferView. Throws Refusal.
class TextureReader {
 public:
  using UseView = std::function<std::uint32_t(const json::Value&)>;
  TextureReader(const json::Value& root, std::vector<Image>& images, UseView use_view)
      : root_(root), images_(images), use_view_(std::move(use_view)) {}

  // Of materials[index], which is there. None: it has none.
  [[nodiscard]] std::optional<TextureInfo> normal_texture(std::size_t index);
  // Of a reference to a texture, with what is stated beside it.
  [[nodiscard]] TextureInfo texture(const json::Value& info);

 private:
  void read_texture(const json::Value& reference, TextureInfo& texture);
  void use_image(const json::Value& reference, TextureInfo& texture);

  const json::Value& root_;
  std::vector<Image>& images_;
  UseView use_view_;
};

}  // namespace fdcg::bake::gltf
