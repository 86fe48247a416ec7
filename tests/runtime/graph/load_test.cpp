// SPDX-License-Identifier: Apache-2.0
// Opening and verifying files, whole and damaged. Over 400 lines: each damage has its own case.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/fdcg.hpp"
#include "meshes.hpp"
#include "random.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;

namespace {

AlignedBytes compiled(const bake::PolygonSoup& soup, const bake::CompileOptions& options = {}) {
  auto result = bake::compile(soup, options);
  REQUIRE(result);
  REQUIRE(result->report.passes());
  return AlignedBytes(result->bytes);
}

bake::CompileOptions small_f32() {
  bake::CompileOptions options;
  options.precision = bake::Precision::f32;
  options.without = {"info"};
  return options;
}

fdcg_status open(AlignedBytes& file, std::uint64_t bytes, fdcg_error& error, fdcg_verify verify = FDCG_VERIFY_FULL) {
  fdcg_graph graph;
  error = {};
  const fdcg_status status = fdcg_open_memory(file.data(), bytes, verify, &graph, &error);
  if (status != FDCG_OK) REQUIRE(graph.header == nullptr);
  return status;
}

bool loads(std::span<const std::byte> bytes) {
  AlignedBytes file(bytes);
  fdcg_graph graph;
  return fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK;
}

// Few nodes, but every kind of record: busy corner, open border, nodes that are not exactly planar, both precisions.
std::vector<AlignedBytes> varied_files() {
  bake::CompileOptions stored, derived;
  stored.without = {"info"};
  derived.without = {"info", "hierarchy"};
  derived.store_planes = false;
  std::vector<AlignedBytes> files;
  for (const auto precision : {bake::Precision::f64, bake::Precision::f32}) {
    stored.precision = derived.precision = precision;
    const auto inexact = rounded_to_float(transformed(grid_box(2, 2, 1, {1, 1, 0.5}), random_rotation(3)));
    for (const auto& soup : {l_prism(), cone(40), plane_grid(2, 2), inexact}) {
      files.push_back(compiled(soup, stored));
      files.push_back(compiled(soup, derived));
    }
  }
  return files;
}

// Changes 1 to 6 words, mostly to something that a damaged or forged file might well hold there. The header seldom.
void corrupt(AlignedBytes& file, Random& random) {
  const auto words = static_cast<std::uint32_t>(file.size() / 4), header_words = std::uint32_t{sizeof(fdcg_header) / 4};
  for (std::uint32_t changes = 1 + random.below(6); changes > 0; --changes) {
    const std::uint32_t first = random.below(16) == 0 ? 0 : header_words;
    const std::uint32_t at = first + random.below(words - first);
    std::uint32_t word, other;
    std::memcpy(&word, file.data() + 4 * at, 4);
    std::memcpy(&other, file.data() + 4 * (header_words + random.below(words - header_words)), 4);
    switch (random.below(6)) {
      case 0:
        word = other;
        break;
      case 1:
        word ^= std::uint32_t{1} << random.below(32);
        break;
      case 2:
        word += static_cast<std::uint32_t>(random.below(9)) - 4;
        break;
      case 3:  // a word of the same section's neighbourhood: another index of its kind
        std::memcpy(&word, file.data() + 4 * (at - random.below(at - first + 1) % 32), 4);
        break;
      case 4:
        word = static_cast<std::uint32_t>(random.bits());
        break;
      default:
        word = 0;
    }
    std::memcpy(file.data() + 4 * at, &word, 4);
  }
}

}  // namespace

