// SPDX-License-Identifier: Apache-2.0
// Harm to the host program: signals, a thread of it that no longer runs, a second one, a graph that changes under it.
#include <dirent.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "host_files.hpp"
#include "strikes.hpp"

namespace fdcg::vm {
namespace {

constexpr Nanoseconds kThreadSilence = 10 * kMillisecond;  // of the servo thread, to the writer
constexpr Nanoseconds kThreadStuck = 5 * kMillisecond;     // of the writer, to the servo thread
constexpr Nanoseconds kSettled = kSecond / 10;

Expectation disarmed_from(Rig& rig, Nanoseconds known) {
  Expectation expected;
  expected.known = known;
  expected.disarms = true;
  rig.device.record.watch(known);
  return expected;
}

// It ends by the signal, its last word is zero, and the next one starts disarmed.
Expectation strike_ending(Rig& rig, int number, bool is_in_order) {
  Expectation expected = disarmed_from(rig, now_ns());
  rig.host.signal(number);
  if (!rig.run_until([&] { return !rig.host.is_running(); }, 2 * kSecond)) expected.broken = "the host does not end";
  const int ending = rig.host.ending();
  if (is_in_order ? ending > 1 : ending != 128 + number) expected.broken = words("the host ends with %d", ending);
  if (is_in_order && rig.host.status_line().find("\"event\":\"end\"") == std::string::npos)
    expected.broken = "the host does not say that it has ended";
  rig.start_host();
  if (!rig.is_answered_again()) expected.broken = "a new host has not opened the device within 5 s";
  rig.run_for(kSettled);
  return expected;
}

// The host's thread of that name. Throws where there is none.
pid_t thread_of(const HostProcess& host, const std::string& name) {
  const std::string tasks = "/proc/" + std::to_string(host.pid()) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::string found;
    std::getline(std::ifstream(task.path() / "comm"), found);
    const auto id = static_cast<pid_t>(std::atoi(task.path().filename().c_str()));
    if (found == name && id != host.pid()) return id;
  }
  throw std::runtime_error("the host has no thread " + name);
}

// Stopped by itself for so long, while the process runs on.
void stop_thread(Rig& rig, pid_t thread, Nanoseconds duration) {
  int status = 0;
  if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) || ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) ||
      waitpid(thread, &status, __WALL) != thread)
    throw std::runtime_error("a thread of the host cannot be stopped");
  rig.run_for(duration);
  ptrace(PTRACE_DETACH, thread, nullptr, nullptr);
}

Expectation strike_thread(Rig& rig, const char* name, Nanoseconds noticed_after) {
  const pid_t thread = thread_of(rig.host, name);
  Expectation expected = disarmed_from(rig, now_ns() + noticed_after);
  stop_thread(rig, thread, rig.random_between(50 * kMillisecond, 400 * kMillisecond));
  rig.run_for(kSettled);
  return expected;
}

}  // namespace

template <int number>
Expectation strike_crash(Rig& rig) {
  return strike_ending(rig, number, false);
}
template <int number>
Expectation strike_end(Rig& rig) {
  return strike_ending(rig, number, true);
}
template Expectation strike_crash<SIGSEGV>(Rig&);
template Expectation strike_crash<SIGABRT>(Rig&);
template Expectation strike_crash<SIGBUS>(Rig&);
template Expectation strike_crash<SIGFPE>(Rig&);
template Expectation strike_crash<SIGILL>(Rig&);
template Expectation strike_crash<SIGQUIT>(Rig&);
template Expectation strike_crash<SIGXCPU>(Rig&);
template Expectation strike_crash<SIGUSR1>(Rig&);
template Expectation strike_crash<SIGUSR2>(Rig&);
template Expectation strike_end<SIGTERM>(Rig&);
template Expectation strike_end<SIGINT>(Rig&);
template Expectation strike_end<SIGHUP>(Rig&);

// Disarmed before it stops, so that the device's watchdog has nothing to do; still so when it is continued.
Expectation strike_stopped(Rig& rig) {
  Expectation expected = disarmed_from(rig, now_ns());
  rig.host.signal(SIGTSTP);
  rig.run_for(rig.random_between(150 * kMillisecond, 400 * kMillisecond));
  const std::uint64_t outputs = rig.device.record.outputs;
  rig.run_for(50 * kMillisecond);
  if (rig.options.is_timed && rig.device.record.outputs != outputs) expected.broken = "it has not stopped";
  rig.host.signal(SIGCONT);
  rig.run_for(2 * kSettled);
  return expected;
}

