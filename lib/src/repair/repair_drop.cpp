// SPDX-License-Identifier: Apache-2.0
// Drops faces that hold no surface, and as the last resort those that no graph can have.
#include <algorithm>
#include <cmath>
#include <mutex>

#include "repair/repair.hpp"
#include "validate/validate.hpp"

namespace fdcg::bake {
namespace {

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool is_usable(const PolygonSoup& soup, std::size_t f) {
  for (std::uint32_t c = soup.face_first[f]; c < soup.face_first[f + 1]; ++c) {
    if (soup.corners[c] >= soup.points.size() || !is_finite(soup.points[soup.corners[c]])) return false;
  }
  return true;
}

// A point of no face is no part of the surface, but one that is not finite is an error all the same.
void drop_points_not_finite(Workpiece& piece) {
  PolygonSoup& soup = piece.soup;
  std::vector<std::uint32_t> number(soup.points.size());
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    number[v] = kept;
    if (!is_finite(soup.points[v])) continue;
    soup.points[kept] = soup.points[v];
    piece.source_point[kept++] = piece.source_point[v];
  }
  soup.points.resize(kept);
  piece.source_point.resize(kept);
  for (std::uint32_t& corner : soup.corners)
    corner = number[corner];
}

// The faces that a finding is ended by dropping.
void add_blocking(std::string_view rule, const Element& element, std::vector<std::uint32_t>& faces) {
  if (element.faces.empty() || rule == "inside-out" || rule == "non-manifold-vertex") return;
  if (rule == "non-manifold-edge") {
    faces.insert(faces.end(), element.faces.begin() + 2, element.faces.end());
  } else if (rule == "winding-inconsistent" || rule == "folded-edge") {
    faces.push_back(element.faces.back());
  } else {
    faces.push_back(element.faces.front());
  }
}

}  // namespace

RepairAction drop_unusable_step(Workpiece& piece) {
  Tally tally;
  FaceEdits edits;
  for (std::size_t f = 0; f < piece.soup.face_count(); ++f) {
    if (is_usable(piece.soup, f)) continue;
    edits.emplace_back(static_cast<std::uint32_t>(f), std::vector<std::vector<std::uint32_t>>{});
    tally.done.push_back(piece.source_face[f]);
  }
  replace_faces(piece, edits);
  drop_points_not_finite(piece);
  return action_of(piece, "drop-unusable", Kind::faces,
                   counted(tally.done.size(), "face was", "faces were") + " dropped: a corner is not finite or not in the file",
                   tally);
}

std::uint64_t drop_blocking(Workpiece& piece, unsigned jobs, Tally& tally) {
  ValidateOptions how;
  how.weld = piece.identity;
  how.jobs = jobs;
  how.max_elements = 0;
  for (const Rule& rule : rules()) {
    if (rule.severity != Severity::error) how.severities[std::string(rule.name)] = std::nullopt;
  }
  std::mutex lock;
  std::vector<std::uint32_t> faces;
  how.each_element = [&](std::string_view rule, Element& element) {
    const std::scoped_lock guard(lock);
    add_blocking(rule, element, faces);
  };
  (void)validate(piece.soup, how);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  FaceEdits edits;
  for (const std::uint32_t f : faces) {
    edits.emplace_back(f, std::vector<std::vector<std::uint32_t>>{});
    tally.done.push_back(piece.source_face[f]);
  }
  replace_faces(piece, edits);
  return faces.size();
}

RepairAction drop_blocking_action(const Workpiece& piece, Tally& tally) {
  return action_of(piece, "drop-blocking", Kind::faces,
                   counted(tally.done.size(), "face was", "faces were") + " dropped that no other step could mend", tally);
}

}  // namespace fdcg::bake
