// SPDX-License-Identifier: Apache-2.0
// What a maker's library is put in front of in tests: a mass of 0.1 kg held by a hand's spring, which comes down after a
// second.
#pragma once

#include <chrono>

namespace fdcg::test {

struct FakeHand {
  double place_m[3] = {0, 0, 0.01}, speed_m_per_s[3] = {};
  std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now(), last = since;

  void push(const double force_n[3]) {
    const auto now = std::chrono::steady_clock::now();
    const double target[3] = {0, 0, now - since < std::chrono::seconds(1) ? 0.01 : -0.003};
    double left_s = std::chrono::duration<double>(now - last).count();
    last = now;
    for (double step_s = 2e-4; left_s > 0; left_s -= step_s) {
      for (int i = 0; i < 3; ++i) {
        speed_m_per_s[i] += (force_n[i] + 200 * (target[i] - place_m[i]) - 6 * speed_m_per_s[i]) / 0.1 * step_s;
        place_m[i] += speed_m_per_s[i] * step_s;
      }
    }
  }
};

}  // namespace fdcg::test