// Nothing takes the force away of a device that has no watchdog of its own, so it is small; it does not grow, and the first
// word of the next host ends it.
Expectation strike_killed_unwatched(Rig& rig) {
  constexpr double kMostN = 1.001;
  Expectation expected;
  expected.disarms = true;
  rig.device.record.restart_forces();
  rig.host.signal(SIGKILL);
  rig.run_until([&] { return !rig.host.is_running(); }, kSecond);
  rig.run_for(rig.random_between(30 * kMillisecond, 500 * kMillisecond));
  if (!(rig.device.record.force_n > 0))
    expected.broken = "the force was gone before there was a host: the device has a watchdog";
  const std::uint64_t outputs = rig.device.record.outputs;
  rig.device.record.watch(now_ns());
  rig.start_host();
  rig.run_until([&] { return rig.device.record.outputs > outputs; }, 5 * kSecond);
  expected.known = now_ns();
  rig.run_for(kSettled);
  if (rig.device.record.most_force_n > kMostN) expected.broken = words("its force is %.3f N", rig.device.record.most_force_n);
  return expected;
}

Expectation strike_servo_thread(Rig& rig) {
  return strike_thread(rig, "fdcg-servo", kThreadSilence);
}

Expectation strike_writer_thread(Rig& rig) {
  return strike_thread(rig, "fdcg-writer", kThreadStuck + rig.period());
}

// It is told whose the device is, and the first goes on as if nothing were.
Expectation strike_second_program(Rig& rig) {
  Expectation expected;
  rig.start_second_host(host_command(rig.options));
  const std::string owner = "process " + std::to_string(rig.host.pid()) + " (fdcg-servo) drives this device";
  const auto is_told = [&] { return rig.second.status_line().find(owner) != std::string::npos; };
  if (!rig.run_until(is_told, 3 * kSecond)) expected.broken = "the second host does not say whose the device is";
  rig.second.say("arm");
  rig.run_for(kSettled);
  rig.second.say("quit");
  if (!rig.run_until([&] { return !rig.second.is_running(); }, 3 * kSecond)) expected.broken = "the second host does not end";
  return expected;
}

// A scene in which the device stands twice does not begin, and says so; the host of before comes back disarmed.
Expectation strike_node_twice(Rig& rig) {
  Expectation expected = disarmed_from(rig, now_ns());
  if (!rig.end_host()) expected.broken = "the host does not end in order";
  const std::uint64_t outputs = rig.device.record.outputs;
  rig.host.start(command_with_node_twice(), nullptr);
  rig.run_until([&] { return !rig.host.is_running(); }, 3 * kSecond);
  const auto is_the_word = [](const std::string& line) { return line.find("finds the same device") != std::string::npos; };
  const bool is_told = std::any_of(rig.host.words().begin(), rig.host.words().end(), is_the_word);
  if (rig.host.is_running() || rig.host.ending() != 3 || !is_told) expected.broken = "it does not say that its devices are one";
  if (rig.device.record.outputs != outputs) expected.broken = "it writes to the device";
  if (!expected.broken.empty()) return expected;
  rig.start_host();
  if (!rig.is_answered_again()) expected.broken = "the next host has not opened the device within 5 s";
  return expected;
}

// The host steps on what it read at its start.
Expectation strike_graph(Rig& rig) {
  constexpr char kAside[] = "/tmp/aside.fdcg";
  Expectation expected;
  std::filesystem::copy_file(kGraph, kAside, std::filesystem::copy_options::overwrite_existing);
  switch (rig.random_between(0, 3)) {
    case 0:
      std::filesystem::resize_file(kGraph, static_cast<std::uintmax_t>(rig.random_between(0, 4095)));
      break;
    case 1: {
      std::fstream(kGraph, std::ios::in | std::ios::out | std::ios::binary)
          << std::string(std::filesystem::file_size(kGraph), 'x');
      break;
    }
    case 2:
      std::filesystem::remove(kGraph);
      break;
    default:
      std::ofstream(kGraph, std::ios::trunc) << "another";
  }
  rig.run_for(3 * kSettled);
  std::filesystem::copy_file(kAside, kGraph, std::filesystem::copy_options::overwrite_existing);
  return expected;
}

}  // namespace fdcg::vm
