// SPDX-License-Identifier: Apache-2.0
// fdcg-servo replay: the step over a recorded HIP, as fast as it goes; or a session's log (replay_session.cpp).
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "../common/atomic_file.hpp"
#include "../common/terminal.hpp"
#include "fdcg/fdcg.h"
#include "replay_session.hpp"
#include "servo_commands.hpp"
#include "session/session_reader.hpp"
#include "step_time_histogram.hpp"
#include "trajectory_csv.hpp"

namespace fdcg::servo {
namespace {

using tools::AtomicFile;
using tools::grouped;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kChunkTicks =
    4096;  // stepped in one go, then logged: so that writing the log does not chill the step's caches
constexpr int kClockSamples = 20001;
constexpr int kBarWidth = 50;
constexpr const char* kStates[] = {"free", "face", "edge", "vertex"};
constexpr const char* kLogHeader = "t,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions\n";

struct ReplayArguments {
  std::string graph;
  std::string trajectory;
  std::string log;
  fdcg_params params = fdcg_make_params();
  bool has_mu_dynamic = false;
  bool quiet = false;
  std::string graphs, touches, rewritten;  // of a session's log
};

struct Tick {
  fdcg_result result{};
  std::uint64_t step_ns = 0;
};

struct Summary {
  StepTimeHistogram step_ns, contact_ns, transitions;
  std::uint64_t ticks = 0, slipping = 0;
  std::uint64_t in_state[4] = {};
  double largest_force_n = 0;
  double largest_ratio = 0;  // |Ft| / |Fn| on faces

