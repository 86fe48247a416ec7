// SPDX-License-Identifier: Apache-2.0
// The mass properties that the file stores: those of the mesh at the requested density or mass.
#pragma once

#include <optional>
#include <string>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/format.h"
#include "graph/regions.hpp"

namespace fdcg::bake {

// The contradiction in the mass options; empty if there is none.
[[nodiscard]] std::string check_mass_options(const CompileOptions& options);

// The record of section MASS for a mesh of triangles that has passed the checks of compiled.report, before its regions are
// merged. Where there is none, the reason is stored in compiled.no_mass, or is a failure (1) if a mass or density was
// requested.
[[nodiscard]] Result<std::optional<fdcg_mass_record>> weigh(const Mesh& mesh, const Topology& topology, const Regions& regions,
                                                            const CompileOptions& options, unsigned jobs, Compiled& compiled);

}  // namespace fdcg::bake
