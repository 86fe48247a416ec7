// SPDX-License-Identifier: Apache-2.0
// The one call to the platform in the graph's stages.
#pragma once

#include <cstddef>

namespace fdcg::bake {

// Asks that the memory, not yet touched, be given in large pages: filling 300 MB then faults 150 times and not 75,000. A hint;
// does nothing where the platform has no such thing.
void prefer_large_pages(void* memory, std::size_t bytes);

}  // namespace fdcg::bake
