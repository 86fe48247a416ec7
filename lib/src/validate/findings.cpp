// SPDX-License-Identifier: Apache-2.0
#include "validate/findings.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "report/phrases.hpp"

namespace fdcg::bake {
namespace {

// Halved first: the middle of two finite points is finite.
Vec3 middle(const Vec3& a, const Vec3& b) {
  return {a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2};
}

bool is_less(const Vec3& a, const Vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

}  // namespace

Findings::Findings(const Subject& subject, const Rule& rule, Severity severity, std::size_t max_elements,
                   const EachElement& each)
    : subject_(subject), rule_(rule), max_elements_(max_elements), each_(each) {
  issue_.rule = rule.name;
  issue_.severity = severity;
}

Element* Findings::found() {
  finish_element();
  if (issue_.total++ >= max_elements_ && !each_) return nullptr;
  element_ = {};
  return current_ = &element_;
}

void Findings::finish_element() {
  if (current_ == nullptr) return;
  current_ = nullptr;
  if (each_) each_(rule_.name, element_);
  std::vector<Element>& listed = issue_.elements;
  if (element_.is_known) ++issue_.known;
  if (listed.size() < max_elements_) {
    listed.push_back(std::move(element_));
  } else if (!element_.is_known && listed.size() > issue_.total - issue_.known - 1) {
    // A listed element is known from the baseline: it is replaced.
    listed.erase(std::find_if(listed.rbegin(), listed.rend(), [](const Element& e) { return e.is_known; }).base() - 1);
    listed.push_back(std::move(element_));
  }
}

void Findings::add_face(Element& element, FaceId f) const {
  constexpr std::size_t kMaxFaces = 32;  // keeps a report small: an edge may have a million faces
  const std::uint32_t source = subject_.mesh.source_of(f);
  if (element.faces.size() == kMaxFaces) {
    ++element.more_faces;
    return;
  }
  element.faces.push_back(source);
  if (element.faces.size() > 1) return;
  const PolygonSoup& soup = subject_.soup;
  if (!element.line && source < soup.face_line.size()) element.line = soup.face_line[source];
  const auto after = std::upper_bound(soup.parts.begin(), soup.parts.end(), source,
                                      [](std::uint32_t face, const Part& part) { return face < part.first_face; });
  if (after != soup.parts.begin()) element.part = std::prev(after)->name;
}

void Findings::at_file() {
  if (Element* const element = found()) element->fingerprint = Fingerprint(rule_.name).value();
}

void Findings::at_vertex(std::uint32_t source) {
  Element* const element = found();
  if (element == nullptr) return;
  element->vertices.push_back(source);
  element->point = subject_.soup.points[source];
  if (source < subject_.soup.point_line.size()) element->line = subject_.soup.point_line[source];
  Fingerprint fingerprint(rule_.name);
  fingerprint.add(*element->point);
  element->fingerprint = fingerprint.value();
}

void Findings::at_face(FaceId f) {
  Element* const element = found();
  if (element == nullptr) return;
  add_face(*element, f);
  Fingerprint fingerprint(rule_.name);
  for (std::uint32_t h = subject_.mesh.face_first[+f]; h < subject_.mesh.face_first[+f + 1]; ++h) {
    const VertexId v = subject_.mesh.corners[h];
    if (v == VertexId{kNone}) {
      fingerprint.add_missing_corner();
      continue;
    }
    if (!element->point) element->point = subject_.source_point(v);
    fingerprint.add(subject_.source_point(v));
  }
  element->fingerprint = fingerprint.value();
}

void Findings::at_face(FaceId f, FaceId original) {
  at_face(f);
  if (current_ != nullptr) add_face(*current_, original);
}

void Findings::at_edge(std::span<const HalfedgeId> halfedges) {
  Element* const element = found();
  if (element == nullptr) return;
  const VertexId u = subject_.start_of(halfedges[0]), v = subject_.end_of(halfedges[0]);
  element->edges.push_back({subject_.mesh.source_point[+u], subject_.mesh.source_point[+v]});
  element->point = middle(subject_.source_point(u), subject_.source_point(v));
  for (const HalfedgeId h : halfedges)
    add_face(*element, subject_.topology.face(h));
  Fingerprint fingerprint(rule_.name);
  fingerprint.add(subject_.source_point(u));
  fingerprint.add(subject_.source_point(v));
  element->fingerprint = fingerprint.value();
}

void Findings::at_pair(FaceId a, FaceId b, const Vec3& point) {
  Element* const element = found();
  if (element == nullptr) return;
  const Vec3& origin = subject_.mesh.origin;
  element->point = Vec3{point.x + origin.x, point.y + origin.y, point.z + origin.z};
  Fingerprint fingerprint(rule_.name);
  for (const FaceId f : {a, b}) {
    add_face(*element, f);
    for (std::uint32_t h = subject_.mesh.face_first[+f]; h < subject_.mesh.face_first[+f + 1]; ++h)
      fingerprint.add(subject_.source_point(subject_.mesh.corners[h]));
  }
  element->fingerprint = fingerprint.value();
}

void Findings::in_edge(VertexId v, HalfedgeId h) {
  at_vertex(subject_.mesh.source_point[+v]);
  if (current_ == nullptr) return;
  Element& element = *current_;
  const VertexId p = subject_.start_of(h), q = subject_.end_of(h);
  element.edges.push_back({subject_.mesh.source_point[+p], subject_.mesh.source_point[+q]});
  element.line.reset();  // an element with faces has the line of the first one
  add_face(element, subject_.topology.face(h));
  Fingerprint fingerprint(rule_.name);
  for (const VertexId vertex : {v, p, q})
    fingerprint.add(subject_.source_point(vertex));
  element.fingerprint = fingerprint.value();
}

// One pass computes it for all patches: the rules of patches rarely have findings, but may then have thousands.
Vec3 Findings::least_corner(std::uint32_t patch) {
  const Patches& patches = subject_.patches;
  if (least_corners_.empty()) {
    for (const Patch& p : patches.patches)
      least_corners_.push_back(subject_.source_point(subject_.mesh.corners[subject_.mesh.face_first[+p.first_face]]));
    for (std::uint32_t f = 0; f < subject_.mesh.face_count(); ++f) {
      if (patches.of_face[f] == kNone) continue;
      Vec3& least = least_corners_[patches.of_face[f]];
      for (std::uint32_t h = subject_.mesh.face_first[f]; h < subject_.mesh.face_first[f + 1]; ++h) {
        const Vec3& point = subject_.source_point(subject_.mesh.corners[h]);
        if (is_less(point, least)) least = point;
      }
    }
  }
  return least_corners_[patch];
}

void Findings::at_patch(std::uint32_t patch) {
  Element* const element = found();
  if (element == nullptr) return;
  const Patch& p = subject_.patches.patches[patch];
  add_face(*element, p.first_face);
  element->point = subject_.source_point(subject_.mesh.corners[subject_.mesh.face_first[+p.first_face]]);
  if (p.conflict != HalfedgeId{kNone}) {
    element->edges.push_back(
        {subject_.mesh.source_point[+subject_.start_of(p.conflict)], subject_.mesh.source_point[+subject_.end_of(p.conflict)]});
  }
  Fingerprint fingerprint(rule_.name);
  fingerprint.add(least_corner(patch));
  element->fingerprint = fingerprint.value();
}

Issue Findings::take() && {
  finish_element();
  std::stable_partition(issue_.elements.begin(), issue_.elements.end(), [](const Element& e) { return !e.is_known; });
  if (issue_.total != 0 && issue_.message.empty()) issue_.message = finding_message(rule_, issue_.total);
  return std::move(issue_);
}

}  // namespace fdcg::bake
