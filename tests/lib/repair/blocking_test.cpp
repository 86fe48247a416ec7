// SPDX-License-Identifier: Apache-2.0
// Repairs of what no graph can have: edges of many faces, folds, polygons that cross themselves, faces with corners that are
// not finite. Assemblies of cells at random have every kind of edge and vertex that solids can touch in. FDCG_REPAIR_CASES sets
// how many assemblies (default 24).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "random.hpp"
#include "repair/surface_distance.hpp"

using namespace fdcg::bake;
using namespace fdcg::test;

namespace {

PolygonSoup read_off(const std::string& text) {
  Result<PolygonSoup> soup = import_memory("OFF\n" + text, "mesh.off");
  REQUIRE(soup.has_value());
  return *soup;
}

std::uint64_t total(const Report& report, const std::string& rule) {
  for (const Issue& issue : report.issues) {
    if (issue.rule == rule) return issue.total;
  }
  return 0;
}

const RepairAction& action(const Repaired& repaired, std::string_view name) {
  const auto found =
      std::find_if(repaired.actions.begin(), repaired.actions.end(), [&](const auto& a) { return a.name == name; });
  REQUIRE(found != repaired.actions.end());
  return *found;
}

Repaired fully_repaired(const PolygonSoup& soup) {
  Result<Repaired> repaired = repair(soup, repair_options(RepairLevel::full));
  REQUIRE(repaired.has_value());
  return *repaired;
}

// Compiles with a repair, and returns the report of the repaired mesh.
Report compiled_report(const PolygonSoup& soup) {
  CompileOptions options;
  options.repair = RepairLevel::full;
  const Result<Compiled> compiled = compile(soup, options);
  REQUIRE(compiled.has_value());
  CHECK_FALSE(compiled->file().empty());
  return compiled->report;
}

// Unit cells of a grid, some of them filled; faces between a filled one and an empty one, and some walls between filled ones.
class Assembly {
 public:
  explicit Assembly(Random& random) : random_(random) {
    for (auto& plane : filled_) {
      for (auto& row : plane) {
        for (bool& cell : row)
          cell = random.chance(0.4);
      }
    }
    const bool has_walls = random.chance(0.5);
    for (int x = 0; x < kSize; ++x) {
      for (int y = 0; y < kSize; ++y) {
        for (int z = 0; z < kSize; ++z)
          add_cell({x, y, z}, has_walls);
      }
    }
  }

  PolygonSoup soup() const {
    std::string text = std::to_string(points_.size()) + " " + std::to_string(faces_.size()) + " 0\n" + points_text_;
    for (const auto& [a, b, c] : faces_)
      text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    return read_off(text);
  }
  int cells() const { return cells_; }
  std::size_t faces() const { return faces_.size(); }

 private:
  static constexpr int kSize = 4;
  using Place = std::array<int, 3>;

  bool is_filled(const Place& at) const {
    for (const int c : at) {
      if (c < 0 || c >= kSize) return false;
    }
    return filled_[at[0]][at[1]][at[2]];
  }
  void add_cell(const Place& at, bool has_walls) {
    if (!is_filled(at)) return;
    ++cells_;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Place other = at;
        other[axis] += side == 0 ? -1 : 1;
        if (!is_filled(other)) {
          add_square(at, axis, side == 1, side == 1);
        } else if (side == 1 && has_walls && random_.chance(0.3)) {
          const bool is_split_one_way = random_.chance(0.5);
          add_square(at, axis, true, true, is_split_one_way);
          add_square(at, axis, true, false, is_split_one_way);
        }
      }
    }
  }
  void add_square(Place at, int axis, bool is_far, bool faces_up) {
    add_square(at, axis, is_far, faces_up, random_.chance(0.5));
  }
  void add_square(Place at, int axis, bool is_far, bool faces_up, bool is_split_one_way) {
    if (is_far) ++at[axis];
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::uint32_t, 4> corner{};
    for (int k = 0; k < 4; ++k) {
      Place p = at;
      if (k == 1 || k == 2) ++p[u];
      if (k == 2 || k == 3) ++p[v];
      corner[k] = point(p);
    }
    const auto add = [&](int a, int b, int c) {
      if (!faces_up) std::swap(b, c);
      faces_.push_back({corner[a], corner[b], corner[c]});
    };
    if (is_split_one_way) {
      add(0, 1, 2);
      add(0, 2, 3);
    } else {
      add(0, 1, 3);
      add(1, 2, 3);
    }
  }
  std::uint32_t point(const Place& at) {
    const auto [entry, is_new] = points_.try_emplace(at, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_text_ += std::to_string(at[0]) + " " + std::to_string(at[1]) + " " + std::to_string(at[2]) + "\n";
    return entry->second;
  }

  Random& random_;
  bool filled_[kSize][kSize][kSize] = {};
  std::map<Place, std::uint32_t> points_;
  std::string points_text_;
  std::vector<std::array<std::uint32_t, 3>> faces_;
  int cells_ = 0;
};

