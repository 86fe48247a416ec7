// SPDX-License-Identifier: Apache-2.0
// Runs the repair steps in order; and helpers of the steps.
#include "repair/repair.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "topology/weld.hpp"

namespace fdcg::bake {

// ---- what the steps share

Workpiece::Workpiece(const PolygonSoup& given) : input(given), soup(given), source_point(given.points.size()) {
  std::iota(source_point.begin(), source_point.end(), 0U);
  source_face.resize(given.face_count());
  std::iota(source_face.begin(), source_face.end(), 0U);
  // Fields of the input file that do not apply to the repaired soup.
  soup.is_text = false;
  soup.point_line.clear();
  soup.face_line.clear();
  soup.sha256.clear();
  soup.ignored.clear();
}

View::View(const Workpiece& piece)
    : mesh(weld_points(piece.soup, piece.identity, Precision::f64)),
      states(face_states(mesh)),
      topology(pair_halfedges(mesh, states)) {}

namespace {

std::vector<bool> used_points(const PolygonSoup& soup) {
  std::vector<bool> is_used(soup.points.size(), false);
  for (const std::uint32_t corner : soup.corners) {
    if (corner != PolygonSoup::kInvalidVertex) is_used[corner] = true;
  }
  return is_used;
}

// Drops the points that are marked in `had_face` and no longer belong to a face.
void drop_deserted_points(Workpiece& piece, const std::vector<bool>& had_face) {
  PolygonSoup& soup = piece.soup;
  const std::vector<bool> has_face = used_points(soup);
  if (has_face == had_face) return;
  std::vector<std::uint32_t> number(soup.points.size());
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    number[v] = kept;
    if (had_face[v] && !has_face[v]) continue;
    soup.points[kept] = soup.points[v];
    piece.source_point[kept++] = piece.source_point[v];
  }
  soup.points.resize(kept);
  piece.source_point.resize(kept);
  for (std::uint32_t& corner : soup.corners) {
    if (corner != PolygonSoup::kInvalidVertex) corner = number[corner];
  }
}

}  // namespace

void replace_faces(Workpiece& piece, const FaceEdits& edits) {
  if (edits.empty()) return;
  PolygonSoup& soup = piece.soup;
  const std::vector<bool> had_face = used_points(soup);
  std::vector<std::uint32_t> corners, face_first{0}, source_face;
  corners.reserve(soup.corners.size());
  face_first.reserve(soup.face_first.size());
  source_face.reserve(piece.source_face.size());
  const auto close_face = [&](std::size_t f) {
    face_first.push_back(static_cast<std::uint32_t>(corners.size()));
    source_face.push_back(piece.source_face[f]);
  };
  auto edit = edits.begin();
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    if (edit == edits.end() || edit->first != f) {
      corners.insert(corners.end(), soup.corners.begin() + soup.face_first[f], soup.corners.begin() + soup.face_first[f + 1]);
      close_face(f);
      continue;
    }
    for (const std::vector<std::uint32_t>& loop : (edit++)->second) {
      corners.insert(corners.end(), loop.begin(), loop.end());
      close_face(f);
    }
  }
  soup.corners = std::move(corners);
  soup.face_first = std::move(face_first);
  piece.source_face = std::move(source_face);
  drop_deserted_points(piece, had_face);
}

namespace {

Element element_at_face(const PolygonSoup& input, std::uint32_t f) {
  Element element;
  element.faces.push_back(f);
  if (f < input.face_line.size()) element.line = input.face_line[f];
  const auto after = std::upper_bound(input.parts.begin(), input.parts.end(), f,
                                      [](std::uint32_t face, const Part& part) { return face < part.first_face; });
  if (after != input.parts.begin()) element.part = std::prev(after)->name;
  for (std::uint32_t c = input.face_first[f]; c < input.face_first[f + 1] && !element.point; ++c) {
    if (input.corners[c] != PolygonSoup::kInvalidVertex) element.point = input.points[input.corners[c]];
  }
  return element;
}

Element element_at_vertex(const PolygonSoup& input, std::uint32_t v) {
  Element element;
  element.vertices.push_back(v);
  element.point = input.points[v];
  if (v < input.point_line.size()) element.line = input.point_line[v];
  return element;
}

std::vector<Element> elements_of(const PolygonSoup& input, Kind kind, std::vector<std::uint32_t>& sources) {
  std::sort(sources.begin(), sources.end());
  std::vector<Element> elements;
  for (std::size_t i = 0; i < std::min(sources.size(), kListedElements); ++i)
    elements.push_back(kind == Kind::faces ? element_at_face(input, sources[i]) : element_at_vertex(input, sources[i]));
  return elements;
}

}  // namespace

