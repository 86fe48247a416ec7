// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_placing.hpp"

namespace fdcg::bake::gltf {

Grain grain_of(const Positions& positions) {
  if (positions.type() == Component::f32) return {0x1p-24, 0};
  const bool is_byte = size_of(positions.type()) == 1;
  // 256 steps are too few for a scan: bytes that are not normalised are taken as a modelling grid, and exact.
  if (!positions.is_normalized()) return {0x1p-53, is_byte ? 0 : 0.5};
  switch (positions.type()) {
    case Component::i8:
      return {0x1p-53, 0.5 / 127};
    case Component::u8:
      return {0x1p-53, 0.5 / 255};
    case Component::i16:
      return {0x1p-53, 0.5 / 32767};
    default:
      return {0x1p-53, 0.5 / 65535};
  }
}

}  // namespace fdcg::bake::gltf
