// SPDX-License-Identifier: Apache-2.0
// A mesh file as a stress case: compiled as by default, faces merged within the numbers' quantum.
#pragma once

#include <string>

#include "stress_case.hpp"

namespace fdcg::test {

// The file is read once. Where it is open its inside is not judged; it should not pass through itself. Throws
// std::runtime_error, naming the file. One file a run: a second call replaces the first.
const StressCase& mesh_case(const std::string& file);

}  // namespace fdcg::test
