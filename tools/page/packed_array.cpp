// SPDX-License-Identifier: Apache-2.0
#include "packed_array.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "base64.hpp"
#include "fdcg/format.h"

namespace fdcg::page {
namespace {

constexpr int kLevel = 7;  // 9 takes twice as long for half a percent

void filter_run(std::span<const std::byte> run, std::uint32_t stride, std::byte* to) {
  const std::size_t records = stride == 0 ? 0 : run.size() / stride;
  std::vector<std::uint32_t> before(stride / 4, 0);
  for (std::size_t r = 0; r < records; ++r) {
    for (std::size_t w = 0; w < before.size(); ++w) {
      std::uint32_t word = 0;
      std::memcpy(&word, run.data() + r * stride + 4 * w, sizeof word);
      const std::uint32_t difference = word - before[w];
      const std::uint32_t zigzag = difference << 1 ^ (difference >> 31 != 0 ? 0xFFFFFFFFu : 0u);
      before[w] = word;
      for (std::size_t k = 0; k < 4; ++k)
        to[(4 * w + k) * records + r] = static_cast<std::byte>(zigzag >> (8 * k) & 0xFF);
    }
  }
  const std::size_t done = records * stride;
  std::copy(run.begin() + static_cast<std::ptrdiff_t>(done), run.end(), to + done);
}

std::vector<std::byte> deflated(const std::vector<std::byte>& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::byte> packed(size);
  const int code = compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                             static_cast<uLong>(bytes.size()), kLevel);
  if (code != Z_OK) throw std::bad_alloc();  // the only way to fail with room for all
  packed.resize(size);
  return packed;
}

// Of the nodes' blocks most are triangles, and have this size whether or not all have it.
std::uint32_t usual_node_bytes(const fdcg_header& header) {
  const std::uint32_t block = header.real_bytes == 8 ? sizeof(fdcg_node_f64) : sizeof(fdcg_node_f32);
  return (header.flags & FDCG_STORED_PLANES) != 0 ? block + 3 * 4 * header.real_bytes : block;
}

}  // namespace

std::string packed(std::span<const std::byte> bytes, const std::vector<Run>& runs) {
  std::vector<std::byte> filtered(bytes.size());
  std::size_t at = 0;
  for (const Run& run : runs) {
    filter_run(bytes.subspan(at, run.bytes), run.stride, filtered.data() + at);
    at += run.bytes;
  }
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), filtered.begin() + static_cast<std::ptrdiff_t>(at));
  return base64(deflated(filtered));
}

std::string packed_text(std::string_view text) {
  return packed(std::as_bytes(std::span<const char>(text)));
}

nlohmann::ordered_json described(std::size_t bytes, const std::vector<Run>& runs) {
  auto list = nlohmann::ordered_json::array();
  for (const Run& run : runs)
    list.push_back({run.bytes, run.stride});
  return {{"bytes", bytes}, {"runs", list}};
}

std::vector<Run> runs_of_graph(std::span<const std::byte> file) {
  fdcg_header header;
  std::memcpy(&header, file.data(), sizeof header);
  std::vector<Run> runs;
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    fdcg_section section;
    std::memcpy(&section, file.data() + sizeof header + i * sizeof section, sizeof section);
    const auto offset = static_cast<std::size_t>(section.offset);
    const auto size = static_cast<std::size_t>(section.record_bytes * section.record_count);
    std::uint32_t stride = section.record_bytes % 4 == 0 ? section.record_bytes : 0;
    if (section.id == FDCG_SECTION_NODES) stride = usual_node_bytes(header);
    runs.push_back({offset - at, 0});
    runs.push_back({size, stride});
    at = offset + size;
  }
  return runs;
}

}  // namespace fdcg::page
