// SPDX-License-Identifier: Apache-2.0
#include "fdcg/fdcg.h"

// A byte of each page, read in order: the system maps pages ahead, and brings those of a file from the disk.
extern "C" void fdcg_warm(const fdcg_graph* graph) {
  constexpr uint64_t kLeastPage = 4096;
  if (graph == nullptr || graph->header == nullptr) return;
  const auto* const file = reinterpret_cast<const volatile unsigned char*>(graph->header);
  for (uint64_t at = 0; at < graph->header->file_bytes; at += kLeastPage)
    (void)file[at];
}
