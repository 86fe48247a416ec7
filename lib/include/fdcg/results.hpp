// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/results.hpp
/// What programs keep of many meshes: hashes of files, and reports on one line.
///
/// **Threads.** Functions may be called from several threads at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

/// The SHA-256 of these bytes as 64 lower-case hex digits, as PolygonSoup::sha256 has that of a file.
std::string sha256_of(std::string_view bytes);

/// The same of a file. Fails with exit code 3 where it cannot be read.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

/// A report as one line of JSON: an entry of `files` in schemas/validate-report.schema.json, without its `file`.
std::string report_line(const Report& report);

}  // namespace fdcg::bake
