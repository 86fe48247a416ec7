// SPDX-License-Identifier: Apache-2.0
#include "fuzz_json_file.hpp"
#include "validate_config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace fdcg::tools;
  const MemoryFile file(data, size);
  const auto config = read_config(file.path());
  if (!config) require_one_short_line(config.error());
  return 0;
}
