// SPDX-License-Identifier: Apache-2.0
// ZIP archives of parts that are stored as they are, put together by hand.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fdcg::test {

inline std::uint32_t crc32_of(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc & 1) != 0 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  return ~crc;
}

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
    put_number(common, crc32_of(bytes), 4), put_number(common, bytes.size(), 4), put_number(common, bytes.size(), 4);
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
