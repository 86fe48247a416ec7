// SPDX-License-Identifier: Apache-2.0
// What PLY vertices may have beside their places: normals, colours, texture coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fdcg/bake.hpp"
#include "import/import_ply.hpp"

namespace fdcg::bake::ply {

// Gives the properties of element 'vertex' their roles, where all of a kind are there once each, as numbers, in rows of one
// size.
void assign_extras(ElementKind& vertex, bool wants_normals, bool wants_appearance);

class VertexExtras {
 public:
  // Room for all rows of the element, as far as its properties have roles here.
  void begin(const ElementKind& vertex);
  // A number of a row below the element's count; its role is one of these.
  void set(std::size_t row, const Property& property, double value);
  // Gives each corner what its vertex has. To be called once all is read.
  void spread(PolygonSoup& soup) const;

 private:
  std::vector<Vec3> normals_;
  std::vector<Colour> colours_;
  std::vector<std::array<float, 2>> uv_;
};

}  // namespace fdcg::bake::ply
