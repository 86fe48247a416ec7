// SPDX-License-Identifier: Apache-2.0
// compile and validate give one verdict: a mesh is refused by the one exactly where the other's report does not pass, with the
// same findings. FDCG_VERDICT_ROUNDS: how many meshes, default 4,000.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>

#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "soups.hpp"

using namespace fdcg::bake;
using fdcg::test::bumpy_sphere;
using fdcg::test::cube;
using fdcg::test::Faces;
using fdcg::test::joined;
using fdcg::test::make_soup;
using fdcg::test::reversed;

namespace {

class Maker {
 public:
  explicit Maker(unsigned seed) : rng_(seed) {}
  std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(rng_() % n); }

  PolygonSoup mesh() {
    if (below(3) == 0) return thrown_together();
    PolygonSoup soup = below(2) == 0 ? cube() : bumpy_sphere(3 + below(3), 4 + below(4));
    if (below(3) == 0) soup = joined(soup, below(2) == 0 ? cube({9, 0, 0}, 1) : reversed(cube({}, 0.25)));
    for (std::uint32_t defects = below(4); defects > 0; --defects)
      damage(soup);
    return soup;
  }

  CompileOptions options() {
    CompileOptions options;
    options.precision = below(2) == 0 ? Precision::f64 : Precision::f32;
    options.orient = below(2) == 0;
    options.merge = below(2) == 0;
    const double distance = below(2) == 0 ? 1e-9 : 0.3;
    options.weld = {static_cast<Weld::Kind>(below(3)), distance};
    if (below(3) == 0) options.coplanar = {Coplanar::Kind::angle, 0.2};
    for (const Rule& rule : rules())
      if (below(6) == 0) options.allow.insert(std::string(rule.name));
    options.self_intersections = below(2) == 0;
    options.jobs = 1 + below(3);
    return options;
  }

 private:
  PolygonSoup thrown_together() {
    std::vector<Vec3> points(3 + below(9));
    for (Vec3& p : points)
      p = {below(5) * 0.1, below(4) * 0.7, below(3) * 0.3};
    Faces faces(1 + below(5));
    for (auto& face : faces) {
      face.resize(3 + below(5));
      for (auto& corner : face)
        corner = below(points.size());
    }
    return make_soup(points, faces);
  }
  void damage(PolygonSoup& soup) {
    const std::uint32_t f = below(soup.face_count());
    const auto begin = soup.corners.begin() + soup.face_first[f], end = soup.corners.begin() + soup.face_first[f + 1];
    switch (below(8)) {
      case 0:
        return std::reverse(begin, end);
      case 1:
        *begin = below(20) == 0 ? PolygonSoup::kInvalidVertex : below(soup.points.size());
        return;
      case 2:
        soup.points[below(soup.points.size())] = soup.points[below(soup.points.size())];
        return;
      case 3:
        soup.points[below(soup.points.size())].x += 0.7;
        return;
      case 4:
        std::swap(*begin, *(end - 1));
        return;
      case 5:
        std::swap(*begin, *(begin + 1));
        return;
      case 6:
        if (below(4) == 0) soup.points[below(soup.points.size())].z = std::numeric_limits<double>::quiet_NaN();
        return;
      default:
        soup.face_first.pop_back();
        soup.corners.resize(soup.face_first.back());
    }
  }

  std::mt19937 rng_;
};

ValidateOptions as_validate(const CompileOptions& options) {
  ValidateOptions same;
  same.weld = options.weld;
  same.allow = options.allow;
  same.precision = options.precision;
  same.orient = options.orient;
  if (!options.self_intersections) same.severities["self-intersection"] = std::nullopt;
  return same;
}

nlohmann::json info_of(const Compiled& compiled) {
  fdcg_graph graph{};
  fdcg_error error{};
  REQUIRE(fdcg_open_memory(compiled.file().data(), compiled.file().size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  return nlohmann::json::parse(std::string_view(graph.info, graph.info_bytes));
}

}  // namespace

TEST_CASE("compile refuses a mesh exactly where validate fails it, and stores the findings") {
  const char* const asked = std::getenv("FDCG_VERDICT_ROUNDS");
  const unsigned rounds = asked != nullptr ? static_cast<unsigned>(std::atoi(asked)) : 4000;
  unsigned refused = 0, accepted = 0;
  for (unsigned seed = 0; seed < rounds; ++seed) {
    CAPTURE(seed);
    Maker maker(seed);
    const PolygonSoup soup = maker.mesh();
    const CompileOptions options = maker.options();
    const Report report = validate(soup, as_validate(options));
    const auto compiled = compile(soup, options);
    if (!compiled) {
      CHECK(compiled.error().message == "");
      continue;
    }
    CHECK(compiled->report.passes() == report.passes());
    CHECK(compiled->file().empty() == !report.passes());
    CHECK(report_json({compiled->report}) == report_json({report}));
    if (compiled->file().empty()) {
      ++refused;
      continue;
    }
    ++accepted;
    const nlohmann::json info = info_of(*compiled);
    CHECK(info["verdict"] == "pass");
    CHECK(info["checks"].get<std::vector<std::string>>() == report.checks);
    CHECK(info["allowed"].get<std::set<std::string>>() == report.allowed);
    std::uint64_t warnings = 0;
    for (const Issue& issue : report.issues) {
      CHECK(info["issues"][issue.rule] == issue.total);
      if (issue.severity == Severity::warning) warnings += issue.total;
    }
    CHECK(info["warnings"] == warnings);
  }
  WARN(rounds << " meshes: " << accepted << " accepted, " << refused << " refused");
  CHECK(refused > rounds / 8);
  CHECK(accepted > rounds / 8);
}
