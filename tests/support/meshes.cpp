// SPDX-License-Identifier: Apache-2.0
// Over 400 lines: a list of short, independent formulas, one a mesh, that reads better unbroken.
#include "meshes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "random.hpp"

namespace fdcg::test {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec3 operator*(const Vec3& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3 unit(const Vec3& a) {
  return a * (1 / std::sqrt(dot(a, a)));
}

std::vector<Polygon> all_faces(const PolygonSoup& soup) {
  std::vector<Polygon> faces;
  for (std::size_t f = 0; f < soup.face_count(); ++f)
    faces.push_back(face_corners(soup, f));
  return faces;
}

// The number of the point in the middle between two, made on first use.
class Midpoints {
 public:
  explicit Midpoints(std::vector<Vec3>& points) : points_(points) {}
  std::uint32_t operator()(std::uint32_t a, std::uint32_t b) {
    const auto [it, is_new] = index_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back((points_[a] + points_[b]) * 0.5);
    return it->second;
  }

 private:
  std::vector<Vec3>& points_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> index_;
};

// The number of the point at a place of an integer lattice, made on first use.
class Lattice {
 public:
  std::uint32_t operator()(const std::array<int, 3>& place) {
    const auto [it, is_new] = index_.try_emplace(place, static_cast<std::uint32_t>(places.size()));
    if (is_new) places.push_back(place);
    return it->second;
  }
  std::vector<std::array<int, 3>> places;

 private:
  std::map<std::array<int, 3>, std::uint32_t> index_;
};

// The quad on the low (0) or high (1) side of a unit cell along an axis, counter-clockwise seen from outside.
Polygon cell_side(Lattice& lattice, const std::array<int, 3>& cell, int axis, int high) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Polygon loop;
  const int steps[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int k = 0; k < 4; ++k) {
    const int* step = steps[high ? k : 3 - k];
    std::array<int, 3> place = cell;
    place[static_cast<std::size_t>(axis)] += high;
    place[static_cast<std::size_t>(u)] += step[0];
    place[static_cast<std::size_t>(v)] += step[1];
    loop.push_back(lattice(place));
  }
  return loop;
}

}  // namespace

PolygonSoup make_soup(std::string name, std::vector<Vec3> points, const std::vector<Polygon>& faces) {
  PolygonSoup soup;
  soup.name = std::move(name);
  soup.points = std::move(points);
  soup.face_first.push_back(0);
  for (const Polygon& face : faces) {
    soup.corners.insert(soup.corners.end(), face.begin(), face.end());
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  soup.relative_quantum = 0x1p-53;
  soup.sha256 = std::string(64, '0');
  return soup;
}

Polygon face_corners(const PolygonSoup& soup, std::size_t face) {
  return {soup.corners.begin() + soup.face_first[face], soup.corners.begin() + soup.face_first[face + 1]};
}

// ---- blocks ----------------------------------------------------------------------------------------------------------------

PolygonSoup grid_box(int nx, int ny, int nz, const Vec3& size) {
  const std::array<int, 3> count = {nx, ny, nz};
  Lattice lattice;
  std::vector<Polygon> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis), u = (a + 1) % 3, v = (a + 2) % 3;
    for (int high = 0; high < 2; ++high) {
      for (int i = 0; i < count[u]; ++i) {
        for (int j = 0; j < count[v]; ++j) {
          std::array<int, 3> cell{};
          cell[a] = high ? count[a] - 1 : 0;
          cell[u] = i;
          cell[v] = j;
          faces.push_back(cell_side(lattice, cell, axis, high));
        }
      }
    }
  }
  std::vector<Vec3> points;
  for (const auto& p : lattice.places) {
    points.push_back({(static_cast<double>(p[0]) / nx - 0.5) * size.x, (static_cast<double>(p[1]) / ny - 0.5) * size.y,
                      (static_cast<double>(p[2]) / nz - 0.5) * size.z});
  }
  return make_soup("grid-box", std::move(points), faces);
}

PolygonSoup cube() {
  PolygonSoup soup = grid_box(1, 1, 1, {1, 1, 1});
  soup.name = "cube";
  return soup;
}

