// SPDX-License-Identifier: Apache-2.0
// Runs the repair steps in order, and measures what each did to the surface.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "base/vec3.hpp"
#include "repair/part_touching.hpp"
#include "repair/repair.hpp"
#include "repair/surface_distance.hpp"
#include "topology/weld.hpp"

namespace fdcg::bake {
namespace {

bool needs_weld(const RepairOptions& options) {
  return options.split_non_manifold_vertices || options.cut_non_manifold || options.triangulate_crossing_faces ||
         options.unfold || options.drop_blocking_faces || options.solid;
}

bool asks_for_anything(const RepairOptions& options) {
  return options.weld || options.drop_degenerate_faces || options.drop_duplicate_faces || options.orient ||
         options.reverse_inside_out || options.simplify_error || options.drop_unusable_faces || needs_weld(options);
}

struct Bounds {
  Vec3 low, high;
};

Bounds bounds_of(const PolygonSoup& soup) {
  Bounds bounds;
  bool is_first = true;
  for (const Vec3& p : soup.points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    if (is_first) bounds = {p, p};
    is_first = false;
    bounds.low = {std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y), std::min(bounds.low.z, p.z)};
    bounds.high = {std::max(bounds.high.x, p.x), std::max(bounds.high.y, p.y), std::max(bounds.high.z, p.z)};
  }
  return bounds;
}

// Each of the two steps can enable the other: once a duplicate is gone, an edge has two faces again. Runs both until neither
// changes the mesh.
void drop_faces(Workpiece& piece, const RepairOptions& options, DegenerateTally& degenerate, Tally& duplicates) {
  for (bool is_first = true;; is_first = false) {
    std::uint64_t done = 0;
    if (options.drop_degenerate_faces) done += drop_degenerate(piece, degenerate);
    if (options.drop_duplicate_faces && (is_first || done != 0))
      done += drop_duplicates(piece, duplicates, options.cut_non_manifold);
    if (done == 0 || !(options.drop_degenerate_faces && options.drop_duplicate_faces)) break;
  }
}

// The first remaining face of each part; an empty part begins and ends at the same face.
void move_parts(Workpiece& piece) {
  for (Part& part : piece.soup.parts) {
    const auto first = std::lower_bound(piece.source_face.begin(), piece.source_face.end(), part.first_face);
    part.first_face = static_cast<std::uint32_t>(first - piece.source_face.begin());
    part.first_point = 0;
  }
}

bool has_equal_points(const PolygonSoup& soup) {
  return weld_points(soup, {}, Precision::f64).joined_vertices != 0;
}

Report judged(const PolygonSoup& soup, Weld::Kind weld, const RepairOptions& options) {
  ValidateOptions how;
  how.weld.kind = weld;
  how.jobs = options.jobs;
  how.progress = options.progress;
  return validate(soup, how);
}

class Run {
 public:
  Run(const PolygonSoup& soup, const RepairOptions& options)
      : options_(options), piece_(soup), bounds_(bounds_of(soup)), middle_(0.5 * (bounds_.low + bounds_.high)) {
    surface_ = surface();
    account_.faces_before = soup.face_count();
    account_.volume_before = signed_volume(surface_);
  }

  void take_steps(const std::optional<Weld>& weld) {
    if (options_.drop_unusable_faces) keep(drop_unusable_step(piece_));
    if (weld) {
      const bool moves = weld->kind == Weld::Kind::distance;
      RepairAction action = weld_step(piece_, *weld);
      moves ? measure(std::move(action)) : keep(std::move(action));
    }
    if (options_.solid) measure(stitch_step(piece_, in_units(options_.solid->gap)));
    if (options_.triangulate_crossing_faces) measure(triangulate_crossing_step(piece_));
    if (options_.unfold) unfold_slivers();
    drop();
    if (options_.cut_non_manifold) {
      if (options_.orient) measure(orient_step(piece_));
      cut();
    }
    if (options_.split_non_manifold_vertices) keep(split_vertices_step(piece_));
    if (options_.orient && !options_.cut_non_manifold) measure(orient_step(piece_));
    if (options_.drop_blocking_faces) drop_blocking_faces();
    if (options_.reverse_inside_out) measure(reverse_inside_out_step(piece_));
    if (options_.solid) options_.solid->method == SolidOptions::Method::exact ? make_solid() : remesh();
    if (options_.simplify_error) simplify();
    if (options_.part_equal_points && weld && weld->kind != Weld::Kind::none) measure(part_equal_points_step(piece_));
  }

