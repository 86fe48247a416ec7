// SPDX-License-Identifier: Apache-2.0
// What the child process runs, in this process: a process for each execution would be slow. libdraco is not built with the
// sanitizers, takes what memory a forged count says, and crashes on some bytes: in fdcg that ends the child only. Run with
//   -fork=1 -ignore_ooms=1 -ignore_timeouts=1 -ignore_crashes=1 -malloc_limit_mb=512 -rss_limit_mb=1024
// and look at what it writes: what counts is that no crash is in our own reading of what libdraco gives.
#include "fuzz_import.hpp"
#include "import/draco_decode.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const fdcg::bake::DracoMesh mesh = fdcg::bake::decode_draco_here({bytes, std::nullopt, {}, true});
  for (const auto& extra : mesh.extras)
    if (!extra.empty() && extra.size() != mesh.points.size()) std::abort();
  if (mesh.corners.size() % 3 != 0 || !(mesh.absolute_quantum >= 0)) std::abort();
  return 0;
}
