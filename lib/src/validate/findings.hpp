// SPDX-License-Identifier: Apache-2.0
// The input of the rules, and the collection of their findings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "fdcg/bake.hpp"
#include "report/fingerprint.hpp"
#include "topology/duplicates.hpp"
#include "topology/edges.hpp"
#include "topology/face_geometry.hpp"
#include "topology/patches.hpp"
#include "topology/topology.hpp"

namespace fdcg::bake {

// The mesh to check, with data shared by several rules.
struct Subject {
  const PolygonSoup& soup;
  const Mesh& mesh;
  const Topology& topology;
  const std::vector<FaceState>& states;
  Precision precision;
  unsigned jobs;                        // threads for the rules that run alone
  const Progress& progress;             // for these too
  FaceGeometry& geometry;               // is_flat() and is_fold() cache results: for the rules of one thread only
  std::vector<OddEdge> odd{};           // odd_edges()
  Patches patches{};                    // find_patches(): for the rules of patches, and afterwards
  std::vector<Duplicate> duplicates{};  // duplicate_faces(): for its rule, and afterwards

  [[nodiscard]] VertexId start_of(HalfedgeId h) const { return mesh.corners[+h]; }
  [[nodiscard]] VertexId end_of(HalfedgeId h) const { return mesh.corners[+next(mesh, topology.face(h), h)]; }
  [[nodiscard]] const Vec3& source_point(VertexId v) const { return soup.points[mesh.source_point[+v]]; }
};

// The findings of one rule: counts all, lists the first few. Each call is one finding; faces, edges and vertices are translated
// to the indices, lines, parts and coordinates of the source.
class Findings {
 public:
  Findings(const Subject& subject, const Rule& rule, Severity severity, std::size_t max_elements, const EachElement& each);

  void at_file();
  void at_vertex(std::uint32_t source);  // also one that the weld joined to another
  void at_face(FaceId f);
  void at_face(FaceId f, FaceId original);              // a copy, and what it copies
  void at_edge(std::span<const HalfedgeId> halfedges);  // all of one edge, at least one
  void at_pair(FaceId a, FaceId b, const Vec3& point);  // two faces that meet; the point in the mesh's frame
  void in_edge(VertexId v, HalfedgeId h);               // the vertex, the edge and its face
  void at_patch(std::uint32_t patch);                   // ascending: of Subject::patches

  // Findings beyond those listed.
  void count_more(std::uint64_t unlisted) { issue_.total += unlisted; }

  // In place of the catalogue's phrase and remedy; the total comes first.
  void say(std::string message) { issue_.message = std::move(message); }
  // There may be more than were counted.
  void say_at_least(std::string message) {
    say(std::move(message));
    issue_.is_at_least = true;
  }
  [[nodiscard]] std::uint64_t total() const { return issue_.total; }
  // Number of findings that need a location; others may be counted by count_more().
  [[nodiscard]] std::size_t max_elements() const { return each_ ? kAllElements : max_elements_; }

  // The issue for the report. Without findings it has no message.
  [[nodiscard]] Issue take() &&;

 private:
  // Counts one finding; null where it is neither listed nor passed to each_. It is complete at the next finding, or at the end.
  Element* found();
  void finish_element();
  void add_face(Element& element, FaceId f) const;
  [[nodiscard]] Vec3 least_corner(std::uint32_t patch);

  const Subject& subject_;
  const Rule& rule_;
  std::size_t max_elements_;
  const EachElement& each_;
  Issue issue_;
  Element element_;                  // the last one found
  Element* current_ = nullptr;       // that, or null
  std::vector<Vec3> least_corners_;  // of each patch; empty until first used
};

}  // namespace fdcg::bake
