// SPDX-License-Identifier: Apache-2.0
#include <dirent.h>

#include <set>
#include <thread>

#include "support/drc_writer.hpp"
#include "support/import_support.hpp"
#include "support/soups.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using fdcg::test::bumpy_sphere;
using fdcg::test::DracoMethod;
using fdcg::test::write_drc;

namespace {

PolygonSoup float_sphere(std::uint32_t rings = 10, std::uint32_t segments = 12) {
  PolygonSoup soup = bumpy_sphere(rings, segments);
  for (Vec3& p : soup.points)
    p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  return soup;
}

}  // namespace

TEST_CASE("a sequential, unquantised Draco file gives back the mesh, bit by bit and number by number") {
  const PolygonSoup mesh = float_sphere();
  const PolygonSoup soup = import_text(write_drc(mesh));
  check_invariants(soup);
  CHECK(soup.format == Format::drc);
  CHECK_FALSE(soup.is_text);
  CHECK(soup.points == mesh.points);
  CHECK(soup.corners == mesh.corners);
  CHECK(soup.face_first == mesh.face_first);
  CHECK(soup.relative_quantum == 0x1p-24);
  CHECK(soup.absolute_quantum == 0);
}

TEST_CASE("doubles in a Draco file stay doubles") {
  const PolygonSoup mesh = bumpy_sphere(6, 7);
  const PolygonSoup soup = import_text(write_drc(mesh));
  CHECK(soup.points == mesh.points);
  CHECK(soup.relative_quantum == 0x1p-53);
}

TEST_CASE("the quantum of a quantised Draco file is half a step") {
  const PolygonSoup mesh = float_sphere();
  double low = 1e9, high = -1e9;
  for (const Vec3& p : mesh.points) {
    low = std::min({low, p.x, p.y, p.z});
    high = std::max({high, p.x, p.y, p.z});
  }
  for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker}) {
    for (const int bits : {10, 11, 16}) {
      const PolygonSoup soup = import_text(write_drc(mesh, {method, bits}));
      check_invariants(soup);
      CHECK(soup.face_count() == mesh.face_count());
      // Draco's range is that of the widest axis, as wide as all coordinates here.
      const double range = high - low, half_step = range / (std::pow(2.0, bits) - 1) / 2;
      CHECK(soup.absolute_quantum == Approx(half_step).epsilon(0.05));
      CHECK(soup.relative_quantum == 0x1p-24);
      if (method == DracoMethod::edgebreaker) continue;
      for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec3 &a = soup.points[i], &b = mesh.points[i];
        const double off = std::max({std::fabs(a.x - b.x), std::fabs(a.y - b.y), std::fabs(a.z - b.z)});
        CHECK(off <= soup.absolute_quantum * 1.001);
      }
    }
  }
}
