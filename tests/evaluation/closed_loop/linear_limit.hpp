// SPDX-License-Identifier: Apache-2.0
// Theory: what stiffness a loop without quantum and dry friction bears, exactly, and the lines that the literature draws.
#pragma once

#include "loop_setup.hpp"

namespace fdcg::test {

// The largest modulus of the eigenvalues of the sampled loop in contact: x, v, the forces under way, the last reading. 1 is the
// border of stability.
long double spectral_radius(const LoopSetup& setup, double wall_n_per_m);

// The stiffness at which it passes 1, to 1e-9.
double exact_limit_n_per_m(const LoopSetup& setup);

// Colgate and Schenkel 1994: a wall K + B (1 - z^-1) / T behind a sample and a zero-order hold is passive, and so stable in any
// passive hand, if and only if
//   b > T / 2 / (1 - cos wT) Re{(1 - e^-jwT) H(e^jwT)} for 0 <= w <= pi / T,   so without delay  b > K T / 2 + |B|.
// With n ticks of delay H is K z^-n; the bracket becomes sin((2 n + 1) wT / 2) / sin(wT / 2) <= 2 n + 1, which gives
//   b > K T / 2 + K T_d,  T_d = n T,
// the same line that Gil, Sanchez, Hulin, Preusche and Hirzinger 2009 propose for stability at low damping. For B > 0 only
// without delay; else NaN. b is the device's alone: the hand's may be anything passive.
double passivity_line_n_per_m(double damping_n_s_per_m, const LoopSetup& setup);

// Abbott and Okamura 2005, K <= min(2 b / T, 2 c / quantum): passive with an encoder, necessary and sufficient. No delay, no B.
double encoder_line_n_per_m(double damping_n_s_per_m, const LoopSetup& setup);

}  // namespace fdcg::test
