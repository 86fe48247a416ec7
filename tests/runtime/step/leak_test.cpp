// SPDX-License-Identifier: Apache-2.0
// No segment leaks through a closed body: aimed exactly at edges, corners, faces and at points within rounding of them, along
// edges and along faces; of bodies convex, concave, spiky, thin and needle-like, of sizes from 1e-6 to 1e6, near the origin and
// a million sizes away, in both precisions. Judged exactly, apart from the runtime:
//   a HIP strictly inside is in contact;
//   a way that surely passes through the surface, or ends inside, is stopped;
//   a way that meets nothing is not.
// FDCG_SEGMENTS: how many (default 300,000); FDCG_SEED: the first batch. A failure names its batch: it is repeated alone by
// FDCG_SEED=that batch and FDCG_SEGMENTS=1.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "catch.hpp"
#include "contact_rig.hpp"
#include "exact_solid.hpp"
#include "meshes.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

constexpr int kBatch = 20'000;         // segments on one body
constexpr int kMostSweepTicks = 1000;  // for the rest of a way that the sweep's bound has cut
constexpr double kRounding = 4;        // eps of the size: a HIP so near to the surface may be taken for outside
constexpr double kSizes[] = {1, 1e-6, 1e6, 0.1};
constexpr double kOffsets[] = {0, 0, 1e3, 1e6};  // sizes

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<std::uint64_t>(std::strtod(text, nullptr));
}

// ---- bodies ----------------------------------------------------------------------------------------------------------------

PolygonSoup small_body(std::uint32_t which) {
  switch (which) {
    case 0:
      return triangulated(cube());
    case 1:
      return triangulated(corner_pit(), 3);
    case 2:
      return triangulated(thin_plate(1e-6));
    case 3:
      return triangulated(thin_plate(0x1p-10, 2));
    case 4:
      return triangulated(l_prism());
    case 5:
      return triangulated(wedge(1e-3));
    case 6:
      return triangulated(v_groove(0.3));
    case 7:
      return triangulated(saddle_block());
    case 8:
      return triangulated(cone(24));
    case 9:
      return triangulated(cone_pit(12));
    case 10:
      return star_sphere(1, 0.4, 5);
    case 11:
      return spiky_sphere(1, 1.5, 7);
    case 12:
      return torus(8, 5);
    case 13:
      return ico_sphere(0);
    case 14:
      return triangulated(fan_block(30, 40, -0.9, -0.8));  // needles from an apex far up
    default:
      return subdivided(cube());
  }
}
constexpr std::uint32_t kSmallBodies = 16;

struct Body {
  PolygonSoup soup;
  fdcg::bake::CompileOptions options;
  std::string description;
};

Body make_body(PolygonSoup shape, Random& random) {
  Body body;
  const double size = kSizes[random.below(4)], offset = size * kOffsets[random.below(4)];
  const bool turned = random.chance(0.5);
  PolygonSoup soup = std::move(shape);
  if (turned) soup = transformed(soup, random_rotation(random.bits()));
  const fdcg::bake::Vec3 d = random.direction();
  soup = moved(scaled(soup, size), {offset * d.x, offset * d.y, offset * d.z});
  body.options.precision = random.chance(0.5) ? Precision::f64 : Precision::f32;
  body.options.coplanar.kind = fdcg::bake::Coplanar::Kind::exact;
  body.options.store_planes = random.chance(0.5);
  body.options.metres_per_unit = random.chance(0.5) ? 1 : 1e-3;
  body.options.jobs = 1;
  body.soup = std::move(soup);
  std::ostringstream text;
  text << body.soup.name << (turned ? ", turned" : "") << ", size " << size << ", offset " << offset << ", "
       << (body.options.precision == Precision::f64 ? "f64" : "f32") << ", unit " << body.options.metres_per_unit;
  body.description = text.str();
  return body;
}

// ---- ways ------------------------------------------------------------------------------------------------------------------

struct Way {
  Hip from, to;
};

Hip between(const Hip& a, const Hip& b, double part) {
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
}

// Makes ways in the frame and precision in which the graph stores its points.
class Aim {
 public:
  Aim(const ExactSolid& solid, bool is_float, Random& random) : solid_(solid), is_float_(is_float), random_(random) {}

  Way way() {
    const auto& triangle = solid_.triangles()[random_.below(static_cast<std::uint32_t>(solid_.triangles().size()))];
    const std::uint32_t k = random_.below(3);
    const Hip &a = triangle[k], &b = triangle[(k + 1) % 3], &c = triangle[(k + 2) % 3];
    const Hip target = point_of_triangle(a, b, c);
    Way way;
    switch (random_.below(7)) {
      case 0:  // to the target itself
        way = {outside(), nudged(target)};
        break;
      case 1: {  // through it
        way.from = outside();
        way.to = nudged(between(way.from, target, 1 + std::pow(2, random_.uniform(-50, 1))));
        break;
      }
      case 2: {  // through it exactly where the numbers allow: a coarse step there and back
        const Hip step = coarse_step();
        const double far = 1 << random_.below(3);
        way.from = {target[0] + step[0], target[1] + step[1], target[2] + step[2]};
        way.to = {target[0] - far * step[0], target[1] - far * step[1], target[2] - far * step[2]};
        break;
      }
      case 3:  // in the face's plane
        way = {nudged(between(between(a, b, random_.uniform(-2, 3)), c, random_.uniform(-2, 3))), nudged(target)};
        break;
      case 4:  // along the edge
        way = {nudged(between(a, b, -0.5 * random_.below(4))), nudged(between(a, b, 0.5 * random_.below(5)))};
        break;
      case 5:  // from within rounding of the target to within rounding of it, or a little further
        way = {nudged(target), nudged(random_.chance(0.5) ? target : between(target, outside(), -1e-3 * random_.unit()))};
        break;
      default:
        way = {outside(), outside()};
    }
    return {rounded(way.from), rounded(way.to)};
  }

