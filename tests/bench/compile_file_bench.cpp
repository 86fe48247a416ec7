// SPDX-License-Identifier: Apache-2.0
// What a mesh file costs from reading it on: checks without self-intersections, `validate` as it is by default, `compile` into
// a buffer that was used before (which counts as memory from the start), and into fresh memory, as the program does, beside
// OpenMesh's reading and normals of the same file, in turns in one run, each in a process of its own, whose processor time and
// memory can be told. Exit code 1 where a ratio or the memory is above its bar.
#include <sys/mman.h>
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
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/heap.hpp"
#include "fdcg/bake.hpp"

using namespace fdcg::bake;

namespace {

constexpr double kMebibyte = 1 << 20;

struct Settings {
  double millions = 1;  // triangles
  unsigned jobs = 0;
  int rounds = 5;
  bool is_double = false;
  std::string only;   // the name of a contender, without OpenMesh beside it; empty: all
  std::string write;  // the mesh to this file, and nothing else
};

// A bumpy torus of 2 * around * across triangles.
template <class Real>
void write_torus(const std::filesystem::path& path, int around, int across) {
  static_assert(std::endian::native == std::endian::little);
  const std::string type = sizeof(Real) == 4 ? "float" : "double";
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << around * across << "\nproperty " << type << " x\nproperty "
       << type << " y\nproperty " << type << " z\nelement face " << 2 * around * across
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  constexpr double kTurn = 6.283185307179586;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = kTurn * i / around, b = kTurn * j / across, r = 0.4 + 0.02 * std::sin(9 * a + 5 * b);
      const Real point[3] = {static_cast<Real>((1 + r * std::cos(b)) * std::cos(a)),
                             static_cast<Real>((1 + r * std::cos(b)) * std::sin(a)), static_cast<Real>(r * std::sin(b))};
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

// What this process has used so far.
Cost used() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) * 1024 / kMebibyte};
}

// A virtual machine that gives its free memory back to its host gets it again far more slowly than a machine clears a page.
// Memory that was just in use is what the next run gets, whichever contender it is.
void take_memory_from_host(std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return;
  madvise(memory, bytes, MADV_HUGEPAGE);
  std::memset(memory, 1, bytes);
  munmap(memory, bytes);
}

// Of `work` in a child, after `prepare` there.
Cost cost_of(const std::function<void()>& prepare, const std::function<bool()>& work, std::size_t memory_bytes) {
  take_memory_from_host(memory_bytes);
  std::fflush(nullptr);
  int ends[2];
  const bool has_pipe = pipe(ends) == 0;
  const pid_t child = has_pipe ? fork() : -1;
  if (child == 0) {
    prepare();
    const Cost before = used();
    const bool is_good = work();
    const Cost after = used();
    const Cost cost{after.wall_s - before.wall_s, after.processor_s - before.processor_s, after.memory_mib};
    _exit(is_good && write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  Cost cost;
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0 || read(ends[0], &cost, sizeof cost) != sizeof cost) {
    std::fprintf(stderr, "a run failed\n");
    std::exit(2);
  }
  close(ends[0]);
  close(ends[1]);
  return cost;
}

Cost median(std::vector<Cost> costs) {
  const auto by = [&](auto member) {
    std::sort(costs.begin(), costs.end(), [&](const Cost& a, const Cost& b) { return a.*member < b.*member; });
    return costs[costs.size() / 2].*member;
  };
  return {by(&Cost::wall_s), by(&Cost::processor_s), by(&Cost::memory_mib)};
}

bool read_by_openmesh(const std::string& path) {
  OpenMesh::TriMesh_ArrayKernelT<> mesh;
  mesh.request_face_normals();
  mesh.request_vertex_normals();
  if (!OpenMesh::IO::read_mesh(mesh, path)) return false;
  mesh.update_normals();
  return true;
}

bool is_valid(const std::string& path, unsigned jobs, bool with_self_intersections) {
  const auto soup = import_mesh(path);
  if (!soup) return false;
  ValidateOptions options;
  if (!with_self_intersections) options.severities["self-intersection"] = std::nullopt;
  options.jobs = jobs;
  return validate(*soup, options).passes();
}

std::span<std::byte> fresh_buffer(std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) std::exit(2);
  madvise(memory, bytes, MADV_HUGEPAGE);
  return {static_cast<std::byte*>(memory), bytes};
}

// Memory for output that has been used before, as that of a program which compiles one mesh after the other.
std::span<std::byte> used_buffer(std::size_t bytes) {
  const std::span<std::byte> buffer = fresh_buffer(bytes);
  std::memset(buffer.data(), 0xAA, bytes);
  return buffer;
}

