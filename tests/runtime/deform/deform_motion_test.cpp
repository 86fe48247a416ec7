// SPDX-License-Identifier: Apache-2.0
// Deformable meshes: nothing falls through a surface that moves, god-objects stay on it, and triangles may lose their area.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>

#include "deform_rig.hpp"
#include "fp_trap.hpp"
#include "meshes.hpp"
#include "random.hpp"

using namespace fdcg;
using namespace fdcg::test;

namespace {

// How far the god-object is off the feature that it is on; local units.
double off_feature(const fdcg_graph& graph, const fdcg_contact& contact) {
  const auto plane_off = [&contact](const double(&normal)[3], double offset) {
    double sum = offset;
    for (int k = 0; k < 3; ++k)
      sum += normal[k] * contact.god_object[k];
    return sum;
  };
  double off = 0;
  if (contact.state == FDCG_FACE) {
    const fdcg_node_info node = fdcg_get_node(&graph, contact.feature);
    off = std::fabs(plane_off(node.normal, node.offset));
    for (std::uint32_t k = 0; k < 3; ++k) {
      const fdcg_side_info side = fdcg_get_side(&graph, contact.feature, k);
      off = std::max(off, plane_off(side.voronoi_normal, side.voronoi_offset));
    }
  } else if (contact.state == FDCG_EDGE) {
    const fdcg_connection_info edge = fdcg_get_connection(&graph, contact.feature);
    const fdcg_corner_info start = fdcg_get_corner(&graph, edge.corner[0]);
    double along = 0, gap2 = 0;
    for (int k = 0; k < 3; ++k)
      along += edge.direction[k] * (contact.god_object[k] - start.point[k]);
    along = std::min(std::max(along, 0.0), edge.length);
    for (int k = 0; k < 3; ++k) {
      const double gap = contact.god_object[k] - start.point[k] - along * edge.direction[k];
      gap2 += gap * gap;
    }
    off = std::sqrt(gap2);
  } else if (contact.state == FDCG_VERTEX) {
    const fdcg_corner_info corner = fdcg_get_corner(&graph, contact.feature);
    for (int k = 0; k < 3; ++k)
      off = std::max(off, std::fabs(corner.point[k] - contact.god_object[k]));
  }
  return off;
}

// A sheet over [-0.5, 0.5]^2 of n x n squares, each cut into two; its heights change, its vertices' x and y do not.
class Sheet {
 public:
  explicit Sheet(int n, bake::Precision precision = bake::Precision::f64)
      : n_(n), rest_(plane_grid(n, n)), options_(triangle_options(precision)), mesh(rest_, options_) {
    height_.assign(rest_.points.size(), 0.0F);
    vertex_.resize(static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 1));
    for (std::size_t v = 0; v < rest_.points.size(); ++v)
      vertex_[at(cell(rest_.points[v].x + 0.5 / n), cell(rest_.points[v].y + 0.5 / n))] = v;
    for (std::size_t f = 0; f < rest_.face_count(); ++f)
      triangles_.push_back(face_corners(rest_, f));
    of_cell_.resize(static_cast<std::size_t>(n * n));
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      const bake::Vec3 c =
          (1.0 / 3) * (rest_.points[triangles_[f][0]] + rest_.points[triangles_[f][1]] + rest_.points[triangles_[f][2]]);
      of_cell_[static_cast<std::size_t>(cell(c.x) * n + cell(c.y))].push_back(f);
    }
  }

  [[nodiscard]] std::size_t vertex_count() const { return height_.size(); }
  // Puts a vertex exactly where its neighbour is, or exactly on the middle of the way there: its triangles lose their area.
  // It follows the neighbour until it is lifted itself.
  void squeeze(std::size_t v, std::size_t neighbour, bool is_half) {
    std::erase_if(squeezed_, [v](const Squeezed& s) { return s.vertex == v; });
    squeezed_.push_back({v, neighbour, is_half});
    follow(squeezed_.back());
  }
  [[nodiscard]] std::size_t vertex_at(int i, int j) const { return vertex_[at(i, j)]; }
  [[nodiscard]] int squares() const { return n_; }

  // The numbers of a mesh made anew whose vertices are where this one's are.
  [[nodiscard]] std::vector<unsigned char> bytes_anew() const { return mesh.bytes_anew(); }
  [[nodiscard]] double updated_extent() { return mesh.updated().header->extent; }
  [[nodiscard]] bool is_near_rim(std::size_t v) const {
    constexpr double kLevel = 0.44;
    return std::max(std::fabs(rest_.points[v].x), std::fabs(rest_.points[v].y)) > kLevel;
  }
  [[nodiscard]] std::size_t vertex_near(double x, double y) const {
    return vertex_[at(std::min(cell(x + 0.5 / n_), n_), std::min(cell(y + 0.5 / n_), n_))];
  }
  void lift(std::size_t v, double z) {
    height_[v] = static_cast<float>(z);
    std::erase_if(squeezed_, [v](const Squeezed& s) { return s.vertex == v; });
    mesh.move(v, {rest_.points[v].x, rest_.points[v].y, static_cast<double>(height_[v])});
    for (const Squeezed& s : squeezed_) {
      if (s.onto == v) follow(s);
    }
  }

  // The same of many at once; of none that is squeezed or followed.
  void lift_with_others(std::size_t v, double z) {
    lifted_.push_back(v);
    places_.insert(places_.end(), {rest_.points[v].x, rest_.points[v].y, static_cast<double>(static_cast<float>(z))});
  }
  void lift_all() {
    mesh.move(lifted_, places_);
    lifted_.clear();
    places_.clear();
  }

  // The surface's height at a place, up to rounding error; on request the cosine of its slope.
  [[nodiscard]] double height_at(double x, double y, double* cosine = nullptr) const {
    double best = -1, height = 0;
    const auto& points = mesh.points();
    for (const std::size_t f : near_triangles(cell(x), cell(y))) {
      const bake::Vec3 &a = points[triangles_[f][0]], &b = points[triangles_[f][1]], &c = points[triangles_[f][2]];
      const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      if (area == 0) continue;
      const double u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
      const double v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      const double inside = std::min({u, v, 1 - u - v});
      if (inside <= best) continue;
      best = inside;
      height = a.z + u * (b.z - a.z) + v * (c.z - a.z);
      if (cosine == nullptr) continue;
      const double rise_x = ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) / area;
      const double rise_y = ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) / area;
      *cosine = 1 / std::sqrt(1 + rise_x * rise_x + rise_y * rise_y);
    }
    return height;
  }
  // How far a place is off the surface's triangle above or below it.
  [[nodiscard]] double off_surface(const double (&place)[3]) const {
    double cosine = 1;
    const double height = height_at(place[0], place[1], &cosine);
    return std::fabs(place[2] - height) * cosine;
  }

 private:
  struct Squeezed {
    std::size_t vertex, onto;
    bool is_half;
  };

  void follow(const Squeezed& s) {
    const bake::Vec3 there = mesh.points()[s.onto];
    mesh.move(s.vertex, s.is_half ? 0.5 * (rest_.points[s.vertex] + there) : there);
  }
  [[nodiscard]] int cell(double x) const { return std::min(std::max(static_cast<int>(std::floor((x + 0.5) * n_)), 0), n_); }
  // Those of a square and the eight around it: no vertex moves further.
  [[nodiscard]] std::vector<std::size_t> near_triangles(int i, int j) const {
    std::vector<std::size_t> near;
    for (int k = std::max(i - 1, 0); k <= std::min(i + 1, n_ - 1); ++k) {
      for (int l = std::max(j - 1, 0); l <= std::min(j + 1, n_ - 1); ++l) {
        const auto& here = of_cell_[static_cast<std::size_t>(k * n_ + l)];
        near.insert(near.end(), here.begin(), here.end());
      }
    }
    return near;
  }
  [[nodiscard]] std::size_t at(int i, int j) const { return static_cast<std::size_t>(i * (n_ + 1) + j); }

  int n_;
  bake::PolygonSoup rest_;
  bake::CompileOptions options_;
  std::vector<Squeezed> squeezed_;
  std::vector<float> height_;
  std::vector<std::size_t> lifted_;
  std::vector<double> places_;
  std::vector<std::size_t> vertex_;
  std::vector<Polygon> triangles_;
  std::vector<std::vector<std::size_t>> of_cell_;

 public:
  DeformableMesh mesh;
};

}  // namespace

