// SPDX-License-Identifier: Apache-2.0
#include "run_fast.hpp"

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "servo_commands.hpp"
#include "status_text.hpp"

namespace fdcg::servo {
namespace {

std::atomic<bool> is_stopping{false};

void on_signal(int) {
  is_stopping.store(true);
}

}  // namespace

int run_fast(dev::Scene scene, const std::vector<std::string>& warnings, const FastRunArguments& arguments) {
  for (const std::string& warning : warnings)
    tools::warn(warning);
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    sigaction(number, &action, nullptr);
  signal(SIGXFSZ, SIG_IGN);  // a file limit is an error where the log is written
  dev::FastSceneRun run;
  run.for_s = arguments.for_s;
  run.arm = arguments.arm;
  run.is_stopping = [] { return is_stopping.load(); };
  const std::string problem = run.run(std::move(scene));
  bool is_clean = true;
  double seconds = 0;
  for (DeviceLook& look : run.looks) {
    seconds = std::max(seconds, look.elapsed_s);
    if (look.elapsed_s > 0) look.rate_hz = static_cast<double>(look.counters.ticks) / look.elapsed_s;
    is_clean = is_clean && (look.is_over || !arguments.arm || !is_trouble(look.fault));
  }
  if (run.looks.empty()) return fail(kFile, problem);  // nothing ran
  if (arguments.says_json) std::printf("%s\n", status_json("end", seconds, run.looks, problem).c_str());
  const bool has_begun = problem.empty() || seconds > 0;  // else there is nothing to sum up
  if (arguments.says_text && has_begun) std::fputs(summary_text(run.looks).c_str(), stdout);
  if (!problem.empty()) return fail(run.has_failed_file ? kFile : kFindings, problem);
  return is_clean ? kClean : kFindings;
}

}  // namespace fdcg::servo
