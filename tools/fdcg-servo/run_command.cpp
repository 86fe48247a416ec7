// SPDX-License-Identifier: Apache-2.0
// fdcg-servo run: the devices of a scene, until a signal, the command quit, or the time is over. A little over 400
// lines: one loop, and what it tells its user.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "../common/terminal.hpp"
#include "base/words.hpp"
#include "host/host.hpp"
#include "run_fast.hpp"
#include "scene/scene_json.hpp"
#include "servo_commands.hpp"
#include "signals.hpp"
#include "status_text.hpp"

namespace fdcg::servo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLookMs = 50;  // how soon a command, a fault or a device is noticed here
constexpr double kTerminalStatusS = 0.2, kPlainStatusS = 1;
constexpr double kArmAgainS = 0.2;      // between requests, until the gate has granted the first
constexpr double kRefusedAfterS = 0.3;  // a request is granted in a tick, or is not
constexpr double kNewStatusS = 0.05;    // after a command, until no status is from before it
constexpr double kStopS = 1;            // that devices get to take their zero before the process is stopped
constexpr std::size_t kLongestCommand = 200;

enum class StatusKind { kText, kJson, kNone };

struct RunArguments {
  std::string scene, log, hid;
  bool no_log = false, arm = false, quiet = false, fast = false;
  double for_s = 0;           // 0: no end
  double status_every_s = 0;  // 0: the default
  StatusKind status = StatusKind::kText;
};

// Commands on standard input, a line each. Its end ends nothing.
class CommandInput {
 public:
  // Waits up to that long. False: standard input has ended (and nothing was waited for).
  bool wait(int milliseconds, std::vector<std::string>* commands) {
    if (has_ended_) return false;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, milliseconds) <= 0 || input.revents == 0) return true;
    char bytes[256];
    const ssize_t got = read(STDIN_FILENO, bytes, sizeof bytes);
    if (got <= 0) {
      has_ended_ = got == 0 || errno != EINTR;
      return true;
    }
    text_.append(bytes, static_cast<std::size_t>(got));
    for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      commands->push_back(text_.substr(0, end));
      text_.erase(0, end + 1);
    }
    if (text_.size() > kLongestCommand) text_.clear();
    return true;
  }

 private:
  std::string text_;
  bool has_ended_ = false;
};

class Session {
 public:
  Session(const RunArguments& arguments, dev::Host& host, Signals& signals, std::string log_file)
      : arguments_(arguments),
        host_(host),
        signals_(signals),
        log_file_(std::move(log_file)),
        is_terminal_(tools::wants_colour(tools::Stream::standard_output)) {
    const auto count = static_cast<std::size_t>(host.device_count());
    looks_.resize(count);
    seen_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      looks_[i].name = host.device(static_cast<int>(i)).name;
      name_width_ = std::max(name_width_, looks_[i].name.size());
      seen_[i].wants_arming = arguments.arm;
    }
    const double standard = is_terminal_ && arguments.status == StatusKind::kText ? kTerminalStatusS : kPlainStatusS;
    status_every_s_ = next_status_s_ = arguments.status_every_s > 0 ? arguments.status_every_s : standard;
  }

  void run();
  int end(const std::string& stop_problem);

 private:
  struct Seen {
    dev::Connection connection = dev::Connection::kAbsent;
    std::string problem;
    std::uint64_t disarmed[dev::kFaults] = {};
    dev::Phase phase = dev::Phase::kDisarmed;
    bool wants_arming = false;  // --arm: until the gate has granted it once
    bool was_asked = false;     // to arm
    double asked_s = -1;        // when; -1: answered, or told
    std::uint64_t ticks = 0;    // at the last status line
  };

  double seconds() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }
  bool says_text() const { return arguments_.status == StatusKind::kText && !arguments_.quiet; }
  void obey(const std::string& command);
  void disarm();
  bool has_left_zero(std::size_t device, std::uint64_t* first_zero);
  void stop_disarmed(int signal);
  void look();
  void notice(std::size_t device);
  void notice_connection(std::size_t device);
  bool is_recorded(std::size_t device) const;
  void arm_where_wanted(std::size_t device);
  void say(const std::string& line);
  void show_status();
  void wipe();

  const RunArguments& arguments_;
  dev::Host& host_;
  Signals& signals_;
  const std::string log_file_;  // empty: none
  const bool is_terminal_;
  const Clock::time_point started_ = Clock::now();
  std::vector<DeviceLook> looks_;
  std::vector<Seen> seen_;
  std::size_t name_width_ = 0;
  double status_every_s_ = 1, next_status_s_ = 0, last_status_s_ = 0, next_arming_s_ = 0;
  std::string log_failure_;
  std::size_t lines_drawn_ = 0;  // of the status, on a terminal
};

