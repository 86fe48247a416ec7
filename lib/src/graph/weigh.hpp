// SPDX-License-Identifier: Apache-2.0
// The mass properties that the file will hold: of the mesh, at the density or mass that was asked for.
#pragma once

#include <optional>
#include <string>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/format.h"
#include "graph/regions.hpp"

namespace fdcg::bake {

// Why the options about mass make no sense; empty where they do.
[[nodiscard]] std::string check_mass_options(const CompileOptions& options);

// The record of section MASS for a mesh of triangles that has passed the checks of compiled.report, before its regions are
// merged. Where there can be none the reason goes to compiled.no_mass, or is a failure (1) if a mass or density was asked for.
[[nodiscard]] Result<std::optional<fdcg_mass_record>> weigh(const Mesh& mesh, const Topology& topology, const Regions& regions,
                                                            const CompileOptions& options, unsigned jobs, Compiled& compiled);

}  // namespace fdcg::bake
