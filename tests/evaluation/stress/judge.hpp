// SPDX-License-Identifier: Apache-2.0
// What must hold of every tick, whatever the body and the hand. A judge sees the contact before and after and the specimen, not
// the step; cost: some 50 ns a tick.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "fdcg/fdcg.h"
#include "specimen.hpp"

namespace fdcg::test {

enum class Fault : std::uint8_t {
  not_a_number,  // NaN or infinite output; on a HIP that is not usable: a change of the contact, a force
  rule_bound,    // work on the surface carried over
  sweep_bound,   // work in free space carried over
  growth,        // |GO - HIP| grew by more than 16 eps of the scale; where a merged face is met, that beyond its slab
  push_through,  // Free and, after having been outside or held, inside by more than 4 eps of the size
  unseen,        // a way through the surface that met nothing
  thin_air,      // a contact though the way met nothing, and the HIP is outside by more than 4 eps of the size; or one that was
                 // let go again, but at a busy corner (FREE-8)
  off_surface,   // GO off the planes of its feature, or beyond its rim, by more than 64 eps of the scale
  pull,          // the HIP is in front of what is said to hold it: the force pulls inwards
  restless,      // the same HIP again: GO came nearer by more than 16 eps of the scale, or moved by more than such a change of
                 // its distance allows, or contact was lost or found
  descent,       // without friction: at rest though a face or an edge there, or the free way itself, leads nearer to the HIP
  free_air,      // ... and the HIP is outside of the solid
  no_force,      // inside by more than 4 eps of the size, after having been outside or held, and no force
  report,        // result and contact say different things, or the contact's HIP is not this tick's
  force,         // not k (GO - HIP), or a force in free space
  friction,      // GO outside of the cone; moved though it holds, held though it does not; a slip flag that is not so
  wrong_face,    // left an edge for the farther of two faces that pull
  uncertified,   // without friction: no local minimum of |x - HIP|, nor for any HIP within rounding, by exact rationals
  stalled,       // work carried over that gets nowhere: the same HIP, and GO no nearer, in more ticks than pass all faces
  count
};
inline constexpr std::size_t kFaults = static_cast<std::size_t>(Fault::count);
constexpr std::uint32_t bit(Fault fault) {
  return 1u << static_cast<unsigned>(fault);
}
std::string_view name_of(Fault fault);
std::optional<Fault> fault_named(std::string_view name);

// The scale of rounding is the largest of the object's extent and the coordinates of HIP: both enter every sum.
inline constexpr double kMostGrowth_eps = 16;
inline constexpr double kSlab_eps = 8;  // of a plane's distance, as the step bounds its own rounding
inline constexpr double kMostOffSurface_eps = 64;
inline constexpr double kEnd_eps = 10;  // of the extent: so near to an edge's end its corner is active (FACE-6, EDGE-6)
inline constexpr double kMostRestless_eps = 16;
inline constexpr double kMostPull_eps = 32;       // of a plane's distance, as the step bounds its own rounding
inline constexpr double kMostFriction_eps = 64;   // times 1 + mu: as GO may be off its feature
inline constexpr double kMostDescent_eps = 64;    // how far the way down may lead, as GO may be off its feature
inline constexpr std::uint32_t kSlowTicks = 4;    // that carry work over and bring GO no nearer: it may go round a fan
inline constexpr std::uint32_t kFacesATick = 10;  // that such a tick passes, at least
inline constexpr double kShallow_eps = 4;   // of the size: a HIP so near to the surface may be taken for outside, or for inside
inline constexpr double kPerDeviation = 4;  // where merging moved faces: so many times the largest deviation as well
inline constexpr double kAirPerDeviation = 16;  // ... and how far from its feature a hand that is let go would be in free air

struct Verdicts {
  std::array<std::uint64_t, kFaults> count{};
  std::uint64_t shallow = 0;       // Free, and inside by less than kShallow_eps
  std::uint64_t most_carried = 0;  // ticks in a row
  std::uint64_t certified = 0;     // ticks that the exact certificate was asked about
  // Contact ticks whose place no law of rest or of friction judges, by why; all that holds for them too is still judged:
  std::uint64_t carried = 0;  // work is carried over
  std::uint64_t slit = 0;     // an edge whose faces' normals cancel but for rounding: its load is any
  // Where faces cross or touch: a place on one sheet that would not be one of rest, were there not another sheet there. No edge
  // joins the two, so the step hands the contact from one to the other and back (contact-model TICK-5).
  std::uint64_t between = 0;
  std::uint64_t other = 0;  // nothing else, but if a judge is changed
  double worst_growth_eps = 0, worst_off_surface_eps = 0, worst_restless_eps = 0, worst_pull_eps = 0, worst_inside_eps = 0,
         worst_descent_eps = 0;

  void add(const Verdicts& more);
};

class Judge {
 public:
  // `owes_force`: of a hand's speed, so that no tick inside may be without force.
  explicit Judge(const Specimen& specimen, bool owes_force = false);

  // Asks the exact certificate about every rest without friction, not about some: of a path that is cut down.
  void certify_all() { certifies_all_ = true; }

  // A new contact: nothing is known of where its HIP is.
  void begin(const fdcg_params& params) {
    is_known_outside_ = is_outside_ = false, last_flags_ = 0, carried_ = stalled_ = 0;
    has_friction_ = params.mu_static > 0 || params.mu_dynamic > 0;
    params_ = params;
  }

  // Whether GO has come no nearer to a held HIP for some ticks that carry work over. Either it goes in a circle, or round a fan
  // of thousands of faces, nearer by less than rounding in each tick: holding the HIP for longer tells.
  [[nodiscard]] bool is_slow() const { return stalled_ >= kSlowTicks; }

