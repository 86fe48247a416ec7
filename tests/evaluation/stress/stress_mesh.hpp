// SPDX-License-Identifier: Apache-2.0
// A mesh file as a stress case: compiled as by default, faces merged within the numbers' quantum.
#pragma once

#include <string>

#include "stress_case.hpp"

namespace fdcg::test {

// The file is read once. Throws std::runtime_error, naming the file. One file a run: a second call replaces the first.
const StressCase& mesh_case(const std::string& file);

// Why the inside of the last mesh_case, rounded to these numbers, is not judged: it is open, or its faces cross or touch one
// another, or some look inwards. Empty where it is judged.
const std::string& why_no_inside(bake::Precision precision);

}  // namespace fdcg::test
