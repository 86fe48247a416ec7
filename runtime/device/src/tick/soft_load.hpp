// SPDX-License-Identifier: Apache-2.0
// What presses on the corners of a soft sheet. A fingertip is no needle: the force on a corner is spread over those around it,
// as heat spreads along the edges for a while,
//
//   f <- f + a * sum over neighbours (f_neighbour - f),  `rounds` times, an even number, a <= 1 / the most edges of a corner
//
// No share is negative, and all of them together are one. The shares are a square of a symmetric matrix that commutes with the
// sheet's springs: so the god-object, which rides on one triangle while the whole patch gives way under it, gets no more work
// out of the sheet than it put in. How far: the shares' root mean square distance is the radius, on an even mesh, inside it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fdcg::dev {

// Who is beside whom: of corner c, neighbour[first[c]] to neighbour[first[c + 1] - 1].
struct CornerNeighbours {
  std::vector<std::uint32_t> first{0}, neighbour;
  std::uint32_t count() const { return static_cast<std::uint32_t>(first.size() - 1); }
};

class SoftLoad {
 public:
  static constexpr int kMostRounds = 64;

  // place_m: 3 numbers a corner, times `scale` metres; `corners` must outlive it. radius_m: 0: a force stays on its corner;
  // none: twice the mean edge, or what kMostRounds allow. Empty: fine. Otherwise that it is more than they allow.
  std::string begin(const CornerNeighbours& corners, const std::vector<double>& place_m, double scale,
                    std::optional<double> radius_m);

  // Adds share * force_n on a corner.
  void press(std::uint32_t corner, const double force_n[3], double share);
  // All that was pressed since the last clear; once. Cost: rounds times the corners that many edges away at most: 2 us at the
  // standard radius, 130 at three times that (a contact; busy machine).
  void spread();
  void clear();
  const double* force_n(std::uint32_t corner) const { return &force_n_[3 * std::size_t{corner}]; }

  double radius_m() const { return radius_m_; }

 private:
  void take_in(std::uint32_t corner);

  const CornerNeighbours* corners_ = nullptr;
  double radius_m_ = 0, share_ = 0;
  int rounds_ = 0;
  std::vector<double> force_n_, next_n_;  // 3 a corner
  std::vector<std::uint32_t> loaded_;     // corners with a force
  std::vector<std::uint8_t> is_loaded_;   // by corner
};

}  // namespace fdcg::dev