// FDCG_STEPS=10000000 FDCG_SHEET=224 is the long form: 10^5 faces. With FDCG_SEED it may run in parts.
TEST_CASE("a sheet that heaves under and over a finger never lets it through") {
  constexpr double kEpsilon = 2.2204460492503131e-16;
  const std::uint64_t steps = steps_or(60000);
  const int n = std::getenv("FDCG_SHEET") != nullptr ? std::atoi(std::getenv("FDCG_SHEET")) : 40;
  Sheet sheet(n);
  const double extent = sheet.updated_extent();
  Random random(std::getenv("FDCG_SEED") != nullptr ? std::strtoull(std::getenv("FDCG_SEED"), nullptr, 10) : 17);
  fdcg_deform_contact contact = {};
  const fdcg_params params = contact_params(0.5, 0.3);
  const auto moving = static_cast<std::uint32_t>(sheet.vertex_count() / 100) + 1;
  const std::uint64_t between =
      std::min<std::uint64_t>(steps / 32, 10000);  // steps, from one computation of the whole to the next
  Hip hip = {0.013, 0.021, 0.3};
  std::uint64_t caught = 0, touched = 0, freed = 0, bound = 0, longest_bound = 0, all_bound = 0;
  std::uint32_t last_state = FDCG_FREE;
  double most_off = 0;
  for (std::uint64_t i = 0; i < steps; ++i) {
    const bool is_still = random.chance(0.3);
    const std::uint32_t moves = random.chance(0.1) ? random.below(moving + 1) : moving;
    for (std::uint32_t m = 0; m < moves; ++m) {
      const bool is_near = random.chance(0.5);
      const std::size_t v = is_near ? sheet.vertex_near(hip[0] + random.uniform(-4, 4) / n, hip[1] + random.uniform(-4, 4) / n)
                                    : random.below(static_cast<std::uint32_t>(sheet.vertex_count()));
      // the rim stays level: over a steep one a god-object may rightly leave an open sheet
      if (!sheet.is_near_rim(v)) sheet.lift_with_others(v, random.uniform(-0.2, 0.2));
    }
    sheet.lift_all();
    if (!is_still) {
      const double size = random.chance(0.1) ? 0.3 : 0.02;
      for (int k = 0; k < 3; ++k)
        hip[static_cast<std::size_t>(k)] += random.uniform(-size, size);
      hip[0] = std::min(std::max(hip[0], -0.35), 0.35);
      hip[1] = std::min(std::max(hip[1], -0.35), 0.35);
      hip[2] = std::min(std::max(hip[2], -0.3), 0.4);
      // close over the sheet, or on it up to rounding error, where the next tick's motion may pass it
      if (random.chance(0.1)) hip[2] = sheet.height_at(hip[0], hip[1]) + (random.chance(0.3) ? 0 : random.uniform(0, 0.05));
    }
    const FpTrap trap(hip.data());
    const fdcg_result result = sheet.mesh.step(params, &contact, hip);
    const double above = hip[2] - sheet.height_at(hip[0], hip[1]);
    INFO("step " << i << " hip " << hip[0] << " " << hip[1] << " " << hip[2] << " above " << above << " state " << result.state
                 << " flags " << result.flags);
    if ((result.flags & FDCG_RESULT_SWEEP_BOUND) == 0 && result.state == FDCG_FREE) REQUIRE(above >= -16 * kEpsilon);
    if (result.state != FDCG_FREE) {
      // compared with the planes used by the step; all planes are compared below, in some ticks only
      REQUIRE(std::isfinite(result.god_object_m[2]));
      const double off = sheet.off_surface(result.god_object_m);
      most_off = std::max(most_off, off);
      REQUIRE(off <= 16 * kEpsilon * extent);
    }
    bound = (result.flags & FDCG_RESULT_SWEEP_BOUND) != 0 ? bound + 1 : 0;  // ticks in a row
    longest_bound = std::max(longest_bound, bound);
    all_bound += bound > 0;
    caught += (result.flags & FDCG_DEFORM_CAUGHT) != 0;
    touched += result.state != FDCG_FREE;
    freed += result.state == FDCG_FREE && last_state != FDCG_FREE;
    last_state = result.state;
    if (i % 64 == 0 && steps <= 100000) REQUIRE(off_feature(sheet.mesh.updated(), contact.contact) <= 8 * kEpsilon * extent);
    if (i % between == 0) {
      REQUIRE(off_feature(sheet.mesh.updated(), contact.contact) <= 8 * kEpsilon * extent);
      REQUIRE(bytes_of(sheet.mesh.updated()) == sheet.bytes_anew());
    }
  }
  std::ostringstream said;
  said << caught << " caught, " << touched << " in touch, " << freed << " freed, " << all_bound << " bound, " << longest_bound
       << " in a row, of " << steps << "; most off the surface " << most_off / (kEpsilon * extent) << " epsilons of the extent";
  INFO(said.str());
  CHECK(caught > steps / 5000);
  CHECK(touched > steps / 10);
  CHECK(freed > steps / 500);
  CHECK(longest_bound < 100);
  if (steps > 100000) WARN(said.str());
}

