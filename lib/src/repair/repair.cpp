// SPDX-License-Identifier: Apache-2.0
// What the steps of a repair share.
#include "repair/repair.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numeric>

#include "topology/weld.hpp"

namespace fdcg::bake {

// ---- what the steps share

namespace {

bool is_float(double x) {
  return !std::isfinite(x) || static_cast<double>(static_cast<float>(x)) == x;
}

}  // namespace

Workpiece::Workpiece(const PolygonSoup& given)
    : input(given),
      soup(given),
      source_point(given.points.size()),
      has_floats(std::all_of(given.points.begin(), given.points.end(),
                             [](const Vec3& p) { return is_float(p.x) && is_float(p.y) && is_float(p.z); })) {
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

std::string in_digits(double value) {
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value, std::chars_format::general, 6).ptr};
}

}  // namespace fdcg::bake
