// SPDX-License-Identifier: Apache-2.0
// Mutations of small graphs, sealed again with right checksums: none that is SAFE leads to undefined behaviour or a tick
// without end, stepped or deformed. Run, of a build with sanitizers: fdcg_mutate_load testdata/fuzz/load [EXECUTIONS [SEED]]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fdcg/body.h"
#include "fdcg/deform.h"
#include "fdcg/pile.h"
#include "sealed_bytes.hpp"

using namespace fdcg::test;

namespace {

struct Random {
  std::uint64_t state;
  std::uint64_t bits() {
    state += 0x9E3779B97F4A7C15;
    std::uint64_t mixed = (state ^ state >> 30) * 0xBF58476D1CE4E5B9;
    mixed = (mixed ^ mixed >> 27) * 0x94D049BB133111EB;
    return mixed ^ mixed >> 31;
  }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>((bits() >> 32) * count >> 32); }
};

// What a forged word might be: another of the file's, one of its neighbours', a number nearby, a limit, a special real.
std::uint32_t forged(AlignedBytes& file, std::uint32_t at, Random* random) {
  const auto words = static_cast<std::uint32_t>(file.size() / 4);
  const fdcg_header& header = file.header();
  const auto word_at = [&](std::uint32_t index) {
    std::uint32_t word;
    std::memcpy(&word, file.data() + std::uint64_t{4} * index, 4);
    return word;
  };
  const std::uint32_t word = word_at(at);
  const std::uint32_t counts[] = {header.node_count, header.connection_count, header.corner_count, 2 * header.connection_count};
  const std::uint32_t reals[] = {0x7FC00000, 0x7F800000, 0xFF800000, 0x7FF00000, 0x7FF80000, 1, 0x80000000, 0x00800000};
  switch (random->below(9)) {
    case 0:
      return word_at(random->below(words));
    case 1:
      return word_at(at - random->below(at < 24 ? at : 24));
    case 2:
      return word ^ std::uint32_t{1} << random->below(32);
    case 3:
      return word + random->below(9) - 4;
    case 4:
      return counts[random->below(4)] - random->below(3);
    case 5:
      return reals[random->below(8)];
    case 6:
      return random->below(counts[random->below(4)] + 1);
    case 7:
      return (word & ~(0xFFu << 8 * random->below(4))) | random->below(256) << 8 * random->below(4);
    default:
      return random->below(2) == 0 ? 0 : FDCG_NONE;
  }
}

// Words mostly: and sometimes a record is exchanged for another, or two neighbours' for each other.
void mutate(AlignedBytes* file, Random* random) {
  const auto words = static_cast<std::uint32_t>(file->size() / 4);
  constexpr std::uint32_t kHeader = sizeof(fdcg_header) / 4;
  for (std::uint32_t changes = 1 + random->below(random->below(4) == 0 ? 12 : 3); changes > 0; --changes) {
    const std::uint32_t first = random->below(24) == 0 ? 0 : kHeader + 10 * file->header().section_count % 640;
    const std::uint32_t at = first < words ? first + random->below(words - first) : random->below(words);
    if (random->below(8) == 0) {
      const std::uint32_t length = 1 + random->below(16), from = random->below(words - 16);
      const std::uint32_t to = at + length < words ? at : words - length - 1;
      std::memmove(file->data() + std::uint64_t{4} * to, file->data() + std::uint64_t{4} * from, std::uint64_t{4} * length);
      continue;
    }
    const std::uint32_t word = forged(*file, at, random);
    std::memcpy(file->data() + std::uint64_t{4} * at, &word, 4);
  }
}

