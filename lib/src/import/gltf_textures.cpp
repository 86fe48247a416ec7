// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_textures.hpp"

#include <cmath>
#include <string_view>

namespace fdcg::bake::gltf {
namespace {

using json::Value;
using Wrap = HeightImage::Wrap;

constexpr json::NumberRange kSane = {-1e6, 1e6};
constexpr std::int64_t kMostSets = 255;  // of texture coordinates

std::size_t index_below(const Value& value, const Value& list, const char* things) {
  const std::size_t count = list ? list.size() : 0;
  const auto index = static_cast<std::uint64_t>(value.integer(0, 0xFFFFFFFE));
  if (index >= count) value.fail("is " + std::to_string(index) + ", but the file has " + std::to_string(count) + " " + things);
  return static_cast<std::size_t>(index);
}

Wrap wrap_of(const Value& value) {
  constexpr std::int64_t kClamp = 33071, kMirror = 33648, kRepeat = 10497;  // the names of OpenGL
  const std::int64_t wrap = value.integer_or(kRepeat, 0, 0xFFFF);
  if (wrap == kClamp) return Wrap::clamp;
  if (wrap == kMirror) return Wrap::mirror;
  if (wrap != kRepeat) value.fail("is " + std::to_string(wrap) + "; it is 10497 (repeat), 33071 (clamp) or 33648 (mirrored)");
  return Wrap::repeat;
}

// Translation times rotation times scale. The rotation's sense is that of the extension's example, in which a quarter turn
// leads to the lower left of the image.
void read_transform(const Value& transform, TextureInfo& texture) {
  double offset[2] = {0, 0}, scale[2] = {1, 1};
  if (const Value given = transform["offset"]) given.numbers(offset, 2, kSane);
  if (const Value given = transform["scale"]) given.numbers(scale, 2, kSane);
  const double angle = transform["rotation"].number_or(0, kSane), c = std::cos(angle), s = std::sin(angle);
  texture.placing = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
  texture.tex_coord = static_cast<std::uint32_t>(transform["texCoord"].integer_or(texture.tex_coord, 0, kMostSets));
}

}  // namespace

std::optional<TextureInfo> TextureReader::normal_texture(std::size_t index) {
  const Value materials = root_["materials"];
  const Value material = materials.item(index);
  const Value info = material["normalTexture"];
  if (!info) return std::nullopt;
  TextureInfo found = texture(info);
  found.scale = info["scale"].number_or(1, kSane);
  return found;
}

TextureInfo TextureReader::texture(const Value& info) {
  TextureInfo texture;
  texture.tex_coord = static_cast<std::uint32_t>(info["texCoord"].integer_or(0, 0, kMostSets));
  if (const Value extensions = info["extensions"]) {
    if (const Value transform = extensions["KHR_texture_transform"]) read_transform(transform, texture);
  }
  read_texture(info["index"], texture);
  return texture;
}

void TextureReader::read_texture(const Value& reference, TextureInfo& texture) {
  const Value textures = root_["textures"];
  const Value item = textures.item(index_below(reference, textures, "textures"));
  const Value source = item["source"];
  if (!source) item.fail("names no image that is read (an extension of it may: KTX2, WebP); export it with PNG images");
  use_image(source, texture);
  const Value sampler = item["sampler"];
  if (!sampler) return;
  const Value samplers = root_["samplers"];
  const Value how = samplers.item(index_below(sampler, samplers, "samplers"));
  texture.wrap = {wrap_of(how["wrapS"]), wrap_of(how["wrapT"])};
}

void TextureReader::use_image(const Value& reference, TextureInfo& texture) {
  const Value images = root_["images"];
  const std::size_t index = index_below(reference, images, "images");
  texture.image = static_cast<std::uint32_t>(index);
  Image& image = images_[index];
  if (image.uri || image.view) return;
  const Value item = images.item(index);
  if (const Value uri = item["uri"]) {
    image.uri = uri.string();
  } else if (const Value view = item["bufferView"]) {
    image.view = use_view_(view);
  } else {
    item.fail("has neither a uri nor a bufferView, so that its bytes are nowhere; export the file again");
  }
}

}  // namespace fdcg::bake::gltf
