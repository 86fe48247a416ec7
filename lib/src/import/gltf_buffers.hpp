// SPDX-License-Identifier: Apache-2.0
// The bytes behind a glTF document: in the GLB's binary chunk, in the JSON as base64, or in files beside it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_bytes.hpp"
#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

// Each buffer is loaded on first use. Throws Refusal. The document must outlive the object.
class Buffers {
 public:
  // `chunk`: of the GLB, if it is one and has one. `file`: the glTF file, beside or beneath whose folder others may be read;
  // null where it came from memory.
  Buffers(const Document& document, std::optional<std::string_view> chunk, const std::filesystem::path* file)
      : document_(document), chunk_(chunk), file_(file), fetched_(document.buffers.size()) {}

  // The bytes of bufferViews[index].
  std::string_view view(Index index);
  // The bytes of images[index], which a texture of the document uses.
  std::string_view image(Index index);

  // Number of other files read so far, and of the bytes in them.
  [[nodiscard]] const std::vector<std::string>& outside_files() const { return outside_files_; }
  [[nodiscard]] std::size_t outside_bytes() const { return outside_bytes_; }

 private:
  std::string_view slice(Index buffer, std::uint64_t offset, std::uint64_t size, const std::string& place);
  std::string_view buffer(Index index);
  std::string_view fetch(Index index);
  std::string_view fetch_file(const std::string& place, const std::string& uri);

  const Document& document_;
  std::optional<std::string_view> chunk_;
  const std::filesystem::path* file_;
  std::vector<std::optional<std::string_view>> fetched_;
  std::map<Index, std::string> decoded_;    // data URIs
  std::map<Index, std::string> images_;     // of data URIs
  std::map<Index, std::string> unpacked_;   // views, by index
  std::map<std::string, FileBytes> files_;  // by URI
  std::vector<std::string> outside_files_;
  std::size_t outside_bytes_ = 0;
};

// For tests: the bytes of a data URI; nothing where it is none or not well formed.
std::optional<std::string> decode_data_uri(std::string_view uri);

}  // namespace fdcg::bake::gltf
