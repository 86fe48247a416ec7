// SPDX-License-Identifier: Apache-2.0
// The JSON that the file carries about itself.
#pragma once

#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// One line: tool, source, options, verdict, the rules that were run and what they found. No path, time or host, and nothing
// that does not change the graph (jobs): same input and options, same text.
[[nodiscard]] std::string info_json(const PolygonSoup& soup, const CompileOptions& options, const Compiled& compiled);

}  // namespace fdcg::bake
