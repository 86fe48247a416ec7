// SPDX-License-Identifier: Apache-2.0
// One fuzz target, linked in, over the files that it once failed on or learnt from: each is a regression test (the target ends
// the program where a promise is broken).
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size);

TEST_CASE("the promises of the fuzz target hold for its corpus, and for the start of each file of it") {
  const std::filesystem::path folder = std::filesystem::path(FDCG_SOURCE_DIR) / "testdata" / "fuzz" / FDCG_FUZZ_FOLDER;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    INFO(entry.path());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (const std::size_t size : {bytes.size(), bytes.size() / 2, bytes.size() - 1}) {
      // A copy of exactly this size on the heap: the address sanitizer sees a read beyond it.
      const std::vector<unsigned char> copy(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      CHECK(LLVMFuzzerTestOneInput(copy.data(), copy.size()) == 0);
    }
    ++files;
  }
  CHECK(files > 0);
}
