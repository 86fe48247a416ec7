// SPDX-License-Identifier: Apache-2.0
// ZIP archives of parts that are stored as they are, put together by hand.
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fdcg::test {

inline void put_number(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i)
    out += static_cast<char>(value >> (8 * i) & 0xFF);
}

inline std::string stored_zip(const std::vector<std::pair<std::string, std::string>>& parts) {
  std::string out, directory;
  for (const auto& [name, bytes] : parts) {
    std::string common;                          // of both headers
    for (const int field : {20, 0, 0, 0, 0x21})  // version 2.0, no flags, stored, midnight, 1 January 1980
      put_number(common, static_cast<std::uint64_t>(field), 2);
    const uLong checksum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    put_number(common, checksum, 4), put_number(common, bytes.size(), 4), put_number(common, bytes.size(), 4);
    put_number(common, name.size(), 2), put_number(common, 0, 2);
    put_number(directory, 0x02014B50, 4), put_number(directory, 20, 2);
    directory += common;
    put_number(directory, 0, 2), put_number(directory, 0, 2), put_number(directory, 0, 2), put_number(directory, 0, 4);
    put_number(directory, out.size(), 4);
    directory += name;
    put_number(out, 0x04034B50, 4);
    out += common + name + bytes;
  }
  const std::size_t start = out.size();
  out += directory;
  put_number(out, 0x06054B50, 4), put_number(out, 0, 4);
  put_number(out, parts.size(), 2), put_number(out, parts.size(), 2), put_number(out, directory.size(), 4);
  put_number(out, start, 4), put_number(out, 0, 2);
  return out;
}

}  // namespace fdcg::test
