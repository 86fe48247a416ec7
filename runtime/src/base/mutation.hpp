// SPDX-License-Identifier: Apache-2.0
// Places where a test takes a rule out. FDCG_MUTANT("name") is the constant false in what ships; where a test compiles with
// FDCG_WITH_MUTANTS it is whether the environment's FDCG_MUTANT is that name when it is first asked. FDCG_WITH_MUTANTS 1: the
// rules alone; 2: with the shortcuts past them that ship too.
#pragma once

#ifndef FDCG_WITH_MUTANTS
#define FDCG_WITH_MUTANTS 0
#endif

#if FDCG_WITH_MUTANTS
#include <stdlib.h>
#include <string.h>

namespace fdcg {

inline bool is_mutant(const char* name) {
  const char* const chosen = getenv("FDCG_MUTANT");
  return chosen != nullptr && strcmp(chosen, name) == 0;
}

}  // namespace fdcg

#define FDCG_MUTANT(name)                                  \
  ([] {                                                    \
    static const bool is_chosen = ::fdcg::is_mutant(name); \
    return is_chosen;                                      \
  }())
#else
#define FDCG_MUTANT(name) false
#endif
