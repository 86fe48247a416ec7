// SPDX-License-Identifier: Apache-2.0
// What the processor's state does to opening a graph, and what a HIP that is no number does to the ticks after it.
#include <cfenv>
#include <cmath>
#include <limits>
#include <string>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "compiled.hpp"
#include "fdcg/deform.h"
#include "fdcg/surface.h"
#include "meshes.hpp"
#include "scene_rig.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Opened {
  bake::Compiled compiled;
  fdcg_graph graph{};
  explicit Opened(const bake::CompileOptions& options = {}) : compiled(compile_whole(cube(), options)) {
    fdcg_error error;
    REQUIRE(fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_SAFE, &graph, &error) == FDCG_OK);
  }
};

bool is_finite(const fdcg_result& result) {
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(result.force_n[k]) || !std::isfinite(result.god_object_m[k])) return false;
  }
  return true;
}

// Presses, loses its HIP in each coordinate in turn, and presses on. `step`: void(hip, fdcg_result*).
template <class Step>
void check_that_no_number_is_forgotten(Step step) {
  fdcg_result result;
  double hip[3] = {0.1, 0.1, 0.6};
  step(hip, &result);
  hip[2] = 0.49;
  step(hip, &result);
  REQUIRE(result.state == FDCG_FACE);
  const double force = result.force_n[2];
  CHECK(force > 0);
  for (int k = 0; k < 3; ++k) {
    for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL, 1e300}) {
      double lost[3] = {0.1, 0.1, 0.49};
      lost[k] = bad;
      step(lost, &result);
      CHECK(is_finite(result));
      CHECK((result.flags & FDCG_RESULT_NON_FINITE) != 0);
      CHECK(result.force_n[2] == 0);
      step(hip, &result);
      CHECK(is_finite(result));
      CHECK(result.force_n[2] == force);
    }
  }
}

}  // namespace

TEST_CASE("a graph is not opened while the processor rounds otherwise than to nearest") {
  const bake::Compiled compiled = compile_whole(cube());
  const auto opened = [&](fdcg_error* error) {
    fdcg_graph graph;
    return fdcg_open_memory(compiled.bytes.data(), compiled.bytes.size(), FDCG_VERIFY_TRUSTED, &graph, error);
  };
  fdcg_error error;
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const fdcg_status status = opened(&error);
    std::fesetround(FE_TONEAREST);
    CHECK(status == FDCG_E_ARITHMETIC);
    CHECK(std::string(error.message).find("fesetround(FE_TONEAREST)") != std::string::npos);
  }
  CHECK(opened(&error) == FDCG_OK);
}

#if defined(__SSE2__)
TEST_CASE("a graph is not opened while the processor loses subnormal numbers") {
  const bake::Compiled compiled = compile_whole(cube());
  const unsigned before = _mm_getcsr();
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
  for (const unsigned state : {kFlushToZero, kDenormalsAreZero, kFlushToZero | kDenormalsAreZero}) {
    fdcg_graph graph;
    fdcg_error error;
    _mm_setcsr(before | state);
    const fdcg_status status = fdcg_open_trusted(compiled.bytes.data(), compiled.bytes.size(), &graph, &error);
    _mm_setcsr(before);
    CHECK(status == FDCG_E_ARITHMETIC);
    CHECK(std::string(error.message).find("subnormal") != std::string::npos);
  }
}
#endif

TEST_CASE("after a HIP that is no number the next tick goes on from before") {
  const Opened opened;
  const fdcg_params params = fdcg_make_params();
  SECTION("on a graph") {
    fdcg_contact contact = {};
    check_that_no_number_is_forgotten(
        [&](const double* hip, fdcg_result* result) { fdcg_step(&opened.graph, &params, &contact, hip, result); });
  }
  SECTION("with the friction curve and damping") {
    fdcg_params all = params;
    all.friction_flags = FDCG_FRICTION_STRIBECK | FDCG_FRICTION_VISCOUS | FDCG_FRICTION_LAG | FDCG_FRICTION_PRESLIDING;
    fdcg_contact contact = {};
    check_that_no_number_is_forgotten(
        [&](const double* hip, fdcg_result* result) { fdcg_step(&opened.graph, &all, &contact, hip, result); });
  }
  SECTION("on a surface") {
    const fdcg_surface box = fdcg_make_box(0.5, 0.5, 0.5);
    fdcg_contact contact = {};
    check_that_no_number_is_forgotten(
        [&](const double* hip, fdcg_result* result) { fdcg_surface_step(&box, &params, &contact, hip, result); });
  }
  SECTION("on a deformable mesh") {
    bake::CompileOptions options;
    options.triangles = true;
    const Opened triangles(options);
    std::vector<std::uint64_t> memory(fdcg_deform_bytes(&triangles.graph) / 8 + 8);
    const fdcg_deform_config config = fdcg_make_deform_config();
    fdcg_deform* deform = nullptr;
    fdcg_error error;
    REQUIRE(fdcg_deform_create(memory.data(), memory.size() * 8, &triangles.graph, &config, &deform, &error) == FDCG_OK);
    fdcg_deform_contact contact = {};
    check_that_no_number_is_forgotten(
        [&](const double* hip, fdcg_result* result) { fdcg_deform_step(deform, &params, &contact, hip, result); });
  }
}
