// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../core/FalconDevice.h"

namespace libnifalcon {
struct FalconFirmwareNovintSDK : FalconFirmware {};
}  // namespace libnifalcon
