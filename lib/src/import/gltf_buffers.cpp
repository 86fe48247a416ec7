// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_buffers.hpp"

#include <algorithm>
#include <cstdint>

#include "import/beside.hpp"
#include "import/meshopt_decode.hpp"

namespace fdcg::bake::gltf {
namespace {

std::string buffer_place(Index index) {
  return "buffers[" + std::to_string(index) + "]";
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// "%20" becomes a blank. Nothing where a '%' is not followed by two digits.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    result += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return result;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;  // '-' and '_': the alphabet for URIs
  if (c == '/' || c == '_') return 63;
  return -1;
}

std::optional<std::string> base64_decoded(std::string_view text) {
  while (text.ends_with('='))
    text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    have += 6;
    if (have < 8) continue;
    have -= 8;
    bytes += static_cast<char>(bits >> have & 0xFF);
  }
  if (have >= 6) return std::nullopt;  // a single digit left over is not a byte
  return bytes;
}

}  // namespace

std::optional<std::string> decode_data_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:", kBase64 = ";base64";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view head = uri.substr(0, comma), body = uri.substr(comma + 1);
  if (!head.ends_with(kBase64)) return percent_decoded(body);
  if (body.find('%') == std::string_view::npos) return base64_decoded(body);
  const std::optional<std::string> plain = percent_decoded(body);
  return plain ? base64_decoded(*plain) : std::nullopt;
}

std::string_view Buffers::view(Index index) {
  const View& view = document_.views[index];
  const std::string place = "bufferViews[" + std::to_string(index) + "]";
  if (!view.meshopt) return slice(view.buffer, view.offset, view.bytes, place);
  const auto known = unpacked_.find(index);
  if (known != unpacked_.end()) return known->second;
  const Meshopt& packed = *view.meshopt;
  const std::string inner = place + ".extensions.EXT_meshopt_compression";
  std::string bytes = decode_meshopt(packed, slice(packed.buffer, packed.offset, packed.bytes, inner), inner);
  return unpacked_.emplace(index, std::move(bytes)).first->second;
}

std::string_view Buffers::slice(Index index, std::uint64_t offset, std::uint64_t size, const std::string& place) {
  const std::string_view bytes = buffer(index);
  if (offset > bytes.size() || size > bytes.size() - offset) {
    throw Refusal{place + ": needs " + std::to_string(size) + " bytes from byte " + std::to_string(offset) + " on, " +
                  buffer_place(index) + " has " + std::to_string(bytes.size()) + "; fetch or export the file again"};
  }
  return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

std::string_view Buffers::buffer(Index index) {
  if (!fetched_[index]) {
    const std::string_view bytes = fetch(index);
    const std::uint64_t promised = document_.buffers[index].bytes;
    if (bytes.size() < promised) {
      throw Refusal{"truncated: " + buffer_place(index) + ".byteLength promises " + std::to_string(promised) +
                    " bytes, there are " + std::to_string(bytes.size()) + "; fetch or export the file again"};
    }
    fetched_[index] = bytes.substr(0, static_cast<std::size_t>(promised));
  }
  return *fetched_[index];
}

std::string_view Buffers::fetch(Index index) {
  const std::optional<std::string>& uri = document_.buffers[index].uri;
  if (!uri) {
    if (index == 0 && chunk_) return *chunk_;
    throw Refusal{buffer_place(index) + ": has neither a uri nor " + (index == 0 ? "a binary chunk" : "the first place") +
                  ", so that its bytes are nowhere; export the file again"};
  }
  if (!uri->starts_with("data:")) return fetch_file(buffer_place(index), *uri);
  std::optional<std::string> bytes = decode_data_uri(*uri);
  if (!bytes) throw Refusal{buffer_place(index) + ".uri: its data is damaged; fetch or export the file again"};
  return decoded_[index] = std::move(*bytes);
}

std::string_view Buffers::image(Index index) {
  const Image& image = document_.images[index];
  if (image.view) return view(*image.view);
  const std::string place = "images[" + std::to_string(index) + "]";
  if (!image.uri->starts_with("data:")) return fetch_file(place, *image.uri);
  if (const auto known = images_.find(index); known != images_.end()) return known->second;
  std::optional<std::string> bytes = decode_data_uri(*image.uri);
  if (!bytes) throw Refusal{place + ".uri: its data is damaged; fetch or export the file again"};
  return images_.emplace(index, std::move(*bytes)).first->second;
}

std::string_view Buffers::fetch_file(const std::string& of, const std::string& uri) {
  if (const auto known = files_.find(uri); known != files_.end()) return known->second.bytes();
  const std::string shown = "'" + uri.substr(0, 128) + "'", place = of + ".uri: ";
  const std::optional<std::string> name = percent_decoded(uri);
  const std::filesystem::path relative = name ? std::filesystem::path(*name) : std::filesystem::path();
  if (!name || !stays_beneath(relative, *name)) {
    throw Refusal{place + shown +
                  " is no file in or beneath the folder of this one, and others are not read; put it there, or "
                  "export as GLB"};
  }
  if (file_ == nullptr) {
    throw Refusal{place + shown +
                  " is a file of its own, but this one is not read from a folder; name the file, or export as GLB"};
  }
  const std::filesystem::path path = file_->parent_path() / relative;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Refusal{place + "the file " + shown + " is missing; put it into the folder of this one, or export as GLB"};
  }
  if (!lies_beneath(path, file_->parent_path())) {
    throw Refusal{place + "the file " + shown +
                  " is a link to one outside the folder of this one, and others are not read; put it there, or export as GLB"};
  }
  Result<FileBytes> file = FileBytes::open(path);
  if (!file) throw Refusal{place + file.error().message};
  outside_bytes_ += file->bytes().size();
  outside_files_.push_back(path.string());
  return files_.emplace(uri, std::move(*file)).first->second.bytes();
}

}  // namespace fdcg::bake::gltf
