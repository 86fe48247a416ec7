// SPDX-License-Identifier: Apache-2.0
// Opening at any level of verification.
#include "base/message.hpp"
#include "graph/load.hpp"
#include "graph/verify.hpp"

namespace fdcg {

fdcg_status open_verified(const void* data, uint64_t bytes, fdcg_verify verify, fdcg_graph* graph, fdcg_error* error) {
  if (verify != FDCG_VERIFY_FULL && verify != FDCG_VERIFY_TRUSTED && verify != FDCG_VERIFY_SAFE) {
    return Message(error, FDCG_E_ARGUMENT)
        .text("verify is ")
        .number(static_cast<uint32_t>(verify))
        .text(", allowed FDCG_VERIFY_FULL (0), FDCG_VERIFY_TRUSTED (1) and FDCG_VERIFY_SAFE (2)");
  }
  fdcg_status status = open_trusted(data, bytes, graph, error);
  if (status == FDCG_OK) status = verify_up_to(*graph, verify, error);
  if (status != FDCG_OK) *graph = {};
  return status;
}

}  // namespace fdcg

extern "C" fdcg_status fdcg_open_memory(const void* data, uint64_t bytes, fdcg_verify verify, fdcg_graph* graph,
                                        fdcg_error* error) {
  if (graph == nullptr) return fdcg::refuse(error, "graph: null pointer");
  *graph = {};
  fdcg_error why = {};
  if (error == nullptr) error = &why;
  return fdcg::told(fdcg::open_verified(data, bytes, verify, graph, error), *graph, *error);
}
