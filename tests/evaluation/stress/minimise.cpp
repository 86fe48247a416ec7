// SPDX-License-Identifier: Apache-2.0
#include "minimise.hpp"
#include <stdexcept>
namespace fdcg::test {
Reproducer minimised(Reproducer reproducer) { return reproducer; }
std::string test_case_text(const Reproducer&, const std::string&) { return {}; }
int minimise_file(const std::string&) { return 2; }
}