  // For ways that go on: near the body, or on it.
  Hip next() { return way().to; }

 private:
  Hip point_of_triangle(const Hip& a, const Hip& b, const Hip& c) {
    switch (random_.below(4)) {
      case 0:
        return a;
      case 1:
        return between(a, b, random_.below(17) / 16.0);
      case 2:
        return between(a, b, random_.unit());
      default:
        return between(between(a, b, random_.unit()), c, random_.unit());
    }
  }

  Hip outside() {
    Hip p;
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = (solid_.low()[i] + solid_.high()[i]) / 2;
      p[i] = middle + solid_.size() * random_.uniform(-1, 1);
    }
    return p;
  }

  // Of few bits, so that adding it to a corner of few bits rounds nothing.
  Hip coarse_step() {
    const double unit = std::exp2(std::floor(std::log2(solid_.size())) - 5);
    Hip step;
    for (double& x : step)
      x = unit * (static_cast<double>(random_.below(129)) - 64);
    return step;
  }

  // Off by some units in the last place, or not at all.
  Hip nudged(Hip p) {
    p = rounded(p);
    if (random_.chance(0.4)) return p;
    for (double& x : p) {
      if (std::abs(x) < 1e-9 * solid_.size()) {  // numbers near zero are closer than any rounding of the body's
        x += (is_float_ ? 0x1p-25 : 0x1p-54) * solid_.size() * (static_cast<double>(random_.below(3)) - 1);
        continue;
      }
      for (std::uint32_t n = random_.below(3); n > 0; --n) {
        const double towards = random_.chance(0.5) ? INFINITY : -INFINITY;
        x = is_float_ ? static_cast<double>(std::nextafter(static_cast<float>(x), static_cast<float>(towards)))
                      : std::nextafter(x, towards);
      }
    }
    return p;
  }

  Hip rounded(Hip p) const {
    for (double& x : p)
      x = is_float_ ? static_cast<double>(static_cast<float>(x)) : x;
    return p;
  }

  const ExactSolid& solid_;
  bool is_float_;
  Random& random_;
};

// ---- the judge -------------------------------------------------------------------------------------------------------------

struct Tally {
  std::uint64_t segments = 0, hits = 0, through = 0, inside = 0, touching = 0, bounded = 0;
  std::uint64_t through_unseen = 0, from_thin_air = 0, lost_deep = 0, lost_shallow = 0, unfinished = 0;
  std::string first, first_lost;  // failures
};

// One contact on one body, moved in the graph's own frame.
class Probe {
 public:
  Probe(const fdcg_graph& graph, double mu) : graph_(graph), contact_(graph, contact_params(mu, 0.8 * mu)) {}

  // Steps until the sweep has come to the end. Returns the changes of state.
  std::uint32_t step(const Hip& local) {
    const fdcg_header& header = *graph_.header;
    Hip hip;
    for (std::size_t k = 0; k < 3; ++k)
      hip[k] = (local[k] + header.origin[k]) * header.metres_per_unit;
    std::uint32_t transitions = 0;
    for (int tick = 0; tick < kMostSweepTicks; ++tick) {
      transitions += contact_.step(hip).transitions;
      if ((contact_.result.flags & FDCG_RESULT_SWEEP_BOUND) == 0) break;
      ++bounded_;
    }
    return transitions;
  }
  // Held by the sweep's bound on and on.
  [[nodiscard]] bool is_unfinished() const { return (contact_.result.flags & FDCG_RESULT_SWEEP_BOUND) != 0; }
  [[nodiscard]] bool is_free() const { return contact_.result.state == FDCG_FREE; }
  // As the step has rounded it.
  [[nodiscard]] Hip hip() const { return {contact_.state.hip[0], contact_.state.hip[1], contact_.state.hip[2]}; }
  [[nodiscard]] double epsilon() const { return graph_.header->real_bytes == 8 ? 0x1p-52 : 0x1p-23; }
  [[nodiscard]] std::uint64_t bounded() const { return bounded_; }
  [[nodiscard]] std::string describe() const { return contact_.describe(); }

 private:
  const fdcg_graph& graph_;
  Contact contact_;
  std::uint64_t bounded_ = 0;
};

std::string hexadecimal(const Hip& p) {
  char text[120];
  std::snprintf(text, sizeof text, "(%a, %a, %a)", p[0], p[1], p[2]);
  return text;
}

