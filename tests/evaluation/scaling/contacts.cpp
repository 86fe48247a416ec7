// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench_graph.hpp"
#include "heap_count.hpp"
#include "random.hpp"
#include "scaling.hpp"
#include "scene_rig.hpp"
#include "slope.hpp"

namespace fdcg::test {
namespace {

constexpr int kParts = 71;  // 100,820 faces
constexpr double kWay_m = 1e-4, kDepth_m = 1e-3, kRadius_m = kObject_m / 2;
constexpr int kArrivingTicks = 2;  // above the surface, then in it: not timed

struct Hand {
  Point from, along;  // unit, at right angles
};

std::vector<Hand> hands(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Hand> list(static_cast<std::size_t>(count));
  for (Hand& hand : list) {
    const bake::Vec3 a = random.direction(), b = random.direction();
    const double ab = a.x * b.x + a.y * b.y + a.z * b.z;
    const Point rest = {b.x - ab * a.x, b.y - ab * a.y, b.z - ab * a.z};
    const double length = std::max(1e-9, std::hypot(rest[0], rest[1], rest[2]));
    hand = {{a.x, a.y, a.z}, {rest[0] / length, rest[1] / length, rest[2] / length}};
  }
  return list;
}

Point hip_of(const Hand& hand, int tick) {
  const double radius = kRadius_m + (tick < kArrivingTicks ? kDepth_m : -kDepth_m), angle = tick * kWay_m / kRadius_m;
  const double c = radius * std::cos(angle), s = radius * std::sin(angle);
  return {c * hand.from[0] + s * hand.along[0], c * hand.from[1] + s * hand.along[1], c * hand.from[2] + s * hand.along[2]};
}

// Steps every contact once a tick, and says what share of them was in contact at the last.
class Contacts {
 public:
  virtual ~Contacts() = default;
  virtual void move(const std::vector<Point>& hips) = 0;  // not timed
  virtual void step() = 0;
  virtual double touching() = 0;
};

class OnGraph final : public Contacts {
 public:
  OnGraph(const fdcg_graph& graph, std::size_t count) : graph_(graph), contacts_(count), results_(count) {}
  void move(const std::vector<Point>& hips) override { hips_ = &hips; }
  void step() override {
    for (std::size_t i = 0; i < contacts_.size(); ++i)
      fdcg_step(&graph_, &params_, &contacts_[i], (*hips_)[i].data(), &results_[i]);
  }
  double touching() override {
    return static_cast<double>(std::count_if(results_.begin(), results_.end(),
                                             [](const fdcg_result& result) { return result.state != FDCG_FREE; })) /
           static_cast<double>(results_.size());
  }

 private:
  const fdcg_graph& graph_;
  const fdcg_params params_ = fdcg_make_params();
  const std::vector<Point>* hips_ = nullptr;
  std::vector<fdcg_contact> contacts_;
  std::vector<fdcg_result> results_;
};

class InScene final : public Contacts {
 public:
  InScene(const fdcg_graph& graph, const std::vector<Point>& hips) : scene_(config(hips.size())) {
    scene_.add(graph, fdcg_make_params(), fdcg_make_identity_pose());
    for (const Point& hip : hips)
      fingers_.push_back(scene_.add(hip));
  }
  static fdcg_scene_config config(std::size_t fingers) {
    fdcg_scene_config config = fdcg_make_scene_config();
    config.object_capacity = 1;
    config.finger_capacity = static_cast<std::uint32_t>(fingers);
    config.touches_per_finger = 1;
    return config;
  }
  void move(const std::vector<Point>& hips) override {
    for (std::size_t i = 0; i < fingers_.size(); ++i)
      scene_.move(fingers_[i], hips[i]);
  }
  void step() override { scene_.step(); }
  double touching() override {
    double count = 0;
    for (const fdcg_finger_id finger : fingers_)
      count += scene_.result(finger).touch_count > 0;
    return count / static_cast<double>(fingers_.size());
  }

 private:
  SceneRig scene_;
  std::vector<fdcg_finger_id> fingers_;
};

}  // namespace

void scale_contacts(const ScalingRun& run) {
  constexpr int kContactTicks = 20'000, kFewestTicks = 12;  // contacts times ticks; ticks
  Table table(run.output, "scaling_contacts",
              {"where", "precision", "contacts", "memory_bytes", "tick_p50_ns", "tick_p99_ns", "tick_max_ns",
               "p50_a_contact_ns", "touching_share"});
  std::uint64_t heap = 0;
  std::printf("\n%-6s %-4s %9s %14s %12s\n", "where", "", "contacts", "tick p50 us", "ns a contact");
  for (const bake::Precision precision : {bake::Precision::f64, bake::Precision::f32}) {
    const std::string name = precision == bake::Precision::f64 ? "f64" : "f32";
    bake::CompileOptions options;
    options.precision = precision;
    const BenchGraph graph(make_body(Body::sphere, kParts), options);
    for (const bool is_scene : {false, true}) {
      const std::string where = is_scene ? "scene" : "graph";
      Series series;
      for (int count = 1; count <= (run.is_quick ? 10'000 : 100'000); count *= 10) {
        const std::vector<Hand> all = hands(count, run.seed);
        std::vector<Point> hips(all.size());
        const auto fill = [&](int tick) {
          for (std::size_t i = 0; i < all.size(); ++i)
            hips[i] = hip_of(all[i], tick);
        };
        fill(0);
        std::unique_ptr<Contacts> contacts;
        if (is_scene) {
          contacts = std::make_unique<InScene>(graph.view(), hips);
        } else {
          contacts = std::make_unique<OnGraph>(graph.view(), all.size());
        }
        const int ticks =
            kArrivingTicks + 1 + std::max(kFewestTicks, std::min(2000, (run.is_quick ? 1 : 10) * kContactTicks / count));
        std::vector<float> taken;
        taken.reserve(static_cast<std::size_t>(ticks));
        for (int tick = 0; tick < ticks; ++tick) {
          fill(tick);
          contacts->move(hips);
          const std::uint64_t heap_before = heap_calls();
          const std::uint64_t begin = Stopwatch::now();
          contacts->step();
          const double ns = run.watch.nanoseconds(begin, Stopwatch::now());
          heap += heap_calls() - heap_before;
          if (tick > kArrivingTicks) taken.push_back(static_cast<float>(ns));
        }
        const Percentiles p(std::move(taken));
        fdcg_scene_config config = InScene::config(all.size());
        const std::uint64_t bytes = is_scene ? fdcg_scene_bytes(&config) : all.size() * sizeof(fdcg_contact);
        table.row(where, name, count, bytes, p.at(0.5), p.at(0.99), p.at(1), p.at(0.5) / count, contacts->touching());
        std::printf("%-6s %-4s %9d %14.2f %12.1f\n", where.c_str(), name.c_str(), count, p.at(0.5) / 1000, p.at(0.5) / count);
        series.emplace_back(count, p.at(0.5));
      }
      const double exponent = exponent_of(series);
      run.exponents->row("scaling_contacts", "sphere", name, "stored", "tick_p50_ns, " + where, 1, series.back().first,
                         exponent);
      std::printf("exponent %6.3f  tick of all contacts, %s, %s\n", exponent, where.c_str(), name.c_str());
    }
  }
  if (can_count_heap_calls()) run.bars->at_most("heap calls while stepping many contacts", static_cast<double>(heap), 0, "");
}

}  // namespace fdcg::test
