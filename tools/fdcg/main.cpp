// SPDX-License-Identifier: Apache-2.0
// fdcg: the offline compiler. One file a subcommand; this one only names them.
#include "fdcg/fdcg.h"
#include "fdcg_commands.hpp"

int main(int argc, char** argv) {
  using namespace fdcg::tools;
  const char* const examples = R"(Examples:
  fdcg validate bunny.off
  fdcg compile bunny.off -o bunny.fdcg --units mm
  fdcg repair bunny.off -o clean.off --all
  fdcg batch --manifest meshes.txt -o out
  fdcg inspect bunny.fdcg
  fdcg explain non-manifold-edge
  fdcg grasp cube.fdcg --contacts fingers.csv --mu 0.5 --grip 10
  fdcg view bunny.off --open
  fdcg help compile

)";
  return run_program({"fdcg",
                      "Compile polygon meshes into Face Directed Connection Graphs (.fdcg) for haptic rendering.",
                      "fdcg " FDCG_VERSION_STRING " (file format 1)",
                      examples + exit_codes("success", "findings (each command says which)"),
                      {add_compile, add_validate, add_repair, add_batch, add_inspect, add_explain, add_grasp, add_view}},
                     argc, argv);
}