// One step of a contact that is free at `from`, or in contact; false where something is wrong.
bool judge_step(const ExactSolid& solid, Probe& probe, const Hip& target, Tally& tally, const std::string& batch) {
  const bool was_free = probe.is_free();
  const Hip from = probe.hip();
  const std::uint32_t transitions = probe.step(target);
  const Hip to = probe.hip();
  const auto report = [&](const char* what) {
    return batch + ": the HIP " + what + ", from " + (was_free ? "free " : "contact ") + hexadecimal(from) + " to " +
           hexadecimal(to) + " in the graph's frame; " + probe.describe();
  };
  ++tally.segments;
  if (probe.is_unfinished()) {
    ++tally.unfinished;
    if (tally.first.empty()) tally.first = report("is never reached by the sweep");
    return false;
  }
  tally.hits += was_free && transitions > 0;
  const char* wrong = nullptr;
  if (was_free) {
    const ExactSolid::Crossing way = solid.crossing(from, to);
    tally.through += way.proper > 0;
    tally.touching += way.touches;
    if (way.proper > 0 && transitions == 0) wrong = "went through the surface";
    if (way.proper == 0 && !way.touches && transitions > 0) wrong = "was stopped where nothing is";
    tally.through_unseen += way.proper > 0 && transitions == 0;
    tally.from_thin_air += way.proper == 0 && !way.touches && transitions > 0;
  }
  if (wrong != nullptr) {
    if (tally.first.empty()) tally.first = report(wrong);
    return false;
  }
  tally.inside += !probe.is_free();
  if (!probe.is_free() || solid.where(to) != ExactSolid::Where::inside) return true;
  const bool is_deep = solid.distance_to_surface(to) > kRounding * probe.epsilon() * solid.size();
  ++(is_deep ? tally.lost_deep : tally.lost_shallow);
  if (tally.first_lost.empty() || (is_deep && tally.lost_deep == 1)) tally.first_lost = report("is free inside");
  return false;
}

void run_batch(std::uint64_t seed, Tally& tally) {
  Random random(seed);
  const Body body = make_body(small_body(random.below(kSmallBodies)), random);
  const CompiledMesh mesh(body.soup, body.options);
  const ExactSolid solid(body.soup, *mesh.view().header);
  const bool is_float = mesh.view().header->real_bytes == sizeof(float);
  Aim aim(solid, is_float, random);
  for (int i = 0; i < kBatch; ++i) {
    const Way way = aim.way();
    if (solid.where(way.from) == ExactSolid::Where::inside) continue;
    Probe probe(mesh.view(), random.chance(0.5) ? 0 : random.uniform(0, 1));
    probe.step(way.from);
    if (solid.where(probe.hip()) == ExactSolid::Where::inside) continue;  // by rounding
    const std::string batch = "batch " + std::to_string(seed) + ", way " + std::to_string(i) + " (" + body.description + ")";
    bool is_well = judge_step(solid, probe, way.to, tally, batch);
    for (std::uint32_t more = random.chance(0.7) ? 0 : random.below(5); is_well && more > 0; --more)
      is_well = judge_step(solid, probe, aim.next(), tally, batch);
    tally.bounded += probe.bounded();
  }
}

// Runs once for both test cases.
const Tally& tally_of_all() {
  static const Tally whole = [] {
    const std::uint64_t wanted = from_environment("FDCG_SEGMENTS", 300'000);
    const std::uint64_t first = from_environment("FDCG_SEED", 1);
    Tally tally;
    std::uint64_t batch = first;
    for (; tally.segments < wanted; ++batch)
      run_batch(batch, tally);
    const auto n = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
    std::printf(
        "batches %llu to %llu: %llu segments, %llu stopped, %llu surely through the surface, %llu touching an edge or "
        "corner, %llu ends in contact, %llu ticks of bounded sweeps\n"
        "through unseen %llu, stopped by nothing %llu, free inside %llu and %llu more within %g eps of the surface, "
        "never reached %llu\n",
        n(first), n(batch - 1), n(tally.segments), n(tally.hits), n(tally.through), n(tally.touching), n(tally.inside),
        n(tally.bounded), n(tally.through_unseen), n(tally.from_thin_air), n(tally.lost_deep), n(tally.lost_shallow), kRounding,
        n(tally.unfinished));
    return tally;
  }();
  return whole;
}

}  // namespace

TEST_CASE("no segment aimed at the edges, corners and faces of a closed body passes through it, none is stopped by nothing") {
  const Tally& tally = tally_of_all();
  INFO(tally.first);
  CHECK(tally.through_unseen == 0);
  CHECK(tally.from_thin_air == 0);
  CHECK(tally.unfinished == 0);
  CHECK(tally.hits > tally.segments / 10);
  CHECK(tally.through > tally.segments / 10);
}

TEST_CASE("a HIP that came from outside and is strictly inside is in contact, whatever it was aimed at") {
  const Tally& tally = tally_of_all();
  INFO(tally.first_lost);
  CHECK(tally.lost_deep == 0);
  CHECK(tally.lost_shallow * 20'000 <= tally.segments);
}