void deform(const fdcg_graph& graph, Random* random) {
  const std::uint64_t bytes = fdcg_deform_bytes(&graph);
  if (bytes == 0 || bytes > 1 << 22) return;
  std::vector<std::uint64_t> memory(bytes / 8 + 1);
  fdcg_deform* made;
  fdcg_error error;
  if (fdcg_deform_create(memory.data(), memory.size() * 8, &graph, nullptr, &made, &error) != FDCG_OK) return;
  const fdcg_params params = fdcg_make_params();
  fdcg_deform_contact contact = {};
  fdcg_result result;
  const fdcg_header& header = *graph.header;
  const auto place = [&](double(&at)[3]) {
    for (int k = 0; k < 3; ++k) {
      const double share = static_cast<double>(random->bits() >> 11) * 0x1p-53;
      at[k] = (header.bounds_min[k] + share * (header.bounds_max[k] - header.bounds_min[k]) + header.origin[k]) *
              header.metres_per_unit;
    }
  };
  for (int tick = 0; tick < 6; ++tick) {
    double at[3];
    place(at);
    (void)fdcg_deform_move(made, random->below(header.corner_count), at, &error);
    place(at);
    fdcg_deform_step(made, &params, &contact, at, &result);
  }
  (void)fdcg_deform_get_graph(made);
}

void look_at_records(const fdcg_graph& graph) {
  std::uint32_t entries[8];
  for (std::uint32_t v = 0; v < graph.header->corner_count; ++v)
    (void)fdcg_get_fan(&graph, v, entries, 8);
  for (std::uint32_t c = 0; c < graph.header->connection_count; ++c)
    (void)fdcg_get_connection(&graph, c);
  double points[8][3];
  std::uint32_t count;
  fdcg_error error;
  if (graph.header->corner_count < 64) (void)fdcg_pick_points(&graph, points, 8, &count, &error);
  fdcg_mass mass;
  (void)fdcg_get_mass(&graph, &mass, &error);
  look_at_visual(graph);
  look_at_heights(graph);
}

struct Running {
  std::uint64_t seed;
  bool is_full;
};

void tell(void* context, const char* condition, const char* file, std::uint32_t line) {
  const auto& running = *static_cast<const Running*>(context);
  std::fprintf(stderr, "seed %llu (%s): %s:%u: %s\n", (unsigned long long)running.seed, running.is_full ? "FULL" : "SAFE", file,
               line, condition);
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: %s FOLDER [EXECUTIONS [SEED]]\n", argv[0]), 2;
  const std::uint64_t executions = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 100000;
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());  // whatever the file system: a seed is to mean the same everywhere
  std::vector<AlignedBytes> files;
  for (const std::filesystem::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    files.emplace_back(std::as_bytes(std::span(bytes)));
  }
  if (files.empty()) return std::fprintf(stderr, "no files in %s\n", argv[1]), 2;
  std::uint64_t opened = 0, full = 0;
  double longest_s = 0;
  Running running = {};
  fdcg_set_assert_handler(tell, &running);
  for (std::uint64_t i = 0; i < executions; ++i) {
    Random random{(seed + i) * 0x2545F4914F6CDD1D};
    AlignedBytes file = files[random.below(static_cast<std::uint32_t>(files.size()))];
    mutate(&file, &random);
    seal(file);
    const auto begin = std::chrono::steady_clock::now();
    fdcg_graph graph;
    const bool is_full = fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK;
    const bool is_safe = fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, nullptr) == FDCG_OK;
    if (is_full && !is_safe) return std::fprintf(stderr, "seed %llu: FULL, but not SAFE\n", (unsigned long long)(seed + i)), 1;
    full += is_full;
    running = {seed + i, is_full};
    if (!is_safe) continue;
    ++opened;
    touch_everywhere(graph, 24);
    look_at_records(graph);
    deform(graph, &random);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    longest_s = seconds > longest_s ? seconds : longest_s;
  }
  std::printf("%llu mutations from seed %llu: %llu SAFE, %llu of them FULL; the longest took %.3f s\n",
              (unsigned long long)executions, (unsigned long long)seed, (unsigned long long)opened, (unsigned long long)full,
              longest_s);
  return 0;
}
