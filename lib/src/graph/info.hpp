// SPDX-License-Identifier: Apache-2.0
// The metadata of the file as JSON.
#pragma once

#include <cstdint>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// One line: tool, source, options, verdict, the rules that were run and their findings. No path, time or host, and no option
// without influence on the graph (jobs): same input and options, same text. Of the soup neither points nor faces are read.
[[nodiscard]] std::string info_json(const PolygonSoup& soup, std::uint32_t vertices, std::uint32_t faces,
                                    const CompileOptions& options, const Compiled& compiled);

}  // namespace fdcg::bake