void Session::wipe() {
  for (; lines_drawn_ > 0; --lines_drawn_)
    std::fputs("\033[A\r\033[K", stdout);
}

// What happened, above the status on a terminal.
void Session::say(const std::string& line) {
  if (!says_text()) return;
  wipe();
  std::printf("%8.2f s  %s\n", seconds(), line.c_str());
  std::fflush(stdout);
}

void Session::show_status() {
  const double now_s = seconds();
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const std::uint64_t ticks = looks_[i].status.counters.ticks;
    looks_[i].rate_hz = now_s > last_status_s_ ? static_cast<double>(ticks - seen_[i].ticks) / (now_s - last_status_s_) : 0;
    seen_[i].ticks = ticks;
  }
  last_status_s_ = now_s;
  if (arguments_.quiet || arguments_.status == StatusKind::kNone) return;
  if (arguments_.status == StatusKind::kJson) {
    std::printf("%s\n", status_json("status", now_s, looks_, log_failure_).c_str());
  } else {
    wipe();
    for (const DeviceLook& look : looks_) {
      // a line that wraps could not be wiped: the terminal cuts it
      if (is_terminal_) std::printf("\033[?7l%s\033[?7h\n", status_line(look, name_width_).c_str());
      if (!is_terminal_) std::printf("%8.2f s  %s\n", now_s, status_line(look, name_width_).c_str());
    }
    if (is_terminal_) lines_drawn_ = looks_.size();
  }
  std::fflush(stdout);
}

// Only from the start to the gate's first yes: after a fault or a re-plug arming is the user's to ask for again.
void Session::arm_where_wanted(std::size_t device) {
  Seen& seen = seen_[device];
  const dev::TickOutput& last = looks_[device].status.last;
  const bool is_there =
      looks_[device].connection.connection == dev::Connection::kOpen && looks_[device].status.counters.ticks > 0;
  if (!seen.wants_arming || !is_there) return;
  if (!seen.was_asked) seen.asked_s = seconds();
  seen.was_asked = true;
  const std::uint64_t* const disarmed = looks_[device].status.counters.disarmed;
  const bool was_armed = std::any_of(disarmed, disarmed + dev::kFaults, [](std::uint64_t count) { return count != 0; });
  if (was_armed || last.phase != dev::Phase::kDisarmed || last.fault == dev::Fault::kUnknownLimit) {
    seen.wants_arming = false;
  } else if (seconds() >= next_arming_s_) {
    host_.arm(static_cast<int>(device));
  }
}

// It is never gone: it ends, and its connection's problem says so.
bool Session::is_recorded(std::size_t device) const {
  return host_.device(static_cast<int>(device)).source == dev::DeviceSource::kRecorded;
}

void Session::notice_connection(std::size_t device) {
  Seen& seen = seen_[device];
  const DeviceLook& look = looks_[device];
  if (look.connection.connection != seen.connection) {
    const bool is_open = look.connection.connection == dev::Connection::kOpen;
    if (is_open || !is_recorded(device)) say(look.name + (is_open ? ": open" : ": gone"));
    seen.connection = look.connection.connection;
  }
  if (look.connection.problem != seen.problem) {
    seen.problem = look.connection.problem;
    if (!seen.problem.empty()) say(look.name + ": " + seen.problem);
  }
}

