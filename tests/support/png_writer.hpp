// SPDX-License-Identifier: Apache-2.0
// PNG files, written by the standard's own words and zlib, not by the library that reads them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace fdcg::test {

// Channels: 1 grey, 2 grey and opacity, 3 red green blue, 4 with opacity. `bits` 8 or 16; a value has so many.
inline std::string png_bytes(std::uint32_t width, std::uint32_t height, std::uint32_t channels, int bits,
                             const std::vector<std::uint16_t>& values) {
  std::string file("\x89PNG\r\n\x1a\n", 8);
  const auto add_number = [](std::string& to, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
      to.push_back(static_cast<char>(value >> shift));
  };
  const auto add_chunk = [&](const char* kind, const std::string& data) {
    add_number(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t body = file.size();
    file.append(kind, 4).append(data);
    const auto size = static_cast<uInt>(file.size() - body);
    add_number(file, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(file.data() + body), size)));
  };
  std::string rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % (width * channels) == 0) rows.push_back('\0');  // no filter
    if (bits == 16) rows.push_back(static_cast<char>(values[i] >> 8));
    rows.push_back(static_cast<char>(values[i]));
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
           static_cast<uLong>(rows.size()));
  packed.resize(size);
  constexpr char kKinds[] = {0, 4, 2, 6};
  std::string header;
  add_number(header, width);
  add_number(header, height);
  header.push_back(static_cast<char>(bits));
  header.push_back(kKinds[channels - 1]);
  header.append(3, '\0');
  add_chunk("IHDR", header);
  add_chunk("IDAT", packed);
  add_chunk("IEND", {});
  return file;
}

}  // namespace fdcg::test
