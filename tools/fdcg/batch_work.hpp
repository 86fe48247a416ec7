// SPDX-License-Identifier: Apache-2.0
// What a rule of a batch makes of a mesh.
#pragma once

#include <optional>

#include "batch_cache.hpp"
#include "batch_rule.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::tools {

bake::ImportOptions import_options(const BatchRule& rule);

// Depends on the mesh and the rule alone: not on the mesh's name, nor on `jobs`, the number of threads. Fails as the commands
// do.
bake::Result<CacheEntry> do_batch_work(const BatchRule& rule, const bake::PolygonSoup& soup, unsigned jobs);

}  // namespace fdcg::tools
