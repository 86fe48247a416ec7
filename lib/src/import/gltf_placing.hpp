// SPDX-License-Identifier: Apache-2.0
// How precise the positions of a glTF accessor are, and the matrix of a node.
#pragma once

#include "import/gltf_accessor.hpp"
#include "import/placing.hpp"

namespace fdcg::bake::gltf {

Grain grain_of(const Positions& positions);

// Translation times rotation times scale. The quaternion was rounded to few digits: dividing by its length keeps angles. False:
// q is no unit quaternion.
bool composed(const std::array<double, 3>& t, const std::array<double, 4>& q, const std::array<double, 3>& s, Matrix& m);

}  // namespace fdcg::bake::gltf
