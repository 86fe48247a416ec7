// SPDX-License-Identifier: Apache-2.0
// What `fdcg batch` costs beside its work: many small meshes compiled by it, on all cores and on one, beside one process of one
// thread that reads, compiles and writes the same files and the same reports, in turns. Exit code 1 where a ratio of wall times
// is above its bar.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"
#include "fdcg/results.hpp"

namespace fs = std::filesystem;
using namespace fdcg::bake;

namespace {

struct Cost {
  double wall_s, processor_s;
};

// An ellipsoid of 4 n (n - 1) triangles.
void write_mesh(const fs::path& path, int n, double stretch) {
  const int around = 2 * n;
  constexpr double kPi = 3.14159265358979323846;
  std::string points = "0 0 1\n", faces;
  for (int i = 1; i < n; ++i) {
    for (int j = 0; j < around; ++j) {
      const double a = kPi * i / n, b = 2 * kPi * j / around;
      char line[96];
      std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", stretch * std::sin(a) * std::cos(b), std::sin(a) * std::sin(b),
                    std::cos(a));
      points += line;
    }
  }
  points += "0 0 -1\n";
  const int last = 1 + (n - 1) * around;
  int count = 0;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * around + j % around; };
  const auto face = [&](int a, int b, int c) {
    faces += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    ++count;
  };
  for (int j = 0; j < around; ++j) {
    face(0, at(1, j), at(1, j + 1));
    face(last, at(n - 1, j + 1), at(n - 1, j));
    for (int i = 1; i + 1 < n; ++i) {
      face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  std::ofstream(path) << "OFF\n" << last + 1 << " " << count << " 0\n" << points << faces;
}

std::vector<fs::path> write_meshes(const fs::path& folder, int count) {
  std::vector<fs::path> paths;
  fs::create_directories(folder);
  for (int i = 0; i < count; ++i) {
    paths.push_back(folder / ("mesh" + std::to_string(i) + ".off"));
    write_mesh(paths.back(), 3 + i % 10, 1 + i * 1e-3);
  }
  return paths;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// Of a child process that does `work`, and of its own children.
Cost cost_of(const std::function<int()>& work) {
  std::fflush(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0) {
    std::fprintf(stderr, "a run failed\n");
    std::exit(2);
  }
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

// All in one process and thread, with what the batch leaves: files, a line for each mesh with hashes, one SARIF.
int work_alone(const std::vector<fs::path>& meshes, const fs::path& folder) {
  fs::create_directories(folder);
  std::ofstream lines(folder / "results.jsonl"), sarif(folder / "report.sarif");
  const auto writer = make_report_writer(ReportFormat::sarif, [&](std::string_view piece) { sarif << piece; }, {});
  CompileOptions options;
  options.jobs = 1;
  for (const fs::path& mesh : meshes) {
    const auto soup = import_mesh(mesh);
    if (!soup) return 1;
    const auto compiled = compile(*soup, options);
    if (!compiled || compiled->bytes.empty()) return 1;
    const std::string_view bytes{reinterpret_cast<const char*>(compiled->bytes.data()), compiled->bytes.size()};
    std::ofstream(folder / (mesh.filename().string() + ".fdcg"), std::ios::binary) << bytes;
    lines << soup->sha256 << sha256_of(bytes) << report_line(compiled->report) << "\n";
    writer->add(compiled->report);
  }
  writer->finish(0);
  return 0;
}

int work_in_batch(const std::string& program, const std::string& manifest, const fs::path& folder, const char* jobs) {
  const std::string output = folder.string();
  execl(program.c_str(), "fdcg", "batch", "--manifest", manifest.c_str(), "-o", output.c_str(), "--quiet", "--jobs", jobs,
        nullptr);
  return 127;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const std::string program = argc > 1 ? argv[1] : FDCG_PROGRAM;
  const int count = argc > 2 ? std::atoi(argv[2]) : 2000, rounds = argc > 3 ? std::atoi(argv[3]) : 5;
  const fs::path shm = "/dev/shm";  // in memory where it can be, so that no disk is measured
  const fs::path folder =
      (fs::is_directory(shm) ? shm : fs::temp_directory_path()) / ("fdcg_batch_bench_" + std::to_string(getpid()));
  const std::vector<fs::path> meshes = write_meshes(folder / "meshes", count);
  const std::string manifest = (folder / "manifest.json").string();
  std::ofstream(manifest) << R"({"meshes": [")" << (folder / "meshes").string() << R"("], "rules": [{"action": "compile"}]})";
  struct Contender {
    const char* name;
    double wall_bar;
    std::function<int()> work;
    std::vector<double> wall{}, processor{};
  };
  const fs::path out = folder / "out";
  const std::string cores = std::to_string(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
  std::vector<Contender> contenders{{"alone", 0, [&] { return work_alone(meshes, out); }},
                                    {"batch", 1.2, [&] { return work_in_batch(program, manifest, out, cores.c_str()); }},
                                    {"batch, one job", 0, [&] { return work_in_batch(program, manifest, out, "1"); }}};
  for (int round = 0; round < rounds; ++round) {
    for (Contender& contender : contenders) {
      fs::remove_all(out);
      const Cost cost = cost_of(contender.work);
      contender.wall.push_back(cost.wall_s);
      contender.processor.push_back(cost.processor_s);
    }
  }
  fs::remove_all(folder);
  bool holds = true;
  std::printf("%d meshes of 24 to 528 triangles; ratios to one process of one thread, with the bar in brackets\n", count);
  for (const Contender& contender : contenders) {
    const double wall = median(contender.wall), ratio = wall / median(contenders.front().wall);
    const double processor = median(contender.processor), processor_ratio = processor / median(contenders.front().processor);
    const bool is_missed = contender.wall_bar > 0 && ratio > contender.wall_bar;
    holds = holds && !is_missed;
    std::printf("%-15s %7.3f s, x %.2f", contender.name, wall, ratio);
    if (contender.wall_bar > 0) std::printf("%s (%.2f)", is_missed ? " MISSED" : "", contender.wall_bar);
    std::printf("; processors %7.3f s, x %.2f\n", processor, processor_ratio);
  }
  return holds ? 0 : 1;
}
