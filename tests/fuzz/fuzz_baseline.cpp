// SPDX-License-Identifier: Apache-2.0
#include "baseline.hpp"
#include "fuzz_json_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace fdcg::tools;
  const MemoryFile file(data, size);
  const auto baseline = Baseline::read(file.path());
  if (!baseline) {
    require_one_short_line(baseline.error());
    return 0;
  }
  const auto files = baseline->files_for({"a.off", "b/a.off", "-"});
  if (files.size() != 3) std::abort();
  return 0;
}
