// SPDX-License-Identifier: Apache-2.0
// The records of a file for a person to read.
#pragma once

#include "../common/atomic_file.hpp"
#include "fdcg/fdcg.h"

namespace fdcg::tools {

// One line a node, side, connection and corner, in the file's order and local frame; numbers with as many digits as tell them
// from their neighbours.
void dump_records(const fdcg_graph& graph, AtomicFile& out);

}  // namespace fdcg::tools