PolygonSoup thin_plate(double thickness, int n) {
  PolygonSoup soup = grid_box(n, n, 1, {1, 1, thickness});
  soup.name = "thin-plate";
  return soup;
}

PolygonSoup voxels(std::string name, const std::vector<std::array<int, 3>>& cells) {
  const std::set<std::array<int, 3>> solid(cells.begin(), cells.end());
  Lattice lattice;
  std::vector<Polygon> faces;
  for (const auto& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int high = 0; high < 2; ++high) {
        std::array<int, 3> next = cell;
        next[static_cast<std::size_t>(axis)] += high ? 1 : -1;
        if (!solid.contains(next)) faces.push_back(cell_side(lattice, cell, axis, high));
      }
    }
  }
  std::vector<Vec3> points;
  for (const auto& p : lattice.places) {
    points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  return make_soup(std::move(name), std::move(points), faces);
}

PolygonSoup l_prism() {
  return voxels("l-prism", {{0, 0, 0}, {-1, 0, 0}, {-1, 0, -1}});
}

PolygonSoup corner_pit() {
  std::vector<std::array<int, 3>> cells;
  for (int k = 0; k < 7; ++k)
    cells.push_back({(k & 1) - 1, ((k >> 1) & 1) - 1, ((k >> 2) & 1) - 1});
  return voxels("corner-pit", cells);
}

PolygonSoup extruded(std::string name, const std::vector<std::array<double, 2>>& profile_yz,
                     const std::vector<Polygon>& pieces) {
  const auto n = static_cast<std::uint32_t>(profile_yz.size());
  std::vector<Vec3> points;
  for (const double x : {-1.0, 1.0}) {
    for (const auto& p : profile_yz)
      points.push_back({x, p[0], p[1]});
  }
  std::vector<Polygon> faces;
  for (const Polygon& piece : pieces) {  // counter-clockwise in (y, z): outward at x = 1
    Polygon back(piece.rbegin(), piece.rend()), front;
    for (const std::uint32_t i : piece)
      front.push_back(i + n);
    faces.push_back(std::move(back));
    faces.push_back(std::move(front));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    faces.push_back({i, j, j + n, i + n});
  }
  return make_soup(std::move(name), std::move(points), faces);
}

PolygonSoup v_groove(double opening_rad) {
  const double slope = std::tan(opening_rad / 2);
  const double height = slope > 1 ? 0.5 / slope : 0.5;
  const double half = slope * height;
  return extruded("v-groove", {{-1, -1}, {1, -1}, {1, height}, {half, height}, {0, 0}, {-half, height}, {-1, height}},
                  {{0, 1, 4}, {1, 2, 3, 4}, {4, 5, 6, 0}});
}

PolygonSoup wedge(double dihedral_rad) {
  const double half = std::tan(dihedral_rad / 2);
  return extruded("wedge", {{0, 0}, {1, -half}, {1, half}}, {{0, 1, 2}});
}

PolygonSoup fan_block(int n, double apex_z, double even_rim_z, double odd_rim_z) {
  const auto m = static_cast<std::uint32_t>(n);
  std::vector<Vec3> points;
  for (int level = 0; level < 2; ++level) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * kPi * i / n;
      points.push_back({std::cos(angle), std::sin(angle), level == 0 ? -1 : (i % 2 == 0 ? even_rim_z : odd_rim_z)});
    }
  }
  points.push_back({0, 0, apex_z});
  const bool has_walls = even_rim_z > -1 || odd_rim_z > -1;
  std::vector<Polygon> faces;
  Polygon floor;
  for (std::uint32_t i = 0; i < m; ++i) {
    const std::uint32_t j = (i + 1) % m, rim = has_walls ? m : 0;
    floor.push_back(m - 1 - i);
    faces.push_back({2 * m, i + rim, j + rim});
    if (has_walls) faces.push_back({i, j, j + m, i + m});
  }
  faces.push_back(std::move(floor));
  if (!has_walls) {  // the rim is the floor's: drop the unused ring
    for (Polygon& face : faces) {
      for (std::uint32_t& i : face)
        i = i == 2 * m ? m : i;
    }
    points.erase(points.begin() + n, points.begin() + 2 * n);
  }
  return make_soup("fan-block", std::move(points), faces);
}

