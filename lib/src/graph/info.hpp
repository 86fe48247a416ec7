// SPDX-License-Identifier: Apache-2.0
// The metadata of the file as JSON.
#pragma once

#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// One line: tool, source, options, verdict, the rules that were run and their findings. No path, time or host, and no option
// without influence on the graph (jobs): same input and options, same text.
[[nodiscard]] std::string info_json(const PolygonSoup& soup, const CompileOptions& options, const Compiled& compiled);

}  // namespace fdcg::bake
