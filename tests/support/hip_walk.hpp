// SPDX-License-Identifier: Apache-2.0
// A restless hand: HIP positions near, on and through a surface, in stretches of one habit each.
#pragma once

#include <array>
#include <cstdint>

#include "fdcg/bake.hpp"
#include "random.hpp"

namespace fdcg::test {

using Hip = std::array<double, 3>;

class HipWalk {
 public:
  HipWalk(const bake::PolygonSoup& soup, std::uint64_t seed);
  // The next HIP, in the soup's units; `god_object` is where the contact is now.
  Hip next(const Hip& god_object);
  // The HIP was put on a corner, an edge, a face or its plane, and has not left it by more than 1e-12 of the size.
  [[nodiscard]] bool is_on_feature() const { return is_on_feature_; }

 private:
  enum class Habit {
    strolls,                  // steps from 1e-4 to 1e-1 of the size
    creeps,                   // steps of 1e-12
    hovers_about_god_object,  // close to the surface, on both sides
    presses,                  // slides at a depth, in straight lines
    trembles,                 // 0.2 % of the size about a fixed point
    jumps,                    // anywhere in and around the object
    meets_corners,            // exactly on corners
    meets_edges,              // on edges: dyadic parts of the way
    meets_faces,              // on the middle of faces
    meets_planes,             // takes single coordinates over from corners
    goes_home,                // to corners and back to the last place
    rounds,                   // to multiples of 2^-10 of the size
    holds,
    count
  };
  void begin_stretch();
  void put_on_edge(std::uint32_t slot);
  void put_on_face();
  Hip corner(std::uint32_t index) const;
  std::uint32_t random_corner_slot();
  Hip somewhere();
  void move();
  void add(Hip& hip, double distance);

  const bake::PolygonSoup& soup_;
  Random random_;
  Hip centre_{}, hip_{}, anchor_{}, heading_{};
  double size_ = 0;
  Habit habit_ = Habit::strolls;
  std::uint32_t left_ = 0;
  bool is_on_feature_ = false;
};

}  // namespace fdcg::test
