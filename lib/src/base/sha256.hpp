// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <thread>

namespace fdcg::bake {

// The SHA-256 of a range of bytes, computed concurrently with other work: on its own thread unless the range is short. The
// bytes must outlive the object.
class Sha256Task {
 public:
  explicit Sha256Task(std::string_view bytes);

  // Waits for the result: 64 lower-case hex digits, or nothing if the crypto library provides no SHA-256.
  std::string finish();

 private:
  void run(const std::stop_token& stop);

  std::string_view bytes_;
  std::string hex_;
  std::jthread thread_;  // declared last: joined on destruction before the members that it writes are destroyed
};

}  // namespace fdcg::bake