  void add(const Tick& tick) {
    ++ticks;
    ++in_state[std::min<std::uint32_t>(tick.result.state, FDCG_VERTEX)];
    slipping += tick.result.slipping;
    step_ns.add(tick.step_ns);
    if (tick.result.state != FDCG_FREE) contact_ns.add(tick.step_ns);
    transitions.add(tick.result.transitions);
  }
};

std::uint64_t nanoseconds(Clock::duration time) {
  return static_cast<std::uint64_t>(
      std::max<std::int64_t>(0, std::chrono::duration_cast<std::chrono::nanoseconds>(time).count()));
}

// Between two readings with nothing between them: what each measured step contains of the clock itself.
std::uint64_t clock_cost_ns() {
  StepTimeHistogram cost;
  for (int i = 0; i < kClockSamples; ++i) {
    const Clock::time_point before = Clock::now();
    cost.add(nanoseconds(Clock::now() - before));
  }
  return cost.quantile(0.5);
}

// The force against the plane of the active face: its normal and tangential part.
void measure_force(const fdcg_graph& graph, const fdcg_result& result, Summary& summary) {
  const double* const f = result.force_n;
  const double square = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
  summary.largest_force_n = std::max(summary.largest_force_n, std::sqrt(square));
  const bool is_carried = (result.flags & FDCG_RESULT_TRANSITION_BOUND) != 0;  // still on its way into the friction cone
  if (result.state != FDCG_FACE || is_carried) return;
  const fdcg_node_info face = fdcg_get_node(&graph, result.feature);
  const double* const n = face.normal;
  double normal_part = 0, tangential_square = 0;
  for (int axis = 0; axis < 3; ++axis)
    normal_part += f[axis] * n[axis];
  for (int axis = 0; axis < 3; ++axis) {
    const double along = f[axis] - normal_part * n[axis];
    tangential_square += along * along;
  }
  if (normal_part > 0) summary.largest_ratio = std::max(summary.largest_ratio, std::sqrt(tangential_square) / normal_part);
}

void append(std::string& line, double value) {
  char digits[40];
  line.append(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17).ptr);
  line += ',';
}

void append_row(std::string& text, const TrajectoryPoint& point, const fdcg_result& result) {
  append(text, point.t_s);
  for (const double x : point.hip_object_m)
    append(text, x);
  for (const double x : result.god_object_m)
    append(text, x);
  for (const double x : result.force_n)
    append(text, x);
  text += kStates[std::min<std::uint32_t>(result.state, FDCG_VERTEX)];
  text += ',' + (result.feature == FDCG_NONE ? std::string("-1") : std::to_string(result.feature));
  text += ',' + std::to_string(result.slipping) + ',' + std::to_string(result.transitions) + '\n';
}

// Steps every point, logs every tick. The clock is read around the step alone.
Summary replay(const fdcg_graph& graph, const fdcg_params& params, const std::vector<TrajectoryPoint>& points,
               fdcg_contact& contact, std::uint64_t clock_ns, AtomicFile* log) {
  Summary summary;
  std::vector<Tick> ticks(std::min(kChunkTicks, points.size()));
  std::string text = kLogHeader;
  for (std::size_t begin = 0; begin < points.size(); begin += kChunkTicks) {
    const std::size_t count = std::min(kChunkTicks, points.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Clock::time_point before = Clock::now();
      fdcg_step(&graph, &params, &contact, points[begin + i].hip_object_m.data(), &ticks[i].result);
      const std::uint64_t measured = nanoseconds(Clock::now() - before);
      ticks[i].step_ns = measured - std::min(measured, clock_ns);
    }
    for (std::size_t i = 0; i < count; ++i) {
      summary.add(ticks[i]);
      measure_force(graph, ticks[i].result, summary);
      if (log != nullptr) append_row(text, points[begin + i], ticks[i].result);
    }
    if (log != nullptr) log->write(text);
    text.clear();
  }
  return summary;
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%",
                whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return text;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string quantiles(const StepTimeHistogram& histogram, const char* unit) {
  const auto value = [&](double fraction) { return grouped(histogram.quantile(fraction)); };
  return "p50 " + value(0.5) + ", p99 " + value(0.99) + ", p99.9 " + value(0.999) + ", max " + grouped(histogram.largest()) +
         unit;
}

// One line a doubling of the time; a count that is not zero shows at least one mark.
std::string histogram_text(const StepTimeHistogram& histogram) {
  std::vector<std::uint64_t> counts;
  for (std::uint64_t low = 0; low <= histogram.largest(); low = low == 0 ? 16 : 2 * low) {
    counts.push_back(histogram.count_between(low, low == 0 ? 16 : 2 * low));
  }
  const std::uint64_t most = std::max<std::uint64_t>(1, *std::max_element(counts.begin(), counts.end()));
  std::string text;
  std::uint64_t low = 0;
  for (const std::uint64_t count : counts) {
    const std::uint64_t high = low == 0 ? 16 : 2 * low;
    char line[64];
    std::snprintf(line, sizeof line, "  %9s to %9s ns %12s  ", grouped(low).c_str(), grouped(high).c_str(),
                  grouped(count).c_str());
    text += line + std::string((count * kBarWidth + most - 1) / most, '#') + "\n";
    low = high;
  }
  return text;
}

std::string summary_text(const Summary& summary, const fdcg_contact& contact, std::uint64_t clock_ns) {
  const std::uint64_t touching = summary.ticks - summary.in_state[FDCG_FREE];
  std::string text = "ticks            " + grouped(summary.ticks) + ", " + percent(touching, summary.ticks) + " in contact, " +
                     percent(summary.slipping, touching) + " of these slipping\n";
  text += "states          ";
  for (int state = FDCG_FREE; state <= FDCG_VERTEX; ++state) {
    text += std::string(state == 0 ? " " : ", ") + kStates[state] + " " + grouped(summary.in_state[state]);
  }
  text += "\ntransitions      p50 " + grouped(summary.transitions.quantile(0.5)) + ", p99.9 " +
          grouped(summary.transitions.quantile(0.999)) + ", max " + grouped(summary.transitions.largest()) + " a step\n";
  text += "step time        " + quantiles(summary.step_ns, " ns") + "\n";
  text += "  in contact     " + quantiles(summary.contact_ns, " ns") + "\n";
  text +=
      "  (the clock's own " + grouped(clock_ns) + " ns, a median, subtracted from each)\n" + histogram_text(summary.step_ns);
  text += "largest force    " + short_number(summary.largest_force_n) + " N\n";
  text += "friction ratio   " + short_number(summary.largest_ratio) + " at most on faces (tangential over normal force)\n";
  const auto counted = [&text](std::uint64_t ticks, const char* what) {
    if (ticks != 0) text += grouped(ticks) + (ticks == 1 ? " tick " : " ticks ") + what + "\n";
  };
  counted(contact.non_finite_ticks, "with a HIP that is NaN or infinite: no force");
  counted(contact.transition_bound_ticks, "reached the bound on transitions and went on in the next tick");
  counted(contact.sweep_bound_ticks, "reached the bound on the sweep and went on in the next tick");
  return text;
}

// A recorded fault is no error, but nobody should take its ticks for free ones: told even where no summary is.
void warn_of_non_finite(const std::string& name, const std::vector<TrajectoryPoint>& points) {
  const auto is_bad = [](const TrajectoryPoint& point) {
    return std::any_of(point.hip_object_m.begin(), point.hip_object_m.end(), [](double x) { return !std::isfinite(x); });
  };
  const auto count = std::count_if(points.begin(), points.end(), is_bad);
  if (count == 0) return;
  const auto first = std::find_if(points.begin(), points.end(), is_bad);
  std::fprintf(
      stderr,
      "fdcg-servo: warning: %s: %s of %s %s a HIP that is NaN or infinite, the first at t = %s s: no force is felt there\n",
      name == "-" ? "standard input" : name.c_str(), grouped(static_cast<std::uint64_t>(count)).c_str(),
      grouped(points.size()).c_str(), count == 1 ? "rows has" : "rows have", short_number(first->t_s).c_str());
}

int check_arguments(const ReplayArguments& arguments) {
  fdcg_error error{};
  const fdcg_params& params = arguments.params;
  if (params.mu_static < params.mu_dynamic) {
    return fail(kUsage, "--mu-s " + short_number(params.mu_static) + " is below --mu-d " + short_number(params.mu_dynamic) +
                            (arguments.has_mu_dynamic ? "" : " (the default)") +
                            "; static friction is at least dynamic friction: give a smaller --mu-d");
  }
  if (fdcg_check_params(&arguments.params, &error) != FDCG_OK) return fail(kUsage, error.message);
  for (const std::string* input : {&arguments.graph, &arguments.trajectory}) {
    if (tools::is_same_file(*input, arguments.log)) return fail(kUsage, "-o " + arguments.log + " would overwrite an input");
  }
  return kClean;
}

// `given`: the options of a graph's replay that stand on the command line.
int run_session(const ReplayArguments& arguments, const std::string& given) {
  if (!given.empty()) return fail(kUsage, given + " is not for a session's log: the log has all that is replayed");
  return replay_session(
      {arguments.graph, arguments.graphs, arguments.log, arguments.touches, arguments.rewritten, arguments.quiet});
}

int run_replay(const ReplayArguments& arguments) {
  if (arguments.trajectory.empty()) {
    fdcg_graph graph{};
    fdcg_error error{};
    if (fdcg_open_file(arguments.graph.c_str(), FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK)
      return fail(kFile, std::string("neither a session's log nor a graph: ") + error.message);
    fdcg_close(&graph);
    return fail(kUsage, "--trajectory is required: '" + arguments.graph +
                            "' is no session's log, and a graph needs a path (see 'fdcg-servo replay --help')");
  }
  if (!arguments.graphs.empty() || !arguments.touches.empty() || !arguments.rewritten.empty()) {
    return fail(kUsage, "--graphs, --touches and --write are for a session's log, and '" + arguments.graph + "' is none");
  }
  if (const int code = check_arguments(arguments); code != kClean) return code;
  std::optional<AtomicFile> log;
  if (!arguments.log.empty()) log.emplace(arguments.log);
  if (log && !log->ok()) return fail(kFile, log->error());
  std::vector<TrajectoryPoint> points;
  std::string message;
  if (!read_trajectory(arguments.trajectory, points, message)) return fail(kFile, message);
  warn_of_non_finite(arguments.trajectory, points);
  fdcg_graph graph{};
  fdcg_error error{};
  if (fdcg_open_file(arguments.graph.c_str(), FDCG_VERIFY_FULL, &graph, &error) != FDCG_OK) {
    return fail(kFile, error.message);
  }
  const std::uint64_t clock_ns = clock_cost_ns();
  fdcg_contact contact{};
  const Summary summary = replay(graph, arguments.params, points, contact, clock_ns, log ? &*log : nullptr);
  fdcg_close(&graph);
  if (log && !log->commit()) return fail(kFile, log->error());
  if (!arguments.quiet)
    std::fputs(summary_text(summary, contact, clock_ns).c_str(), tools::is_stream(arguments.log) ? stderr : stdout);
  return kClean;
}

// A number from 0 to the largest that the runtime takes.
void add_number(CLI::App& command, const char* name, double& value, const std::string& unit, const char* help, const char* type,
                bool* is_given = nullptr) {
  constexpr double kLargest = 1e9;  // fdcg_check_params
  const auto parse = [&value, is_given, name, unit](const std::string& text) {
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stopped != end || !(value >= 0 && value <= kLargest))
      throw CLI::ValidationError(name, "'" + text + "' is no number from 0 to 1e9" + unit);
    if (is_given != nullptr) *is_given = true;
  };
  command.add_option_function<std::string>(name, parse, help)->type_name(type);
}

}  // namespace

Command add_replay(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("replay", "Run the step over a recorded path, or a session's log once more");
  command->footer(R"(
Examples:
  fdcg-servo replay bunny.fdcg --trajectory hip.csv -o log.csv
  fdcg-servo replay bunny.fdcg --trajectory hip.csv -o - --mu-s 0 --mu-d 0 | head
  fdcg-servo replay bunny.fdcg --trajectory hip.csv --stiffness 2000 --edge-friction paper

  fdcg-servo replay session.fdcglog -o session.csv --touches touches.csv

The trajectory's header names at least t, x, y and z: seconds, and metres in the object's frame. Replaying twice gives the
same log, byte for byte. Without -o only the summary is printed.

A session's log (of fdcg-servo run) has all that is needed: every recorded input is given to the same code again, and every
output compared bit for bit. Exit code 1: an output differs, or the log lacks ticks.)");
  const auto arguments = std::make_shared<ReplayArguments>();
  fdcg_params& params = arguments->params;
  command->add_option("graph", arguments->graph, "FDCG file, or a session's log")->required()->type_name("GRAPH");
  command->add_option("--trajectory", arguments->trajectory, "Recorded HIP: CSV; - is standard input")->type_name("FILE");
  command->add_option("-o,--output", arguments->log, "Write the log to FILE (CSV); - is standard output")->type_name("FILE");
  add_number(*command, "--mu-s", params.mu_static, "", "Static friction coefficient, at least --mu-d; default: 0.6", "MU");
  add_number(*command, "--mu-d", params.mu_dynamic, "", "Dynamic friction coefficient; default: 0.4", "MU",
             &arguments->has_mu_dynamic);
  add_number(*command, "--stiffness", params.stiffness_n_per_m, " N/m", "N/m; default: 1000", "K");
  const auto parse_edge_friction = [arguments](const std::string& name) {
    if (name != "wedge" && name != "paper")
      throw CLI::ValidationError("--edge-friction", "'" + name + "' is none of wedge, paper");
    arguments->params.edge_friction = name == "wedge" ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER;
  };
  command
      ->add_option_function<std::string>("--edge-friction", parse_edge_friction,
                                         "In a groove: by the load of both faces (wedge, the default), or by the distance from "
                                         "the edge as the 2004 paper has it")
      ->type_name("wedge|paper");
  command->add_option("--graphs", arguments->graphs, "Session's log: the folder of its graphs; default: where they were")
      ->type_name("FOLDER");
  command->add_option("--touches", arguments->touches, "Session's log: a row for each touch of each contact to FILE (CSV)")
      ->type_name("FILE");
  command->add_option("--write", arguments->rewritten, "Session's log: write it anew from the replay")->type_name("FILE");
  command->add_flag("-q,--quiet", arguments->quiet, "No summary");
  return {command, [arguments, command] {
            if (!dev::is_session_log(arguments->graph)) return run_replay(*arguments);
            std::string given;
            for (const char* const name : {"--trajectory", "--mu-s", "--mu-d", "--stiffness", "--edge-friction"})
              if (given.empty() && command->count(name) != 0) given = name;
            return run_session(*arguments, given);
          }};
}

}  // namespace fdcg::servo
