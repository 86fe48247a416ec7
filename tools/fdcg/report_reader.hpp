// SPDX-License-Identifier: Apache-2.0
// A report from its JSON (schemas/validate-report.schema.json).
#pragma once

#include <simdjson.h>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// As bake::report_line wrote it; the file's name is left empty. Throws simdjson::simdjson_error where a member is missing or
// wrong.
bake::Report read_report(simdjson::dom::element json);

}  // namespace fdcg::tools
