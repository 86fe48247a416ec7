// SPDX-License-Identifier: Apache-2.0
// How strongly a signal vibrates within a band of frequencies.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

namespace fdcg::test {

// Mean square of what lies between two frequencies of a signal of samples taken `rate_hz` times a second, through a Hann
// window, its straight line taken out. Quadratic in the samples of the band.
inline double band_power(const std::vector<double>& signal, double rate_hz, double low_hz, double high_hz) {
  const std::size_t count = signal.size();
  const auto n = static_cast<double>(count);
  std::vector<double> windowed(count);
  double weight = 0;
  const double slope = (signal.back() - signal.front()) / (n - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / n);
    windowed[i] = w * (signal[i] - signal.front() - slope * static_cast<double>(i));
    weight += w * w;
  }
  double power = 0;
  for (std::size_t k = 1; 2 * k < count; ++k) {
    const double hz = static_cast<double>(k) * rate_hz / n;
    if (hz < low_hz || hz > high_hz) continue;
    const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / n);
    std::complex<double> sum = 0, phase = 1;
    for (const double value : windowed) {
      sum += value * phase;
      phase *= turn;
    }
    power += 2 * std::norm(sum);
  }
  return power / (n * weight);
}

}  // namespace fdcg::test
