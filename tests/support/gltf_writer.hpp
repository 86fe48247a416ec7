// SPDX-License-Identifier: Apache-2.0
// Soups of triangles as glTF 2.0: one node, one mesh, one primitive, positions as floats, 32-bit indices.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drc_writer.hpp"
#include "fdcg/bake.hpp"

namespace fdcg::test {

// The soup has triangles alone, and coordinates that are floats (others are rounded). A corner that is no vertex stays one.
std::string write_gltf(const bake::PolygonSoup& soup);  // JSON, the buffer in it as base64
std::string write_glb(const bake::PolygonSoup& soup);
std::string write_glb_draco(const bake::PolygonSoup& soup, const DracoWriteOptions& options = {});

// For files put together by hand.
std::string glb_container(std::string_view json, std::optional<std::string_view> binary);
std::string base64(std::string_view bytes);

}  // namespace fdcg::test