TEST_CASE("opening a compiled file gives its graph, in both precisions and verification levels") {
  for (const auto precision : {bake::Precision::f64, bake::Precision::f32}) {
    bake::CompileOptions options;
    options.precision = precision;
    AlignedBytes file = compiled(cube(), options);
    for (const auto verify : {FDCG_VERIFY_FULL, FDCG_VERIFY_SAFE, FDCG_VERIFY_TRUSTED}) {
      fdcg_graph graph;
      fdcg_error error = {};
      REQUIRE(fdcg_open_memory(file.data(), file.size(), verify, &graph, &error) == FDCG_OK);
      CHECK(graph.header->node_count == 6);
      CHECK(graph.header->connection_count == 12);
      CHECK(graph.header->corner_count == 8);
      CHECK(graph.info_bytes > 0);
      CHECK(graph.mapping == nullptr);
      fdcg_close(&graph);
      CHECK(graph.header == nullptr);
    }
  }
}

TEST_CASE("an unknown verification level is refused") {
  AlignedBytes file = compiled(cube(), {});
  fdcg_graph graph;
  fdcg_error error = {};
  CHECK(fdcg_open_memory(file.data(), file.size(), static_cast<fdcg_verify>(3), &graph, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message).find("verify is 3") == 0);
}

TEST_CASE("every truncation of a file is refused with a message") {
  AlignedBytes file = compiled(cube(), small_f32());
  for (std::uint64_t bytes = 0; bytes < file.size(); ++bytes) {
    for (const auto verify : {FDCG_VERIFY_FULL, FDCG_VERIFY_SAFE, FDCG_VERIFY_TRUSTED}) {
      fdcg_error error;
      const fdcg_status status = open(file, bytes, error, verify);
      REQUIRE(status == FDCG_E_TRUNCATED);
      REQUIRE(error.status == status);
      REQUIRE(std::string(error.message).size() > 20);
    }
  }
}

TEST_CASE("every change of a single byte is refused with a message") {
  AlignedBytes file = compiled(cube(), small_f32());
  INFO("file of " << file.size() << " bytes");
  for (std::uint64_t at = 0; at < file.size(); ++at) {
    const unsigned char before = file.data()[at];
    for (unsigned change = 1; change < 256; ++change) {
      file.data()[at] = static_cast<unsigned char>(before ^ change);
      fdcg_error error;
      if (open(file, file.size(), error, FDCG_VERIFY_SAFE) == FDCG_OK || error.message[0] == '\0')
        FAIL("byte " << at << " xor " << change);
    }
    file.data()[at] = before;
  }
  fdcg_error error;
  REQUIRE(open(file, file.size(), error) == FDCG_OK);
}

TEST_CASE("chunks in any order, in parts of several threads, come to what opening does") {
  AlignedBytes file = compiled(star_sphere(4, 0.3, 5), {});
  fdcg_graph graph;
  fdcg_error error = {};
  REQUIRE(fdcg_open_trusted(file.data(), file.size(), &graph, &error) == FDCG_OK);
  const std::uint32_t chunks = fdcg_verify_chunk_count(&graph);
  REQUIRE(chunks > 3);
  for (const auto level : {FDCG_VERIFY_SAFE, FDCG_VERIFY_FULL}) {
    fdcg_verification parts[3] = {};
    for (std::uint32_t i = chunks; i-- > 1;)
      REQUIRE(fdcg_verify_chunk(&graph, level, i, &parts[i % 3], &error) == FDCG_OK);
    CHECK(fdcg_verify_sum(&graph, level, parts, 3, &error) == FDCG_E_ARGUMENT);  // one is missing
    REQUIRE(fdcg_verify_chunk(&graph, level, 0, &parts[0], &error) == FDCG_OK);
    CHECK(fdcg_verify_sum(&graph, level, parts, 3, &error) == FDCG_OK);
    CHECK(fdcg_verify_chunk(&graph, level, chunks, &parts[0], &error) == FDCG_E_ARGUMENT);
  }
  CHECK(fdcg_verify_chunk(&graph, FDCG_VERIFY_TRUSTED, 0, nullptr, &error) == FDCG_E_ARGUMENT);
  const_cast<fdcg_corner_f64*>(static_cast<const fdcg_corner_f64*>(graph.corners))->normal[0] ^= 1;
  fdcg_verification part = {};
  for (std::uint32_t i = 0; i < chunks; ++i)
    REQUIRE(fdcg_verify_chunk(&graph, FDCG_VERIFY_SAFE, i, &part, &error) == FDCG_OK);
  CHECK(fdcg_verify_sum(&graph, FDCG_VERIFY_SAFE, &part, 1, &error) == FDCG_E_CHECKSUM);
}

