// SPDX-License-Identifier: Apache-2.0
// What the loop's own work takes on an object of a million faces: from the bytes of a report to the force that has left the
// gate, beside the scene's step alone in it. A hand of 0.3 m/s slides over it and lifts off, at 1 and 8 kHz. Arguments: parts
// of a geodesic sphere (default 224: 1,003,520 faces), ticks (default 100,000). Exit code 1 where the bar does not hold: 10 us
// at p99.9.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench_graph.hpp"
#include "plain_profile.hpp"
#include "stopwatch.hpp"
#include "tick/device_tick.hpp"

using namespace fdcg::test;
using namespace fdcg::dev;

namespace {

constexpr double kBar_ns = 10'000, kSpeed_m_per_s = 0.3, kDepth_m = 0.0005, kQuantum_m = 1e-8;

// Once round with whole ticks timed, or with the step inside them alone.
struct Times {
  std::vector<float> tick_ns, step_ns;
  std::uint64_t in_contact = 0;
};

// One finger on one object.
struct Hand {
  std::vector<std::uint64_t> memory;
  fdcg_scene* scene = nullptr;

  explicit Hand(const fdcg_graph& graph) {
    const fdcg_scene_config config = fdcg_make_scene_config();
    memory.resize(fdcg_scene_bytes(&config) / 8 + 1);
    fdcg_scene_create(memory.data(), memory.size() * 8, &config, &scene, nullptr);
    const fdcg_params params = fdcg_make_params();
    const fdcg_pose pose = fdcg_make_identity_pose();
    fdcg_object_id object;
    fdcg_scene_add_object(scene, &graph, &params, &pose, &object, nullptr);
  }
};

Times run(const fdcg_graph& graph, const Path& path, double rate_hz, const Stopwatch& watch) {
  Hand hand(graph), bare(graph);
  DeviceSetup setup;
  setup.profile = plain_profile(kQuantum_m);
  setup.profile.rate_hz = rate_hz;
  setup.scene = hand.scene;
  static DeviceState device;
  static TickInput input;
  begin_device(setup, &device, nullptr);
  fdcg_finger_id finger;
  fdcg_scene_add_finger(bare.scene, path[0].data(), &finger, nullptr);
  Times times;
  TickOutput output;
  for (std::size_t i = 0; i < path.size(); ++i) {
    Sample sample;
    for (std::size_t k = 0; k < 3; ++k)
      sample.axis[k] = path[i][k];
    sample.sequence = static_cast<std::uint32_t>(i + 1);
    sample.time_s = static_cast<double>(i) / rate_hz;
    encode_input(setup.profile, sample, input.reports[0].data);
    input.report_count = 1;
    input.read = ReadStatus::kReport;
    input.reports[0].bytes = setup.profile.input.bytes;
    input.now_ns = input.reports[0].host_ns = static_cast<std::uint64_t>((1 + static_cast<double>(i) / rate_hz) * 1e9);
    input.arm = i % 100 == 0;
    std::uint64_t begin = Stopwatch::now();
    device_tick(device, input, &output);
    times.tick_ns.push_back(static_cast<float>(watch.nanoseconds(begin, Stopwatch::now())));
    times.in_contact += output.state != FDCG_FREE;
    begin = Stopwatch::now();
    fdcg_scene_move_finger(bare.scene, finger, path[i].data(), nullptr);
    fdcg_scene_step(bare.scene);
    times.step_ns.push_back(static_cast<float>(watch.nanoseconds(begin, Stopwatch::now())));
  }
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  const int parts = argc > 1 ? std::atoi(argv[1]) : 224;
  const int ticks = argc > 2 ? std::atoi(argv[2]) : 100'000;
  if (parts < 1 || ticks < 1) {
    std::fprintf(stderr, "usage: fdcg_bench_device_tick [PARTS [TICKS]]\n");
    return 2;
  }
  const BenchGraph graph(make_body(Body::rough, parts), {});
  const Surface surface(Body::rough, parts);
  const Stopwatch watch;
  bool holds = true;
  std::printf("%d faces; ns      p50      p99    p99.9      max   in contact\n", faces_of(Body::rough, parts));
  for (const double rate_hz : {1000.0, 8000.0}) {
    const Times times = run(graph.view(), slide(surface, kSpeed_m_per_s / rate_hz, kDepth_m, ticks), rate_hz, watch);
    const Percentiles tick(times.tick_ns), step(times.step_ns);
    const double share = static_cast<double>(times.in_contact) / ticks;
    std::printf("%g kHz tick  %8.0f %8.0f %8.0f %8.0f   %.0f %%\n", rate_hz / 1000, tick.at(0.5), tick.at(0.99), tick.at(0.999),
                tick.at(1), 100 * share);
    std::printf("%g kHz step  %8.0f %8.0f %8.0f %8.0f   (after the tick has warmed the caches)\n", rate_hz / 1000, step.at(0.5),
                step.at(0.99), step.at(0.999), step.at(1));
    holds = holds && tick.at(0.999) < kBar_ns && share > 0.3;
  }
  return holds ? 0 : 1;
}