int cases() {
  const char* value = std::getenv("FDCG_REPAIR_CASES");
  return value != nullptr ? std::atoi(value) : 24;
}

// Of a triangle's point from another triangle, by trying many points of it: slow, and never too small by more than `step`.
double tried_distance(const Vec3& p, const std::array<Vec3, 3>& t, int steps) {
  double least = 1e300;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double a = static_cast<double>(i) / steps, b = static_cast<double>(j) / steps, c = 1 - a - b;
      const double x = a * t[0].x + b * t[1].x + c * t[2].x - p.x, y = a * t[0].y + b * t[1].y + c * t[2].y - p.y,
                   z = a * t[0].z + b * t[1].z + c * t[2].z - p.z;
      least = std::min(least, std::sqrt(x * x + y * y + z * z));
    }
  }
  return least;
}

double tried_distance(const TriangleSet& from, const TriangleSet& to, int steps) {
  double largest = 0;
  for (const auto& t : from) {
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const double a = static_cast<double>(i) / steps, b = static_cast<double>(j) / steps, c = 1 - a - b;
        const Vec3 p{a * t[0].x + b * t[1].x + c * t[2].x, a * t[0].y + b * t[1].y + c * t[2].y,
                     a * t[0].z + b * t[1].z + c * t[2].z};
        double least = 1e300;
        for (const auto& other : to)
          least = std::min(least, tried_distance(p, other, steps));
        largest = std::max(largest, least);
      }
    }
  }
  return largest;
}

constexpr const char* kFlatSquare = "4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

}  // namespace