TEST_CASE("bytes after the end are refused") {
  AlignedBytes file = compiled(cube(), small_f32());
  AlignedBytes longer(std::vector<std::byte>(file.size() + 64));
  std::memcpy(longer.data(), file.data(), file.size());
  fdcg_error error;
  REQUIRE(open(longer, longer.size(), error) == FDCG_E_TRUNCATED);
}

TEST_CASE("a changed word under valid checksums is refused or harmless to step on") {
  for (const auto precision : {bake::Precision::f64, bake::Precision::f32}) {
    bake::CompileOptions options;
    options.precision = precision;
    options.without = {"info"};
    AlignedBytes file = compiled(l_prism(), options);
    std::uint64_t refused = 0, opened = 0;
    for (std::uint64_t at = 0; at + 4 <= file.size(); at += 4) {
      std::uint32_t before;
      std::memcpy(&before, file.data() + at, 4);
      for (const std::uint32_t value :
           {0u, 1u, before + 1, before - 1, before ^ 0x80000000u, 0x7FC00000u, 0xFFFFFFFFu, 0x7FFFFFFFu}) {
        std::memcpy(file.data() + at, &value, 4);
        seal(file);
        fdcg_graph graph;
        fdcg_error error = {};
        if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK) {
          ++opened;
          touch_everywhere(graph, 40);
        } else {
          REQUIRE(error.message[0] != '\0');
        }
        if (fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) ++refused;
      }
      std::memcpy(file.data() + at, &before, 4);
      seal(file);
    }
    INFO("FULL refused " << refused << ", SAFE opened " << opened);
    CHECK(opened > 1000);
    CHECK(refused > opened);
  }
}

TEST_CASE("several changed words under valid checksums are refused or harmless to step on") {
  constexpr int kCases = 20000;
  const std::vector<AlignedBytes> files = varied_files();
  int opened = 0;
  for (int i = 0; i < kCases; ++i) {
    const std::uint64_t seed = 1000 + static_cast<std::uint64_t>(i);
    INFO("seed " << seed);
    Random random(seed);
    AlignedBytes file = files[random.below(files.size())];
    corrupt(file, random);
    opened += open_and_touch(std::as_bytes(std::span(file.data(), file.size())), 40);
  }
  CHECK(opened > kCases / 50);  // else the step was hardly reached
  CHECK(opened < kCases / 2);
}

TEST_CASE("every fuzz find and seed is refused or harmless to step on") {
  int files = 0, opened = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FDCG_SOURCE_DIR "/testdata/fuzz/load")) {
    INFO(entry.path());
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    opened += open_and_touch(std::as_bytes(std::span(bytes)), 1000) > 0;
    ++files;
  }
  CHECK(files >= 8);
  CHECK(opened >= 8);
}

TEST_CASE("a corner with many faces but no fan tree is refused") {
  AlignedBytes file = compiled(cone(40), small_f32());
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
  REQUIRE(graph.header->busy_count == 1);
  const_cast<fdcg_busy_corner*>(graph.busy_corners)->first_box = FDCG_NONE;
  seal(file);
  fdcg_error error;
  CHECK(open(file, file.size(), error) == FDCG_E_GRAPH);
  CHECK(std::string(error.message).find("no tree") != std::string::npos);
}

TEST_CASE("a file of an early draft, with other records, is refused and not misread") {
  AlignedBytes file = compiled(cube(), small_f32());
  auto& header = *reinterpret_cast<fdcg_header*>(file.data());
  auto* const section = reinterpret_cast<fdcg_section*>(&header + 1);
  header.node_bytes = 0;  // the draft had zeros here, and nodes of 24 bytes
  header.flags = 0;
  REQUIRE(section->id == FDCG_SECTION_NODES);
  section->record_count = section->record_count * section->record_bytes / 24;
  section->record_bytes = 24;
  seal(file);
  fdcg_error error;
  CHECK(open(file, file.size(), error) == FDCG_E_LAYOUT);
  CHECK(std::string(error.message).find("compile the mesh again") != std::string::npos);
}

