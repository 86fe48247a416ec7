// SPDX-License-Identifier: Apache-2.0
// usage: pty_device SCENE.json PROFILE.json LINK
// A device on a serial line: the scene's simulated one, firmware core and faults included, behind a pseudo-terminal that LINK
// points to, in the frames or lines of the profile. Prints "ready", then for every line that it reads on standard input what
// its motors were last asked for, and whether it says that it applies that: "force N enabled 0|1 outputs COUNT applies 0|1". It
// ends with its input. An unplugged device hangs up.
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include "profile/profile_json.hpp"
#include "profile/report_codec.hpp"
#include "scene/scene_json.hpp"
#include "transport/serial_frames.hpp"
#include "transport/transports.hpp"

using namespace fdcg::dev;

namespace {

struct Asked {
  std::atomic<double> force_n{0};
  std::atomic<bool> is_enabled{false}, is_applied{false};
  std::atomic<long> outputs{0};
};

std::string text_of(const char* path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

[[noreturn]] void stop(const std::string& problem) {
  std::fprintf(stderr, "pty_device: %s\n", problem.c_str());
  std::_Exit(3);
}

class Bridge {
 public:
  Bridge(const SimulationConfig& simulation, const Profile& spoken, std::string link)
      : device_(make_simulated_transport(simulation)),
        own_(simulated_profile(simulation)),
        spoken_(spoken),
        link_(std::move(link)) {}

  void run(Asked* asked) {
    for (;;) {
      while (!device_->open().empty())
        usleep(1000);
      open_line();
      std::atomic<bool> is_over{false};
      std::thread receiver([&] { receive(asked, &is_over); });
      send(asked);
      is_over = true;
      receiver.join();
      close(line_);
      device_->close();
    }
  }

 private:
  void open_line() {
    line_ = posix_openpt(O_RDWR | O_NOCTTY);
    if (line_ < 0 || grantpt(line_) != 0 || unlockpt(line_) != 0) stop("no pseudo-terminal");
    termios raw{};
    tcgetattr(line_, &raw);
    cfmakeraw(&raw);
    tcsetattr(line_, TCSANOW, &raw);
    const std::string next = link_ + ".next";
    unlink(next.c_str());
    if (symlink(ptsname(line_), next.c_str()) != 0 || rename(next.c_str(), link_.c_str()) != 0) stop("no link " + link_);
    keeper_ = open(ptsname(line_), O_RDWR | O_NOCTTY);  // so that a host which comes later, or again, is no hang-up
  }

  void send(Asked* asked) {
    std::uint8_t report[kMaxReportBytes + 16], frame[2 * kMaxFrameBytes];
    for (;;) {
      const ReadResult read = device_->read(report, sizeof report, 100);
      if (read.status == ReadStatus::kLost) break;
      if (read.status == ReadStatus::kTimeout) continue;
      int bytes = read.bytes;
      Sample sample;
      const bool is_told = decode_input(own_, report, bytes, &sample) == Verdict::kGood || sample.has_fault;
      if (is_told) asked->is_applied = sample.is_enabled;
      if (spoken_.input.is_text()) {
        if (!is_told) continue;
        answered_ = sample.sequence;
        bytes = encode_input(spoken_, sample, report);
      }
      const int count = make_frame(spoken_.input.is_text(), report, std::min(bytes, kMaxReportBytes), frame);
      if (write(line_, frame, static_cast<std::size_t>(count)) < 0) break;
    }
    close(keeper_);
  }

  void receive(Asked* asked, const std::atomic<bool>* is_over) {
    FrameReader frames(spoken_.output.is_text());
    std::uint8_t report[kMaxReportBytes + 1];
    while (!*is_over) {
      pollfd ready{line_, POLLIN, 0};
      if (poll(&ready, 1, 20) <= 0) continue;
      const ssize_t got = read(line_, frames.room(), static_cast<std::size_t>(frames.room_bytes()));
      if (got <= 0) continue;
      frames.added(static_cast<int>(got));
      for (int bytes = 0; frames.next(report, sizeof report, &bytes);)
        take(report, bytes, asked);
    }
  }

  void take(const std::uint8_t* report, int bytes, Asked* asked) {
    Command command;
    if (!decode_output(spoken_, report, bytes, &command)) return;
    asked->force_n = std::hypot(command.effort[0], command.effort[1], command.effort[2]);
    asked->is_enabled = command.is_enabled;
    ++asked->outputs;
    std::uint8_t own[kMaxReportBytes];
    if (!spoken_.output.is_text()) {
      device_->write(report, bytes);
      return;
    }
    // a line of 16 bits becomes a report of 32, which answers the newest sample
    sequence_ += (command.sequence - sequence_) & 0xFFFF;
    command.sequence = sequence_;
    command.echo = answered_;
    device_->write(own, encode_output(own_, command, own));
  }

  std::unique_ptr<Transport> device_;
  const Profile own_, spoken_;
  const std::string link_;
  int line_ = -1, keeper_ = -1;
  std::uint32_t sequence_ = 0;
  std::atomic<std::uint32_t> answered_{0};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) stop("usage: pty_device SCENE.json PROFILE.json LINK");
  HostConfig scene;
  Profile profile;
  if (const std::string problem = parse_scene(text_of(argv[1]), argv[1], &scene); !problem.empty()) stop(problem);
  if (const std::string problem = parse_profile(text_of(argv[2]), argv[2], &profile); !problem.empty()) stop(problem);
  sched_param priority{};
  priority.sched_priority = 60;
  sched_setscheduler(0, SCHED_FIFO, &priority);  // where it may: the threads have it too
  static Asked asked;
  static Bridge bridge(scene.devices.at(0).simulation, profile, argv[3]);
  std::thread([] { bridge.run(&asked); }).detach();
  for (int i = 0; i < 5000 && access(argv[3], F_OK) != 0; ++i)
    usleep(1000);
  std::printf("ready\n");
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
    std::printf("force %.6g enabled %d outputs %ld applies %d\n", asked.force_n.load(), asked.is_enabled ? 1 : 0,
                asked.outputs.load(), asked.is_applied ? 1 : 0);
    std::fflush(stdout);
  }
  std::_Exit(0);
}
