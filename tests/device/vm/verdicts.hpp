// SPDX-License-Identifier: Apache-2.0
// PASS and FAIL lines with their numbers: what the console is compared by.
#pragma once

#include <cstdio>
#include <string>

namespace fdcg::vm {

class Verdicts {
 public:
  void say(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  bool check(bool holds, const std::string& what) {
    say((holds ? "PASS " : "FAIL ") + what);
    failed_ += !holds;
    return holds;
  }
  int failed() const { return failed_; }

 private:
  int failed_ = 0;
};

template <class... Values>
std::string words(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace fdcg::vm
