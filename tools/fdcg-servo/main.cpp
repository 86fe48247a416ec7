// SPDX-License-Identifier: Apache-2.0
// fdcg-servo: the host of the servo step. One file a subcommand; this one only names them.
#include "fdcg/fdcg.h"
#include "servo_commands.hpp"

int main(int argc, char** argv) {
  using namespace fdcg::servo;
  const char* const examples = R"(Examples:
  fdcg-servo replay bunny.fdcg --path slide
  fdcg-servo replay bunny.fdcg --trajectory hip.csv -o log.csv
  fdcg-servo replay session.fdcglog
  fdcg-servo devices
  fdcg-servo check scene.json
  fdcg-servo run scene.json --arm
  fdcg-servo latency scene.json
  fdcg-servo calibrate scene.json -o my-device.json
  fdcg-servo help run

)";
  return fdcg::tools::run_program(
      {"fdcg-servo",
       "Run the servo step on Face Directed Connection Graphs (.fdcg): with devices, or on recorded paths.",
       "fdcg-servo " FDCG_VERSION_STRING " (file format 1)",
       examples + fdcg::tools::exit_codes("success", "findings (each command says which)"),
       {add_run, add_devices, add_check, add_latency, add_calibrate, add_replay}},
      argc, argv);
}