PolygonSoup cone(int n) {
  PolygonSoup soup = fan_block(n, 1, -1, -1);
  soup.name = "cone";
  return soup;
}

PolygonSoup cone_pit(int n) {
  PolygonSoup soup = fan_block(n, 0, 0.6, 0.6);
  soup.name = "cone-pit";
  return soup;
}

PolygonSoup saddle_block() {
  std::vector<Vec3> points;
  const double heights[8] = {0.5, 0.2, -0.4, -0.1, 0.6, 0.1, -0.5, -0.2};
  for (int level = 0; level < 2; ++level) {
    for (int i = 0; i < 8; ++i)
      points.push_back({std::cos(kPi * i / 4), std::sin(kPi * i / 4), level == 0 ? -1 : heights[i]});
  }
  points.push_back({0, 0, 0});
  std::vector<Polygon> faces;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t j = (i + 1) % 8;
    faces.push_back({16, i + 8, j + 8});
    faces.push_back({i, j, j + 8, i + 8});
  }
  faces.push_back({7, 6, 5, 4, 3, 2, 1, 0});
  return make_soup("saddle-block", std::move(points), faces);
}

PolygonSoup prism(int n) {
  const auto m = static_cast<std::uint32_t>(n);
  std::vector<Vec3> points;
  for (const double z : {-1.0, 1.0}) {
    for (int i = 0; i < n; ++i)
      points.push_back({std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), z});
  }
  std::vector<Polygon> faces;
  Polygon floor, roof;
  for (std::uint32_t i = 0; i < m; ++i) {
    const std::uint32_t j = (i + 1) % m;
    faces.push_back({i, j, j + m, i + m});
    floor.push_back(m - 1 - i);
    roof.push_back(m + i);
  }
  faces.push_back(std::move(floor));
  faces.push_back(std::move(roof));
  return make_soup("prism", std::move(points), faces);
}

// ---- rounded bodies --------------------------------------------------------------------------------------------------------

PolygonSoup ico_sphere(int level) {
  const double g = std::numbers::phi;
  std::vector<Vec3> points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Polygon> faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int l = 0; l < level; ++l) {
    Midpoints middle(points);
    std::vector<Polygon> finer;
    for (const Polygon& f : faces) {
      const std::uint32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    faces = std::move(finer);
  }
  for (Vec3& p : points)
    p = unit(p);
  return make_soup("ico-sphere", std::move(points), faces);
}

PolygonSoup geodesic_sphere(int parts) {
  const PolygonSoup base = ico_sphere(0);
  const auto n = static_cast<std::uint32_t>(parts);
  PolygonSoup soup = make_soup("geodesic-sphere", base.points, {});
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_of_edge;  // n - 1 points from the lesser end on
  std::vector<std::uint32_t> number((n + 1) * (n + 2) / 2);                        // row i has i + 1 places
  const auto at = [&](std::uint32_t i, std::uint32_t j) -> std::uint32_t& { return number[i * (i + 1) / 2 + j]; };
  for (std::size_t f = 0; f < base.face_count(); ++f) {
    const Polygon corner = face_corners(base, f);  // places (0, 0), (n, 0), (n, n)
    const auto add = [&](std::uint32_t i, std::uint32_t j) {
      const Vec3 p = base.points[corner[0]] * (n - i) + base.points[corner[1]] * (i - j) + base.points[corner[2]] * j;
      soup.points.push_back(unit(p));
    };
    const auto along = [&](std::uint32_t a, std::uint32_t b, auto place) {
      const auto [it, is_new] = first_of_edge.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(soup.points.size()));
      for (std::uint32_t k = 1; k < n; ++k) {
        const auto [i, j] = place(a < b ? k : n - k);
        at(i, j) = it->second + k - 1;
        if (is_new) add(i, j);
      }
    };
    using Place = std::pair<std::uint32_t, std::uint32_t>;
    at(0, 0) = corner[0], at(n, 0) = corner[1], at(n, n) = corner[2];
    along(corner[0], corner[1], [&](std::uint32_t k) { return Place(k, 0); });
    along(corner[0], corner[2], [&](std::uint32_t k) { return Place(k, k); });
    along(corner[1], corner[2], [&](std::uint32_t k) { return Place(n, k); });
    for (std::uint32_t i = 2; i < n; ++i) {
      for (std::uint32_t j = 1; j < i; ++j) {
        at(i, j) = static_cast<std::uint32_t>(soup.points.size());
        add(i, j);
      }
    }
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      soup.corners.insert(soup.corners.end(), {a, b, c});
      soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    };
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j <= i; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        if (j < i) triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return soup;
}

