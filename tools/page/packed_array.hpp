// SPDX-License-Identifier: Apache-2.0
// Arrays on their way into a page: filtered so that they compress, deflated, as base64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fdcg::page {

// A run of records of `stride` bytes, a multiple of 4: each 32-bit word gives way to its difference from the word in the record
// before (zigzag: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...), and of all records the first bytes stand together, then the second
// ones, and so on. What is left over at the end of the run stays as it is, and so does a run with stride 0.
struct Run {
  std::size_t bytes = 0;
  std::uint32_t stride = 0;
};

// Filters, deflates and encodes. `runs` cover the bytes from their beginning; what they do not cover stays as it is.
std::string packed(std::span<const std::byte> bytes, const std::vector<Run>& runs = {});

std::string packed_text(std::string_view text);

template <class T>
std::string packed_records(const std::vector<T>& records, std::uint32_t stride = sizeof(T)) {
  const auto bytes = std::as_bytes(std::span<const T>(records));
  return packed(bytes, {{bytes.size(), stride}});
}

// What the viewer needs to undo packed(): {"bytes": ..., "runs": [[bytes, stride], ...]}.
nlohmann::ordered_json described(std::size_t bytes, const std::vector<Run>& runs);

// The runs of an FDCG file: its header and tables as they are, its sections by their records.
std::vector<Run> runs_of_graph(std::span<const std::byte> file);

}  // namespace fdcg::page
