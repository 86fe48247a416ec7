// SPDX-License-Identifier: Apache-2.0
// fdcg-servo latency: how long a device, its driver and this computer take, measured without any force.
#include <algorithm>
#include <cstdio>

#include "../common/atomic_file.hpp"
#include "../common/terminal.hpp"
#include "fdcg/device_tools.hpp"
#include "servo_commands.hpp"
#include "signals.hpp"
#include "status_text.hpp"

namespace fdcg::servo {
namespace {

using Json = nlohmann::ordered_json;
using dev::DeviceLook;
using dev::TimeHistogram;
using tools::grouped;

struct LatencyArguments {
  std::string scene, hid, output;
  double for_s = 5;
  bool json = false, plugins = false;
};

struct Measure {
  const char *name, *key;
  const TimeHistogram* times;
};

std::vector<Measure> measures_of(const DeviceLook& look) {
  return {{"round trip", "round_trip", &look.round_trip},
          {"interval", "interval", &look.interval},
          {"work", "work", &look.work},
          {"write", "write", &look.write}};
}

double in_us(std::uint64_t ns) {
  return static_cast<double>(ns) * 1e-3;
}

// The quickest that is known, from above.
std::uint64_t quickest_ns(const TimeHistogram& times) {
  return times.quantile(1.0 / static_cast<double>(times.total));
}

// What the gate would say to arming: fault_text(kLag) where the round trip is known and too long.
const char* verdict_of(const DeviceLook& look) {
  if (look.opened == 0) return "absent";
  if (look.round_trip.total == 0) return "unknown";
  return in_us(quickest_ns(look.round_trip)) <= 1e6 * dev::most_round_trip_s(look.stated_rate_hz) ? "fits" : "too-long";
}

void print_bars(const TimeHistogram& times) {
  constexpr int kWidth = 50;
  const std::uint64_t most = *std::max_element(std::begin(times.counts), std::end(times.counts));
  int first = TimeHistogram::kBins, last = -1;
  for (int bin = 0; bin < TimeHistogram::kBins; ++bin) {
    if (times.counts[bin] == 0) continue;
    first = std::min(first, bin);
    last = bin;
  }
  for (int bin = first; bin <= last; ++bin) {
    const std::uint64_t from = bin == 0 ? 0 : TimeHistogram::upper_end_ns(bin - 1);
    const auto length = static_cast<std::size_t>((times.counts[bin] * kWidth + most - 1) / most);
    std::printf("    %10.1f to %10.1f us %12s  %s\n", in_us(from), in_us(TimeHistogram::upper_end_ns(bin)),
                grouped(times.counts[bin]).c_str(), std::string(length, '#').c_str());
  }
}

void print_text(const DeviceLook& look) {
  std::printf("%s\n", look.name.c_str());
  if (look.opened == 0) {
    std::printf("  never there%s%s\n", look.problem.empty() ? "" : ": ", look.problem.c_str());
    return;
  }
  std::printf("  reports        %s in %.3g s, %.5g a second (%.5g stated); %s lost, %s late\n",
              grouped(look.counters.ticks).c_str(), look.elapsed_s, look.rate_hz, look.stated_rate_hz,
              grouped(look.counters.lost).c_str(), grouped(look.counters.late).c_str());
  for (const Measure& measure : measures_of(look)) {
    const TimeHistogram& times = *measure.times;
    if (times.total == 0) {
      std::printf("  %-14s not known%s\n", measure.name, measure.times == &look.round_trip ? ": the device does not echo" : "");
      continue;
    }
    std::printf("  %-14s %s", measure.name, times_text(times).c_str());
  }
  const std::string verdict = verdict_of(look);
  if (verdict == "too-long") std::printf("  arming         refused: %s\n", dev::fault_text(dev::Fault::kLag));
  if (verdict == "fits")
    std::printf("  arming         allowed: the quickest is below %.4g us\n", 1e6 * dev::most_round_trip_s(look.stated_rate_hz));
  if (look.round_trip.total == 0) return;
  std::printf("  from the write of an output to the report that echoes it:\n");
  print_bars(look.round_trip);
}

Json latency_json(const DeviceLook& look) {
  Json json;
  json["name"] = look.name;
  json["arming"] = verdict_of(look);
  if (!look.problem.empty()) json["problem"] = look.problem;
  json["reports"] = look.counters.ticks;
  json["rate_hz"] = look.rate_hz;
  json["stated_rate_hz"] = look.stated_rate_hz;
  json["lost"] = look.counters.lost;
  json["late"] = look.counters.late;
  for (const Measure& measure : measures_of(look))
    json[std::string(measure.key) + "_us"] = times_json(*measure.times);
  return json;
}

std::string histogram_csv(const std::vector<DeviceLook>& looks) {
  std::string text = "device,measure,from_us,to_us,count\n";
  for (std::size_t device = 0; device < looks.size(); ++device) {
    for (const Measure& measure : measures_of(looks[device])) {
      for (int bin = 0; bin < TimeHistogram::kBins; ++bin) {
        if (measure.times->counts[bin] == 0) continue;
        char line[120];
        std::snprintf(line, sizeof line, "%zu,%s,%.3f,%.3f,%llu\n", device, measure.key,
                      bin == 0 ? 0 : in_us(TimeHistogram::upper_end_ns(bin - 1)), in_us(TimeHistogram::upper_end_ns(bin)),
                      static_cast<unsigned long long>(measure.times->counts[bin]));
        text += line;
      }
    }
  }
  return text;
}

int measure(const LatencyArguments& arguments) {
  if (tools::is_same_file(arguments.scene, arguments.output))
    return fail(kUsage, "'" + arguments.output + "' would overwrite the scene");
  dev::Scene scene;
  std::vector<std::string> warnings;
  if (const std::string problem = scene.read(arguments.scene, &warnings); !problem.empty()) return fail(kFile, problem);
  for (const std::string& warning : warnings)
    tools::warn(warning);
  tools::AtomicFile output(arguments.output);
  if (!output.ok()) return fail(kFile, output.error());
  scene.set_log_file("");
  if (!arguments.hid.empty()) scene.set_backend(arguments.hid);
  dev::SceneRun host;
  if (const std::string problem = host.open(std::move(scene)); !problem.empty()) return fail(kFile, problem);
  if (arguments.plugins) host.allow_plugins();
  Signals signals(&host);
  if (const std::string problem = host.start(); !problem.empty()) return fail(kFile, problem);
  for (const std::string& warning : host.warnings())
    tools::warn(warning);
  constexpr int kMs = 1000;
  host.wait_ms(static_cast<int>(arguments.for_s * kMs));
  std::vector<DeviceLook> looks;
  const std::string problem = host.stop();
  bool is_clean = problem.empty();
  for (int i = 0; i < host.device_count(); ++i) {
    DeviceLook look = host.look(i);
    if (look.elapsed_s > 0) look.rate_hz = static_cast<double>(look.counters.ticks) / look.elapsed_s;
    const std::string verdict = verdict_of(look);
    is_clean = is_clean && verdict != "absent" && verdict != "too-long";
    looks.push_back(std::move(look));
  }
  output.write(histogram_csv(looks));
  if (!output.commit()) return fail(kFile, output.error());
  if (tools::is_stream(arguments.output)) {
    // nothing beside the histograms
  } else if (arguments.json) {
    Json json;
    json["devices"] = Json::array();
    for (const DeviceLook& look : looks)
      json["devices"].push_back(latency_json(look));
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    for (const DeviceLook& look : looks)
      print_text(look);
  }
  if (!problem.empty()) return fail(kFindings, problem);
  return is_clean ? kClean : kFindings;
}

}  // namespace

Command add_latency(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("latency", "Measure a scene's devices: round trip, jitter, losses. No force.");
  command->footer(R"(Examples:
  fdcg-servo latency scene.json
  fdcg-servo latency scene.json --for 60 -o latency.csv
  gnuplot -e "name = 'latency'" tools/latency.gp

Outputs are sent as in a run, none of them enabled. The round trip goes from the write of an output to the report that echoes
it; a device without an echo has none. Beyond 4 ms (or four periods, where those are longer) the safety gate arms no device.

)" + tools::exit_codes("every device was there, and its round trip is short enough, where it is known",
                       "a device was never there, or its round trip is too long"));
  const auto arguments = std::make_shared<LatencyArguments>();
  tools::required_argument(*command, "scene", "SCENE", arguments->scene, "Scene file (schemas/servo-scene.schema.json).");
  const tools::OptionGroup devices(*command, "Devices"), output(*command, "Output");
  devices.number("--for", "SECONDS", arguments->for_s, {0.1, 1e6, " seconds"}, "How long, in seconds.", "5");
  add_hid_option(devices, arguments->hid, "the scene's");
  devices.flag("--plugins", arguments->plugins,
               "Load the plugins that the scene names. They are code, and run as this program.");
  output.text("-o,--output", "FILE.csv", arguments->output, "Write the histograms: device, measure, from_us, to_us, count.");
  output.flag("--json", arguments->json, "Print JSON.");
  return {command, [arguments] { return measure(*arguments); }};
}

}  // namespace fdcg::servo
