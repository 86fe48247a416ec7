// SPDX-License-Identifier: Apache-2.0
// Buffer views that EXT_meshopt_compression has packed (meshoptimizer, whose decoders are made for data that is not trusted).
#pragma once

#include <string>
#include <string_view>

#include "import/gltf_document.hpp"

namespace fdcg::bake::gltf {

// The unpacked bytes. `place`: of the view, for messages. Throws Refusal.
std::string decode_meshopt(const Meshopt& packed, std::string_view bytes, const std::string& place);

}  // namespace fdcg::bake::gltf
