// SPDX-License-Identifier: Apache-2.0
// The transforms of a COLLADA node.
#pragma once

#include "import/placing.hpp"
#include "import/xml_file.hpp"

namespace fdcg::bake::dae {

// Of an element inside a <node>; the identity where it is none of translate, rotate, scale, matrix, skew and lookat. Throws
// Refusal.
Matrix transform_of(const xml::File& file, const xml::Node& element);

}  // namespace fdcg::bake::dae
