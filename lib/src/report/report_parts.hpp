// SPDX-License-Identifier: Apache-2.0
// Shared by the formats of a report: phrases, places, limits. Each format is in a file report_FORMAT.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

using Write = std::function<void(std::string_view)>;

// Bytes of a part's name that are repeated with every element: keeps reports small where names are long.
inline constexpr std::size_t kLongestName = 80;

[[nodiscard]] std::string_view name_of(Severity severity);

// "1 face", "2 faces".
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view one, std::string_view many);

// The place of an element as text: "line 10, edge 3-7, faces 4 9, part \"wheel\", at (1, 0.5, 2)". Printable.
[[nodiscard]] std::string place_of(const Element& element);

// 16 lower-case hex digits.
[[nodiscard]] std::string fingerprint_text(std::uint64_t fingerprint);

// Whether the file gave no mesh: its only issue is unreadable or empty-mesh.
[[nodiscard]] bool is_import_failure(const Report& report);

// Whether its findings fail the verdict: the severity is high enough, and not all findings are allowed or known.
[[nodiscard]] bool fails(const Report& report, const Issue& issue);

std::unique_ptr<ReportWriter> make_text_writer(Write write, const ReportOptions& options);
std::unique_ptr<ReportWriter> make_json_writer(Write write, const ReportOptions& options);
std::unique_ptr<ReportWriter> make_sarif_writer(Write write, const ReportOptions& options);
std::unique_ptr<ReportWriter> make_junit_writer(Write write, const ReportOptions& options);

}  // namespace fdcg::bake
