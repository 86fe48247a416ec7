// SPDX-License-Identifier: Apache-2.0
// compile() without its repair, which needs more libraries than the rest: who wants it hands it in.
#pragma once

#include "fdcg/bake.hpp"
#include "validate/validate.hpp"

namespace fdcg::bake {

// Repairs a mesh that was judged; the account goes into `compiled`, the mesh as it is then into `ready`.
using RepairStage = void(const PolygonSoup& soup, const CompileOptions& options, const CheckOptions& how, Compiled& compiled,
                         Prepared& ready);

// `repair` null: options.repair does not count. `spare`, the soup itself or null: what may be freed once it has served.
Result<Compiled> compile_by(const PolygonSoup& soup, const CompileOptions& options, RepairStage* repair, PolygonSoup* spare);

// Of a quantum that a program gives what counts, as of a grid's step (base/quantised.hpp).
[[nodiscard]] double quantum_that_counts(double given, const PolygonSoup& soup);

}  // namespace fdcg::bake
