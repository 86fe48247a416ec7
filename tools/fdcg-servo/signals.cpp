// SPDX-License-Identifier: Apache-2.0
#include "signals.hpp"

#include <signal.h>

#include <atomic>

#include "fdcg/device.h"

namespace fdcg::servo {
namespace {

std::atomic<dev::SceneRun*> the_host{nullptr};
std::atomic<int> the_stop{0};

void on_end(int) {
  if (dev::SceneRun* const host = the_host.load()) host->request_stop();
}

// Disarmed at once: the main thread may be about to wait for a command, and would see the stop only after that.
void on_stop(int number) {
  if (dev::SceneRun* const host = the_host.load()) host->disarm(dev::kAllDevices);
  the_stop.store(number);
}

// Without SA_RESTART: the wait for a command is interrupted.
void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(number, &action, nullptr);
}

bool is_ignored(int number) {
  struct sigaction action {};
  sigaction(number, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

}  // namespace

Signals::Signals(dev::SceneRun* host) {
  the_host.store(host);
  the_stop.store(0);
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    handle(number, on_end);
  for (const int number : {SIGPIPE, SIGXFSZ, SIGTTOU})
    handle(number, SIG_IGN);
  for (const int number : {SIGTSTP, SIGTTIN})
    if (!is_ignored(number)) handle(number, on_stop);
  fdcg_device_install_crash_handlers();  // last: they handle the signals that are left
}

Signals::~Signals() {
  the_host.store(nullptr);
}

int Signals::take_stop() {
  return the_stop.exchange(0);
}

void Signals::stop_process(int signal) {
  handle(signal, SIG_DFL);
  raise(signal);
  handle(signal, on_stop);
}

}  // namespace fdcg::servo
