// SPDX-License-Identifier: Apache-2.0
/// @file fdcg/grasp.hpp
/// How well contacts hold an object: force closure, Ferrari-Canny epsilon, the load at which it slips. Offline; exact friction
/// cones (second-order cones, no pyramids), and answers between bounds that are proved.
///
///     fdcg::grasp::Grasp grasp{contacts, centre_m, torque_scale_m};
///     if (!fdcg::grasp::problem_of(grasp)) auto closure = fdcg::grasp::force_closure(grasp);
///
/// Wrenches: force in newtons, torque about the centre in newton metres. Where a length or a direction of wrenches is spoken
/// of, torques are divided by the torque scale first; a unit wrench has length 1 so.
///
/// Positions are metres in the object's right-handed frame. Arguments are values and are not kept; functions may be called from
/// several threads at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::grasp {

using bake::Vec3;

/// Lengths of wrenches below this count as zero, bounds this near as tight. Rounding stays far below it.
inline constexpr double kTolerance = 1e-9;

/// What problem_of allows.
inline constexpr std::size_t kMostContacts = 1000;
inline constexpr double kMostMu = 100;             ///< likewise
inline constexpr double kMostTorsionScales = 100;  ///< likewise
inline constexpr double kFarthest_m = 1e12;        ///< likewise
/// Of loads, caps and totals: what is computed from them stays a number.
inline constexpr double kLeastForce_n = 1e-100;
inline constexpr double kMostForce_n = 1e100;  ///< likewise

/// Where and how the object is touched.
struct Contact {
  Vec3 point_m{};        ///< object's frame
  Vec3 inward{};         ///< unit normal, into the object
  double mu = 0;         ///< friction coefficient
  double torsion_m = 0;  ///< soft finger: the largest moment about the normal for each newton pressed; 0: a hard finger.
                         ///< Limit surface: (tangential / (mu press))^2 + (moment / (torsion press))^2 <= 1
  double cap_n = std::numeric_limits<double>::infinity();  ///< the most that it presses; read by slip_margin alone
};

/// What is judged.
struct Grasp {
  std::vector<Contact> contacts;  ///< 1 to 1,000
  Vec3 centre_m{};                ///< torques are about it
  double torque_scale_m = 1;      ///< a torque of this many newton metres counts as much as a force of one newton
};

/// A force, and a torque about the centre.
struct Wrench {
  Vec3 force_n{};    ///< object's frame
  Vec3 torque_nm{};  ///< about the centre, object's frame
};

/// Why a grasp cannot be judged: contact (from 0), value, limit, remedy. None where it can: 1 to 1,000 contacts, points at most
/// 1,000 torque scales from the centre, which is at most 1e12 m away along each axis, normals of unit length within 1e-9, mu
/// from 0 to 100, torsion from 0 to 100 torque scales, caps from 1e-100 to 1e100 N or infinite, torque scale from 1e-100 to
/// 1e100 m. The functions below need this.
std::optional<std::string> problem_of(const Grasp& grasp);
/// Of a load: its length, torques divided by the torque scale, is from 1e-100 to 1e100 N.
std::optional<std::string> problem_of(const Wrench& load, double torque_scale_m);

// ---- force closure -------------------------------------------------------------------------------------------------------

/// Of force closure; marginal: neither is proved.
enum class Verdict { closure, no_closure, marginal };

/// Can the contacts, pressing hard enough, resist every wrench? Epsilon (below) is greater than 0 exactly then.
struct Closure {
  Verdict verdict = Verdict::marginal;  ///< the answer
  /// Epsilon is between them. closure: lower > kTolerance. no_closure: `weakest` cannot be resisted, or only within kTolerance
  /// (is_flat). marginal: neither is proved. Negative: the origin is so far outside, at least (upper).
  double lower = 0;
  double upper = 0;      ///< see lower
  bool is_flat = false;  ///< no contact gives anything along `weakest` nor against it
  Wrench weakest;        ///< unit: the disturbance that is resisted least, of those found
};
/// Judges force closure.
Closure force_closure(const Grasp& grasp);

// ---- epsilon -------------------------------------------------------------------------------------------------------------

/// What the contacts are given: 1 N of normal force all together (L1: the convex hull of their cones), or each (Linf: the sum).
enum class Effort { together, each };

/// The largest wrench that is resisted whatever its direction (Ferrari and Canny 1992).
struct Epsilon {
  double value = 0;         ///< what `weakest` meets: not below epsilon. 0 without closure
  double lower = 0;         ///< proved: not above epsilon
  bool is_tight = false;    ///< value - lower <= kTolerance
  Wrench weakest;           ///< unit: the disturbance that is resisted least
  std::uint64_t cells = 0;  ///< cones of directions looked at
};
/// Computes epsilon. Work: some 10 us a cone, a thousand to a hundred thousand of them, more where the grasp is symmetric;
/// after max_cells the bounds are given as they are. `progress` is told which part of them was looked at: the search may end
/// before.
Epsilon ferrari_canny(const Grasp& grasp, Effort effort = Effort::together, std::uint64_t max_cells = 200'000,
                      const bake::Progress& progress = {});

// ---- margin --------------------------------------------------------------------------------------------------------------

/// A contact's push on the object.
struct ContactForce {
  double press_n = 0;         ///< along the inward normal
  Vec3 tangential_n{};        ///< at right angles to it
  double moment_nm = 0;       ///< about the inward normal
  double used = 0;            ///< of the friction that it has at this press, 0 to 1
  double carried = 0;         ///< of the load, all together 1; below 0: pushes with it
  double factor_without = 0;  ///< load_factor with this contact gone
};

/// How many times the load the contacts can hold, each pressing with at most its cap and all together with at most total_n,
/// however they share it: beyond that no force of theirs can keep the object from slipping.
struct Margin {
  double load_factor = 0;            ///< can be held
  double upper = 0;                  ///< cannot be held beyond this; no farther from load_factor than 1e-9 of it
  std::vector<ContactForce> forces;  ///< that hold load_factor times the load
};
/// Computes the margin. `load` acts on the object, torque about the centre; problem_of has nothing against it. total_n is as a
/// cap may be, and finite unless each cap is.
Margin slip_margin(const Grasp& grasp, const Wrench& load, double total_n = std::numeric_limits<double>::infinity());

}  // namespace fdcg::grasp
