// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "support/gltf_writer.hpp"
#include "support/import_support.hpp"
#include "support/soups.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using fdcg::test::bumpy_sphere;
using fdcg::test::DracoMethod;

namespace {

PolygonSoup float_sphere(std::uint32_t rings = 10, std::uint32_t segments = 12) {
  PolygonSoup soup = bumpy_sphere(rings, segments);
  for (Vec3& p : soup.points)
    p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  return soup;
}

void check_same(const PolygonSoup& soup, const PolygonSoup& mesh) {
  check_invariants(soup);
  CHECK(soup.format == Format::gltf);
  CHECK_FALSE(soup.is_text);
  CHECK(soup.points == mesh.points);
  CHECK(soup.corners == mesh.corners);
  CHECK(soup.face_first == mesh.face_first);
  CHECK(soup.relative_quantum == 0x1p-24);
  CHECK(soup.absolute_quantum == 0);
  CHECK(soup.ignored.empty());
  REQUIRE(soup.parts.size() == 1);
  CHECK(soup.parts[0].name == "node/mesh/primitive 0");
  CHECK(soup.parts[0].first_face == 0);
  CHECK(soup.parts[0].first_point == 0);
}

}  // namespace

TEST_CASE("a mesh comes back from glTF, GLB and GLB with Draco, bit by bit and number by number") {
  const PolygonSoup mesh = float_sphere();
  check_same(import_text(fdcg::test::write_gltf(mesh)), mesh);
  check_same(import_text(fdcg::test::write_glb(mesh)), mesh);
  check_same(import_text(fdcg::test::write_glb_draco(mesh)), mesh);
}
