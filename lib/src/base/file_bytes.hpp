// SPDX-License-Identifier: Apache-2.0
// A file's bytes as one range of memory. The platform-dependent part of the import; file_bytes.cpp implements it for POSIX.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// What is wrong with a stream of more than kMostStreamBytes: "has more than ..."
std::string stream_too_long();

// Regular files are mapped read-only, small ones and anything else (a pipe, a device) are read to their end. The bytes are
// valid while the object lives; another process that shortens the file meanwhile makes them unreadable, as with every mapping.
class FileBytes {
 public:
  // Fails with exit code 3 on a path that does not exist, is a directory or cannot be read. An empty file is not a failure.
  static Result<FileBytes> open(const std::filesystem::path& path, const std::string& what = "a mesh file");

  FileBytes() = default;
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  ~FileBytes();

  [[nodiscard]] std::string_view bytes() const {
    return mapping_ == nullptr ? std::string_view(buffer_) : std::string_view(static_cast<const char*>(mapping_), size_);
  }

 private:
  void* mapping_ = nullptr;  // nullptr: the bytes are in buffer_
  std::size_t size_ = 0;
  std::string buffer_;
};

}  // namespace fdcg::bake