// Tells what has changed since the last look.
void Session::notice(std::size_t device) {
  Seen& seen = seen_[device];
  const DeviceLook& look = looks_[device];
  const dev::DeviceStatus& status = look.status;
  bool has_disarmed = false;
  for (int i = 1; i < dev::kFaults; ++i) {
    const auto fault = static_cast<dev::Fault>(i);
    if (status.counters.disarmed[i] > seen.disarmed[i]) {
      const bool is_end = fault == dev::Fault::kReadFailed && is_recorded(device);
      if (!is_end) say(look.name + ": disarmed: " + dev::fault_text(fault));
      has_disarmed = true;
    }
    seen.disarmed[i] = status.counters.disarmed[i];
  }
  if (status.last.phase != dev::Phase::kDisarmed || has_disarmed) seen.asked_s = -1;
  if (seen.asked_s >= 0 && seconds() - seen.asked_s > kRefusedAfterS) {
    const bool is_unknown = status.last.fault == dev::Fault::kUnknownLimit;
    say(look.name + ": not armed: " +
        (is_unknown ? dev::fault_text(dev::Fault::kUnknownLimit) : "the tip is pressed against something, or does not report"));
    seen.asked_s = -1;
  }
  if (status.last.phase == dev::Phase::kRamping && seen.phase == dev::Phase::kDisarmed) say(look.name + ": armed");
  seen.phase = status.last.phase;
}

void Session::look() {
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    looks_[i].connection = host_.connection(static_cast<int>(i));
    looks_[i].status = host_.status(static_cast<int>(i));
    notice_connection(i);
    notice(i);
    arm_where_wanted(i);
  }
  if (seconds() >= next_arming_s_) next_arming_s_ = seconds() + kArmAgainS;
  if (std::string failure = host_.log_failure(); !failure.empty() && log_failure_.empty()) {
    wipe();
    std::fprintf(stderr, "fdcg-servo: warning: %s\n", failure.c_str());
    log_failure_ = std::move(failure);
  }
  if (seconds() >= next_status_s_) {
    show_status();
    next_status_s_ = std::max(next_status_s_ + status_every_s_, seconds());
  }
  if (std::ferror(stdout) != 0) host_.request_stop();  // nobody reads any more
}

void Session::obey(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
  const std::string command = first == std::string::npos ? "" : line.substr(first, last - first + 1);
  if (command == "arm") {
    for (Seen& seen : seen_) {
      seen.was_asked = true;
      seen.asked_s = seconds();
    }
    host_.arm(dev::kAllDevices);
  } else if (command == "disarm") {
    disarm();
  } else if (command == "quit") {
    host_.request_stop();
  } else if (!command.empty()) {
    wipe();
    std::fprintf(stderr, "fdcg-servo: no such command; one of arm, disarm, quit, and Enter\n");
  }
}

void Session::disarm() {
  for (Seen& seen : seen_)
    seen.wants_arming = false;
  host_.disarm(dev::kAllDevices);
}

// Disarmed, and it has taken reports since: `first_zero`, 0 at first, keeps the number of the first that is surely zero.
bool Session::has_left_zero(std::size_t device, std::uint64_t* first_zero) {
  const int index = static_cast<int>(device);
  if (host_.connection(index).connection != dev::Connection::kOpen || !host_.device(index).profile.has_output) return true;
  const dev::DeviceStatus status = host_.status(index);
  if (status.last.phase != dev::Phase::kDisarmed) return false;
  constexpr std::uint64_t kUnderWay = 2;  // one that is being sent, one that the tick before has put
  if (*first_zero == 0) *first_zero = status.writes + kUnderWay;
  return status.writes > *first_zero;
}