PolygonSoup uv_sphere(int slices, int stacks) {
  const auto n = static_cast<std::uint32_t>(slices), rings = static_cast<std::uint32_t>(stacks - 1);
  std::vector<Vec3> points;
  for (int j = 1; j < stacks; ++j) {
    const double theta = kPi * j / stacks;
    for (int i = 0; i < slices; ++i) {
      const double phi = 2 * kPi * i / slices;
      points.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  const auto north = static_cast<std::uint32_t>(points.size()), south = north + 1;
  points.push_back({0, 0, 1});
  points.push_back({0, 0, -1});
  std::vector<Polygon> faces;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n, last = (rings - 1) * n;
    faces.push_back({north, i, k});
    faces.push_back({south, last + k, last + i});
    for (std::uint32_t j = 0; j + 1 < rings; ++j) {
      faces.push_back({j * n + i, (j + 1) * n + i, (j + 1) * n + k});
      faces.push_back({j * n + i, (j + 1) * n + k, j * n + k});
    }
  }
  return make_soup("uv-sphere", std::move(points), faces);
}

PolygonSoup torus(int around, int across, double tube_radius) {
  std::vector<Vec3> points;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * j / across, r = 1 + tube_radius * std::cos(v);
      points.push_back({r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)});
    }
  }
  std::vector<Polygon> faces;
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return make_soup("torus", std::move(points), faces);
}

PolygonSoup star_sphere(int level, double amplitude, std::uint64_t seed) {
  PolygonSoup soup = ico_sphere(level);
  soup.name = "star-sphere";
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    Vec3& p = soup.points[i];
    const double waves = std::sin(3 * p.x + 1) * std::cos(4 * p.y) + std::sin(5 * p.z + 2 * p.x);
    p = p * (1 + amplitude * (0.5 * waves + hashed_unit(seed, i) - 0.5));
  }
  return soup;
}

PolygonSoup spiky_sphere(int level, double height, std::uint64_t seed) {
  PolygonSoup soup = ico_sphere(level);
  soup.name = "spiky-sphere";
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const double u = hashed_unit(seed, i);
    soup.points[i] = soup.points[i] * (1 + height * u * u * u);
  }
  return soup;
}

// ---- open patches ----------------------------------------------------------------------------------------------------------

namespace {

// (nx + 1)(ny + 1) points over [-0.5, 0.5]^2, triangles facing +z, diagonals alternating.
PolygonSoup height_field(std::string name, int nx, int ny) {
  std::vector<Vec3> points;
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j)
      points.push_back({static_cast<double>(i) / nx - 0.5, static_cast<double>(j) / ny - 0.5, 0});
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (ny + 1) + j); };
  std::vector<Polygon> faces;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if ((i + j) % 2 == 0) {
        faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
      } else {
        faces.insert(faces.end(), {{b, c, d}, {b, d, a}});
      }
    }
  }
  return make_soup(std::move(name), std::move(points), faces);
}

}  // namespace

PolygonSoup plane_quad() {
  return make_soup("plane-quad", {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}}, {{0, 1, 2, 3}});
}

PolygonSoup plane_grid(int nx, int ny) {
  return height_field("plane-grid", nx, ny);
}

