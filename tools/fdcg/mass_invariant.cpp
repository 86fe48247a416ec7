// SPDX-License-Identifier: Apache-2.0
// The mass properties against the solid that the nodes enclose, summed anew in plain floating point.
#include <algorithm>
#include <limits>

#include "invariants.hpp"
#include "points.hpp"

namespace fdcg::tools {
namespace {

using bake::Vec3;

// A sum that keeps what each addition loses (Neumaier 1974), so that its error does not grow with the number of terms.
class Sum {
 public:
  void add(double x) {
    const double next = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
  }
  [[nodiscard]] double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

const fdcg_mass_record* record_of(const fdcg_header& header) {
  const auto* const table = reinterpret_cast<const fdcg_section*>(&header + 1);
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    if (table[i].id == FDCG_SECTION_MASS)
      return reinterpret_cast<const fdcg_mass_record*>(reinterpret_cast<const unsigned char*>(&header) + table[i].offset);
  }
  return nullptr;
}

constexpr int kFirstOf[6] = {0, 1, 2, 0, 0, 1};  // xx, yy, zz, xy, xz, yz
constexpr int kSecondOf[6] = {0, 1, 2, 1, 2, 2};

// Moments about the recorded centroid, and what bounds their error.
struct Solid {
  Sum volume, first[3], second[6];
  double magnitude = 0;  // of the volume's terms
  double area = 0;
  double reach = 0;  // the farthest corner

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double determinant = dot(a, cross(b, c));
    const Vec3 sum = plus(plus(a, 1, b), 1, c);
    volume.add(determinant / 6);
    for (int k = 0; k < 3; ++k)
      first[k].add(determinant * component(sum, k) / 24);
    for (int n = 0; n < 6; ++n) {
      const auto product = [n](const Vec3& v) { return component(v, kFirstOf[n]) * component(v, kSecondOf[n]); };
      second[n].add(determinant * (product(sum) + product(a) + product(b) + product(c)) / 120);
    }
    area += length(cross(plus(b, -1, a), plus(c, -1, a))) / 2;
    reach = std::max({reach, length(a), length(b), length(c)});
    magnitude += length(a) * length(cross(b, c)) / 6;
  }
};

Solid solid_inside(const fdcg_graph& graph, const Vec3& centroid) {
  Solid solid;
  const auto corner = [&](std::uint32_t n, std::uint32_t k) {
    return plus(vec3(fdcg_get_corner(&graph, fdcg_get_side(&graph, n, k).corner).point), -1, centroid);
  };
  for (std::uint32_t n = 0; n < graph.header->node_count; ++n) {
    const std::uint32_t sides = fdcg_get_node(&graph, n).side_count;
    for (std::uint32_t k = 2; k < sides; ++k)
      solid.add(corner(n, 0), corner(n, k - 1), corner(n, k));
  }
  return solid;
}

}  // namespace

std::vector<Invariant> check_mass(const fdcg_graph& graph) {
  const fdcg_mass_record* const record = record_of(*graph.header);
  if (record == nullptr) return {};
  const Solid solid = solid_inside(graph, vec3(record->centroid));
  // Between the mesh and the nodes lies at most the area times what either may be off; a sum of products is good to some ten
  // roundings of its terms. Twice the one, three times the other, to be sure.
  const double epsilon = std::numeric_limits<double>::epsilon();
  const double off = graph.header->max_deviation + record->deviation + 4 * epsilon * graph.header->extent;
  const double volume = 2 * solid.area * off + 32 * epsilon * solid.magnitude;
  Invariant invariant{
      "mass properties are those of the solid inside the nodes (1: all that flattening and rounding explain)", 0, 0, 0, 1, -1};
  const auto compare = [&](double measured, double said, double bound) {
    const double share = std::abs(measured - said) / bound;
    ++invariant.checked;
    if (!(share <= invariant.worst)) invariant.worst = share;
    if (share <= invariant.limit) return;  // NaN is a violation
    ++invariant.violations;
    if (invariant.first < 0) invariant.first = 0;
  };
  compare(solid.volume.value(), record->volume, volume);
  for (const Sum& first : solid.first)
    compare(first.value(), 0, volume * solid.reach);
  const double about_centroid = volume * solid.reach * solid.reach;
  for (std::size_t k = 0; k < 3; ++k)
    compare(solid.second[(k + 1) % 3].value() + solid.second[(k + 2) % 3].value(), record->inertia[k], 2 * about_centroid);
  for (std::size_t n = 3; n < 6; ++n)
    compare(-solid.second[n].value(), record->inertia[n], about_centroid);
  return {invariant};
}

}  // namespace fdcg::tools