bool compiles(const std::string& path, unsigned jobs, std::span<std::byte> buffer) {
  auto soup = import_mesh(path);
  if (!soup) return false;
  CompileOptions options;
  options.jobs = jobs;
  options.allocate = [&](std::size_t bytes) {
    fdcg::tools::give_back_free_memory();  // as the program does
    if (buffer.empty()) return fresh_buffer(bytes);
    return bytes <= buffer.size() ? buffer.first(bytes) : std::span<std::byte>{};
  };
  const auto compiled = compile(std::move(*soup), options);
  return compiled && !compiled->file().empty() && compiled->no_mass.empty();
}

struct Contender {
  const char* name;
  double wall_bar, processor_bar;  // of OpenMesh's; 0: none
  double byte_bar;                 // a triangle; 0: none
  std::function<void()> prepare;
  std::function<bool()> work;
  std::vector<Cost> costs{};
};

int compare(const Settings& settings, const std::string& path) {
  const bool is_large = settings.millions >= 5;
  const auto nothing = [] {};
  const auto ours = [] { fdcg::tools::keep_large_arrays(); };  // as the program does
  std::span<std::byte> buffer;
  constexpr double kLargestFile = 262;  // bytes a triangle
  const auto with_buffer = [&] {
    fdcg::tools::keep_large_arrays();
    buffer = used_buffer(static_cast<std::size_t>(kLargestFile * 1e6 * settings.millions) + 65536);
  };
  std::vector<Contender> contenders{
      {"openmesh", 0, 0, 0, nothing, [&] { return read_by_openmesh(path); }},
      {"checks", is_large ? 0.5 : 0.75, 0, 120, ours, [&] { return is_valid(path, settings.jobs, false); }},
      {"validate", is_large ? 0.7 : 0.8, 0, 0, ours, [&] { return is_valid(path, settings.jobs, true); }},
      {"compile", 1.5, is_large ? 0 : 2.2, 0, with_buffer, [&] { return compiles(path, settings.jobs, buffer); }},
      {"fresh", 1.5, is_large ? 0 : 2.2, 350, ours, [&] { return compiles(path, settings.jobs, {}); }}};
  if (!settings.only.empty()) std::erase_if(contenders, [&](const Contender& c) { return c.name != settings.only; });
  const auto memory_bytes = static_cast<std::size_t>(700e6 * settings.millions);  // more than any of them takes
  for (int round = 0; round < settings.rounds; ++round) {
    for (Contender& contender : contenders)
      contender.costs.push_back(cost_of(contender.prepare, contender.work, memory_bytes));
  }
  bool holds = true;
  const auto bar = [&](double value, double limit) {
    holds = holds && (limit == 0 || value <= limit);
    return limit == 0 ? std::string{} : (value <= limit ? " (" : " MISSED (") + std::to_string(limit).substr(0, 4) + ")";
  };
  std::printf("%.1f M triangles, %s; times beside OpenMesh's, with the bar in brackets\n", settings.millions,
              settings.is_double ? "double" : "float");
  const Cost them = median(contenders.front().costs);
  for (const Contender& contender : contenders) {
    const Cost us = median(contender.costs);
    const double wall = us.wall_s / them.wall_s, processor = us.processor_s / them.processor_s;
    const double bytes = us.memory_mib * kMebibyte / (settings.millions * 1e6);
    std::printf("%-9s %7.3f s, x %.2f%s; processors %7.3f s, x %.2f%s; %5.0f bytes a triangle%s\n", contender.name, us.wall_s,
                wall, bar(wall, contender.wall_bar).c_str(), us.processor_s, processor,
                bar(processor, contender.processor_bar).c_str(), bytes, bar(bytes, contender.byte_bar).c_str());
  }
  return holds ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    if (option == "--double") {
      settings.is_double = true;
      continue;
    }
    if (option == "--millions") settings.millions = std::atof(value.c_str());
    if (option == "--jobs") settings.jobs = static_cast<unsigned>(std::atoi(value.c_str()));
    if (option == "--rounds") settings.rounds = std::max(1, std::atoi(value.c_str()));
    if (option == "--only") settings.only = value;
    if (option == "--write") settings.write = value;
    ++i;
  }
  const int across = static_cast<int>(std::lround(std::sqrt(settings.millions * 250'000)));
  const std::filesystem::path shm = "/dev/shm";  // in memory where it can be, so that no disk is measured
  const std::filesystem::path folder = std::filesystem::is_directory(shm) ? shm : std::filesystem::temp_directory_path();
  const bool is_written_only = !settings.write.empty();
  const std::filesystem::path path = is_written_only
                                         ? std::filesystem::path(settings.write)
                                         : folder / ("fdcg_compile_file_bench_" + std::to_string(getpid()) + ".ply");
  settings.is_double ? write_torus<double>(path, 2 * across, across) : write_torus<float>(path, 2 * across, across);
  if (is_written_only) return 0;
  const int code = compare(settings, path.string());
  std::filesystem::remove(path);
  return code;
}
