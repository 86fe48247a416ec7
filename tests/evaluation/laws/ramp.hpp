// SPDX-License-Identifier: Apache-2.0
// Surfaces to press and slide on: flat ones, cut by seams or not, V-grooves, and blocks whose sides meet in obtuse edges.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "coulomb_load.hpp"
#include "meshes.hpp"
#include "plain_graph.hpp"

namespace fdcg::test {

enum class RampKind {
  face,           // one triangle
  exact_seams,    // a grid of triangles, exactly coplanar, axis-aligned
  rounded_seams,  // the same turned: its corners are off the plane by a rounding, its seams convex and concave by as much
  groove,         // opening_deg between the walls
  convex_edges    // a prism of `sides`
};

struct RampShape {
  RampKind kind;
  double opening_deg = 180;  // between the faces, outside the solid for a groove and inside for convex edges
  int sides = 0;

  [[nodiscard]] std::string name() const;
};

// All of them: the groove's openings from 30 to 150 degrees, convex edges from 108 to 170.
std::vector<RampShape> ramp_shapes();

// How a ramp becomes a graph.
enum class RampGraph {
  plain,     // a triangle a node: nothing is merged
  compiled,  // by the compiler, which merges
  far_away,  // the same, a million sizes from the origin
  derived    // nothing is merged, and planes are derived in the step: it has no short ways over edges there
};
constexpr RampGraph kRampGraphs[] = {RampGraph::plain, RampGraph::compiled, RampGraph::far_away, RampGraph::derived};
const char* name_of(RampGraph graph);

// One of them in some orientation.
class Ramp {
 public:
  Ramp(const RampShape& shape, bake::Precision precision, std::uint64_t orientation_seed, RampGraph graph = RampGraph::plain);

  [[nodiscard]] const fdcg_graph& view() const { return plain_ ? plain_->view() : compiled_->view(); }
  [[nodiscard]] const ReferenceSurface<Wide>& surface() const { return *surface_; }
  // From the body's own frame (z up out of the surface, x along the groove, the prism's axis along z) to the object's.
  [[nodiscard]] Hip place(double x, double y, double z) const;

 private:
  Rotation rotation_{};
  Vec3 offset_;
  std::unique_ptr<PlainGraph> plain_;  // this or the next
  std::unique_ptr<CompiledMesh> compiled_;
  std::unique_ptr<ReferenceSurface<Wide>> surface_;
};

}  // namespace fdcg::test