// A stopped process sends nothing: what its devices took last is what they would go on pushing with.
void Session::stop_disarmed(int signal) {
  disarm();
  const double asked_s = seconds();
  std::vector<std::uint64_t> first_zeros(looks_.size());
  const auto all_have_left = [&] {
    bool all = true;
    for (std::size_t i = 0; i < looks_.size(); ++i)
      all = has_left_zero(i, &first_zeros[i]) && all;
    return all;
  };
  while (seconds() - asked_s < kNewStatusS || (!all_have_left() && seconds() - asked_s < kStopS)) {
    if (host_.wait_ms(1)) return;  // it is to end
  }
  say("disarmed and stopped by a signal");
  signals_.stop_process(signal);
  say("continued: there is no force until you type arm and Enter");
}

void Session::run() {
  CommandInput input;
  std::vector<std::string> commands;
  while (!host_.is_stopping()) {
    if (arguments_.for_s > 0 && seconds() >= arguments_.for_s) break;
    const double left_s = arguments_.for_s > 0 ? arguments_.for_s - seconds() : 1;
    const int wait_ms = std::clamp(static_cast<int>(std::ceil(left_s * 1000)), 0, kLookMs);
    commands.clear();
    const bool has_waited = input.wait(wait_ms, &commands);
    // what is typed on the terminal that shows the status takes a line below it
    if (lines_drawn_ > 0 && isatty(STDIN_FILENO) != 0) lines_drawn_ += commands.size();
    for (const std::string& command : commands)
      obey(command);
    if (host_.wait_ms(has_waited ? 0 : wait_ms)) break;
    if (const int signal = signals_.take_stop(); signal != 0) stop_disarmed(signal);
    look();
  }
}

int Session::end(const std::string& stop_problem) {
  bool is_clean = true;
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const dev::ConnectionReport after = host_.connection(static_cast<int>(i));  // all are closed: only is_over tells
    looks_[i].status = host_.status(static_cast<int>(i));
    const bool is_missing = looks_[i].status.opened == 0;
    const dev::Fault fault = looks_[i].status.last.fault;
    const bool is_played = after.is_over || (is_recorded(i) && fault == dev::Fault::kReadFailed);  // that end is no fault
    looks_[i].connection.is_over = is_played;
    notice(i);
    const bool is_only_read = fault == dev::Fault::kUnknownLimit && !seen_[i].was_asked;
    is_clean = is_clean && (is_played || ((!is_trouble(fault) || is_only_read) && !is_missing));
  }
  wipe();
  if (!arguments_.quiet && arguments_.status == StatusKind::kJson) {
    std::printf("%s\n", status_json("end", seconds(), looks_, log_failure_).c_str());
  }
  if (says_text()) std::fputs(summary_text(looks_).c_str(), stdout);
  std::fflush(stdout);
  if (!stop_problem.empty()) {
    const bool is_of_log = !log_file_.empty() && stop_problem.find(log_file_ + ": ") != std::string::npos;
    return fail(is_of_log ? kFile : kFindings, stop_problem);
  }
  return is_clean ? kClean : kFindings;
}

// What is no number, too, is outside.
CLI::Validator seconds_from(double least) {
  const auto check = [least](const std::string& text) -> std::string {
    constexpr double kMost = 1e9;
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc{} && stopped == end && value >= least && value <= kMost) return {};
    return "'" + text + "' is no number from " + dev::shown_number(least) + " to 1e9 seconds";
  };
  return {check, ""};
}

