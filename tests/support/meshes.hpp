// SPDX-License-Identifier: Apache-2.0
// Meshes for tests, made by formula: closed ones enclose positive volume, every face is convex and counter-clockwise seen
// from outside, vertices are shared, no vertex lies inside another face's edge. About unit size, centred near the origin.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::test {

using bake::PolygonSoup;
using bake::Vec3;
using Polygon = std::vector<std::uint32_t>;

PolygonSoup make_soup(std::string name, std::vector<Vec3> points, const std::vector<Polygon>& faces);
Polygon face_corners(const PolygonSoup& soup, std::size_t face);

// ---- blocks ----------------------------------------------------------------------------------------------------------------

PolygonSoup cube();                                              // 6 quads, 8 points at +-0.5
PolygonSoup grid_box(int nx, int ny, int nz, const Vec3& size);  // each side cut into quads
PolygonSoup thin_plate(double thickness, int n = 1);             // 1 x 1 x thickness, top and bottom n x n quads

// The outside of a set of unit cubes at integer places, one quad for each free side. Cubes that touch along an edge or at a
// point only would give a mesh that is not manifold.
PolygonSoup voxels(std::string name, const std::vector<std::array<int, 3>>& cells);
PolygonSoup l_prism();     // voxels: exactly one concave line
PolygonSoup corner_pit();  // a cube of 2 without its octant: a concave corner of three faces at the origin

// A profile extruded along x from -1 to 1. `pieces` are convex polygons that cover the profile using its own points only.
PolygonSoup extruded(std::string name, const std::vector<std::array<double, 2>>& profile_yz,
                     const std::vector<Polygon>& pieces);
PolygonSoup v_groove(double opening_rad);  // in a block: the groove's bottom is the line y = z = 0, |x| <= 1
PolygonSoup wedge(double dihedral_rad);    // a knife edge along x through the origin, the body towards +y

// A vertical block over a regular n-gon of radius 1 around the origin, floor at z = -1; its top is n triangles from an apex on
// the axis to a rim whose heights alternate (n even) between two values.
PolygonSoup fan_block(int n, double apex_z, double even_rim_z, double odd_rim_z);
PolygonSoup cone(int n);      // apex at z = 1 over the floor z = -1
PolygonSoup cone_pit(int n);  // a funnel: concave corner of n faces at the origin
PolygonSoup saddle_block();   // a saddle corner of eight faces at the origin
PolygonSoup prism(int n);     // n-gon, radius 1, from z = -1 to z = 1

// ---- rounded bodies --------------------------------------------------------------------------------------------------------

PolygonSoup ico_sphere(int level);              // 20 * 4^level triangles, radius 1
PolygonSoup geodesic_sphere(int parts);         // 20 * parts^2 triangles, radius 1: each edge of an icosahedron cut into parts
PolygonSoup uv_sphere(int slices, int stacks);  // with two corners of `slices` faces
PolygonSoup torus(int around, int across, double tube_radius = 0.4);
// Radius 1 + amplitude * (waves + bumps hashed from the seed): star-shaped, full of saddles.
PolygonSoup star_sphere(int level, double amplitude, std::uint64_t seed);
// Every point of ico_sphere(level) pulled out by a hashed factor of up to 1 + height.
PolygonSoup spiky_sphere(int level, double height, std::uint64_t seed);

// ---- open patches ----------------------------------------------------------------------------------------------------------

PolygonSoup plane_quad();                               // [-0.5, 0.5]^2 at z = 0, facing +z
PolygonSoup plane_grid(int nx, int ny);                 // the same in 2 nx ny triangles
PolygonSoup plane_jittered(int n, std::uint64_t seed);  // 2 n n triangles, inner points moved about
PolygonSoup bumpy_patch(int n, double amplitude, std::uint64_t seed);
PolygonSoup needle_strip(int n, double amplitude, std::uint64_t seed);  // 2 n triangles of 1 / n by 1

// ---- changes ---------------------------------------------------------------------------------------------------------------

using Rotation = std::array<Vec3, 3>;  // rows
Rotation random_rotation(std::uint64_t seed);
Vec3 rotated(const Rotation& rotation, const Vec3& v);

// point -> rotation * point * scale + translation
PolygonSoup transformed(const PolygonSoup& soup, const Rotation& rotation, double scale = 1, const Vec3& translation = {});
PolygonSoup scaled(const PolygonSoup& soup, double scale);
PolygonSoup moved(const PolygonSoup& soup, const Vec3& translation);
PolygonSoup rounded_to_float(const PolygonSoup& soup);
PolygonSoup triangulated(const PolygonSoup& soup, std::uint64_t seed = 0);  // each face a fan from a hashed corner
// Every edge cut in the middle, every face into its corners and a middle, that into triangles. On dyadic coordinates planar
// faces stay exactly planar.
PolygonSoup subdivided(const PolygonSoup& soup, std::uint64_t seed = 0);

}  // namespace fdcg::test
