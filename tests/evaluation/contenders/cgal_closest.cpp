// SPDX-License-Identifier: Apache-2.0
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <malloc.h>

#include <chrono>
#include <vector>

#include "contender.hpp"
#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
#if CGAL_VERSION_MAJOR >= 6  // where they have a dimension in their names
using Primitive = CGAL::AABB_triangle_primitive_3<Kernel, std::vector<Triangle>::const_iterator>;
using Traits = CGAL::AABB_traits_3<Kernel, Primitive>;
#else
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
#endif
using Tree = CGAL::AABB_tree<Traits>;

std::size_t heap_in_use() {
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

class CgalClosest : public Contender {
 public:
  explicit CgalClosest(const bake::PolygonSoup& soup) {
    const std::size_t heap_before = heap_in_use();
    const auto begin = std::chrono::steady_clock::now();
    const auto cgal = [&](std::uint32_t i) { return Kernel::Point_3(soup.points[i].x, soup.points[i].y, soup.points[i].z); };
    triangles_.reserve(soup.corners.size() - 2 * soup.face_count());
    normals_.reserve(soup.corners.size() - 2 * soup.face_count());
    for (std::size_t f = 0; f < soup.face_count(); ++f) {
      const std::uint32_t first = soup.face_first[f], last = soup.face_first[f + 1];
      for (std::uint32_t k = first + 1; k + 1 < last; ++k) {
        triangles_.emplace_back(cgal(soup.corners[first]), cgal(soup.corners[k]), cgal(soup.corners[k + 1]));
        const Triangle& t = triangles_.back();
        const Kernel::Vector_3 n = CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
        normals_.push_back({n.x(), n.y(), n.z()});  // the sign of a side is all that is asked
      }
    }
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
    tree_.accelerate_distance_queries();
    info_.bake_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    info_.bytes = heap_in_use() - heap_before;
    info_.name = "cgal_closest";
    info_.family = "closest_point";
    reset();
  }
  void reset() override { has_hint_ = false; }
  void step(const Point& hip_m, Feel& feel) override {
    const Kernel::Point_3 query(hip_m[0], hip_m[1], hip_m[2]);
    hint_ = has_hint_ ? tree_.closest_point_and_primitive(query, hint_) : tree_.closest_point_and_primitive(query);
    has_hint_ = true;
    const Point closest = {hint_.first.x(), hint_.first.y(), hint_.first.z()};
    feel = {hip_m, {}, false, 0};
    if (dot(hip_m - closest, normals_[static_cast<std::size_t>(hint_.second - triangles_.begin())]) >= 0) return;
    feel.god_object = closest;
    feel.force = (closest - hip_m) * kStiffness_n_per_m;
    feel.in_contact = true;
  }

 private:
  std::vector<Triangle> triangles_;
  std::vector<Point> normals_;
  Tree tree_;
  Tree::Point_and_primitive_id hint_;
  bool has_hint_ = false;
};

}  // namespace

std::unique_ptr<Contender> make_cgal_closest(const bake::PolygonSoup& soup) {
  return std::make_unique<CgalClosest>(soup);
}

}  // namespace fdcg::test
