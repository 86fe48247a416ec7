// SPDX-License-Identifier: Apache-2.0
// A terminal whose keys are read one by one, so that one key alone stops: what is typed is shown and edited here instead.
#pragma once

#include <string>
#include <vector>

namespace fdcg::servo {

class TerminalKeys {
 public:
  // No effect where standard input is no terminal, or this process is not in its foreground.
  TerminalKeys();
  ~TerminalKeys();  // as it was
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  [[nodiscard]] bool is_on() const { return is_on_; }
  // Turns bytes that were typed into commands: a space is "disarm" at once, Enter ends a line.
  void type(const char* bytes, std::size_t count, std::vector<std::string>* commands);
  void suspend();  // before the process is stopped
  void resume();

 private:
  bool is_on_ = false;
  std::string line_;
};

}  // namespace fdcg::servo
