// SPDX-License-Identifier: Apache-2.0
#include "terminal_keys.hpp"

#include <termios.h>
#include <unistd.h>

#include <cstdio>

#include "fdcg/device_tools.hpp"

namespace fdcg::servo {
namespace {

constexpr char kBackspace = 8, kDelete = 127;
constexpr std::size_t kLongestLine = 200;
termios as_it_was;

void restore() {
  tcsetattr(STDIN_FILENO, TCSANOW, &as_it_was);
}

}  // namespace

TerminalKeys::TerminalKeys() {
  resume();
}

TerminalKeys::~TerminalKeys() {
  suspend();
}

void TerminalKeys::resume() {
  if (is_on_ || isatty(STDIN_FILENO) == 0 || tcgetpgrp(STDIN_FILENO) != getpgrp()) return;
  if (tcgetattr(STDIN_FILENO, &as_it_was) != 0) return;
  termios keys = as_it_was;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // signals' keys stay
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  is_on_ = tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
  if (is_on_) dev::set_last_act(restore);
}

void TerminalKeys::suspend() {
  dev::set_last_act(nullptr);
  if (is_on_) restore();
  is_on_ = false;
}

void TerminalKeys::type(const char* bytes, std::size_t count, std::vector<std::string>* commands) {
  for (std::size_t i = 0; i < count; ++i) {
    const char key = bytes[i];
    if (key == ' ') {
      commands->emplace_back("disarm");
      line_.clear();
      std::fputs("\n", stdout);
    } else if (key == '\n' || key == '\r') {
      commands->push_back(line_);
      line_.clear();
      std::fputs("\n", stdout);
    } else if (key == kBackspace || key == kDelete) {
      if (line_.empty()) continue;
      line_.pop_back();
      std::fputs("\b \b", stdout);
    } else if (key > ' ' && line_.size() < kLongestLine) {
      line_ += key;
      std::fputc(key, stdout);
    }
  }
  std::fflush(stdout);
}

}  // namespace fdcg::servo