RepairAction action_of(const Workpiece& piece, std::string name, Kind kind, std::string message, Tally& tally) {
  RepairAction action;
  action.name = std::move(name);
  action.total = tally.done.size();
  action.message = std::move(message);
  action.elements = elements_of(piece.input, kind, tally.done);
  action.left = tally.left.size();
  action.left_elements = elements_of(piece.input, kind, tally.left);
  if (tally.left.empty()) return action;
  const std::string one = kind == Kind::faces ? "face was" : "vertex was",
                    many = kind == Kind::faces ? "faces were" : "vertices were";
  action.left_message = counted(action.left, one, many) + " left as found: ";
  std::size_t told = 0;
  for (const auto& [reason, count] : tally.reasons)
    action.left_message += (told++ == 0 ? "" : ", ") + std::to_string(count) + " " + reason;
  return action;
}

std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

// ---- the order

namespace {

bool asks_for_anything(const RepairOptions& options) {
  return options.weld || options.drop_degenerate_faces || options.drop_duplicate_faces || options.split_non_manifold_vertices ||
         options.orient || options.reverse_inside_out || options.simplify_error;
}

// Each of the two steps can enable the other: once a duplicate is gone, an edge has two faces again. Runs both until neither
// changes the mesh.
void drop_faces(Workpiece& piece, const RepairOptions& options, std::vector<RepairAction>& actions) {
  DegenerateTally degenerate;
  Tally duplicates;
  for (bool is_first = true;; is_first = false) {
    std::uint64_t done = 0;
    if (options.drop_degenerate_faces) done += drop_degenerate(piece, degenerate);
    if (options.drop_duplicate_faces && (is_first || done != 0)) done += drop_duplicates(piece, duplicates);
    if (done == 0 || !(options.drop_degenerate_faces && options.drop_duplicate_faces)) break;
  }
  if (options.drop_degenerate_faces) actions.push_back(drop_degenerate_action(piece, degenerate));
  if (options.drop_duplicate_faces) actions.push_back(drop_duplicates_action(piece, duplicates));
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

}  // namespace

Result<Repaired> repair(const PolygonSoup& soup, const RepairOptions& options) {
  if (!asks_for_anything(options)) return Failure{2, soup.name + ": no repair is asked for", {}};
  if (options.simplify_error && !(*options.simplify_error > 0 && std::isfinite(*options.simplify_error)))
    return Failure{2, soup.name + ": the error to simplify to is no number above 0", {}};
  std::optional<Weld> weld = options.weld;
  if (!weld && options.split_non_manifold_vertices) weld = Weld{};

  Repaired repaired;
  const bool keeps_vertices = weld && weld->kind == Weld::Kind::none;
  repaired.before = judged(soup, keeps_vertices ? Weld::Kind::none : Weld::Kind::exact, options);
  Workpiece piece(soup);
  std::vector<RepairAction>& actions = repaired.actions;
  if (weld) actions.push_back(weld_step(piece, *weld));
  drop_faces(piece, options, actions);
  if (options.split_non_manifold_vertices) actions.push_back(split_vertices_step(piece));
  if (options.orient) actions.push_back(orient_step(piece));
  if (options.reverse_inside_out) actions.push_back(reverse_inside_out_step(piece));
  if (options.simplify_error) {
    actions.push_back(simplify_step(piece, *options.simplify_error, options.jobs, options.progress));
  }

  move_parts(piece);
  for (std::size_t f = 0; !soup.face_material.empty() && f < piece.source_face.size(); ++f)
    piece.soup.face_material[f] = soup.face_material[piece.source_face[f]];
  piece.soup.face_material.resize(soup.face_material.empty() ? 0 : piece.soup.face_count());
  if (piece.identity.kind == Weld::Kind::none && has_equal_points(piece.soup)) repaired.read_with = Weld::Kind::none;
  repaired.after = judged(piece.soup, repaired.read_with, options);
  repaired.soup = std::move(piece.soup);
  return repaired;
}

}  // namespace fdcg::bake
