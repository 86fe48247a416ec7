// SPDX-License-Identifier: Apache-2.0
// What FDCG_VERIFY_FULL checks beyond header and section table.
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

// Every section's checksum and padding. Cost: reads every byte once.
fdcg_status verify_checksums(const void* data, const fdcg_header& header, fdcg_error* error);

// Every index in range, every number finite, every node's loop, connection and fan consistent with the others: what the step
// relies on to stay inside the file and inside its bounds. Cost: linear in the records.
fdcg_status verify_graph(const fdcg_graph& graph, fdcg_error* error);

}  // namespace fdcg