TEST_CASE("objects too large or too small for the step's arithmetic are refused") {
  bake::CompileOptions options = small_f32();
  for (const double size : {1e-70, 1e-20, 1e-10, 1e-8, 1e8, 1e10, 1e65}) {
    INFO("size " << size);
    options.precision = bake::Precision::f64;
    const auto f64 = bake::compile(scaled(cube(), size), options);
    CHECK((f64.has_value() && !f64->file().empty() && loads(f64->file())) == (size > 1e-60 && size < 1e60));
    options.precision = bake::Precision::f32;
    const auto f32 = bake::compile(scaled(cube(), size), options);
    CHECK((f32.has_value() && !f32->file().empty() && loads(f32->file())) == (size > 1e-9 && size < 1e9));
  }
}

TEST_CASE("a Voronoi plane that cannot be derived is refused") {
  bake::CompileOptions options = small_f32();
  options.store_planes = false;
  AlignedBytes file = compiled(cube(), options);
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
  auto* node = const_cast<fdcg_node_f32*>(static_cast<const fdcg_node_f32*>(graph.nodes));
  const fdcg_connection_info edge = fdcg_get_connection(&graph, fdcg_get_side(&graph, 0, 0).connection);
  for (int k = 0; k < 3; ++k)
    node->plane.normal[k] = static_cast<float>(edge.direction[k]);  // parallel: their cross product has no direction
  seal(file);
  fdcg_error error;
  CHECK(open(file, file.size(), error) == FDCG_E_GRAPH);
  CHECK(std::string(error.message).find("Voronoi") != std::string::npos);
}

TEST_CASE("optional sections may be absent without effect on the step") {
  bake::CompileOptions bare;
  bare.without = {"hierarchy", "source-map", "info"};
  bare.store_planes = false;
  AlignedBytes whole = compiled(star_sphere(1, 0.3, 5)), lean = compiled(star_sphere(1, 0.3, 5), bare);
  REQUIRE(lean.size() < whole.size() * 3 / 4);
  fdcg_graph a, b;
  REQUIRE(fdcg_open_memory(whole.data(), whole.size(), FDCG_VERIFY_FULL, &a, nullptr) == FDCG_OK);
  REQUIRE(fdcg_open_memory(lean.data(), lean.size(), FDCG_VERIFY_FULL, &b, nullptr) == FDCG_OK);
  CHECK(b.hierarchy == nullptr);
  CHECK(b.edges == nullptr);
  CHECK((a.header->flags & FDCG_STORED_PLANES) != 0);
  CHECK((b.header->flags & FDCG_STORED_PLANES) == 0);
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contact_a = {}, contact_b = {};
  std::uint32_t touching = 0;
  for (int i = 0; i < 20000; ++i) {
    const double angle = 1e-3 * i, radius = 1.05 + 0.35 * std::cos(7e-3 * i);
    const double hip[3] = {radius * std::cos(angle), radius * std::sin(angle) * 0.8, radius * std::sin(angle) * 0.6};
    fdcg_result ra, rb;
    fdcg_step(&a, &params, &contact_a, hip, &ra);
    fdcg_step(&b, &params, &contact_b, hip, &rb);
    touching += ra.state != FDCG_FREE;
    REQUIRE(std::memcmp(&ra, &rb, sizeof ra) == 0);
  }
  CHECK(touching > 5000);
}

