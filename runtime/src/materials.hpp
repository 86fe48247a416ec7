// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

// Every name ends, every node's material is there; FDCG_OK where the file has none. Cost: linear in nodes and materials.
fdcg_status verify_materials(const fdcg_graph& graph, fdcg_error* error);

}  // namespace fdcg
