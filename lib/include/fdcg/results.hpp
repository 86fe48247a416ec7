// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/results.hpp
/// What programs keep of many meshes: hashes of files, and reports on one line.
///
/// **Threads.** Functions may be called from several threads at once.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

class FileBytes;

/// The SHA-256 of these bytes as 64 lower-case hex digits, as PolygonSoup::sha256 has that of a file.
std::string sha256_of(std::string_view bytes);

/// The same of a file. Fails with exit code 3 where it cannot be read.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

/// A mesh file, read once: its hash says whether its mesh is wanted. Copies share the bytes.
class MeshFile {
 public:
  /// Fails with exit code 3 where it cannot be read. An empty file is not a failure.
  static Result<MeshFile> open(const std::filesystem::path& path);
  /// Of the bytes, as sha256_of() has it.
  [[nodiscard]] const std::string& sha256() const { return sha256_; }
  /// As import_mesh() does, of the bytes that the hash is of.
  [[nodiscard]] Result<PolygonSoup> import(const ImportOptions& options = {}) const;

 private:
  std::filesystem::path path_;
  std::shared_ptr<const FileBytes> bytes_;
  std::string sha256_;
};

/// A report as one line of JSON: an entry of `files` in schemas/validate-report.schema.json, without its `file`.
std::string report_line(const Report& report);

}  // namespace fdcg::bake
