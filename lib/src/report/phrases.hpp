// SPDX-License-Identifier: Apache-2.0
// The text of a report about a rule's findings.
#pragma once

#include <cstdint>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::bake {

// "2 edges have more than two faces. Split ..." of a rule that check() runs; total > 0.
[[nodiscard]] std::string finding_message(const Rule& rule, std::uint64_t total);

}  // namespace fdcg::bake
