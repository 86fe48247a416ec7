// SPDX-License-Identifier: Apache-2.0
#include "mesh_input.hpp"

#include <cstdio>
#include <new>
#include <stdexcept>

#include "fdcg_commands.hpp"

namespace fdcg::tools {
namespace {

bake::Result<std::string> read_standard_input() {
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  std::string bytes;
  try {
    for (std::size_t used = 0;;) {
      bytes.resize(used + bytes.size() / 2 + kChunk);
      const std::size_t got = std::fread(bytes.data() + used, 1, bytes.size() - used, stdin);
      used += got;
      if (got != 0) continue;
      bytes.resize(used);
      break;
    }
  } catch (const std::bad_alloc&) {
    return bake::Failure{kFile, "-: standard input needs more memory than there is", "unreadable"};
  } catch (const std::length_error&) {
    return bake::Failure{kFile, "-: standard input needs more memory than there is", "unreadable"};
  }
  if (std::ferror(stdin) != 0) return bake::Failure{kFile, "-: standard input cannot be read", "unreadable"};
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
