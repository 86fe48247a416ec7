// SPDX-License-Identifier: Apache-2.0
#include "run_session.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>

#include "../common/terminal.hpp"
#include "servo_commands.hpp"
#include "status_text.hpp"

namespace fdcg::servo {
namespace {

constexpr int kLookMs = 50;  // how soon a command, a fault or a device is noticed here
constexpr double kTerminalStatusS = 0.2, kPlainStatusS = 1;
constexpr double kArmAgainS = 0.2;      // between requests, until the gate has granted the first
constexpr double kRefusedAfterS = 0.3;  // a request is granted in a tick, or is not
constexpr double kNewStatusS = 0.05;    // after a command, until no status is from before it
constexpr double kStopS = 1;            // that devices get to take their zero before the process is stopped
constexpr std::size_t kLongestCommand = 200;

// Commands on standard input, a line each; on a terminal a space too. Its end ends nothing.
class CommandInput {
 public:
  TerminalKeys keys;

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
    if (keys.is_on()) {
      keys.type(bytes, static_cast<std::size_t>(got), commands);
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

}  // namespace

RunSession::RunSession(const RunArguments& arguments, dev::SceneRun& host, Signals& signals, std::string log_file, RunTap* tap)
    : arguments_(arguments),
      host_(host),
      signals_(signals),
      tap_(tap),
      log_file_(std::move(log_file)),
      is_terminal_(tools::wants_colour(tools::Stream::standard_output)) {
  const auto count = static_cast<std::size_t>(host.device_count());
  looks_.resize(count);
  seen_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    looks_[i] = host.look(static_cast<int>(i));
    name_width_ = std::max(name_width_, looks_[i].name.size());
    seen_[i].wants_arming = arguments.arm;
  }
  const double standard = is_terminal_ && arguments.status == StatusKind::kText ? kTerminalStatusS : kPlainStatusS;
  status_every_s_ = next_status_s_ = arguments.status_every_s > 0 ? arguments.status_every_s : standard;
}

void RunSession::wipe() {
  for (; lines_drawn_ > 0; --lines_drawn_)
    std::fputs("\033[A\r\033[K", stdout);
}

// What happened, above the status on a terminal.
void RunSession::say(const std::string& line) {
  if (tap_ != nullptr) tap_->say(seconds(), line);
  if (!says_text()) return;
  wipe();
  std::printf("%8.2f s  %s\n", seconds(), line.c_str());
  std::fflush(stdout);
}

void RunSession::show_status() {
  const double now_s = seconds();
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const std::uint64_t ticks = looks_[i].counters.ticks;
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

// Only of what is there at the start, and to the gate's first yes: after a fault, or of a device that is plugged in later,
// arming is the user's to ask for.
void RunSession::arm_where_wanted(std::size_t device) {
  Seen& seen = seen_[device];
  const DeviceLook& last = looks_[device];
  const bool is_there = last.is_open && last.counters.ticks > 0;
  if (seen.wants_arming && last.opened == 0 && !last.problem.empty()) {
    seen.wants_arming = false;
    say(last.name + ": not there at the start; when it is, type arm and Enter");
  }
  if (!seen.wants_arming || !is_there) return;
  if (!seen.was_asked) seen.asked_s = seconds();
  seen.was_asked = true;
  const std::uint64_t* const disarmed = last.counters.disarmed;
  const bool was_armed = std::any_of(disarmed, disarmed + dev::kFaults, [](std::uint64_t count) { return count != 0; });
  if (was_armed || last.phase != dev::Phase::kDisarmed || last.fault == dev::Fault::kUnknownLimit) {
    seen.wants_arming = false;
  } else if (seconds() >= next_arming_s_) {
    host_.arm(static_cast<int>(device));
  }
}

void RunSession::notice_connection(std::size_t device) {
  Seen& seen = seen_[device];
  const DeviceLook& look = looks_[device];
  if (look.is_open != seen.is_open) {
    // a recording is never gone: it ends, and its problem says so
    if (look.is_open || !look.is_recorded) say(look.name + (look.is_open ? ": open" : ": gone"));
    seen.is_open = look.is_open;
  }
  if (look.problem != seen.problem) {
    seen.problem = look.problem;
    if (!seen.problem.empty()) say(look.name + ": " + seen.problem);
  }
}

void RunSession::notice_stability(std::size_t device) {
  Seen& seen = seen_[device];
  const DeviceLook& look = looks_[device];
  if (look.calmed > seen.calmed) {
    char share[16];
    std::snprintf(share, sizeof share, "%.3g", 100 * (1 - look.calmed));
    say(look.name + ": it shakes: the scene's forces are cut to " + share + " % until it is armed again; lower the stiffness");
  }
  if (look.is_hot && !seen.is_hot) say(look.name + ": the motors are warm: the force is cut to what they stand");
  seen.calmed = look.calmed;
  seen.is_hot = look.is_hot;
}

// Tells what has changed since the last look.
void RunSession::notice(std::size_t device) {
  Seen& seen = seen_[device];
  const DeviceLook& look = looks_[device];
  bool has_disarmed = false;
  for (int i = 1; i < dev::kFaults; ++i) {
    const auto fault = static_cast<dev::Fault>(i);
    if (look.counters.disarmed[i] > seen.disarmed[i]) {
      const bool is_end = fault == dev::Fault::kReadFailed && look.is_recorded;
      if (!is_end) say(look.name + ": disarmed: " + dev::fault_text(fault));
      has_disarmed = true;
    }
    seen.disarmed[i] = look.counters.disarmed[i];
  }
  if (look.phase != dev::Phase::kDisarmed || has_disarmed) seen.asked_s = -1;
  if (seen.asked_s >= 0 && seconds() - seen.asked_s > kRefusedAfterS) {
    const bool has_cause = look.fault != dev::Fault::kNone && look.fault != dev::Fault::kCommanded;
    say(look.name + ": not armed: " +
        (has_cause ? dev::fault_text(look.fault) : "the tip is pressed against something, or does not report"));
    seen.asked_s = -1;
  }
  if (look.phase == dev::Phase::kRamping && seen.phase == dev::Phase::kDisarmed) say(look.name + ": armed");
  seen.phase = look.phase;
}

void RunSession::look() {
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const double rate_hz = looks_[i].rate_hz;
    looks_[i] = host_.look(static_cast<int>(i));
    looks_[i].rate_hz = rate_hz;
    notice_connection(i);
    notice_stability(i);
    notice(i);
    arm_where_wanted(i);
  }
  if (seconds() >= next_arming_s_) next_arming_s_ = seconds() + kArmAgainS;
  if (std::string failure = host_.log_failure(); !failure.empty() && log_failure_.empty()) {
    wipe();
    tools::warn(failure);
    log_failure_ = std::move(failure);
  }
  if (seconds() >= next_status_s_) {
    show_status();
    next_status_s_ = std::max(next_status_s_ + status_every_s_, seconds());
  }
  if (std::ferror(stdout) != 0) host_.request_stop();  // nobody reads any more
}

void RunSession::obey(const std::string& line) {
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
  } else if (tap_ != nullptr && (command == "record" || command == "pause")) {
    say(tap_->set_recording(command == "record"));
  } else if (!command.empty()) {
    wipe();
    std::fprintf(stderr, "fdcg-servo: no such command; one of arm, disarm, quit%s, and Enter\n",
                 tap_ != nullptr ? ", record, pause" : "");
  }
}

void RunSession::disarm() {
  for (Seen& seen : seen_)
    seen.wants_arming = false;
  host_.disarm(dev::kAllDevices);
}

// Disarmed, and it has taken reports since: `first_zero`, 0 at first, keeps the number of the first that is surely zero.
bool RunSession::has_left_zero(std::size_t device, std::uint64_t* first_zero) {
  const DeviceLook look = host_.look(static_cast<int>(device));
  if (!look.is_open || !look.takes_output) return true;
  if (look.phase != dev::Phase::kDisarmed) return false;
  constexpr std::uint64_t kUnderWay = 2;  // one that is being sent, one that the tick before has put
  if (*first_zero == 0) *first_zero = look.writes + kUnderWay;
  return look.writes > *first_zero;
}

// A stopped process sends nothing: what its devices took last is what they would go on pushing with.
void RunSession::stop_disarmed(int signal, TerminalKeys& keys) {
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
  keys.suspend();
  signals_.stop_process(signal);
  keys.resume();
  say("continued: there is no force until you type arm and Enter");
}

void RunSession::run() {
  CommandInput input;
  std::vector<std::string> commands;
  while (!host_.is_stopping()) {
    if (arguments_.for_s > 0 && seconds() >= arguments_.for_s) break;
    const double left_s = arguments_.for_s > 0 ? arguments_.for_s - seconds() : 1;
    const int wait_ms = std::clamp(static_cast<int>(std::ceil(left_s * 1000)), 0, tap_ != nullptr ? RunTap::kLookMs : kLookMs);
    commands.clear();
    const bool has_waited = input.wait(wait_ms, &commands);
    // what is typed on the terminal that shows the status takes a line below it
    if (lines_drawn_ > 0 && isatty(STDIN_FILENO) != 0) lines_drawn_ += commands.size();
    if (tap_ != nullptr) tap_->take_commands(&commands);
    for (const std::string& command : commands)
      obey(command);
    if (host_.wait_ms(has_waited ? 0 : wait_ms)) break;
    if (const int signal = signals_.take_stop(); signal != 0) stop_disarmed(signal, input.keys);
    look();
    if (tap_ != nullptr) tap_->look(seconds());
  }
}

int RunSession::end(const std::string& stop_problem) {
  bool is_clean = true;
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    DeviceLook after = host_.look(static_cast<int>(i));
    const bool is_missing = after.opened == 0;
    const dev::Fault fault = after.fault;
    const bool is_played = after.is_over || (after.is_recorded && fault == dev::Fault::kReadFailed);  // that end is no fault
    // all are closed by now: how they were connected is what was last seen
    after.is_open = looks_[i].is_open;
    after.problem = looks_[i].problem;
    after.rate_hz = looks_[i].rate_hz;
    after.is_over = is_played;
    looks_[i] = std::move(after);
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

}  // namespace fdcg::servo
