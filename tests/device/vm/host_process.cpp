// SPDX-License-Identifier: Apache-2.0
#include "host_process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace fdcg::vm {
namespace {

constexpr std::size_t kKeptWords = 40;

[[noreturn]] void become(const std::vector<std::string>& command, const char* preload, int input, int output) {
  setpgid(0, 0);           // a group of its own, as a shell's job: one that SIGTSTP stops
  sched_param ordinary{};  // not the rig's own priority
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
  if (preload != nullptr) setenv("LD_PRELOAD", preload, 1);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& word : command)
    words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execv(words[0], words.data());
  _exit(127);
}

}  // namespace

HostProcess::~HostProcess() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void HostProcess::start(const std::vector<std::string>& command, const char* preload) {
  int input[2], output[2];
  if (pipe2(input, O_CLOEXEC) || pipe2(output, O_CLOEXEC)) throw std::runtime_error("no pipe to the host program");
  status_line_ = "null";
  partial_.clear();
  words_.clear();
  calmings_ = 0;
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork fails");
  if (pid_ == 0) become(command, preload, input[0], output[1]);
  close(input[0]);
  close(output[1]);
  input_ = input[1];
  output_ = output[0];
  fcntl(output_, F_SETFL, O_NONBLOCK);
}

void HostProcess::say(const std::string& line) {
  const std::string words = line + '\n';
  if (input_ >= 0 && write(input_, words.data(), words.size()) < 0 && errno != EPIPE)
    throw std::runtime_error("the host takes no word");
}

void HostProcess::signal(int number) {
  if (pid_ > 0) kill(pid_, number);
}

void HostProcess::receive() {
  char bytes[4096];
  ssize_t count;
  while ((count = read(output_, bytes, sizeof bytes)) > 0) {
    partial_.append(bytes, static_cast<std::size_t>(count));
    for (std::size_t end; (end = partial_.find('\n')) != std::string::npos; partial_.erase(0, end + 1))
      take_line(partial_.substr(0, end));
  }
  if (count < 0) return;  // nothing more for now
  int status = 0;
  waitpid(pid_, &status, 0);
  ending_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  close(input_);
  close(output_);
  pid_ = input_ = output_ = -1;
}

void HostProcess::take_line(const std::string& line) {
  if (!line.empty() && line[0] == '{') {
    status_line_ = line;
    ++status_count_;
    return;
  }
  calmings_ += line.find(": it shakes") != std::string::npos;
  words_.push_back(line);
  if (words_.size() > kKeptWords) words_.pop_front();
}

std::uint64_t count_of(const std::string& status_line, const std::string& name) {
  return nlohmann::json::parse(status_line).at(nlohmann::json::json_pointer("/devices/0/" + name)).get<std::uint64_t>();
}

std::uint64_t count_of_reason(const std::string& status_line, const std::string& reason) {
  return nlohmann::json::parse(status_line).at("devices").at(0).at("disarmed").value(reason, std::uint64_t{0});
}

}  // namespace fdcg::vm
