// SPDX-License-Identifier: Apache-2.0
// The results of a SARIF run, for report_sarif.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/json_writer.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::bake {

inline constexpr std::string_view kSarifRoot = "%SRCROOT%";  // what relative URIs start from; code scanning knows the name

// A member that holds a message.
inline void write_sarif_text(JsonWriter& json, std::string_view key, std::string_view text) {
  json.key(key);
  json.begin_object(JsonWriter::Layout::one_line);
  json.member("text", text);
  json.end_object();
}

// The results of one file, into the list that is open: `uri` is its own, `artifact` its place in the run's list.
void write_sarif_results(JsonWriter& json, const Report& report, const std::string& uri, std::size_t artifact,
                         const ReportOptions& options);

}  // namespace fdcg::bake
