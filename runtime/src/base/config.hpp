// SPDX-License-Identifier: Apache-2.0
// Build options of the runtime. Each is 0 or 1 and may be set on the compiler's command line; CMake has options of these names.
#pragma once

#include "base/arithmetic.hpp"
#include "fdcg/fdcg.h"

// Graphs of either precision. A library without one refuses its files (FDCG_E_VERSION) and is some 40 % smaller.
#ifndef FDCG_WITH_F64
#define FDCG_WITH_F64 1
#endif
#ifndef FDCG_WITH_F32
#define FDCG_WITH_F32 1
#endif
#if !FDCG_WITH_F64 && !FDCG_WITH_F32
#error "a library needs FDCG_WITH_F64, FDCG_WITH_F32 or both"
#endif

// fdcg_open_file: needs a system with memory-mapped files. Without it the function returns an error; fdcg_open_memory is always
// available.
#ifndef FDCG_WITH_FILES
#if defined(__unix__) || defined(__APPLE__) || defined(_WIN32)
#define FDCG_WITH_FILES 1
#else
#define FDCG_WITH_FILES 0
#endif
#endif

// Specific texts in fdcg_error.message. Without them the message is that of fdcg_status_text, and the library is some 5 kB
// smaller.
#ifndef FDCG_WITH_MESSAGES
#define FDCG_WITH_MESSAGES 1
#endif

// Without these either the message is empty, and the texts are in programs that call fdcg_status_text.
#ifndef FDCG_WITH_STATUS_TEXTS
#define FDCG_WITH_STATUS_TEXTS 1
#endif

// fdcg_params.friction_flags: the friction curve, materials. Without them the library is smaller (README.md), and
// fdcg_check_params refuses them.
#ifndef FDCG_WITH_FRICTION_TERMS
#define FDCG_WITH_FRICTION_TERMS 1
#endif

// FDCG_FRICTION_SHADING, one of these terms.
#ifndef FDCG_WITH_SHADING
#define FDCG_WITH_SHADING FDCG_WITH_FRICTION_TERMS
#endif
#if FDCG_WITH_SHADING && !FDCG_WITH_FRICTION_TERMS
#error "FDCG_WITH_SHADING needs FDCG_WITH_FRICTION_TERMS"
#endif

// Graphs with corners of more than FDCG_BUSY_FAN edges, and graphs with merged faces whose corners lie off their planes
// (header.max_deviation). A library without one refuses such files (FDCG_E_VERSION), and the step is smaller.
#ifndef FDCG_WITH_BUSY_CORNERS
#define FDCG_WITH_BUSY_CORNERS 1
#endif
#ifndef FDCG_WITH_INEXACT_NODES
#define FDCG_WITH_INEXACT_NODES 1
#endif

// Graphs of derived planes or edges (fdcg compile --planes derived). A library without refuses them (FDCG_E_VERSION).
#ifndef FDCG_WITH_DERIVED_PLANES
#define FDCG_WITH_DERIVED_PLANES 1
#endif

// The ball around a free contact that no face touches (contact-model FREE-7). It spares a free hand's sweeps and changes
// nothing that is felt; without it the library is smaller.
#ifndef FDCG_WITH_CLEAR_BALLS
#define FDCG_WITH_CLEAR_BALLS 1
#endif

// A short way of ticks on a face. Nothing that is felt depends on it; without it the library is smaller, and such ticks take
// longer.
#ifndef FDCG_WITH_FAST_FACES
#define FDCG_WITH_FAST_FACES 1
#endif

// Short ways along edges, onto them and off them (step/along_edge.hpp). Nothing that is felt depends on them; without them the
// library is smaller, and such ticks take longer.
#ifndef FDCG_WITH_FAST_EDGES
#define FDCG_WITH_FAST_EDGES 1
#endif

// FDCG_ASSERT: checks for programming errors in the library, in the step too. CMake sets it in debug builds.
#ifndef FDCG_WITH_ASSERTS
#define FDCG_WITH_ASSERTS 0
#endif

namespace fdcg {

inline bool has_precision(uint32_t real_bytes) {
  return (FDCG_WITH_F64 && real_bytes == sizeof(double)) || (FDCG_WITH_F32 && real_bytes == sizeof(float));
}

// Calls `work` with a value of the graph's real type. fdcg_open_memory has checked that the library supports it.
template <class Work>
auto with_real_of(const fdcg_header& header, Work work) {
  if constexpr (!FDCG_WITH_F32) {
    return work(double{});
  } else if constexpr (!FDCG_WITH_F64) {
    return work(float{});
  } else {
    return header.real_bytes == sizeof(double) ? work(double{}) : work(float{});
  }
}

}  // namespace fdcg
