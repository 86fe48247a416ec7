// SPDX-License-Identifier: Apache-2.0
// Cuts a reproducer down to a few faces and ticks (delta debugging: Zeller and Hildebrandt 2002).
#pragma once

#include <string>

#include "reproducer.hpp"

namespace fdcg::test {

// The smallest that was found with the same fault: fewer ticks; corners drawn together along edges, so that a closed mesh stays
// closed; faces left out, where the fault does not ask for an inside; coordinates of fewer bits. Throws std::runtime_error if
// the reproducer does not fail. Cost: some thousand compilations of ever smaller meshes.
Reproducer minimised(Reproducer reproducer);

// The body of a Catch2 test case that fails as the reproducer does: shapes and ways as C++ numbers.
std::string test_case_text(const Reproducer& reproducer, const std::string& name);

// Reads FILE, writes FILE.small.obj and FILE.test.cpp, and says what it did. Returns an exit code.
int minimise_file(const std::string& file);

}  // namespace fdcg::test
