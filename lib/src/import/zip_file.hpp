// SPDX-License-Identifier: Apache-2.0
// The parts of a ZIP archive in memory (libzip, which zip_file.cpp alone includes), each checked against its CRC.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace fdcg::bake {

// Throws json::Refusal. The bytes outlive the archive.
class ZipFile {
 public:
  explicit ZipFile(std::string_view bytes);
  ~ZipFile();
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  // The unpacked bytes of a part, whatever the case of its letters; nothing where there is none. All parts together unpack to
  // at most 256 KiB and 100 bytes for each of the archive, so that a small file cannot fill the memory.
  std::optional<std::string> read(std::string_view name);
  // The first part whose name ends so, in lower case; empty: none.
  [[nodiscard]] std::string find_ending(std::string_view ending) const;

 private:
  struct Archive;
  std::unique_ptr<Archive> archive_;
  std::uint64_t room_;  // bytes that may yet be unpacked
  std::uint64_t limit_;
};

}  // namespace fdcg::bake
