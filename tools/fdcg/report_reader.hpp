// SPDX-License-Identifier: Apache-2.0
// A report from its JSON (schemas/validate-report.schema.json).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// As bake::report_line wrote it; the file's name is left empty. Throws nlohmann's exceptions where a member is missing or wrong.
bake::Report read_report(const nlohmann::ordered_json& json);

}  // namespace fdcg::tools