  Repaired finish() {
    Repaired repaired;
    move_parts(piece_);
    const PolygonSoup& input = piece_.input;
    for (std::size_t f = 0; !input.face_material.empty() && f < piece_.source_face.size(); ++f) {
      if (f >= piece_.soup.face_material.size()) piece_.soup.face_material.resize(f + 1);
      piece_.soup.face_material[f] = input.face_material[piece_.source_face[f]];
    }
    piece_.soup.face_material.resize(input.face_material.empty() ? 0 : piece_.soup.face_count());
    if (piece_.identity.kind == Weld::Kind::none && has_equal_points(piece_.soup)) repaired.read_with = Weld::Kind::none;
    account_.faces_after = piece_.soup.face_count();
    account_.volume_after = signed_volume(surface());
    for (const RepairAction& action : account_.actions) {
      if (action.name != "close-holes") account_.distance += action.distance;
    }
    static_cast<RepairAccount&>(repaired) = std::move(account_);
    if (options_.judges) repaired.after = judged(piece_.soup, repaired.read_with, options_);
    repaired.source_face = std::move(piece_.source_face);
    repaired.source_point = std::move(piece_.source_point);
    repaired.soup = std::move(piece_.soup);
    return repaired;
  }

 private:
  [[nodiscard]] TriangleSet surface() const {
    const View view(piece_);
    return triangles_of(piece_.soup, view.mesh, view.states, middle_);
  }

  // A step that moves no point of the surface and turns no face.
  void keep(RepairAction action) {
    account_.actions.push_back(std::move(action));
    constexpr double kSteps = 13;  // of the longest list
    if (options_.progress) options_.progress("repair", std::min(1.0, static_cast<double>(account_.actions.size()) / kSteps));
  }

  void measure(RepairAction action) {
    if (action.total != 0) {
      TriangleSet now = surface();
      const SurfaceChange change = surface_change(surface_, now);
      action.distance = change.distance;
      action.volume_change = change.volume_change;
      surface_ = std::move(now);
    }
    keep(std::move(action));
  }

  void drop() {
    DegenerateTally degenerate;
    Tally duplicates;
    drop_faces(piece_, options_, degenerate, duplicates);
    const bool is_measured_later = !duplicates.done.empty();  // the rounds of both are one change; faces without area add none
    if (options_.drop_degenerate_faces) {
      RepairAction action = drop_degenerate_action(piece_, degenerate);
      is_measured_later ? keep(std::move(action)) : measure(std::move(action));
    }
    if (options_.drop_duplicate_faces) measure(drop_duplicates_action(piece_, duplicates));
  }

  // Before copies are dropped, since a flap is a face and its copy.
  void unfold_slivers() {
    constexpr double kThickness = 1e-3;  // of the object's size
    UnfoldTally tally;
    unfold(piece_, kThickness * length(bounds_.high - bounds_.low), tally);
    measure(unfold_action(piece_, tally));
  }

  void cut() {
    CutTally tally;
    cut_edges(piece_, tally);
    measure(cut_action(piece_, tally));
  }

  void drop_blocking_faces() {
    Tally tally;
    constexpr int kMostRounds = 16;
    for (int round = 0; round < kMostRounds && drop_blocking(piece_, options_.jobs, tally) != 0; ++round) {
      if (options_.split_non_manifold_vertices) (void)split_vertices_step(piece_);
    }
    measure(drop_blocking_action(piece_, tally));
  }

  [[nodiscard]] double in_units(const Extent& extent) const {
    constexpr double kSlack = 1 + 1e-9;  // a hole as large as the object is not larger than it
    return extent.is_share ? kSlack * extent.value * length(bounds_.high - bounds_.low) : extent.value;
  }

