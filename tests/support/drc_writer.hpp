// SPDX-License-Identifier: Apache-2.0
// Soups of triangles as Draco files, by libdraco's encoder.
#pragma once

#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::test {

// sequential keeps the points, their numbers, the faces and their order as they are; edgebreaker renumbers, leaves isolated
// points and degenerate faces out and cuts non-manifold edges open.
enum class DracoMethod { sequential, edgebreaker };

struct DracoWriteOptions {
  DracoMethod method = DracoMethod::sequential;
  int position_bits = 0;  // 0: not quantised, exact (float where every coordinate is one, else double)
};

// The soup has triangles alone, with corners in range.
std::string write_drc(const bake::PolygonSoup& soup, const DracoWriteOptions& options = {});

// With normals, texture coordinates (as they stand) and colours of the soup's corners, of 8 bits: the attributes 1, 2 and 3.
// Quantised where options.position_bits is not 0, normals to 10 bits and texture coordinates to 12.
std::string write_drc_with_looks(const bake::PolygonSoup& soup, const DracoWriteOptions& options = {});

// Two triangles that meet in an edge, but differ in colour there: four places, six points, 0 1 2 and 3 4 5.
std::string write_drc_with_seam();
std::string write_drc_cloud();  // four points, no face

}  // namespace fdcg::test
