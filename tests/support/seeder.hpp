// SPDX-License-Identifier: Apache-2.0
// Plants defects in a clean mesh and predicts the findings of a validator from the known surroundings of each defect. The
// finished mesh is not analysed: predictions follow from single defects, which are kept so far apart that they do not interact.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "clean_mesh.hpp"
#include "fdcg/bake.hpp"
#include "meshes.hpp"
#include "random.hpp"

namespace fdcg::test {

// The place of a finding by the file's indices: its faces and its vertices (an edge has two), ascending.
struct Place {
  std::vector<std::uint32_t> faces, vertices;
  auto operator<=>(const Place&) const = default;
};
using Findings = std::map<std::string, std::multiset<Place>>;

struct SeededMesh {
  PolygonSoup soup;  // to be written; for files without vertices of their own (STL) each corner has its own point
  Findings findings;
  std::uint64_t vertices = 0, components = 0, kept_faces = 0;  // as the report counts them
  std::map<std::string, int> planted;                          // how many defects of each kind
};

class Seeder {
 public:
  struct Setting {
    bool welds = true;         // equal points count as one
    bool has_vertices = true;  // faces name vertices; else (STL) each corner is a point of its own, and `welds` holds
    bool triangles_only = false;
    bool has_non_finite = true;  // the file can hold NaN and infinities
    bool has_bad_indices = true;
  };

  Seeder(const CleanMesh& clean, const Setting& setting, Random& random);

  // Plants one defect of a kind drawn at random, if there is room; false if none was found.
  bool plant();
  // Plants one of this kind: a name of kinds().
  bool plant(const std::string& kind);
  static std::vector<std::string> kinds();

  // Turns over the whole of a shell, drawn at random where none is named; before anything else.
  void reverse_shell();
  void reverse_shell(std::uint32_t shell);
  // Turns over, or deletes, each face of one untouched shell with a probability.
  bool flip_many(double probability);
  bool delete_many(double probability);

  // Numbers faces and vertices in an order drawn at random.
  SeededMesh finish();

 private:
  using Face = std::uint32_t;    // numbers of this class, not of the file
  using Vertex = std::uint32_t;  // likewise
  struct Finding {
    std::vector<Face> faces;
    std::vector<Vertex> vertices;
  };

  // ---- the clean mesh
  [[nodiscard]] const Polygon& clean_loop(Face f) const { return clean_loops_[f]; }
  [[nodiscard]] Face face_with(Vertex from, Vertex to) const;  // the one that runs along this directed edge
  [[nodiscard]] Face across(Vertex u, Vertex v, Face f) const;
  [[nodiscard]] std::vector<Vertex> ring(Vertex v) const;  // the far ends of its edges, in cyclic order
  [[nodiscard]] bool is_triangle_fan(Vertex v) const;

  // ---- room
  // All vertices of all faces at these are taken, unless one already was.
  bool claim(const std::vector<Vertex>& core);
  std::optional<Face> free_face(bool triangle);
  std::optional<Vertex> free_vertex(bool (Seeder::*fits)(Vertex) const);
  bool any_vertex(Vertex) const { return true; }
  Vec3 far_away();  // a place 3 units from any other, beyond the mesh

  // ---- changes
  Vertex add_point(const Vec3& p);
  Face add_face(const Polygon& loop, std::uint32_t shell);
  void find(const std::string& rule, std::vector<Face> faces, std::vector<Vertex> vertices = {});
  void find_hole(Face f);  // its neighbours now have boundary edges
  void cut_apart(Vertex v, std::vector<Vertex>& copies);
  void break_shell(Face f) { is_broken_[shell_of_[f]] = true; }
  void make_equal(Vertex v, Vertex w);

  // ---- kinds of defects
  static const std::map<std::string, bool (Seeder::*)()>& planters();
  bool flip_face();
  bool delete_face();
  bool duplicate_face();
  bool pinch_vertex();
  bool poke_vertex();
  bool unweld_vertex();
  bool non_finite_vertex();
  bool isolated_vertex();
  bool repeated_point();
  bool collapse_edge();
  bool repeated_corner();
  bool collinear_face();
  bool bad_index();
  bool split_edge();
  bool fin();
  bool moebius_band();
  bool folded_pair();
  bool sliver();
  bool bow_tie();
  bool bulge();

  [[nodiscard]] bool keeps_shape(Vertex v, const Vec3& p, const std::vector<Face>& gone) const;
  void number_file(SeededMesh& out);
  void find_inside_out(SeededMesh& out) const;
  void count(SeededMesh& out) const;

  const CleanMesh& clean_;
  Setting setting_;
  Random& random_;
  std::vector<Polygon> clean_loops_;
  std::vector<std::vector<Face>> faces_at_;
  std::vector<std::uint32_t> shell_of_;        // of each face, those added too; kNone: of none
  std::vector<bool> is_broken_, is_reversed_;  // of each shell
  std::vector<bool> is_taken_;                 // of each clean vertex

  std::vector<Vec3> points_;
  std::vector<Vertex> place_;  // the vertex that stands for all at the same point
  std::vector<Polygon> loops_;
  std::vector<bool> is_there_;
  std::set<Face> dropped_;  // not among the faces kept
  std::multimap<std::string, Finding> found_;
  std::map<std::string, int> planted_;
  double far_ = 0;

  std::vector<std::uint32_t> face_number_;
  std::vector<std::uint32_t> vertex_number_;  // of the first in the file of those at the same place
};

}  // namespace fdcg::test
