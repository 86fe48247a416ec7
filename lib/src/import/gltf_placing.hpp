// SPDX-License-Identifier: Apache-2.0
// How precise the positions of a glTF accessor are.
#pragma once

#include "import/gltf_accessor.hpp"
#include "import/placing.hpp"

namespace fdcg::bake::gltf {

Grain grain_of(const Positions& positions);

}  // namespace fdcg::bake::gltf
