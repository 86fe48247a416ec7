// SPDX-License-Identifier: Apache-2.0
// The POSIX side of the terminal; another platform needs another file of this name.
#include "terminal.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace fdcg::tools {
namespace {

constexpr auto kQuietTime = std::chrono::seconds(1);  // work shorter than this shows no bar
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;

}  // namespace

bool is_terminal(Stream stream) {
  return isatty(static_cast<int>(stream)) == 1;
}

bool wants_colour(Stream stream) {
  const char* const no_color = std::getenv("NO_COLOR");
  const char* const term = std::getenv("TERM");
  if (no_color != nullptr && *no_color != '\0') return false;
  if (term != nullptr && std::string_view(term) == "dumb") return false;
  return is_terminal(stream);
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, 1, ',');
  }
  return text;
}

std::string counted(std::uint64_t count, const std::string& singular) {
  return grouped(count) + " " + singular + (count == 1 ? "" : "s");
}

std::string short_number(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

ProgressBar::ProgressBar(bool enabled) : enabled_(enabled && is_terminal(Stream::standard_error)) {}

void ProgressBar::update(std::string_view stage, double fraction) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - started_ < kQuietTime || now - last_drawn_ < kRedrawInterval) return;
  last_drawn_ = now;
  drawn_ = true;
  const double whole = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(whole * kBarWidth);
  std::fprintf(stderr, "\r\033[K[%-*s] %3.0f %%  %.*s", kBarWidth, std::string(static_cast<std::size_t>(filled), '#').c_str(),
               100 * whole, static_cast<int>(stage.size()), stage.data());
  std::fflush(stderr);
}

void ProgressBar::wipe() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace fdcg::tools