TEST_CASE("solids that touch in edges, vertices and walls become closed surfaces, none of whose points moves") {
  std::uint64_t parted = 0;
  for (int i = 0; i < cases(); ++i) {
    Random random(4'000 + static_cast<std::uint64_t>(i));
    const Assembly assembly(random);
    const PolygonSoup soup = assembly.soup();
    INFO("case " << i << ", cells " << assembly.cells());
    const Repaired repaired = fully_repaired(soup);
    CHECK(repaired.after.passes());
    // a wall that ends inside a solid folds back on itself there, and is cut
    const bool has_folds = total(repaired.before, "folded-edge") != 0;
    CHECK((total(repaired.after, "boundary-edge") == 0) == !has_folds);
    CHECK(repaired.soup.face_count() >= assembly.faces());
    CHECK(repaired.distance < 1e-7);  // corners in the middle of edges that keep both ends
    CHECK(repaired.volume_after == Approx(assembly.cells()).epsilon(1e-12));
    CHECK(action(repaired, "drop-blocking").total == 0);
    parted += action(repaired, "cut-non-manifold").total;
    CHECK(total(compiled_report(soup), "boundary-edge") == total(repaired.after, "boundary-edge"));
  }
  CHECK(parted > 0);
}

TEST_CASE("at an edge of three faces the two that bound solid go on into each other, and the third ends there") {
  // a floor of two faces, and a wall on it
  const Repaired repaired =
      fully_repaired(read_off("6 3 0\n0 0 0\n0 1 0\n1 0 0\n-1 0 0\n0 0 1\n0 0.5 1\n3 0 2 1\n3 0 1 3\n3 0 1 4\n"));
  CHECK(repaired.after.passes());
  CHECK(total(repaired.after, "boundary-edge") == 7);  // four of the floor, three of the wall
  CHECK(action(repaired, "cut-non-manifold").total == 1);
  CHECK(repaired.distance == 0);
}

TEST_CASE("a folded sliver is unfolded; a folded sheet is cut") {
  // a square of two triangles, and a sliver at the diagonal that lies on one of them
  const Repaired repaired =
      fully_repaired(read_off("5 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5003 0.5 0\n3 0 1 2\n3 0 2 4\n3 0 4 3\n3 4 2 3\n"));
  CHECK(total(repaired.before, "folded-edge") > 0);
  CHECK(repaired.after.passes());
  CHECK(action(repaired, "unfold").total == 1);
  CHECK(total(repaired.after, "boundary-edge") == 4);
  CHECK(repaired.soup.face_count() == 4);
  CHECK(repaired.distance < 1e-7);

  const Repaired sheet = fully_repaired(read_off("4 2 0\n0 0 0\n1 0 0\n0.5 1 0\n0.2 0.7 0\n3 0 1 2\n3 1 0 3\n"));
  CHECK(sheet.after.passes());
  CHECK(action(sheet, "unfold").total == 0);
  CHECK(action(sheet, "cut-non-manifold").total == 1);
  CHECK(total(sheet.after, "boundary-edge") == 6);
  CHECK(sheet.distance == 0);
}

TEST_CASE("a polygon that crosses itself becomes triangles with the side that its outline gives each part") {
  const Repaired bow = fully_repaired(read_off("4 1 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n"));
  CHECK(bow.after.passes());
  CHECK(bow.soup.points.size() == 6);  // the crossing, once for each of the two that only touch there
  CHECK(bow.soup.face_count() == 2);
  const Repaired beside =
      fully_repaired(read_off("6 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0.5 0.5 2\n0 0.2 3\n4 0 1 2 3\n3 2 1 4\n"));
  CHECK(beside.after.passes());  // the neighbour has the crossing too

  const Repaired star = fully_repaired(
      read_off("5 1 0\n0 1 0\n0.5878 -0.809 0\n-0.9511 0.309 0\n0.9511 0.309 0\n-0.5878 -0.809 0\n5 0 1 2 3 4\n"));
  double doubled = 0;  // the area, once for each time that the outline winds around it
  for (std::size_t f = 0; f < star.soup.face_count(); ++f) {
    const auto at = [&](std::uint32_t k) { return star.soup.points[star.soup.corners[star.soup.face_first[f] + k]]; };
    const double own = (at(1).x - at(0).x) * (at(2).y - at(0).y) - (at(1).y - at(0).y) * (at(2).x - at(0).x);
    CHECK(own < 0);
    doubled += own;
  }
  CHECK(doubled / 2 == Approx(-5 * 0.5 * std::sin(4 * 3.14159265358979 / 5)).epsilon(1e-3));
  CHECK(star.after.passes());

  const Repaired skew = fully_repaired(read_off("4 1 0\n0 0 0\n1 0 0\n0.2 1 0.5\n0.9 0.9 -0.4\n4 0 1 2 3\n"));
  CHECK(skew.after.passes());
  CHECK(skew.soup.points.size() == 4);
}

TEST_CASE("a one-sided strip is cut once, and faces with a corner that is not finite go") {
  std::string strip = "16 16 0\n";
  for (int i = 0; i < 8; ++i) {
    const double a = i * 0.7853981633974483, half = a / 2;
    for (const double s : {-0.3, 0.3}) {
      const double r = 1 + s * std::cos(half);
      strip += std::to_string(r * std::cos(a)) + " " + std::to_string(r * std::sin(a)) + " " +
               std::to_string(s * std::sin(half)) + "\n";
    }
  }
  for (int i = 0; i < 8; ++i) {
    const bool is_last = i == 7;
    const int a = 2 * i, b = 2 * i + 1, c = is_last ? 1 : 2 * i + 2, d = is_last ? 0 : 2 * i + 3;
    strip += "3 " + std::to_string(a) + " " + std::to_string(c) + " " + std::to_string(b) + "\n";
    strip += "3 " + std::to_string(b) + " " + std::to_string(c) + " " + std::to_string(d) + "\n";
  }
  const PolygonSoup soup = read_off(strip);
  const Repaired repaired = fully_repaired(soup);
  CHECK(total(repaired.before, "not-orientable") == 1);
  CHECK(repaired.after.passes());
  CHECK(repaired.soup.face_count() == 16);
  CHECK(action(repaired, "cut-non-manifold").total == 1);

  PolygonSoup torn = read_off(kFlatSquare);
  torn.points[3].z = std::nan("");
  const Repaired rest = fully_repaired(torn);
  CHECK(rest.after.passes());
  CHECK(rest.soup.face_count() == 1);
  CHECK(action(rest, "drop-unusable").total == 1);
  CHECK(total(validate(torn), "boundary-edge") == 0);  // the cause alone is told
}

TEST_CASE("the distance between surfaces is at least what trying many points shows, and hardly more") {
  for (std::uint64_t i = 0; i < 12; ++i) {
    Random random(900 + i);
    TriangleSet before, after;
    const auto point = [&] { return Vec3{random.unit(), random.unit(), 0.2 * random.unit()}; };
    for (int t = 0; t < 4; ++t)
      before.push_back({point(), point(), point()});
    after = before;
    after.pop_back();
    if (i % 2 == 0) after.push_back({point(), point(), point()});
    constexpr int kSteps = 24;
    const double tried = std::max(tried_distance(before, after, kSteps), tried_distance(after, before, kSteps));
    const SurfaceChange change = surface_change(before, after);
    INFO("case " << i << ", tried " << tried << ", bound " << change.distance);
    constexpr double kGrid = 1.5 / kSteps;  // between the points tried
    CHECK(change.distance > tried - kGrid);
    CHECK(change.distance < 1.02 * tried + kGrid);
    CHECK(change.volume_change == Approx(signed_volume(after) - signed_volume(before)).margin(1e-15));
  }
  const TriangleSet square{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}}, {Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}};
  const TriangleSet other{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}};
  CHECK(surface_change(square, other).distance < 1e-7);  // the other diagonal
  CHECK(surface_change(square, square).distance == 0);
  CHECK(std::isinf(surface_change(square, {}).distance));
}

