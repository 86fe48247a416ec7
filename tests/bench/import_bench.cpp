// SPDX-License-Identifier: Apache-2.0
// Reading a million triangles: ours beside OpenMesh, in one run, because ratios carry over between machines and times do not.
#include <benchmark/benchmark.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace {

constexpr int kCells = 707;  // 2 * 707^2 triangles: just under a million

struct Grid {
  std::vector<float> points;
  std::vector<std::int32_t> corners;
};

Grid make_grid() {
  Grid grid;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      grid.points.insert(grid.points.end(), {x * 1e-3F, y * 1e-3F, 0.1F * std::sin(x * 0.05F) * std::cos(y * 0.04F)});
    }
  }
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const int a = i * (kCells + 1) + j, b = a + 1, c = a + kCells + 1, d = c + 1;
      grid.corners.insert(grid.corners.end(), {a, c, b, b, c, d});
    }
  }
  return grid;
}

template <class T>
void put(std::ofstream& file, const T* values, std::size_t count) {
  file.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

// The same mesh in each format, in a folder in memory where there is one, so that no disk is measured.
std::string mesh_file(const std::string& ending) {
  const std::filesystem::path shm = "/dev/shm";
  const auto folder = std::filesystem::is_directory(shm) ? shm : std::filesystem::temp_directory_path();
  const std::string path = (folder / ("fdcg-bench-import" + ending)).string();
  if (std::filesystem::exists(path)) return path;
  const Grid grid = make_grid();
  const std::size_t vertices = grid.points.size() / 3, faces = grid.corners.size() / 3;
  std::ofstream file(path, std::ios::binary);
  if (ending == ".ply") {
    file << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces
         << "\nproperty list uchar int vertex_indices\nend_header\n";
    put(file, grid.points.data(), grid.points.size());
    for (std::size_t f = 0; f < faces; ++f) {
      file.put(3);
      put(file, &grid.corners[3 * f], 3);
    }
  } else if (ending == ".stl") {
    const auto count = static_cast<std::uint32_t>(faces);
    file << std::string(80, ' ');
    put(file, &count, 1);
    for (std::size_t f = 0; f < faces; ++f) {
      const float normal[3] = {0, 0, 1};
      put(file, normal, 3);
      for (std::size_t k = 0; k < 3; ++k)
        put(file, &grid.points[3 * static_cast<std::size_t>(grid.corners[3 * f + k])], 3);
      file.write("\0\0", 2);
    }
  } else {
    const bool is_obj = ending == ".obj";
    if (!is_obj) file << "OFF\n" << vertices << ' ' << faces << " 0\n";
    for (std::size_t v = 0; v < vertices; ++v) {
      file << (is_obj ? "v " : "") << grid.points[3 * v] << ' ' << grid.points[3 * v + 1] << ' ' << grid.points[3 * v + 2]
           << '\n';
    }
    const int first = is_obj ? 1 : 0;
    for (std::size_t f = 0; f < faces; ++f) {
      file << (is_obj ? "f " : "3 ") << grid.corners[3 * f] + first << ' ' << grid.corners[3 * f + 1] + first << ' '
           << grid.corners[3 * f + 2] + first << '\n';
    }
  }
  return path;
}

void ours(benchmark::State& state, const std::string& ending) {
  const std::string path = mesh_file(ending);
  for (auto _ : state) {
    const auto soup = fdcg::bake::import_mesh(path);
    if (!soup || soup->face_count() != std::size_t{2} * kCells * kCells) state.SkipWithError("not read");
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(std::filesystem::file_size(path)));
}

void open_mesh(benchmark::State& state, const std::string& ending) {
  const std::string path = mesh_file(ending);
  for (auto _ : state) {
    OpenMesh::TriMesh_ArrayKernelT<> mesh;
    if (!OpenMesh::IO::read_mesh(mesh, path) || mesh.n_faces() != std::size_t{2} * kCells * kCells)
      state.SkipWithError("not read");
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(std::filesystem::file_size(path)));
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string ending : {".ply", ".stl", ".obj", ".off"}) {
    for (const bool is_ours : {true, false}) {
      benchmark::RegisterBenchmark(
          (std::string(is_ours ? "fdcg" : "OpenMesh") + "/1M" + ending).c_str(),
          [ending, is_ours](benchmark::State& state) { is_ours ? ours(state, ending) : open_mesh(state, ending); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime()
          ->Repetitions(5)
          ->ReportAggregatesOnly();
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  for (const std::string ending : {".ply", ".stl", ".obj", ".off"})
    std::filesystem::remove(mesh_file(ending));
  return 0;
}
