// SPDX-License-Identifier: Apache-2.0
// Stick-slip against its formulas, on a flat grid of seams.
//
// Driven: the HIP goes to and fro at a constant speed. The god-object breaks away when the HIP is mu_s d ahead of it, springs
// forward by (mu_s - mu_d) d at once, and follows without chatter; after the HIP turns it stays until the HIP has come back by
// (mu_s + mu_d) d. What is sampled may be late by one tick's way at most.
//
// Pulled: a hand (mass, spring, damper) whose far end goes at a constant speed drags the HIP. Between ticks it is integrated
// exactly, so that what remains is the sampling of the contact. In continuous time a period is, from one break-away to the
// next,
//   vT = s + (mu_s - mu_d) d,   s: the HIP's way from break-away to its next standstill,
// where s follows from a damped swing that starts at the break-away's force and ends at x' = 0, and where the swing of the mass
// on the virtual spring has died away before the next break-away.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "held_plant.hpp"
#include "laws.hpp"
#include "pressed.hpp"
#include "ramp.hpp"

namespace fdcg::test {
namespace {

constexpr double kRates_hz[] = {1e3, 4e3, 1e4, 4e4};
constexpr double kRounding = 1e-9;  // of the depth: far above the god-object's rounding, far below a tick's way

// One quantity: what was seen and what should have been.
void say(Table& table, const std::string& motion, double rate_hz, double speed_m_per_s, const fdcg_params& params,
         double depth_m, const std::string& quantity, double measured, double analytic) {
  table.row(motion, rate_hz, speed_m_per_s, params.mu_static, params.mu_dynamic, depth_m, quantity, measured, analytic,
            measured / analytic - 1);
}

// ---- driven ----------------------------------------------------------------------------------------------------------------

struct Driven {
  double break_away_m = 0, leap_m = 0, turn_m = 0;  // HIP ahead of GO just after the tick's move; GO's leap; way after the turn
  int chatter = 0;                                  // changes between stick and slip beyond the two break-aways and the turn
};

Driven drive(const Ramp& ramp, const fdcg_params& params, double depth_m, double tick_m) {
  constexpr double kWay_m = 0.03;
  Pressed pressed{&ramp.view()};
  pressed.press(params, ramp.place(0, 0.003, depth_m), ramp.place(0, 0.003, -depth_m));
  const Hip along = ramp.place(1, 0, 0);
  const auto god_object = [&] {
    return dot(Hip{pressed.result.god_object_m[0], pressed.result.god_object_m[1], pressed.result.god_object_m[2]}, along);
  };
  Driven seen;
  double x = 0, turned_at = 0;
  int changes = 0;
  bool was_slipping = false;
  for (int leg = 0; leg < 2; ++leg) {
    const double heading = leg == 0 ? 1 : -1;
    const int ticks = static_cast<int>(kWay_m / tick_m);
    for (int tick = 0; tick < ticks; ++tick) {
      const double before = god_object();
      x += heading * tick_m;
      pressed.step(params, ramp.place(x, 0.003, -depth_m));
      const bool slips = pressed.result.slipping != 0;
      if (slips != was_slipping) ++changes;
      if (slips && !was_slipping && leg == 0 && changes == 1) {
        seen.break_away_m = x - before;
        seen.leap_m = god_object() - before;
      }
      if (slips && !was_slipping && leg == 1) seen.turn_m = turned_at - x;
      was_slipping = slips;
    }
    turned_at = x;
  }
  seen.chatter = changes - 3;  // slip; at the turn stick; slip
  return seen;
}

void measure_driven(const LawOptions& options, Table& table, Bars& bars) {
  constexpr double kFrictions[][2] = {{0.3, 0.2}, {0.6, 0.4}, {1, 0.5}, {1.5, 0.3}};
  constexpr double kSpeeds_m_per_s[] = {0.003, 0.03, 0.1};
  double earliest = 0, latest = 0;  // in ticks' ways
  int chatter = 0, cases = 0;
  for (const auto& mu : kFrictions) {
    for (const double depth_m : {1e-3, 5e-3}) {
      for (const double speed : kSpeeds_m_per_s) {
        for (const double rate : kRates_hz) {
          if (options.is_quick && rate > 1e4) continue;
          const Ramp ramp({RampKind::rounded_seams}, bake::Precision::f64, options.seed);
          const fdcg_params params = contact_params(mu[0], mu[1]);
          const double tick_m = speed / rate;
          const Driven seen = drive(ramp, params, depth_m, tick_m);
          const double expected[] = {mu[0] * depth_m, (mu[0] - mu[1]) * depth_m, (mu[0] + mu[1]) * depth_m};
          const double measured[] = {seen.break_away_m, seen.leap_m, seen.turn_m};
          const char* const names[] = {"break_away_m", "leap_m", "turn_m"};
          for (int q = 0; q < 3; ++q) {
            say(table, "driven", rate, speed, params, depth_m, names[q], measured[q], expected[q]);
            const double late = (measured[q] - expected[q]) / tick_m, rounding = kRounding * depth_m / tick_m;
            earliest = std::min(earliest, late + rounding);
            latest = std::max(latest, late - rounding);
          }
          chatter += seen.chatter;
          ++cases;
        }
      }
    }
  }
  bars.at_least("stick-slip, driven: earliest break-away, leap or turn", earliest, 0, "ticks", "against mu_s d and its kin");
  bars.at_most("stick-slip, driven: latest break-away, leap or turn", latest, 1, "ticks");
  bars.at_most("stick-slip, driven: changes between stick and slip beyond the three there are", chatter, 0, "changes",
               std::to_string(cases) + " motions");
}

// ---- pulled ----------------------------------------------------------------------------------------------------------------

constexpr double kMass_kg = 0.1, kHand_n_per_m = 300, kHand_n_s_per_m = 2.2, kPull_m_per_s = 0.004;
constexpr double kContact_n_per_m = 2000, kPulledDepth_m = 5e-3;

struct Pulled {
  double break_force_n = 0, drop_n = 0, slip_way_m = 0, period_s = 0;
};

// In continuous time. y = x - X: the HIP seen from the hand's far end.
Pulled analytic_pull(double mu_static, double mu_dynamic) {
  const long double m = kMass_kg, k = kHand_n_per_m, b = kHand_n_s_per_m, v = kPull_m_per_s;
  const long double load = static_cast<long double>(kContact_n_per_m) * kPulledDepth_m;
  const long double creep = v * k / (k + kContact_n_per_m);  // speed of the HIP while the god-object sticks
  const long double decay = b / (2 * m), turn = std::sqrt(k / m - decay * decay);
  const long double rest = -mu_dynamic * load / k, y0 = -(mu_static * load + b * (creep - v)) / k;
  const long double a = y0 - rest, c = (creep - v + decay * a) / turn;
  const auto swing = [&](long double t) { return std::exp(-decay * t) * (a * std::cos(turn * t) + c * std::sin(turn * t)); };
  const auto speed = [&](long double t) {
    return v +
           std::exp(-decay * t) * ((turn * c - decay * a) * std::cos(turn * t) - (turn * a + decay * c) * std::sin(turn * t));
  };
  // The HIP starts at `creep` > 0 and is pulled on; within a turn and a half of the swing it stands still.
  const long double step = 1e-4L / turn;
  long double before = 0;
  while (speed(before + step) > 0)
    before += step;
  long double after = before + step;
  for (int halving = 0; halving < 60; ++halving) {
    const long double middle = (before + after) / 2;
    (speed(middle) > 0 ? before : after) = middle;
  }
  const long double way = swing(after) - swing(0) + v * after;
  Pulled pulled;
  pulled.break_force_n = static_cast<double>(mu_static * load);
  pulled.drop_n = static_cast<double>((mu_static - mu_dynamic) * load);
  pulled.slip_way_m = static_cast<double>(way);
  pulled.period_s = static_cast<double>((way + (mu_static - mu_dynamic) * static_cast<long double>(kPulledDepth_m)) / v);
  return pulled;
}

// The mean over the periods after the first, in which the start dies away.
Pulled pull(const Ramp& ramp, const fdcg_params& params, double rate_hz, Table* trace) {
  constexpr int kPeriods = 7;
  constexpr double kStart_m = -0.07, kTraceTick_s = 1e-2, kTraced_s = 9;
  const HeldPlant hand({kMass_kg, kHand_n_s_per_m, kHand_n_per_m, 0}, 1 / rate_hz);
  const Hip along = ramp.place(1, 0, 0);
  Pressed pressed{&ramp.view()};
  const auto place = [&](double x) { return ramp.place(x, 0.003, -kPulledDepth_m); };
  pressed.press(params, ramp.place(kStart_m, 0.003, kPulledDepth_m), place(kStart_m));
  PlantState state = {0, -kPull_m_per_s};  // at rest, seen from the far end
  std::vector<double> broke_at_s;
  Pulled sums;
  double started_at_m = 0, last_pull_n = 0;
  bool was_slipping = false;
  const auto traced_ticks = std::max(1L, std::lround(kTraceTick_s * rate_hz));
  for (long tick = 1; broke_at_s.size() <= kPeriods && tick < 60 * rate_hz; ++tick) {
    const double force_n = dot({pressed.result.force_n[0], pressed.result.force_n[1], pressed.result.force_n[2]}, along);
    state = hand.after_tick(state, force_n);
    const double time_s = static_cast<double>(tick) / rate_hz, x = kStart_m + kPull_m_per_s * time_s + state.x_m;
    pressed.step(params, place(x));
    const bool slips = pressed.result.slipping != 0, is_counted = !broke_at_s.empty();
    const double now_n = -dot({pressed.result.force_n[0], pressed.result.force_n[1], pressed.result.force_n[2]}, along);
    if (slips && !was_slipping) {
      if (is_counted) sums.break_force_n += last_pull_n, sums.drop_n += last_pull_n - now_n;
      broke_at_s.push_back(time_s);
      started_at_m = x;
    }
    if (!slips && was_slipping && is_counted && broke_at_s.size() > 1) sums.slip_way_m += x - started_at_m;
    if (trace != nullptr && tick % traced_ticks == 0 && time_s < kTraced_s) {
      trace->row(rate_hz, time_s, -kHand_n_per_m * state.x_m, now_n, static_cast<int>(slips));
    }
    last_pull_n = now_n;
    was_slipping = slips;
  }
  if (broke_at_s.size() <= kPeriods) return {};  // it stopped breaking away: every error is then 100 %
  sums.break_force_n /= kPeriods, sums.drop_n /= kPeriods;
  sums.slip_way_m /= kPeriods - 1;  // the last break-away ends the run
  sums.period_s = (broke_at_s.back() - broke_at_s[1]) / (kPeriods - 1);
  return sums;
}

void measure_pulled(const LawOptions& options, Table& table, Bars& bars) {
  constexpr double kMuStatic = 0.6, kMuDynamic = 0.4;
  Table trace(options.output, "stick_slip_trace", {"rate_hz", "time_s", "hand_spring_n", "friction_n", "slips"});
  const Ramp ramp({RampKind::rounded_seams}, bake::Precision::f64, options.seed);
  fdcg_params params = contact_params(kMuStatic, kMuDynamic);
  params.stiffness_n_per_m = kContact_n_per_m;
  const Pulled expected = analytic_pull(kMuStatic, kMuDynamic);
  for (const double rate : kRates_hz) {
    if (options.is_quick && rate > 4e3) continue;
    const Pulled seen = pull(ramp, params, rate, rate == kRates_hz[0] ? &trace : nullptr);
    const auto row = [&](const char* quantity, double measured, double analytic) {
      say(table, "pulled", rate, kPull_m_per_s, params, kPulledDepth_m, quantity, measured, analytic);
    };
    row("break_force_n", seen.break_force_n, expected.break_force_n);
    row("drop_n", seen.drop_n, expected.drop_n);
    row("slip_way_m", seen.slip_way_m, expected.slip_way_m);
    row("period_s", seen.period_s, expected.period_s);
    constexpr double kShare_per_tick = 0.01 * 1e-3;  // 1 % at 1 kHz, in proportion to the tick
    const std::string of = ", pulled at " + cell(rate / 1e3) + " kHz";
    const auto worst =
        std::max({std::abs(seen.break_force_n / expected.break_force_n - 1), std::abs(seen.drop_n / expected.drop_n - 1),
                  std::abs(seen.slip_way_m / expected.slip_way_m - 1)});
    bars.at_most("stick-slip" + of + ": amplitude (force, drop, way)", worst, kShare_per_tick * 1e6 / rate, "",
                 "relative; 1 % at 1 kHz, in proportion to the tick");
    bars.at_most("stick-slip" + of + ": period", std::abs(seen.period_s / expected.period_s - 1), kShare_per_tick * 1e6 / rate,
                 "", cell(expected.period_s) + " s by formula");
  }
}

}  // namespace

void measure_stick_slip(const LawOptions& options, Bars& bars) {
  Table table(options.output, "stick_slip",
              {"motion", "rate_hz", "speed_m_per_s", "mu_static", "mu_dynamic", "depth_m", "quantity", "measured", "analytic",
               "relative_error"});
  measure_driven(options, table, bars);
  measure_pulled(options, table, bars);
}

}  // namespace fdcg::test
