// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "../../support/drc_writer.hpp"
#include "../../support/import_support.hpp"
#include "../../support/soups.hpp"
#include "import/draco_decode.hpp"
#include "import/guarded_child.hpp"

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

TEST_CASE("doubles in a Draco file are kept exactly") {
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

TEST_CASE("points on seams of other attributes keep Draco's indices and are joined only by the weld") {
  // Two triangles with a corner each of their own colour: four places, six points.
  const std::string bytes = fdcg::test::write_drc_with_seam();
  const PolygonSoup soup = import_text(bytes);
  CHECK(soup.points.size() == 6);
  CHECK(faces_of(soup) == std::vector<std::vector<std::uint32_t>>{{0, 1, 2}, {3, 4, 5}});
  CHECK(soup.points[0] == soup.points[3]);
}

TEST_CASE("a Draco point cloud holds no face") {
  const std::string message = refusal(fdcg::test::write_drc_cloud());
  CHECK(message == "mesh: is a Draco point cloud and holds no face; compress a mesh");
  CHECK(import_memory(fdcg::test::write_drc_cloud(), "mesh").error().rule == "empty-mesh");
}

TEST_CASE("forged counts end quickly, with the limit in the message") {
  for (const char* name : {"unreadable-half-billion-faces.drc", "unreadable-half-billion-faces-valence.drc",
                           "unreadable-billion-sequential-faces.drc"}) {
    INFO(name);
    const auto start = std::chrono::steady_clock::now();
    const Result<PolygonSoup> soup = import_mesh(testdata() / "meshes" / "bad" / name);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    REQUIRE_FALSE(soup);
    CHECK(soup.error().exit_code == 3);
    CHECK(soup.error().rule == "unreadable");
    CHECK(took.count() < 5);
    if (!tells_of_memory() || std::string(name).find("half") == std::string::npos) continue;
    CHECK(soup.error().message.ends_with(
        ": decoding its Draco data took more than the 256 MiB of memory that a file of this size is given; the file is damaged "
        "or forged: compress the mesh again"));
  }
}

TEST_CASE("many threads may import Draco files at once") {
  const PolygonSoup mesh = float_sphere(20, 30);
  const std::string good = write_drc(mesh, {DracoMethod::edgebreaker, 11}), bad = good.substr(0, good.size() / 2);
  const PolygonSoup alone = import_text(good);
  constexpr int kThreads = 8, kRuns = 20;
  std::atomic<int> right{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < kRuns; ++i) {
        const Result<PolygonSoup> soup = import_memory(good, "good");
        right += soup && soup->points == alone.points && soup->corners == alone.corners && soup->sha256 == alone.sha256;
        right += !import_memory(bad, "bad");
      }
    });
  }
  for (std::thread& thread : threads)
    thread.join();
  CHECK(right == 2 * kThreads * kRuns);
}

TEST_CASE("a quantisation whose forged range is no number has no step") {
  const std::string bytes = read_bytes(testdata() / "fuzz" / "import_drc" / "range-no-number");
  const DracoMesh mesh = decode_draco_here({bytes, std::nullopt, {}, true});
  CHECK(mesh.is_float);
  CHECK(mesh.absolute_quantum == 0);
}