  void remesh() {
    SolidEffect effect;
    const SolidOptions& how = *options_.solid;
    measure(remesh_step(piece_, in_units(how.voxel), how.as_floats, options_.jobs, options_.progress, effect));
  }

  void make_solid() {
    HoleTally holes;
    close_holes(piece_, in_units(options_.solid->hole_size), holes);
    measure(close_holes_action(piece_, holes));
    if (!account_.actions.back().elements.empty()) measure(reverse_inside_out_step(piece_));
    SolidEffect effect;
    RepairAction action = solid_step(piece_, options_.solid->as_floats, options_.jobs, options_.progress, effect);
    if (effect.is_solid) {
      const auto first_made = static_cast<std::uint32_t>(piece_.soup.points.size());
      CutTally cut;
      cut_edges(piece_, cut);
      (void)split_vertices_step(piece_);
      constexpr double kApart = 0x1p-20;  // of the object's size
      const Parting parting = part_touching(piece_, first_made, kApart * length(bounds_.high - bounds_.low),
                                            options_.solid->as_floats, resolve_jobs(options_.jobs));
      add_parting(parting, action);
      effect.distance += parting.distance;
    }
    const double before = signed_volume(surface_);
    surface_ = surface();
    action.distance = effect.distance;
    action.volume_change = signed_volume(surface_) - before;
    keep(std::move(action));
  }

  static void add_parting(const Parting& parting, RepairAction& action) {
    if (parting.moved == 0) return;
    action.message += "; " + counted(parting.moved, "vertex was", "vertices were") + " moved by up to " +
                      in_digits(parting.distance) + ", since solids touched there";
    if (parting.left == 0) return;
    action.is_refused = true;
    action.left += parting.left;
    action.left_message += (action.left_message.empty() ? "" : "; ") +
                           counted(parting.left, "pair of faces still meets", "pairs of faces still meet") +
                           " where solids touch";
  }

  // The step proves its distance for each collapse.
  void simplify() {
    RepairAction action = simplify_step(piece_, *options_.simplify_error, options_.jobs, options_.progress);
    const double before = signed_volume(surface_);
    surface_ = surface();
    if (action.total != 0) action.distance = *options_.simplify_error;
    action.volume_change = signed_volume(surface_) - before;
    keep(std::move(action));
  }

  const RepairOptions& options_;
  Workpiece piece_;
  Bounds bounds_;
  Vec3 middle_;
  TriangleSet surface_;  // as last measured
  RepairAccount account_;
};

}  // namespace

RepairOptions repair_options(RepairLevel level) {
  RepairOptions options;
  options.weld = Weld{};
  options.drop_degenerate_faces = options.drop_duplicate_faces = options.split_non_manifold_vertices = true;
  options.orient = options.reverse_inside_out = options.cut_non_manifold = true;
  const bool is_full = level != RepairLevel::safe;
  if (level == RepairLevel::solid) options.solid = SolidOptions{};
  options.drop_unusable_faces = options.triangulate_crossing_faces = options.unfold = options.drop_blocking_faces = is_full;
  return options;
}

Result<Repaired> repair(const PolygonSoup& soup, const RepairOptions& options) {
  if (!asks_for_anything(options)) return Failure{2, soup.name + ": no repair is asked for", {}};
  if (options.simplify_error && !(*options.simplify_error > 0 && std::isfinite(*options.simplify_error)))
    return Failure{2, soup.name + ": the error to simplify to is no number above 0", {}};
  std::optional<Weld> weld = options.weld;
  if (!weld && needs_weld(options)) weld = Weld{};
  const bool keeps_vertices = weld && weld->kind == Weld::Kind::none;
  Report before;
  if (options.judges) before = judged(soup, keeps_vertices ? Weld::Kind::none : Weld::Kind::exact, options);
  Run run(soup, options);
  run.take_steps(weld);
  Repaired repaired = run.finish();
  for (const Issue& issue : before.issues)
    repaired.found[issue.rule] = issue.total;
  repaired.before = std::move(before);
  return repaired;
}

}  // namespace fdcg::bake