// As any program computes it, the middle of a side lies off it by a rounding: the triangle's normal is noise, and may point
// into the sheet.
TEST_CASE("a triangle squeezed onto its side under a still finger lets nothing through, and comes back") {
  constexpr int kPresses = 3000, kTicks = 4;
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    for (const double mu : {0.0, 0.4}) {
      const bake::PolygonSoup rest = plane_grid(7, 7);  // places that are no dyadic fractions
      DeformableMesh mesh(rest, triangle_options(precision));
      const fdcg_params params = contact_params(mu, mu);
      Random random(53);
      std::uint64_t felt = 0, rims = 0;
      for (int press = 0; press < kPresses; ++press) {
        const std::uint32_t* const triangle =
            &rest.corners[3 * random.below(static_cast<std::uint32_t>(rest.corners.size() / 3))];
        const std::uint32_t k = random.below(3), a = triangle[k], b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
        double weight[3] = {random.uniform(0.05, 1), random.uniform(0.05, 1), random.uniform(0.05, 1)};
        const double sum = weight[0] + weight[1] + weight[2];
        const bake::Vec3 at =
            (weight[0] / sum) * rest.points[a] + (weight[1] / sum) * rest.points[b] + (weight[2] / sum) * rest.points[c];
        fdcg_deform_contact contact = {};
        mesh.step(params, &contact, {at.x, at.y, 0.005});
        const Hip hip = {at.x, at.y, -0.005};
        REQUIRE(mesh.step(params, &contact, hip).state != FDCG_FREE);
        mesh.move(a, 0.5 * (rest.points[b] + rest.points[c]));
        const bool is_rim = std::fabs(rest.points[a].x) > 0.49 || std::fabs(rest.points[a].y) > 0.49;
        for (int tick = 0; tick < kTicks; ++tick) {
          const fdcg_result result = mesh.step(params, &contact, hip);
          INFO("press " << press << " at " << at.x << " " << at.y << " corner " << k << " tick " << tick << " state "
                        << result.state);
          if (is_rim) continue;  // there the sheet is gone from over the finger
          REQUIRE(result.state != FDCG_FREE);
          CHECK(result.force_n[2] == Approx(1000 * 0.005).epsilon(1e-5));
          ++felt;
        }
        rims += is_rim;
        mesh.move(a, rest.points[a]);
        const fdcg_result back = mesh.step(params, &contact, hip);
        if (!is_rim) CHECK(back.state != FDCG_FREE);
      }
      CHECK(felt > kPresses);
      CHECK(rims < kPresses / 2);
    }
  }
}

