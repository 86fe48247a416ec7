// SPDX-License-Identifier: Apache-2.0
// Steps two builds' libraries over the same ways in one program, in turns of some hundred ticks, so that what else the machine
// does falls on both alike, and neither finds what the other has left in the cache: each has a file of its own.
//   against ROUNDS BASE.fdcg HEAD.fdcg WAY...
// For each way a line: way,share of ticks in contact,base p50,base p99,head p50,head p99 (ns, of ticks in contact; of each
// figure the median of the rounds).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "side.h"
#include "stopwatch.hpp"

extern "C" const side base_side, head_side;

using namespace fdcg::test;

namespace {

constexpr std::size_t kTurn = 500;  // ticks
constexpr int kSides = 2;

struct Hip {
  double at_m[3];
};

struct Runner {
  const side* library;
  void* contact;
  std::vector<float> times;                // of ticks in contact, of a round
  std::vector<double> median, percentile;  // of each round
};

std::vector<Hip> read_way(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<Hip> way;
  for (Hip hip; file.read(reinterpret_cast<char*>(&hip), sizeof hip);)
    way.push_back(hip);
  return way;
}

void turn(Runner& runner, const std::vector<Hip>& way, std::size_t first, std::size_t end, const Stopwatch& watch) {
  for (std::size_t i = first; i < end; ++i) {
    const Hip hip = way[i];  // at hand, as it is to who has just computed it: every third of a way's is in a new line
    const std::uint64_t begin = Stopwatch::now();
    const int touches = runner.library->step(runner.contact, hip.at_m);
    const std::uint64_t done = Stopwatch::now();
    if (touches != 0) runner.times.push_back(static_cast<float>(watch.nanoseconds(begin, done)));
  }
}

double middle_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void run_way(const char* path, int rounds, Runner (&runners)[kSides], const Stopwatch& watch) {
  const std::vector<Hip> way = read_way(path);
  std::size_t touching = 0;
  for (Runner& runner : runners)
    runner.median.clear(), runner.percentile.clear();
  for (int round = 0; round < rounds; ++round) {
    for (Runner& runner : runners) {
      runner.library->restart(runner.contact);
      runner.times.clear();
    }
    for (std::size_t first = 0, t = 0; first < way.size(); first += kTurn, ++t) {
      const std::size_t end = std::min(first + kTurn, way.size());
      for (int k = 0; k < kSides; ++k)  // who begins changes from turn to turn
        turn(runners[(t + static_cast<std::size_t>(round) + static_cast<std::size_t>(k)) % kSides], way, first, end, watch);
    }
    for (Runner& runner : runners) {
      touching = runner.times.size();
      const Percentiles sorted(runner.times);
      runner.median.push_back(sorted.finely_at(0.5));
      runner.percentile.push_back(sorted.finely_at(0.99));
    }
  }
  std::printf("%s,%.4f", path, static_cast<double>(touching) / static_cast<double>(way.size()));
  for (const Runner& runner : runners)
    std::printf(",%.2f,%.2f", middle_of(runner.median), middle_of(runner.percentile));
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 4 ? std::atoi(argv[1]) : 0;
  if (rounds < 1) {
    std::fprintf(stderr, "usage: against ROUNDS BASE.fdcg HEAD.fdcg WAY...\n");
    return 2;
  }
  Runner runners[kSides] = {{&base_side, nullptr, {}, {}, {}}, {&head_side, nullptr, {}, {}, {}}};
  for (int k = 0; k < kSides; ++k) {
    char why[256];
    runners[k].contact = runners[k].library->open(argv[2 + k], why, sizeof why);
    if (runners[k].contact != nullptr) continue;
    std::fprintf(stderr, "%s: %s\n", argv[2 + k], why);
    return 3;
  }
  const Stopwatch watch;
  for (int i = 4; i < argc; ++i)
    run_way(argv[i], rounds, runners, watch);
  for (Runner& runner : runners)
    runner.library->close(runner.contact);
  return 0;
}
