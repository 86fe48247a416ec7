// SPDX-License-Identifier: Apache-2.0
// Self-intersections of about a million triangles, beside CGAL's sequential self_intersections on the same mesh in the same
// run; prints both times, their ratio and the pairs found. With a mesh file as argument, of that mesh. Exit code 1 where the
// pairs differ or the ratio is above the bar.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "soups.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"
#include "validate/self_intersection.hpp"

using namespace fdcg::bake;

namespace {

constexpr double kBar = 0.4;  // of CGAL's time
constexpr int kRounds = 5;    // the medians of these are compared

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Surface surface_of(const Mesh& mesh) {
  Surface surface;
  for (const Vec3& p : mesh.points)
    surface.add_vertex({p.x, p.y, p.z});
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto vertex = [&](unsigned i) { return Surface::Vertex_index(+mesh.corners[3 * f + i]); };
    if (surface.add_face(vertex(0), vertex(1), vertex(2)) == Surface::null_face()) {
      std::fprintf(stderr, "face %u: not a manifold mesh\n", f);
      std::exit(2);
    }
  }
  return surface;
}

template <class Work>
double seconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Two bumpy spheres, one in part inside the other: some thousand pairs among a million faces.
PolygonSoup default_mesh() {
  PolygonSoup other = fdcg::test::bumpy_sphere(500, 500);
  for (Vec3& p : other.points)
    p = {p.x + 0.7, p.y + 0.31, p.z - 0.05};
  return fdcg::test::joined(fdcg::test::bumpy_sphere(500, 500), other);
}

}  // namespace

int main(int argc, char** argv) {
  PolygonSoup soup;
  if (argc > 1) {
    auto read = import_mesh(argv[1]);
    if (!read) return std::fprintf(stderr, "%s\n", read.error().message.c_str()), 2;
    soup = std::move(*read);
  } else {
    soup = default_mesh();
  }
  const unsigned jobs = resolve_jobs(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0);
  const Mesh mesh = weld_points(soup, {}, Precision::f64, jobs);
  const FaceGeometry geometry(mesh, face_states(mesh));
  const Surface surface = surface_of(mesh);
  std::vector<double> ours, theirs;
  SelfIntersections found;
  Pairs pairs;
  for (int round = 0; round < kRounds; ++round) {
    ours.push_back(seconds([&] { found = find_self_intersections(mesh, geometry, {kAllElements, jobs, {}}); }));
    theirs.push_back(seconds([&] {
      std::vector<std::pair<Surface::Face_index, Surface::Face_index>> out;
      CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(surface, std::back_inserter(out));
      pairs.clear();
      for (const auto& [a, b] : out) {
        if (a != b) pairs.emplace_back(std::min<std::uint32_t>(a, b), std::max<std::uint32_t>(a, b));
      }
    }));
  }
  std::sort(pairs.begin(), pairs.end());
  const bool is_same = std::equal(found.listed.begin(), found.listed.end(), pairs.begin(), pairs.end(),
                                  [](const MeetingFaces& p, const auto& q) { return +p.a == q.first && +p.b == q.second; });
  const double ratio = median(ours) / median(theirs);
  std::printf(
      "%u faces, %u threads: %.3f s, CGAL %.3f s, ratio %.3f (bar %.2f); %zu pairs (%llu cross, %llu touch), CGAL %zu: %s\n",
      mesh.face_count(), jobs, median(ours), median(theirs), ratio, kBar, found.listed.size(),
      static_cast<unsigned long long>(found.crossing), static_cast<unsigned long long>(found.touching), pairs.size(),
      is_same ? "the same" : "DIFFERENT");
  return is_same && ratio <= kBar ? 0 : 1;
}
