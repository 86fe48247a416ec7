// SPDX-License-Identifier: Apache-2.0
#include "run_fast.hpp"

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "host/fast_run.hpp"
#include "servo_commands.hpp"
#include "status_text.hpp"

namespace fdcg::servo {
namespace {

std::atomic<bool> is_stopping{false};

void on_signal(int) {
  is_stopping.store(true);
}

}  // namespace

int run_fast(dev::HostConfig config, const std::vector<std::string>& warnings, const FastRunArguments& arguments) {
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "fdcg-servo: warning: %s\n", warning.c_str());
  dev::FastRun run;
  if (const std::string problem = run.open(std::move(config)); !problem.empty()) return fail(kFile, problem);
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    sigaction(number, &action, nullptr);
  signal(SIGXFSZ, SIG_IGN);  // a file limit is an error where the log is written
  const std::string problem = run.run(arguments.for_s, arguments.arm, [] { return is_stopping.load(); });
  std::vector<DeviceLook> looks;
  bool is_clean = true;
  double seconds = 0;
  for (int i = 0; i < run.device_count(); ++i) {
    DeviceLook look;
    look.name = run.device(i).name;
    look.status = run.status(i);
    look.connection.connection = look.status.connection;
    look.connection.is_over = run.has_ended(i);
    seconds = std::max(seconds, look.status.elapsed_s);
    if (look.status.elapsed_s > 0) look.rate_hz = static_cast<double>(look.status.counters.ticks) / look.status.elapsed_s;
    is_clean = is_clean && (look.connection.is_over || !arguments.arm || !is_trouble(look.status.last.fault));
    looks.push_back(look);
  }
  if (arguments.says_json) std::printf("%s\n", status_json("end", seconds, looks, problem).c_str());
  const bool has_begun = problem.empty() || seconds > 0;  // else there is nothing to sum up
  if (arguments.says_text && has_begun) std::fputs(summary_text(looks).c_str(), stdout);
  if (!problem.empty()) return fail(run.has_failed_file() ? kFile : kFindings, problem);
  return is_clean ? kClean : kFindings;
}

}  // namespace fdcg::servo
