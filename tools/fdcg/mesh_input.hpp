// SPDX-License-Identifier: Apache-2.0
// The mesh that an argument names: a file, or "-" for standard input.
#pragma once

#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// import_mesh, or all of standard input to import_memory. Of a run only one input can be "-".
bake::Result<bake::PolygonSoup> import_input(const std::string& path, const bake::ImportOptions& options);

}  // namespace fdcg::tools
