// SPDX-License-Identifier: Apache-2.0
#include "profile/crc.hpp"

#include <array>

namespace fdcg::dev {
namespace {

// Remainders of one byte. A reflected CRC takes a byte's lowest bit first, and its polynomial is written backwards.
template <class Word>
using Table = std::array<Word, 256>;

template <class Word>
constexpr Table<Word> straight_table(Word polynomial) {
  constexpr int kWidth = static_cast<int>(sizeof(Word)) * 8;
  Table<Word> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    Word rest = static_cast<Word>(static_cast<Word>(byte) << (kWidth - 8));
    for (int bit = 0; bit < 8; ++bit)
      rest = static_cast<Word>((rest >> (kWidth - 1)) != 0 ? (rest << 1) ^ polynomial : rest << 1);
    table[byte] = rest;
  }
  return table;
}

template <class Word>
constexpr Table<Word> reflected_table(Word polynomial) {
  Table<Word> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    Word rest = static_cast<Word>(byte);
    for (int bit = 0; bit < 8; ++bit)
      rest = static_cast<Word>((rest & 1) != 0 ? (rest >> 1) ^ polynomial : rest >> 1);
    table[byte] = rest;
  }
  return table;
}

constexpr auto kCcitt = straight_table<std::uint16_t>(0x1021);
constexpr auto kModbus = reflected_table<std::uint16_t>(0xA001);
constexpr auto kIsoHdlc = reflected_table<std::uint32_t>(0xEDB88320);
constexpr auto kSmbus = straight_table<std::uint8_t>(0x07);

template <class Word>
Word reflected(const Table<Word>& table, Word rest, const std::uint8_t* data, int bytes) {
  for (int i = 0; i < bytes; ++i)
    rest = static_cast<Word>((rest >> 8) ^ table[(rest ^ data[i]) & 0xFF]);
  return rest;
}

}  // namespace

int bytes_of(CrcKind kind) {
  constexpr int kBytes[] = {0, 2, 2, 4, 1, 1, 1};
  return kBytes[static_cast<int>(kind)];
}

std::uint32_t crc_of(CrcKind kind, const std::uint8_t* data, int bytes) {
  switch (kind) {
    case CrcKind::kNone:
      return 0;
    case CrcKind::kCrc16CcittFalse: {
      std::uint16_t rest = 0xFFFF;
      for (int i = 0; i < bytes; ++i)
        rest = static_cast<std::uint16_t>((rest << 8) ^ kCcitt[(rest >> 8) ^ data[i]]);
      return rest;
    }
    case CrcKind::kCrc16Modbus:
      return reflected<std::uint16_t>(kModbus, 0xFFFF, data, bytes);
    case CrcKind::kCrc32:
      return ~reflected<std::uint32_t>(kIsoHdlc, 0xFFFFFFFF, data, bytes);
    case CrcKind::kCrc8: {
      std::uint8_t rest = 0;
      for (int i = 0; i < bytes; ++i)
        rest = kSmbus[rest ^ data[i]];
      return rest;
    }
    case CrcKind::kSum8:
    case CrcKind::kXor8: {
      std::uint8_t rest = 0;
      for (int i = 0; i < bytes; ++i)
        rest = static_cast<std::uint8_t>(kind == CrcKind::kSum8 ? rest + data[i] : rest ^ data[i]);
      return rest;
    }
  }
  return 0;
}

}  // namespace fdcg::dev