  // One tick, which began with `before`. Returns a bit for each fault, 1 << fault, and counts them.
  std::uint32_t judge(const fdcg_contact& before, const Hip& hip_m, const fdcg_contact& after, const fdcg_result& result,
                      Verdicts& verdicts);

 private:
  struct Tick {
    const fdcg_contact& before;
    const fdcg_contact& after;
    const fdcg_result& result;
    Hip hip, god_object;
    double rounding;  // eps of the scale
    std::uint32_t faults;
    bool is_way_clear;  // the way from the last HIP to this one surely does not meet the surface
  };
  struct Rubbing {
    double load = 0, gap = 0;  // what presses; how far GO is from the foot of HIP on its feature
    double slack = 0;          // rounding
  };
  void look_at_numbers(Tick& tick) const;
  void look_at_result(Tick& tick, const Hip& hip_m) const;
  // False: it has no say there.
  bool look_at_friction(Tick& tick) const;
  void look_at_choice(Tick& tick) const;
  void look_at_certificate(Tick& tick, Verdicts& v);
  [[nodiscard]] std::optional<Rubbing> rubbing_at(const Tick& tick) const;
  [[nodiscard]] std::optional<Rubbing> rubbing_on_edge(const Tick& tick, const EdgeShape& edge) const;
  [[nodiscard]] Rubbing rubbing_on_face(const Tick& tick, std::uint32_t node) const;
  [[nodiscard]] bool is_held_by_face(const Tick& tick, std::uint32_t node) const;
  [[nodiscard]] bool is_over_at(std::uint32_t node, const Tick& tick, double sure) const;
  [[nodiscard]] bool is_held_by_edge(const Tick& tick, const EdgeShape& edge) const;
  [[nodiscard]] bool is_held_at_corner(const Tick& tick) const;
  [[nodiscard]] bool is_held_beside(const Tick& tick) const;
  [[nodiscard]] bool is_on_rim(const Tick& tick) const;
  [[nodiscard]] bool moves_by_coulomb(const Tick& tick, const Rubbing& rubbing, bool is_still) const;
  void look_at_growth(Tick& tick, Verdicts& v) const;
  [[nodiscard]] double slab_around(const Hip& x) const;
  void look_at_feature(Tick& tick, Verdicts& v) const;
  [[nodiscard]] double in_front_of_node(std::uint32_t node, const Hip& x) const;
  [[nodiscard]] double in_front_of_edge(const EdgeShape& edge, const Hip& x) const;
  [[nodiscard]] bool is_beyond_open_corner(const Tick& tick) const;
  [[nodiscard]] double in_front_of_corner(std::uint32_t corner, const Hip& x, double rounding) const;
  void look_at_pull(Tick& tick, Verdicts& v) const;
  void look_at_rest(Tick& tick, Verdicts& v) const;
  void look_at_carried(Tick& tick);
  [[nodiscard]] double descent_from(const Tick& tick) const;
  [[nodiscard]] double descent_at(std::uint32_t corner, const Tick& tick) const;
  [[nodiscard]] bool is_meant(std::uint32_t corner, const Hip& place) const;
  bool look_at_descent(Tick& tick, Verdicts& v) const;  // false: it has no say there
  [[nodiscard]] double turned(double edge_length, double depth) const;
  void look_at_place(Tick& tick, Verdicts& v);
  void pass_over_between_sheets(Tick& tick, Verdicts& v) const;
  [[nodiscard]] bool is_on_other_sheet(const Tick& tick) const;
  [[nodiscard]] double merged_descent_from(const Tick& tick) const;
  [[nodiscard]] double merged_descent_at(std::uint32_t corner, const Tick& tick) const;
  [[nodiscard]] Hip outwards(const Tick& tick) const;
  [[nodiscard]] bool is_in_merged_air(const Tick& tick) const;
  [[nodiscard]] bool rests_on_mesh(const Tick& tick) const;
  [[nodiscard]] bool passes_busy_corner(const Hip& from, const Hip& to) const;
  void look_at_way(Tick& tick);
  void look_at_merged_way(Tick& tick) const;
  [[nodiscard]] bool passes_slab(const Hip& from, const Hip& to) const;
  [[nodiscard]] bool passes_slab_of(std::uint32_t n, const Hip& from, const Hip& to) const;
  bool is_let_off(const Hip& point);
  void look_inside(Tick& tick, Verdicts& v);
  void look_at_owed_force(Tick& tick);
  // How deep inside of the mesh a HIP may be that is outside of the graph's surface.
  [[nodiscard]] double moved_inside() const { return deviation_ > moved_ ? deviation_ : moved_; }

  const Specimen& specimen_;
  bool owes_force_;
  double epsilon_, deviation_;  // deviation_: allowed on top of rounding
  double moved_;                // how far the graph's surface may be from the mesh's: the file's stated deviation and rounding
  bool is_exact_;               // the graph's faces are the solid's triangles, or unions of them
  fdcg_params params_{};
  bool has_friction_ = true;
  std::uint64_t asked_certificates_ = 0;
  bool certifies_all_ = false;
  bool is_known_outside_ = false;
  bool is_outside_ = false;       // ... and of the last tick's HIP: exactly, in no face's plane
  std::size_t asked_ = 0;         // in crowded cells
  std::uint32_t last_flags_ = 0;  // of the last tick with a finite HIP
  std::uint64_t carried_ = 0;     // ticks in a row
  std::uint32_t stalled_ = 0;     // ... of a held HIP, in which the god-object came no nearer
};

}  // namespace fdcg::test
