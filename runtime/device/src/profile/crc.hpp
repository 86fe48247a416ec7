// SPDX-License-Identifier: Apache-2.0
// Checksums of reports. Names as in the catalogue of parametrised CRC algorithms: CRC-16/IBM-3740 (known as CCITT-FALSE),
// CRC-16/MODBUS, CRC-32/ISO-HDLC, CRC-8/SMBUS; sum8 and xor8 are what they say.
#pragma once

#include <cstdint>

#include "profile/profile.hpp"

namespace fdcg::dev {

int bytes_of(CrcKind kind);  // 0 of kNone
// No heap; time linear in `bytes`; 0 of kNone.
std::uint32_t crc_of(CrcKind kind, const std::uint8_t* data, int bytes);

}  // namespace fdcg::dev
