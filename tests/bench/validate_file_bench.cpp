// SPDX-License-Identifier: Apache-2.0
// Import and all checks but self-intersection of a binary PLY, beside what OpenMesh needs to read that file, in turns in the
// same run, each in a process of its own so that its memory can be told. Arguments: millions of triangles (default 1), threads
// (default: all). Exit code 1 where the ratio of the medians or the memory is above its bar.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

using namespace fdcg::bake;

namespace {

constexpr int kRounds = 5;
constexpr double kMebibyte = 1 << 20;

// A bumpy torus of 2 * around * across triangles.
void write_torus(const std::filesystem::path& path, int around, int across) {
  static_assert(std::endian::native == std::endian::little);
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << around * across
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << 2 * around * across
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  constexpr double kTurn = 6.283185307179586;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = kTurn * i / around, b = kTurn * j / across, r = 0.4 + 0.02 * std::sin(9 * a + 5 * b);
      const float point[3] = {static_cast<float>((1 + r * std::cos(b)) * std::cos(a)),
                              static_cast<float>((1 + r * std::cos(b)) * std::sin(a)), static_cast<float>(r * std::sin(b))};
      file.write(reinterpret_cast<const char*>(point), sizeof point);
    }
  }
  const auto at = [&](int i, int j) { return i % around * across + j % across; };
  const auto triangle = [&](int a, int b, int c) {
    const int corners[3] = {a, b, c};
    file.put(3);
    file.write(reinterpret_cast<const char*>(corners), sizeof corners);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

struct Cost {
  double wall_s = 0, processor_s = 0, memory_mib = 0;
};

// Of `work` in a child, which says by its exit code whether all went well.
template <class Work>
Cost cost_of(Work work) {
  std::fflush(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) _exit(work() ? 0 : 1);
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0) {
    std::fprintf(stderr, "a run failed\n");
    std::exit(2);
  }
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) * 1024 / kMebibyte};
}

Cost median(std::vector<Cost> costs) {
  const auto by = [&](auto member) {
    std::sort(costs.begin(), costs.end(), [&](const Cost& a, const Cost& b) { return a.*member < b.*member; });
    return costs[costs.size() / 2].*member;
  };
  return {by(&Cost::wall_s), by(&Cost::processor_s), by(&Cost::memory_mib)};
}

void print(const char* what, const Cost& cost) {
  std::printf("%-20s %7.3f s, %7.3f s of processors, %6.0f MiB\n", what, cost.wall_s, cost.processor_s, cost.memory_mib);
}

}  // namespace

int main(int argc, char** argv) {
  const double millions = argc > 1 ? std::atof(argv[1]) : 1;
  const unsigned jobs = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0;
  const int across = static_cast<int>(std::lround(std::sqrt(millions * 250'000)));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("fdcg_validate_file_bench_" + std::to_string(getpid()) + ".ply");
  write_torus(path, 2 * across, across);
  std::vector<Cost> ours, theirs;
  for (int round = 0; round < kRounds; ++round) {
    theirs.push_back(cost_of([&] {
      OpenMesh::TriMesh_ArrayKernelT<> mesh;
      return OpenMesh::IO::read_mesh(mesh, path.string());
    }));
    ours.push_back(cost_of([&] {
      const auto soup = import_mesh(path);
      if (!soup) return false;
      ValidateOptions options;
      options.severities["self-intersection"] = std::nullopt;
      options.jobs = jobs;
      return validate(*soup, options).passes();
    }));
  }
  std::filesystem::remove(path);
  const Cost us = median(ours), them = median(theirs);
  const bool is_large = millions >= 5;
  const double bar = is_large ? 0.5 : 0.75, memory_bar = 1.2e9 / kMebibyte * std::max(1.0, millions / 10);
  print("OpenMesh, read", them);
  print("import and validate", us);
  std::printf("%.1f M triangles: ratio %.2f (bar %.2f), of processor time %.2f, memory %.0f MiB (bar %.0f)\n", millions,
              us.wall_s / them.wall_s, bar, us.processor_s / them.processor_s, us.memory_mib, memory_bar);
  return us.wall_s <= bar * them.wall_s && us.memory_mib <= memory_bar ? 0 : 1;
}
