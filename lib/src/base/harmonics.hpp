// SPDX-License-Identifier: Apache-2.0
// Real harmonics of a line of numbers: the transforms in which the second difference of neighbours is a product.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace fdcg::bake {

// Discrete Fourier transform of any length, by powers of two (L. I. Bluestein's chirps for others). n log n.
class Fourier {
 public:
  explicit Fourier(std::size_t count);

  // value[k] = sum over n of value[n] e^(-2 pi i k n / count), in place; `values` has count of them.
  void transform(std::vector<std::complex<double>>& values) const;

 private:
  void transform_power(std::vector<std::complex<double>>& values) const;

  std::size_t count_, power_;  // power_: of two, count_ itself or at least 2 count_ - 1
  std::vector<std::complex<double>> turns_, chirp_, kernel_;
};

// With joined ends the last number's neighbour is the first (D. Hartley's transform); with free ends it is itself (the cosine
// transform of the second kind).
class Harmonics {
 public:
  enum class Ends { joined, free };
  Harmonics(std::size_t count, Ends ends);

  [[nodiscard]] std::size_t count() const { return count_; }
  // In place, of `count` numbers; backward is forward's inverse.
  void forward(double* line) const;
  void backward(double* line) const;
  // Twice a number less its two neighbours is this times the number, in harmonic k. 0 for k = 0 alone.
  [[nodiscard]] double stiffness(std::size_t k) const;

 private:
  std::size_t count_;
  Ends ends_;
  Fourier fourier_;
};

}  // namespace fdcg::bake
