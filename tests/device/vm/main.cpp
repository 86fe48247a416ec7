// SPDX-License-Identifier: Apache-2.0
// Runs in the guest: vm_rig timing|faults [usb] [NAME=VALUE...]. Exit code: 0 all passed, 1 not, 2 the rig itself failed.
#include <sched.h>
#include <sys/mman.h>

#include <csignal>
#include <cstring>
#include <exception>
#include <map>

#include "scenarios.hpp"

namespace {

constexpr int kDevicePriority = 85;  // above the host's threads: a real device does not wait for them

}  // namespace

int main(int count, char** arguments) {
  using namespace fdcg::vm;
  std::map<std::string, std::string> given = {{"times", "20"}, {"seconds", "10"}, {"only", ""},   {"rate", "1000"},
                                              {"seed", "1"},   {"backend", "hidraw"}, {"way", "uhid"}, {"timed", "1"}};
  for (int i = 2; i < count; ++i) {
    const std::string word = arguments[i];
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || !given.contains(word.substr(0, equals))) {
      std::printf("vm_rig does not know %s\n", word.c_str());
      return 2;
    }
    given[word.substr(0, equals)] = word.substr(equals + 1);
  }
  sched_param parameters{};
  parameters.sched_priority = kDevicePriority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters)) std::puts("vm_rig: no real-time priority");
  mlockall(MCL_CURRENT | MCL_FUTURE);
  std::signal(SIGPIPE, SIG_IGN);
  Verdicts verdicts;
  try {
    RigOptions options;
    options.is_usb = given["way"] == "usb";
    options.backend = given["backend"];
    options.rate_hz = std::stoi(given["rate"]);
    options.seed = std::stoull(given["seed"]);
    options.is_timed = given["timed"] == "1";
    const std::string scenario = count > 1 ? arguments[1] : "";
    if (scenario == "timing") {
      options.has_log = true;
      run_timing(options, std::stoi(given["seconds"]), verdicts);
    } else if (scenario == "faults") {
      run_faults(options, std::stoi(given["times"]), given["only"], verdicts);
    } else {
      std::printf("vm_rig: timing or faults, not \"%s\"\n", scenario.c_str());
      return 2;
    }
  } catch (const std::exception& error) {
    std::printf("vm_rig: %s\n", error.what());
    return 2;
  }
  return verdicts.failed() == 0 ? 0 : 1;
}
