// SPDX-License-Identifier: Apache-2.0
// Bytes as text (RFC 4648, with padding).
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace fdcg::page {

std::string base64(std::span<const std::byte> bytes);

}  // namespace fdcg::page
