// SPDX-License-Identifier: Apache-2.0
// Runs in the guest: vm_rig timing|faults [NAME=VALUE...] [then timing|faults ...]. Exit code: 0 all passed, 1 not, 2 the rig
// itself failed.
#include <sched.h>
#include <sys/mman.h>

#include <csignal>
#include <exception>
#include <map>
#include <stdexcept>

#include "scenarios.hpp"
#include "udev_stand_in.hpp"

namespace fdcg::vm {
namespace {

constexpr int kDevicePriority = 85;  // above the host's threads: a real device does not wait for them

using Settings = std::map<std::string, std::string>;

const Settings kDefaults = {{"way", "uhid"}, {"backend", "hidraw"}, {"rate", "1000"}, {"seconds", "10"},
                            {"times", "20"}, {"only", ""},          {"seed", "1"},    {"timed", "1"}};

void take_priority() {
  sched_param parameters{};
  parameters.sched_priority = kDevicePriority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) || mlockall(MCL_CURRENT | MCL_FUTURE))
    throw std::runtime_error("no real-time priority, or no locked memory");
  std::signal(SIGPIPE, SIG_IGN);
}

void run_scenario(const std::string& name, Settings& settings, Verdicts& verdicts) {
  RigOptions options;
  options.is_usb = settings["way"] == "usb";
  options.backend = settings["backend"];
  options.rate_hz = std::stoi(settings["rate"]);
  options.seed = std::stoull(settings["seed"]);
  options.is_timed = settings["timed"] == "1";
  if (name == "timing") {
    options.has_log = true;
    run_timing(options, std::stoi(settings["seconds"]), verdicts);
  } else if (name == "faults") {
    run_faults(options, std::stoi(settings["times"]), settings["only"], verdicts);
  } else {
    throw std::runtime_error("there is no scenario \"" + name + '"');
  }
}

void run_all(const std::vector<std::string>& given, Verdicts& verdicts) {
  for (std::size_t at = 0; at < given.size(); ++at) {
    const std::string& name = given[at];
    Settings settings = kDefaults;
    for (++at; at < given.size() && given[at] != "then"; ++at) {
      const std::size_t equals = given[at].find('=');
      const auto setting = settings.find(given[at].substr(0, equals));
      if (equals == std::string::npos || setting == settings.end())
        throw std::runtime_error("there is no setting " + given[at]);
      setting->second = given[at].substr(equals + 1);
    }
    run_scenario(name, settings, verdicts);
  }
}

}  // namespace
}  // namespace fdcg::vm

int main(int count, char** arguments) {
  fdcg::vm::Verdicts verdicts;
  try {
    fdcg::vm::start_udev_stand_in();
    fdcg::vm::take_priority();
    fdcg::vm::run_all({arguments + 1, arguments + count}, verdicts);
  } catch (const std::exception& error) {
    std::printf("vm_rig: %s\n", error.what());
    return 2;
  }
  return verdicts.failed() == 0 ? 0 : 1;
}
