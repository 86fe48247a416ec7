// SPDX-License-Identifier: Apache-2.0
#include "nearest_judge.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <vector>

namespace fdcg::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Exact::Point_3 exact(const Kernel::Point_3& p) {
  return {CGAL::Exact_rational(p.x()), CGAL::Exact_rational(p.y()), CGAL::Exact_rational(p.z())};
}

}  // namespace

struct NearestJudge::Trees {
  Mesh mesh;
  std::unique_ptr<Tree> tree;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;
};

NearestJudge::NearestJudge(const bake::PolygonSoup& soup) : trees_(std::make_unique<Trees>()) {
  std::vector<Mesh::Vertex_index> vertices;
  for (const bake::Vec3& p : soup.points)
    vertices.push_back(trees_->mesh.add_vertex({p.x, p.y, p.z}));
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const std::uint32_t* const c = &soup.corners[soup.face_first[f]];
    trees_->mesh.add_face(vertices[c[0]], vertices[c[1]], vertices[c[2]]);
  }
  trees_->tree = std::make_unique<Tree>(faces(trees_->mesh).first, faces(trees_->mesh).second, trees_->mesh);
  trees_->tree->accelerate_distance_queries();
  trees_->side = std::make_unique<CGAL::Side_of_triangle_mesh<Mesh, Kernel>>(trees_->mesh);
}

NearestJudge::~NearestJudge() = default;

double NearestJudge::distance(const bake::Vec3& point) const {
  const Kernel::Point_3 at{point.x, point.y, point.z};
  const auto face = trees_->tree->closest_point_and_primitive(at).second;
  std::vector<Exact::Point_3> corners;
  for (const auto v : vertices_around_face(trees_->mesh.halfedge(face), trees_->mesh))
    corners.push_back(exact(trees_->mesh.point(v)));
  const Exact::Triangle_3 triangle(corners[0], corners[1], corners[2]);
  return std::sqrt(CGAL::to_double(CGAL::squared_distance(exact(at), triangle)));
}

bool NearestJudge::is_inside(const bake::Vec3& point) const {
  return (*trees_->side)({point.x, point.y, point.z}) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace fdcg::test