int run_scene(const RunArguments& arguments) {
  dev::HostConfig config;
  std::vector<std::string> warnings;
  if (const std::string problem = dev::read_scene(arguments.scene, &config, &warnings); !problem.empty()) {
    return fail(kFile, problem);
  }
  if (!arguments.log.empty()) config.log_file = arguments.log;
  if (arguments.no_log) config.log_file.clear();
  if (arguments.hid == "hidraw") config.loop.backend = dev::HidBackend::kHidraw;
  if (arguments.hid == "libusb") config.loop.backend = dev::HidBackend::kLibusb;
  const StatusKind says = arguments.quiet ? StatusKind::kNone : arguments.status;
  if (arguments.fast) {
    const auto is_simulated = [](const dev::DeviceConfig& device) { return device.source == dev::DeviceSource::kSimulated; };
    if (!(arguments.for_s > 0) && std::any_of(config.devices.begin(), config.devices.end(), is_simulated))
      return fail(kUsage, "a simulated device never ends; say for how long it runs (--for)");
    return run_fast(std::move(config), warnings,
                    {arguments.for_s, arguments.arm, says == StatusKind::kText, says == StatusKind::kJson});
  }
  const std::string log_file = config.log_file;
  dev::Host host;
  if (const std::string problem = host.open(std::move(config)); !problem.empty()) return fail(kFile, problem);
  Signals signals(&host);
  if (const std::string problem = host.start(); !problem.empty()) return fail(kFile, problem);
  for (const std::vector<std::string>& list : {warnings, host.warnings()})
    for (const std::string& warning : list)
      std::fprintf(stderr, "fdcg-servo: warning: %s\n", warning.c_str());
  if (!arguments.arm && !arguments.quiet && arguments.status == StatusKind::kText) {
    std::puts("Not armed: there is no force until you type arm and Enter (disarm, quit), or start with --arm.");
  }
  Session session(arguments, host, signals, log_file);
  session.run();
  const std::string problem = host.stop();
  return session.end(problem);
}

}  // namespace

Command add_run(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("run", "Run the devices of a scene: read, step, push, log");
  command->footer(R"(
Examples:
  fdcg-servo run scene.json
  fdcg-servo run scene.json --arm --for 60 --log session.fdcglog
  fdcg-servo run scene.json --arm --for 60 --fast --log session.fdcglog
  fdcg-servo run scene.json --status json --status-every 0.1 | jq .devices[0].rate_hz

Commands on standard input, a line each: arm, disarm, quit. Its end does not end the run; Ctrl-C does, with zero force.
Any other signal that ends the program leaves zero force too (not kill -9); Ctrl-Z disarms before it stops.
Nothing is pushed until a device is armed, and after a fault until it is armed again. A log that is there is overwritten.

Exit codes: 0 clean (a recording that has ended is no fault); 1 a device ended disarmed by a fault, or was never there;
2 wrong usage; 3 a file; 4 a fault of the program.)");
  const auto arguments = std::make_shared<RunArguments>();
  command->add_option("scene", arguments->scene, "Scene (schemas/servo-scene.schema.json)")->required()->type_name("SCENE");
  command->add_flag("--arm", arguments->arm, "Arm each device once, as soon as it is there and free of force");
  command->add_flag("--fast", arguments->fast,
                    "Simulated and recorded devices only: no waiting, each on a clock of its own; the same log every time");
  command->add_option("--for", arguments->for_s, "Stop after so long")->type_name("SECONDS")->check(seconds_from(0.001));
  command->add_option("--hid", arguments->hid, "hidapi's back end, in place of the scene's")
      ->type_name("hidraw|libusb")
      ->check(CLI::IsMember({"hidraw", "libusb"}));
  CLI::Option* const log =
      command->add_option("--log", arguments->log, "Log to FILE, in place of the scene's")->type_name("FILE");
  command->add_flag("--no-log", arguments->no_log, "No log, whatever the scene says")->excludes(log);
  const std::vector<std::pair<std::string, StatusKind>> kinds = {
      {"text", StatusKind::kText}, {"json", StatusKind::kJson}, {"none", StatusKind::kNone}};
  command->add_option("--status", arguments->status, "What is printed while it runs; default: text")
      ->type_name("text|json|none")
      ->transform(CLI::CheckedTransformer(kinds));
  command->add_option("--status-every", arguments->status_every_s, "Default: 0.2 on a terminal, 1 elsewhere")
      ->type_name("SECONDS")
      ->check(seconds_from(0.01));
  command->add_flag("-q,--quiet", arguments->quiet, "Errors and warnings only");
  return {command, [arguments] { return run_scene(*arguments); }};
}

}  // namespace fdcg::servo