TEST_CASE("misused calls are refused by name") {
  AlignedBytes file = compiled(cube(), small_f32());
  fdcg_graph graph;
  fdcg_error error = {};
  CHECK(fdcg_open_memory(nullptr, 100, FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, nullptr, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_open_memory(file.data() + 4, file.size() - 4, FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_ALIGNMENT);
  CHECK(fdcg_open_file(nullptr, FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_ARGUMENT);
  CHECK(fdcg_open_file("no such file", FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_IO);
  CHECK(std::string(error.message).find("no such file") != std::string::npos);
  CHECK(fdcg_open_file(".", FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_IO);
  CHECK(std::string(error.message).find("directory") != std::string::npos);
  CHECK(fdcg_open_file("/dev/null", FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_E_IO);
  fdcg_close(&graph);
  fdcg_close(nullptr);
}

TEST_CASE("a file is mapped, and a foreign one refused") {
  const AlignedBytes file = compiled(cube(), small_f32());
  const std::string path = std::filesystem::temp_directory_path() / ("fdcg-load-test-" + std::to_string(getpid()));
  const auto write = [&](const char* bytes, std::uint64_t count) {
    std::ofstream(path, std::ios::binary).write(bytes, static_cast<std::streamsize>(count));
  };
  AlignedBytes copy = file;
  write(reinterpret_cast<const char*>(copy.data()), copy.size());
  {
    fdcg::Graph graph;
    fdcg_error error = {};
    REQUIRE(graph.open_file(path.c_str(), &error));
    CHECK(graph.header().node_count == 6);
    fdcg::Graph moved = std::move(graph);
    CHECK(moved.header().node_count == 6);
  }
  for (const std::uint32_t way : {0u, 1u, 2u}) {
    fdcg_open_options options = fdcg_make_open_options();
    options.populate = way == 1;
    options.huge_pages = way == 2;
    fdcg_graph opened;
    REQUIRE(fdcg_open_file_with(path.c_str(), &options, &opened, nullptr) == FDCG_OK);
    fdcg_warm(&opened);
    CHECK(opened.mapping_bytes == copy.size());
    CHECK(std::memcmp(opened.mapping, copy.data(), copy.size()) == 0);
    fdcg_close(&opened);
    options.populate = 2;
    CHECK(fdcg_open_file_with(path.c_str(), &options, &opened, nullptr) == FDCG_E_ARGUMENT);
  }
  const std::string text(400, 'x');
  write(text.data(), text.size());
  fdcg_graph graph;
  fdcg_error error = {};
  CHECK(fdcg_open_file(path.c_str(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_MAGIC);
  CHECK(std::string(error.message).find(path) != std::string::npos);
  write("", 0);
  CHECK(fdcg_open_file(path.c_str(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_IO);
  std::remove(path.c_str());
}

TEST_CASE("a later version of the format is refused by its number") {
  AlignedBytes file = compiled(cube(), small_f32());
  file.header().format_version = 2;
  seal(file);
  fdcg_error error;
  REQUIRE(open(file, file.size(), error) == FDCG_E_VERSION);
  CHECK(std::string(error.message).find("version 2") != std::string::npos);
}

TEST_CASE("parameters out of range are refused with field, value and limit") {
  fdcg_params params = fdcg_make_params();
  fdcg_error error = {};
  REQUIRE(fdcg_check_params(&params, &error) == FDCG_OK);
  params.mu_static = 0.3;
  REQUIRE(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message) == "params.mu_static is 0.3, allowed 0.4 to 1e9 (at least mu_dynamic)");
  params.mu_static = std::numeric_limits<double>::quiet_NaN();
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  params = fdcg_make_params();
  params.stiffness_n_per_m = -1;
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  params = fdcg_make_params();
  params.reserved[0] = 7;
  CHECK(fdcg_check_params(&params, &error) == FDCG_E_ARGUMENT);
  CHECK(std::string(error.message) == "params.reserved is 7, allowed 0; start from fdcg_make_params()");
  params = fdcg_make_params();
  params.edge_friction = 7;
  CHECK(fdcg_check_params(&params, nullptr) == FDCG_E_ARGUMENT);
  CHECK(fdcg_check_params(nullptr, &error) == FDCG_E_ARGUMENT);
}