TEST_CASE("vertices put apart at equal coordinates come back apart from a format without numbers of vertices") {
  for (int i = 0; i < cases() / 4; ++i) {
    Random random(8'000 + static_cast<std::uint64_t>(i));
    const PolygonSoup soup = Assembly(random).soup();
    RepairOptions options = repair_options(RepairLevel::full);
    options.part_equal_points = true;
    const Result<Repaired> repaired = repair(soup, options);
    REQUIRE(repaired.has_value());
    CHECK(repaired->read_with == Weld::Kind::exact);
    CHECK(repaired->distance < 1e-5);
    const Result<std::string> bytes = export_mesh(repaired->soup, {Format::stl, false});
    REQUIRE(bytes.has_value());
    const Result<PolygonSoup> again = import_memory(*bytes, "again.stl");
    REQUIRE(again.has_value());
    const Report report = validate(*again);
    INFO("case " << i);
    CHECK(report.passes());
    CHECK(total(report, "boundary-edge") == total(repaired->after, "boundary-edge"));
  }
}

TEST_CASE("compile repairs only where something blocks, and says what it did") {
  CompileOptions plain, repairing;
  plain.without = repairing.without = {"info"};
  repairing.repair = RepairLevel::full;
  const PolygonSoup clean = read_off("4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  const Result<Compiled> one = compile(clean, plain), other = compile(clean, repairing);
  REQUIRE((one.has_value() && other.has_value()));
  CHECK(one->bytes == other->bytes);
  CHECK(other->repair->actions.empty());
  CHECK(compile_report_json(*one) == report_json({one->report}));

  Random random(5);
  const PolygonSoup assembly = Assembly(random).soup();
  const Result<Compiled> refused = compile(assembly, plain), mended = compile(assembly, repairing);
  REQUIRE((refused.has_value() && mended.has_value()));
  CHECK(refused->bytes.empty());
  CHECK_FALSE(refused->repair.has_value());
  REQUIRE_FALSE(mended->bytes.empty());
  CHECK(mended->repair->found.count("non-manifold-vertex") + mended->repair->found.count("non-manifold-edge") > 0);
  CHECK(compile_report_json(*mended).find("\"volume_change\"") != std::string::npos);

  repairing.precision = Precision::f32;
  const Result<Compiled> rounded = compile(assembly, repairing);
  REQUIRE(rounded.has_value());
  CHECK_FALSE(rounded->bytes.empty());
}
