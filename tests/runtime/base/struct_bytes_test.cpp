// SPDX-License-Identifier: Apache-2.0
// A program built against an older header hands in shorter structs; one built against a newer header longer ones.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;

namespace {

// fdcg_params as in an early header.
struct OlderParams {
  std::uint32_t struct_bytes;
  std::uint32_t edge_friction;
  double mu_static, mu_dynamic;
};
static_assert(sizeof(OlderParams) == offsetof(fdcg_params, stiffness_n_per_m));

// `bytes` bytes that end where the memory ends: to read or write one more is a fault.
class LastBytes {
 public:
  explicit LastBytes(std::size_t bytes) : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    void* memory = mmap(nullptr, 2 * page_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    start_ = static_cast<unsigned char*>(memory);
    REQUIRE(mprotect(start_ + page_, page_, PROT_NONE) == 0);
    at_ = start_ + page_ - bytes;
  }
  LastBytes(const LastBytes&) = delete;
  LastBytes& operator=(const LastBytes&) = delete;
  ~LastBytes() { munmap(start_, 2 * page_); }
  template <class Struct>
  [[nodiscard]] Struct* as() const {
    return reinterpret_cast<Struct*>(at_);
  }
  [[nodiscard]] fdcg_params* params() const { return as<fdcg_params>(); }

 private:
  std::size_t page_;
  unsigned char *start_ = nullptr, *at_ = nullptr;
};

std::vector<double> forces(const fdcg_graph& graph, const fdcg_params* params) {
  std::vector<double> felt;
  fdcg_contact contact = {};
  for (int tick = 0; tick < 60; ++tick) {
    const double hip_m[3] = {0.1 + 0.01 * tick, 0.02 * tick, tick == 0 ? 0.6 : 0.4};
    fdcg_result result;
    fdcg_step(&graph, params, &contact, hip_m, &result);
    felt.insert(felt.end(), result.force_n, result.force_n + 3);
  }
  return felt;
}

}  // namespace

TEST_CASE("of a struct of any size the first bytes are set, its size among them, and no more") {
  fdcg_params whole;
  fdcg_params_init(&whole, sizeof whole);
  for (std::uint32_t bytes = 0; bytes <= sizeof whole; ++bytes) {
    const LastBytes memory(bytes);
    fdcg_params_init(memory.params(), bytes);
    fdcg_params expected = whole;
    expected.struct_bytes = bytes;
    CHECK(std::memcmp(memory.params(), &expected, bytes) == 0);
  }
}

TEST_CASE("an older, shorter struct is filled, checked and used, within its memory") {
  const LastBytes memory(sizeof(OlderParams));
  fdcg_params* params = memory.params();
  fdcg_params_init(params, sizeof(OlderParams));
  CHECK(params->struct_bytes == sizeof(OlderParams));
  CHECK(params->mu_static == 0.6);
  params->mu_static = 0.9;
  params->mu_dynamic = 0.7;
  fdcg_error error = {};
  CHECK(fdcg_check_params(params, &error) == FDCG_OK);
  params->mu_static = 0.5;
  CHECK(fdcg_check_params(params, &error) == FDCG_E_ARGUMENT);
  params->mu_static = 0.9;

  const auto compiled = bake::compile(cube(), {});
  REQUIRE(compiled);
  AlignedBytes file(compiled->bytes);
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  fdcg_params whole = fdcg_make_params();
  whole.mu_static = 0.9;
  whole.mu_dynamic = 0.7;
  CHECK(forces(graph, params) == forces(graph, &whole));
  fdcg_params other = whole;
  other.mu_dynamic = 0.2;
  CHECK(forces(graph, params) != forces(graph, &other));
}

TEST_CASE("every valid struct length is accepted, others are refused") {
  fdcg_error error = {};
  for (std::uint32_t bytes = 0; bytes <= sizeof(fdcg_params) + 16; ++bytes) {
    fdcg_params params = fdcg_make_params();
    params.struct_bytes = bytes;
    const bool is_known = bytes >= 8 && bytes % 8 == 0 && bytes <= sizeof params;
    CAPTURE(bytes);
    CHECK(fdcg_check_params(&params, &error) == (is_known ? FDCG_OK : FDCG_E_ARGUMENT));
  }
  CHECK(std::string(error.message).find("the library is older than the header") != std::string::npos);
}

TEST_CASE("a newer, longer struct gets the known defaults, and is refused") {
  alignas(8) unsigned char longer[sizeof(fdcg_params) + 16];
  std::memset(longer, 0xA5, sizeof longer);
  auto* params = reinterpret_cast<fdcg_params*>(longer);
  fdcg_params_init(params, sizeof longer - 8);
  CHECK(params->struct_bytes == sizeof longer - 8);
  CHECK(params->tick_s == 0.001);
  for (std::size_t i = sizeof(fdcg_params); i < sizeof longer; ++i)
    CHECK(longer[i] == 0xA5);
  CHECK(fdcg_check_params(params, nullptr) == FDCG_E_ARGUMENT);
}

TEST_CASE("a surface in an older, shorter struct steps as in the full one, within its memory") {
  constexpr std::uint32_t kOlderBytes = offsetof(fdcg_surface, top_radius_m);  // no length yet: its default is 0
  const LastBytes memory(kOlderBytes);
  auto* const older = memory.as<fdcg_surface>();
  fdcg_surface_init(older, kOlderBytes);
  older->kind = FDCG_SURFACE_CAPSULE;
  older->radius_m = 0.05;
  fdcg_error error = {};
  REQUIRE(fdcg_check_surface(older, &error) == FDCG_OK);
  const fdcg_surface whole = fdcg_make_capsule(0.05, 0);
  const fdcg_params params = fdcg_make_params();
  fdcg_contact contacts[2] = {};
  for (int tick = 0; tick < 60; ++tick) {
    const double hip_m[3] = {0.001 * tick, 0.0005 * tick, tick == 0 ? 0.06 : 0.045};
    fdcg_result felt[2] = {};
    double normals[2][3];
    fdcg_surface_step(older, &params, &contacts[0], hip_m, &felt[0]);
    fdcg_surface_step(&whole, &params, &contacts[1], hip_m, &felt[1]);
    fdcg_surface_get_normal(older, &felt[0], normals[0]);
    fdcg_surface_get_normal(&whole, &felt[1], normals[1]);
    if (tick > 0 && tick < 15) REQUIRE(felt[1].state == FDCG_FACE);
    REQUIRE(std::memcmp(&felt[0], &felt[1], sizeof felt[0]) == 0);
    REQUIRE(std::memcmp(normals[0], normals[1], sizeof normals[0]) == 0);
  }
  fdcg_mass masses[2];
  REQUIRE(fdcg_surface_get_mass(older, &masses[0], &error) == FDCG_OK);
  REQUIRE(fdcg_surface_get_mass(&whole, &masses[1], &error) == FDCG_OK);
  CHECK(std::memcmp(&masses[0], &masses[1], sizeof masses[0]) == 0);
}
