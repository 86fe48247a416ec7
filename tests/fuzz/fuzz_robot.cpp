// SPDX-License-Identifier: Apache-2.0
// Descriptions of robots: any bytes give a list of meshes, each found or with a reason, or a refusal on one line.
//   fdcg_fuzz_robot -dict=tests/fuzz/robot.dict -max_len=1024 FOLDER testdata/fuzz/robot
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fdcg/robot.hpp"

namespace {

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

bool is_line(const std::string& text) {
  return !text.empty() && text.find('\n') == std::string::npos && text.size() < 2000;
}

// A file without a folder, so that each run is quick and no other file is found.
const std::string& file_of(const unsigned char* data, std::size_t size) {
  static const int file = memfd_create("robot", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  require(file >= 0 && ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == static_cast<ssize_t>(size),
          "a file in memory");
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return -1;
  const auto meshes = fdcg::bake::meshes_of_robot(file_of(data, size));
  if (!meshes) {
    require(meshes.error().exit_code == 3 && is_line(meshes.error().message), "a refusal is one line");
    return 0;
  }
  for (const fdcg::bake::NamedMesh& mesh : *meshes) {
    require(mesh.problem.empty() || is_line(mesh.problem), "a problem is one line");
    require(!mesh.file.empty(), "a mesh has a file");
    for (const double factor : {mesh.scale.x, mesh.scale.y, mesh.scale.z})
      require(std::isfinite(factor) && factor != 0, "a scale is finite and not 0");
  }
  return 0;
}
