// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

inline const std::uint8_t NOVINT_FALCON_NVENT_FIRMWARE[] = {0};
constexpr long NOVINT_FALCON_NVENT_FIRMWARE_SIZE = 1;