PolygonSoup plane_jittered(int n, std::uint64_t seed) {
  PolygonSoup soup = height_field("plane-jittered", n, n);
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    Vec3& p = soup.points[i];
    if (std::abs(p.x) == 0.5 || std::abs(p.y) == 0.5) continue;
    p.x += (hashed_unit(seed, 2 * i) - 0.5) * 0.4 / n;
    p.y += (hashed_unit(seed, 2 * i + 1) - 0.5) * 0.4 / n;
  }
  return soup;
}

PolygonSoup bumpy_patch(int n, double amplitude, std::uint64_t seed) {
  PolygonSoup soup = height_field("bumpy-patch", n, n);
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    soup.points[i].z = amplitude * (hashed_unit(seed, i) - 0.5);
  return soup;
}

PolygonSoup needle_strip(int n, double amplitude, std::uint64_t seed) {
  PolygonSoup soup = height_field("needle-strip", n, 1);
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    Vec3& p = soup.points[i];
    p.z = 0.2 * (1 - 4 * p.x * p.x) + amplitude * (hashed_unit(seed, i) - 0.5) / n;
  }
  return soup;
}

// ---- changes ---------------------------------------------------------------------------------------------------------------

Rotation random_rotation(std::uint64_t seed) {
  Random random(seed);
  const Vec3 a = random.direction();
  Vec3 b = random.direction();
  b = unit(b + a * -dot(a, b));
  return {a, b, {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}};
}

Vec3 rotated(const Rotation& rotation, const Vec3& v) {
  return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)};
}

PolygonSoup transformed(const PolygonSoup& soup, const Rotation& rotation, double scale, const Vec3& translation) {
  PolygonSoup result = soup;
  for (Vec3& p : result.points)
    p = rotated(rotation, p) * scale + translation;
  return result;
}

PolygonSoup scaled(const PolygonSoup& soup, double scale) {
  PolygonSoup result = soup;
  for (Vec3& p : result.points)
    p = p * scale;
  return result;
}

PolygonSoup moved(const PolygonSoup& soup, const Vec3& translation) {
  PolygonSoup result = soup;
  for (Vec3& p : result.points)
    p = p + translation;
  return result;
}

PolygonSoup rounded_to_float(const PolygonSoup& soup) {
  PolygonSoup result = soup;
  for (Vec3& p : result.points)
    p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  result.relative_quantum = 0x1p-24;
  return result;
}

PolygonSoup triangulated(const PolygonSoup& soup, std::uint64_t seed) {
  std::vector<Polygon> triangles;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const Polygon face = face_corners(soup, f);
    const std::size_t n = face.size();
    const std::size_t first = Random(seed * 7919 + f).below(static_cast<std::uint32_t>(n));
    for (std::size_t k = 1; k + 1 < n; ++k) {
      triangles.push_back({face[first], face[(first + k) % n], face[(first + k + 1) % n]});
    }
  }
  PolygonSoup result = make_soup(soup.name + "-triangles", soup.points, triangles);
  result.relative_quantum = soup.relative_quantum;
  return result;
}

PolygonSoup subdivided(const PolygonSoup& soup, std::uint64_t seed) {
  std::vector<Vec3> points = soup.points;
  std::vector<Polygon> triangles;
  Midpoints middle(points);
  for (const Polygon& face : all_faces(soup)) {
    const std::size_t n = face.size();
    Polygon inner;
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t after = middle(face[k], face[(k + 1) % n]), before = middle(face[(k + n - 1) % n], face[k]);
      triangles.push_back({face[k], after, before});
      inner.push_back(after);
    }
    const std::size_t first = Random(seed + triangles.size()).below(static_cast<std::uint32_t>(n));
    for (std::size_t k = 1; k + 1 < n; ++k) {
      triangles.push_back({inner[first], inner[(first + k) % n], inner[(first + k + 1) % n]});
    }
  }
  PolygonSoup result = make_soup(soup.name + "-finer", std::move(points), triangles);
  result.relative_quantum = soup.relative_quantum;
  return result;
}

}  // namespace fdcg::test
