// SPDX-License-Identifier: Apache-2.0
// The fuzz targets over the files that they once failed on or learnt from: each is a regression test (a target ends the program
// where a promise is broken).
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "catch.hpp"

namespace {

using Target = int(const unsigned char* data, std::size_t size);

void run_over_corpus(const char* name, Target& target) {
  const std::filesystem::path folder = std::filesystem::path(FDCG_SOURCE_DIR) / "testdata" / "fuzz" / name;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    INFO(entry.path());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (const std::size_t size : {bytes.size(), bytes.size() / 2, bytes.size() - 1}) {
      // A copy of exactly this size on the heap: the address sanitizer sees a read beyond it.
      const std::vector<unsigned char> copy(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      CHECK(target(copy.data(), copy.size()) == 0);
    }
    ++files;
  }
  CHECK(files > 0);
}

}  // namespace

// The promises of each fuzz target hold for its corpus, and for the start of each file of it.
#define FDCG_CORPUS(name)                                   \
  extern "C" Target fdcg_fuzz_##name;                       \
  TEST_CASE("the corpus of " #name " keeps its promises") { \
    run_over_corpus(#name, fdcg_fuzz_##name);               \
  }
FDCG_CORPUS(validate)
FDCG_CORPUS(heights)
FDCG_CORPUS(robot)
FDCG_CORPUS(config)
FDCG_CORPUS(baseline)
FDCG_CORPUS(contacts)
FDCG_CORPUS(firmware)
FDCG_CORPUS(profile)
FDCG_CORPUS(report)
FDCG_CORPUS(scene)
FDCG_CORPUS(serial)
FDCG_CORPUS(session)
FDCG_CORPUS(visitors)
FDCG_CORPUS(websocket)
