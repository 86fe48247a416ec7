// SPDX-License-Identifier: Apache-2.0
// Weld, topology and checks on about a million triangles: in file order, as an STL file has them, and shuffled.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "soups.hpp"
#include "topology/topology.hpp"
#include "topology/weld.hpp"
#include "validate/validate.hpp"

using namespace fdcg::bake;

namespace {

enum Layout : int { kIndexed, kLoose, kShuffled };

const PolygonSoup& soup_of(int layout) {
  static const PolygonSoup indexed = fdcg::test::bumpy_sphere(708, 708);
  static const PolygonSoup loose = [] {
    PolygonSoup soup = indexed;
    soup.format = Format::stl;
    soup.points.clear();
    for (std::uint32_t& corner : soup.corners) {
      soup.points.push_back(indexed.points[corner]);
      corner = static_cast<std::uint32_t>(soup.points.size() - 1);
    }
    return soup;
  }();
  static const PolygonSoup shuffled = [] {
    PolygonSoup soup = indexed;
    std::mt19937 rng(1);
    std::vector<std::uint32_t> vertex(soup.points.size()), face(soup.face_count());
    std::iota(vertex.begin(), vertex.end(), 0U);
    std::iota(face.begin(), face.end(), 0U);
    std::shuffle(vertex.begin(), vertex.end(), rng);
    std::shuffle(face.begin(), face.end(), rng);
    for (std::size_t v = 0; v < vertex.size(); ++v)
      soup.points[vertex[v]] = indexed.points[v];
    for (std::size_t h = 0; h < soup.corners.size(); ++h) {
      soup.corners[h] = vertex[indexed.corners[std::size_t{3} * face[h / 3] + h % 3]];
    }
    return soup;
  }();
  return layout == kIndexed ? indexed : layout == kLoose ? loose : shuffled;
}

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(soup_of(0).face_count()));
}

void weld(benchmark::State& state) {
  const PolygonSoup& soup = soup_of(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(weld_points(soup, {}, Precision::f64));
  count(state);
}

void topology(benchmark::State& state) {
  const Mesh mesh = weld_points(soup_of(static_cast<int>(state.range(0))), {}, Precision::f64);
  for (auto _ : state)
    benchmark::DoNotOptimize(pair_halfedges(mesh));
  count(state);
}

void whole_validation(benchmark::State& state) {
  const PolygonSoup& soup = soup_of(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(validate(soup));
  count(state);
}

}  // namespace

BENCHMARK(weld)->DenseRange(kIndexed, kShuffled)->Unit(benchmark::kMillisecond);
BENCHMARK(topology)->DenseRange(kIndexed, kShuffled)->Unit(benchmark::kMillisecond);
BENCHMARK(whole_validation)->DenseRange(kIndexed, kShuffled)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
