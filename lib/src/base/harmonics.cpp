// SPDX-License-Identifier: Apache-2.0
#include "base/harmonics.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace fdcg::bake {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

// Without the care for infinities that operator* takes.
Complex product(const Complex& a, const Complex& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

Complex turned(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

std::size_t power_for(std::size_t count) {
  std::size_t power = 1;
  while (power < count)
    power *= 2;
  if (power == count) return power;
  while (power < 2 * count - 1)
    power *= 2;
  return power;
}

}  // namespace

Fourier::Fourier(std::size_t count) : count_(count), power_(power_for(count)) {
  turns_.reserve(power_ / 2);
  for (std::size_t k = 0; k < power_ / 2; ++k)
    turns_.push_back(turned(-2 * kPi * static_cast<double>(k) / static_cast<double>(power_)));
  if (power_ == count_) return;
  kernel_.assign(power_, {});
  for (std::size_t n = 0; n < count_; ++n) {
    const std::size_t square = n * n % (2 * count_);  // of n below 2^32
    chirp_.push_back(turned(-kPi * static_cast<double>(square) / static_cast<double>(count_)));
    kernel_[n] = kernel_[(power_ - n) % power_] = std::conj(chirp_.back());
  }
  transform_power(kernel_);
}

void Fourier::transform_power(std::vector<Complex>& values) const {
  for (std::size_t i = 1, j = 0; i < power_; ++i) {  // j: i with its bits in reverse
    std::size_t bit = power_ / 2;
    for (; (j & bit) != 0; bit /= 2)
      j ^= bit;
    j ^= bit;
    if (i < j) std::swap(values[i], values[j]);
  }
  for (std::size_t half = 1; half < power_; half *= 2) {
    const std::size_t stride = power_ / 2 / half;
    for (std::size_t first = 0; first < power_; first += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const Complex odd = product(turns_[k * stride], values[first + half + k]), even = values[first + k];
        values[first + k] = even + odd;
        values[first + half + k] = even - odd;
      }
    }
  }
}

void Fourier::transform(std::vector<Complex>& values) const {
  if (power_ == count_) return transform_power(values);
  std::vector<Complex> longer(power_);
  for (std::size_t n = 0; n < count_; ++n)
    longer[n] = product(values[n], chirp_[n]);
  transform_power(longer);
  for (std::size_t n = 0; n < power_; ++n)
    longer[n] = std::conj(product(longer[n], kernel_[n]));
  transform_power(longer);
  const double share = 1 / static_cast<double>(power_);
  for (std::size_t n = 0; n < count_; ++n)
    values[n] = product(share * std::conj(longer[n]), chirp_[n]);
}

Harmonics::Harmonics(std::size_t count, Ends ends) : count_(count), ends_(ends), fourier_(count) {}

double Harmonics::stiffness(std::size_t k) const {
  const double sine = std::sin((ends_ == Ends::joined ? kPi : kPi / 2) * static_cast<double>(k) / static_cast<double>(count_));
  return 4 * sine * sine;
}

void Harmonics::forward(double* line) const {
  std::vector<Complex> values(count_);
  if (ends_ == Ends::joined) {
    for (std::size_t n = 0; n < count_; ++n)
      values[n] = line[n];
    fourier_.transform(values);
    for (std::size_t k = 0; k < count_; ++k)
      line[k] = values[k].real() - values[k].imag();
    return;
  }
  // every second number, and the others backwards (J. Makhoul 1980)
  for (std::size_t n = 0; n < count_; ++n)
    values[n % 2 == 0 ? n / 2 : count_ - 1 - n / 2] = line[n];
  fourier_.transform(values);
  for (std::size_t k = 0; k < count_; ++k)
    line[k] = 2 * product(turned(-kPi * static_cast<double>(k) / static_cast<double>(2 * count_)), values[k]).real();
}

void Harmonics::backward(double* line) const {
  const double share = 1 / static_cast<double>(count_);
  std::vector<Complex> values(count_);
  if (ends_ == Ends::joined) {
    forward(line);  // its own inverse, but for a factor
    for (std::size_t n = 0; n < count_; ++n)
      line[n] *= share;
    return;
  }
  for (std::size_t k = 0; k < count_; ++k) {
    const Complex both(line[k], k == 0 ? 0 : -line[count_ - k]);
    values[k] = std::conj(product(turned(kPi * static_cast<double>(k) / static_cast<double>(2 * count_)), both));
  }
  fourier_.transform(values);  // of the conjugates: the inverse's conjugate, which is real
  for (std::size_t n = 0; n < count_; ++n)
    line[n] = share / 2 * values[n % 2 == 0 ? n / 2 : count_ - 1 - n / 2].real();
}

}  // namespace fdcg::bake