TEST_CASE("triangles squeezed to lines and points let nothing through, and come back") {
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    const double epsilon = precision == bake::Precision::f64 ? 2.2204460492503131e-16 : 1.1920929e-7;
    const std::uint64_t steps = steps_or(120000);
    Sheet sheet(32, precision);  // places are dyadic: what is squeezed is exactly so
    const double extent = sheet.updated_extent();
    Random random(23);
    fdcg_deform_contact contact = {};
    const fdcg_params params = contact_params(0.5, 0.3);
    Hip hip = {0.013, 0.021, 0.3};
    std::uint64_t touched = 0, caught = 0, freed = 0;
    std::uint32_t last_state = FDCG_FREE;
    for (std::uint64_t i = 0; i < steps; ++i) {
      // every third vertex is squeezed or let go; the others rise and sink
      const int n = sheet.squares(), ci = static_cast<int>((hip[0] + 0.5) * n), cj = static_cast<int>((hip[1] + 0.5) * n);
      for (int m = 0; m < 6; ++m) {
        const int vi = ci + static_cast<int>(random.below(7)) - 3, vj = cj + static_cast<int>(random.below(7)) - 3;
        if (vi < 1 || vj < 1 || vi >= n || vj >= n) continue;
        const double z = std::ldexp(std::floor(random.uniform(-64, 64)), -10);
        if (vi % 3 != 0 || vj % 3 != 0 || random.chance(0.2)) {
          sheet.lift(sheet.vertex_at(vi, vj), z);
        } else {
          static constexpr int kTo[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
          const int* const to = kTo[random.below(4)];
          sheet.squeeze(sheet.vertex_at(vi, vj), sheet.vertex_at(vi + to[0], vj + to[1]), random.chance(0.4));
        }
      }
      for (int k = 0; k < 3 && !random.chance(0.3); ++k)
        hip[static_cast<std::size_t>(k)] += random.uniform(-0.02, 0.02);
      hip[0] = std::min(std::max(hip[0], -0.4), 0.4);
      hip[1] = std::min(std::max(hip[1], -0.4), 0.4);
      hip[2] = std::min(std::max(hip[2], -0.2), 0.3);
      if (random.chance(0.1)) hip[2] = sheet.height_at(hip[0], hip[1]) + random.uniform(1e-9, 0.05);
      const FpTrap trap(hip.data());
      const fdcg_result result = sheet.mesh.step(params, &contact, hip);
      const double above = hip[2] - sheet.height_at(hip[0], hip[1]);
      INFO("step " << i << " hip " << hip[0] << " " << hip[1] << " " << hip[2] << " above " << above << " state "
                   << result.state << " flags " << result.flags);
      if ((result.flags & FDCG_RESULT_SWEEP_BOUND) == 0 && result.state == FDCG_FREE) REQUIRE(above >= -64 * epsilon * extent);
      REQUIRE(std::isfinite(result.force_n[0] + result.force_n[1] + result.force_n[2]));
      if (result.state != FDCG_FREE) {
        const double off = result.god_object_m[2] - sheet.height_at(result.god_object_m[0], result.god_object_m[1]);
        REQUIRE(std::fabs(off) <= 1e5 * epsilon * extent);  // walls of 80 degrees: a rounding in x is many in z
      }
      caught += (result.flags & FDCG_DEFORM_CAUGHT) != 0;
      touched += result.state != FDCG_FREE;
      freed += result.state == FDCG_FREE && last_state != FDCG_FREE;
      last_state = result.state;
    }
    INFO(caught << " caught, " << touched << " in touch, " << freed << " freed of " << steps);
    CHECK(caught > steps / 500);
    CHECK(touched > steps / 10);
    CHECK(freed > steps / 500);
  }
}

