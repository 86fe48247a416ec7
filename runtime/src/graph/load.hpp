// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

// Header and section table; where they are in order *graph is the view.
fdcg_status open_trusted(const void* data, uint64_t bytes, fdcg_graph* graph, fdcg_error* error);

// The same, and all that the level asks for (open.cpp). The view is zeroed where it fails.
fdcg_status open_verified(const void* data, uint64_t bytes, fdcg_verify verify, fdcg_graph* graph, fdcg_error* error);

// Tells the log handler how an opening went, and hands the status on.
fdcg_status told(fdcg_status status, const fdcg_graph& graph, const fdcg_error& error);

}  // namespace fdcg
