// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <thread>

namespace fdcg::bake {

// The SHA-256 of some bytes, computed beside other work: on a thread of its own unless they are few. The bytes must outlive it.
class Sha256Task {
 public:
  explicit Sha256Task(std::string_view bytes);

  // Waits for it: 64 lower-case hex digits, or nothing if the library has no SHA-256.
  std::string finish();

 private:
  void run(const std::stop_token& stop);

  std::string_view bytes_;
  std::string hex_;
  std::jthread thread_;  // last: its end, on destruction, comes before that of what it writes to
};

}  // namespace fdcg::bake
