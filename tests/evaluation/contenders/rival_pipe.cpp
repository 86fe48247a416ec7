// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "rival.hpp"

namespace fdcg::test {
namespace {

constexpr int kLoad_ms = 600'000, kStep_ms = 60'000;

// A shell's command whose standard input and output are ours.
class Process {
 public:
  explicit Process(std::string command) : command_(std::move(command)) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw std::runtime_error(command_ + ": no socket");
    child_ = fork();
    if (child_ == 0) {
      setpgid(0, 0);  // so that all that the shell starts ends with it
      dup2(ends[1], STDIN_FILENO);
      dup2(ends[1], STDOUT_FILENO);
      execl("/bin/sh", "sh", "-c", command_.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    socket_ = ends[0];
    if (child_ < 0) throw std::runtime_error(command_ + ": no process");
  }
  ~Process() {
    close(socket_);
    kill(-child_, SIGKILL);
    kill(child_, SIGKILL);  // should it have no group yet
    waitpid(child_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void write(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t sent = send(socket_, text.data() + done, text.size() - done, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) throw std::runtime_error("pipe:" + command_ + ": the process has ended, or closed its input");
      done += static_cast<std::size_t>(sent);
    }
  }
  // A line without its end.
  std::string read(int patience_ms) {
    for (;;) {
      const std::size_t end = come_.find('\n');
      if (end != std::string::npos) {
        std::string line = come_.substr(0, end);
        come_.erase(0, end + 1);
        return line;
      }
      pollfd waiting = {socket_, POLLIN, 0};
      const int ready = poll(&waiting, 1, patience_ms);
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0)
        throw std::runtime_error("pipe:" + command_ + ": no answer in " + std::to_string(patience_ms / 1000) + " s");
      char some[4096];
      const ssize_t got = recv(socket_, some, sizeof some, 0);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) throw std::runtime_error("pipe:" + command_ + ": the process has ended, or closed its output");
      come_.append(some, static_cast<std::size_t>(got));
    }
  }

 private:
  std::string command_, come_;
  pid_t child_ = -1;
  int socket_ = -1;
};

class RivalOfPipe : public Contender {
 public:
  RivalOfPipe(const std::string& command, const bake::PolygonSoup& soup) : process_(command) {
    const RivalMesh mesh(soup);
    std::string text = "fdcg-rival 1\nmesh " + std::to_string(mesh.points_m.size() / 3) + " " +
                       std::to_string(mesh.corners.size() / 3) + " " + hexadecimal({kStiffness_n_per_m}) + "\n";
    for (std::size_t i = 0; i < mesh.points_m.size(); i += 3)
      text += hexadecimal({mesh.points_m[i], mesh.points_m[i + 1], mesh.points_m[i + 2]}) + "\n";
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
      text += std::to_string(mesh.corners[i]) + " " + std::to_string(mesh.corners[i + 1]) + " " +
              std::to_string(mesh.corners[i + 2]) + "\n";
    const auto begin = std::chrono::steady_clock::now();
    process_.write(text);
    const std::string answer = process_.read(kLoad_ms);
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::istringstream words(answer);
    std::string ready, friction;
    words >> ready >> info_.name >> info_.family >> info_.precision >> friction >> info_.bytes;
    if (!words || ready != "ready" || (friction != "yes" && friction != "no"))
      throw std::runtime_error("pipe:" + command + ": says '" + answer + "', not: ready NAME FAMILY PRECISION yes|no BYTES");
    info_.has_friction = friction == "yes";
    info_.version = "pipe:" + command;
    check_rival(info_.version, info_);
  }
  void reset() override { process_.write("reset\n"); }
  void set_friction(double mu_static, double mu_dynamic) override {
    process_.write("friction " + hexadecimal({mu_static, mu_dynamic}) + "\n");
    reset();
  }
  void step(const Ground::Point& hip_m, Feel& feel) override {
    process_.write("step " + hexadecimal({hip_m[0], hip_m[1], hip_m[2]}) + "\n");
    const std::string answer = process_.read(kStep_ms);
    const std::size_t space = answer.find(' ');
    const std::string state = answer.substr(0, space);
    const char* at = space == std::string::npos ? "" : answer.c_str() + space;
    double numbers[7];
    for (double& number : numbers) {
      char* end = nullptr;
      number = std::strtod(at, &end);
      if (end == at || (state != "contact" && state != "free"))
        throw std::runtime_error(info_.name + ": says '" + answer + "', not: contact|free and seven numbers");
      at = end;
    }
    feel = {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}, state == "contact", 0, false};
    own_ns_ = numbers[6];
  }
  [[nodiscard]] double own_ns() const override { return own_ns_; }

 private:
  static std::string hexadecimal(std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) {
      char number[40];
      std::snprintf(number, sizeof number, "%a", value);
      text.append(text.empty() ? "" : " ").append(number);
    }
    return text;
  }

  Process process_;
  double own_ns_ = -1;
};

}  // namespace

std::unique_ptr<Contender> make_rival_of_pipe(const std::string& command, const bake::PolygonSoup& soup) {
  return std::make_unique<RivalOfPipe>(command, soup);
}

}  // namespace fdcg::test
