// SPDX-License-Identifier: Apache-2.0
#include "mesh_input.hpp"

#include <cstdio>
#include <new>
#include <string>

#include "fdcg_commands.hpp"

namespace fdcg::tools {
namespace {

bake::Result<std::string> read_standard_input() {
  std::string chunk(std::size_t{1} << 18, '\0'), bytes;
  const auto refused = [](const std::string& what) { return bake::Failure{kFile, "-: " + what, "unreadable"}; };
  try {
    bytes.reserve(bake::kMostStreamBytes);  // address space alone: no copy of what is there while it grows
    while (const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), stdin)) {
      if (got > bake::kMostStreamBytes - bytes.size()) {
        return refused("standard input has more than " + std::to_string(bake::kMostStreamBytes >> 20) +
                       " MiB, as much as is read of it; save the mesh as a file and name that");
      }
      bytes.append(chunk, 0, got);
    }
  } catch (const std::bad_alloc&) {
    return refused("standard input needs more memory than there is");
  }
  if (std::ferror(stdin) != 0) return refused("standard input cannot be read");
  return bytes;
}

}  // namespace

bake::Result<bake::PolygonSoup> import_input(const std::string& path, const bake::ImportOptions& options) {
  if (path != "-") return bake::import_mesh(path, options);
  const auto bytes = read_standard_input();
  if (!bytes) return bytes.error();
  return bake::import_memory(*bytes, path, options);
}

}  // namespace fdcg::tools
