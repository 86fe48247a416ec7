// SPDX-License-Identifier: Apache-2.0
// What is compared: ways of finding the god-object (or what stands in for it) of a HIP, behind one interface, so that every one
// pays for the same call and the same result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "fdcg/bake.hpp"
#include "ground.hpp"

namespace fdcg::test {

constexpr double kStiffness_n_per_m = 1000;  // of every contender

struct Feel {
  Ground::Point god_object{};  // HIP while free
  Ground::Point force{};       // newtons: stiffness times god-object less HIP
  bool in_contact = false;
  std::uint32_t transitions = 0;  // changes of feature, where the contender has features
  bool is_carried = false;        // the contender says that it goes on with this tick's work in the next
};

struct ContenderInfo {
  std::string name;     // as in the tables
  std::string family;   // fdcg, paper, ablation (of fdcg's rules), closest_point, distance_grid, proxy; a rival's own word
  std::string version;  // of a rival, in words
  std::string precision = "f64", planes = "none", merged = "no";
  bool has_friction = false;
  std::size_t bytes = 0;  // that it needs at run time
  double bake_s = 0;      // from polygon soup to ready, one thread
};

class Contender {
 public:
  virtual ~Contender() = default;
  // The next step is the first.
  virtual void reset() = 0;
  virtual void step(const Ground::Point& hip_m, Feel& feel) = 0;
  // What the last step took by the contender's own clock, where the way to it takes longer than the step does; else negative.
  [[nodiscard]] virtual double own_ns() const { return -1; }
  // No effect on what knows no friction. Resets.
  virtual void set_friction(double /*mu_static*/, double /*mu_dynamic*/) { reset(); }
  [[nodiscard]] const ContenderInfo& info() const { return info_; }

 protected:
  ContenderInfo info_;
};

// ---- the contenders --------------------------------------------------------------------------------------------------------

struct FdcgVariant {
  bake::Precision precision = bake::Precision::f64;
  bool is_stored = true;  // Voronoi planes in the file, or derived in the step
  bool is_merged = true;  // coplanar neighbours made one node
};
// This project's runtime on a graph in memory, without the sections that a step does not use.
std::unique_ptr<Contender> make_fdcg(const bake::PolygonSoup& soup, const FdcgVariant& variant);

// Melder and Harwin 2004 as printed, with only its signs repaired (contact-model PAPER-1 to PAPER-3: depth, the comparison of
// slip, planes); then with the other corrections added one after the other, to show what each buys. fdcg has them all: the
// sweep of every release and the seat as well. What the paper calls "the collision detection algorithm" is Embree's ray.
enum class PaperLevel {
  printed,    // paper
  crossings,  // paper_crossings: and the first crossing along the way (contact-model PAPER-4, PAPER-5)
  edges,      // paper_edges: and an edge's rule of contact-model EDGE-1, EDGE-2, which looks at the faces' planes too
  vertices    // paper_vertices: and a vertex's of contact-model CORNER-1, the steepest descent
};
std::unique_ptr<Contender> make_paper(const bake::PolygonSoup& soup, PaperLevel level = PaperLevel::printed);

// The closest point by CGAL's AABB tree in double, the last answer as its hint. Inside is behind the nearest face's plane.
std::unique_ptr<Contender> make_cgal_closest(const bake::PolygonSoup& soup);

// The closest point by Embree 3's point query in float, as in Embree's tutorial, its radius bounded by the distance to the last
// answer. Inside is behind the nearest face's plane.
std::unique_ptr<Contender> make_embree_closest(const bake::PolygonSoup& soup);

// A grid of float distances over the bounds and 3 mm around them, `resolution` samples along the longest side; the distance is
// trilinear, its gradient the direction. Exact within 4 mm of the surface, where the nearest feature's pseudo-normal tells the
// sign.
std::unique_ptr<Contender> make_distance_grid(const Ground& ground, int resolution);

// A point proxy with a tree of the kind that haptic libraries have: a ray from the proxy towards the HIP, then along the plane
// that was met, then along the line of two planes (Ruspini et al. 1997 without a radius); Embree's ray in float, and a gap of a
// micrometre to the surface, since a proxy on it would fall through.
std::unique_ptr<Contender> make_proxy(const bake::PolygonSoup& soup);

}  // namespace fdcg::test
