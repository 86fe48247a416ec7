// SPDX-License-Identifier: Apache-2.0
// Parts of the JSON report that report_full.cpp writes too; schemas/validate-report.schema.json describes it.
#pragma once

#include <functional>
#include <string_view>

#include "base/json_writer.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

// Everything but `files`, which is left open as an array; end_json_document closes it.
void begin_json_document(JsonWriter& json);
void end_json_document(JsonWriter& json, std::string& out);

void write_json_element(JsonWriter& json, const Element& element);

// An entry of `files`; `elements` writes the items of an issue's array.
void write_json_file(JsonWriter& json, const Report& report, const std::function<void(const Issue&)>& elements);

}  // namespace fdcg::bake