TEST_CASE("a closed body that swells and shrinks over a finger never lets it in") {
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    const std::uint64_t steps = steps_or(20000);
    const bake::PolygonSoup rest = ico_sphere(2);
    DeformableMesh mesh(rest, triangle_options(precision));
    bake::PolygonSoup now = rest;
    Random random(29);
    HipWalk walk(rest, 31);
    fdcg_deform_contact contact = {};
    const fdcg_params params = contact_params(0.5, 0.3);
    Hip hip = {0, 0, 3}, god_object = hip;
    std::uint64_t caught = 0, touched = 0, judged = 0;
    for (std::uint64_t i = 0; i < steps; ++i) {
      if (random.chance(0.8)) {
        for (int m = 0; m < 8; ++m) {  // along its ray: the body stays star-shaped, and crosses itself nowhere
          const std::uint32_t v = random.below(static_cast<std::uint32_t>(rest.points.size()));
          now.points[v] = random.uniform(0.6, 1.6) * rest.points[v];
          mesh.move(v, now.points[v]);
        }
      }
      if (i > 0 && random.chance(0.7)) hip = walk.next(god_object);
      const FpTrap trap(hip.data());
      const fdcg_result result = mesh.step(params, &contact, hip);
      god_object = {result.god_object_m[0], result.god_object_m[1], result.god_object_m[2]};
      caught += (result.flags & FDCG_DEFORM_CAUGHT) != 0;
      touched += result.state != FDCG_FREE;
      if (result.state != FDCG_FREE || (result.flags & FDCG_RESULT_SWEEP_BOUND) != 0) continue;
      ++judged;
      if (winding_number(now, hip) < 0.9) continue;  // in between only within rounding of the surface
      const double depth = distance(hip, closest_point(now, hip));
      INFO("step " << i << " hip " << hip[0] << " " << hip[1] << " " << hip[2] << " inside by " << depth);
      REQUIRE(depth <= (precision == bake::Precision::f64 ? 1e-14 : 1e-6));  // where the HIP is rounded to
    }
    INFO(caught << " caught, " << touched << " in touch, " << judged << " judged of " << steps);
    CHECK(caught > steps / 500);
    CHECK(touched > steps / 10);
    CHECK(judged > steps / 10);
  }
}
