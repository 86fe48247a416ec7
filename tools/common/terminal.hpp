// SPDX-License-Identifier: Apache-2.0
// What the programs show to a person: colour, progress, grouped digits.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace fdcg::tools {

enum class Stream { standard_output = 1, standard_error = 2 };

bool is_terminal(Stream stream);

// The stream is a terminal, and neither NO_COLOR (https://no-color.org) nor TERM=dumb forbids it.
bool wants_colour(Stream stream);

std::string grouped(std::uint64_t number);                              // 1234567 -> "1,234,567"
std::string counted(std::uint64_t count, const std::string& singular);  // "1 contact", "2,000 nodes"
std::string short_number(double value, int digits = 6);                 // significant ones

// A bar on standard error, drawn once the work has taken a second, wiped when it ends. Nothing where standard error is no
// terminal or `enabled` is false.
class ProgressBar {
 public:
  explicit ProgressBar(bool enabled);
  ~ProgressBar() { wipe(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::string_view stage, double fraction);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool drawn_ = false;
  Clock::time_point started_ = Clock::now();
  Clock::time_point last_drawn_{};
};

}  // namespace fdcg::tools
