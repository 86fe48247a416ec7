// SPDX-License-Identifier: Apache-2.0
// fdcg-servo replay: the step over a recorded HIP, as fast as it goes; or a session's log (replay_session.cpp).
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "../common/atomic_file.hpp"
#include "../common/expand_paths.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "effect_option.hpp"
#include "fdcg/device_tools.hpp"
#include "fdcg/fdcg.h"
#include "friction_options.hpp"
#include "hand_path.hpp"
#include "path_warnings.hpp"
#include "relief_option.hpp"
#include "replay_session.hpp"
#include "servo_commands.hpp"
#include "status_text.hpp"
#include "step_time_histogram.hpp"
#include "trajectory_csv.hpp"

namespace fdcg::servo {
namespace {

using tools::AtomicFile;
using tools::grouped;
using tools::short_number;
using Clock = std::chrono::steady_clock;

// Stepped in one go, then logged: writing the log must not empty the caches between two steps.
constexpr std::size_t kChunkTicks = 4096;
constexpr int kClockSamples = 20001;
constexpr int kBarWidth = 50;
constexpr const char* kLogHeader = "t,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions\n";

struct ReplayArguments {
  std::string graph;
  std::string trajectory;
  std::string log;
  fdcg_params params = fdcg_make_params();
  FrictionOptions friction;
  ReliefOption relief;
  EffectOption effect;
  std::string path, written_path;
  bool has_mu_dynamic = false;
  bool quiet = false;
  std::string graphs, touches, rewritten;  // of a session's log
};

struct Tick {
  fdcg_result result{};
  std::uint64_t step_ns = 0;
};

struct ReplaySummary {
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

// The time between two readings of the clock: the part of each measured step that is the clock's own.
std::uint64_t clock_cost_ns() {
  StepTimeHistogram cost;
  for (int i = 0; i < kClockSamples; ++i) {
    const Clock::time_point before = Clock::now();
    cost.add(nanoseconds(Clock::now() - before));
  }
  return cost.quantile(0.5);
}

// The force against the plane of the active face: its normal and tangential part.
void measure_force(const fdcg_graph& graph, const fdcg_result& result, ReplaySummary& summary) {
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
  text += state_name(result.state);
  text += ',' + (result.feature == FDCG_NONE ? std::string("-1") : std::to_string(result.feature));
  text += ',' + std::to_string(result.slipping) + ',' + std::to_string(result.transitions) + '\n';
}

// One tick of the contact, with what is felt on top of it.
void step(const fdcg_graph& graph, const fdcg_params& params, const double* hip_m, ReliefOption& relief, EffectOption& effect,
          fdcg_contact* contact, fdcg_result* result) {
  if (relief.is_given()) {
    relief.step(graph, params, hip_m, contact, result);
  } else {
    fdcg_step(&graph, &params, contact, hip_m, result);
  }
  if (!effect.is_given()) return;
  fdcg_result felt = *result;
  if (relief.is_given()) std::copy_n(relief.flat_force_n(), 3, felt.force_n);
  effect.effects().feel(graph, felt, hip_m, result->force_n);
}

// Steps every point, logs every tick. The clock is read around the step alone.
ReplaySummary replay(const fdcg_graph& graph, ReplayArguments& arguments, const std::vector<TrajectoryPoint>& points,
                     fdcg_contact& contact, std::uint64_t clock_ns, AtomicFile& log, tools::ProgressBar& bar) {
  ReplaySummary summary;
  std::vector<Tick> ticks(std::min(kChunkTicks, points.size()));
  std::string text = kLogHeader;
  for (std::size_t begin = 0; begin < points.size(); begin += kChunkTicks) {
    const std::size_t count = std::min(kChunkTicks, points.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Clock::time_point before = Clock::now();
      step(graph, arguments.params, points[begin + i].hip_object_m.data(), arguments.relief, arguments.effect, &contact,
           &ticks[i].result);
      const std::uint64_t measured = nanoseconds(Clock::now() - before);
      ticks[i].step_ns = measured - std::min(measured, clock_ns);
    }
    bar.update("replay", static_cast<double>(begin) / static_cast<double>(points.size()));
    for (std::size_t i = 0; i < count; ++i) {
      summary.add(ticks[i]);
      measure_force(graph, ticks[i].result, summary);
      if (log.is_wanted()) append_row(text, points[begin + i], ticks[i].result);
    }
    log.write(text);
    text.clear();
  }
  bar.wipe();
  return summary;
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%",
                whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole));
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

std::string replay_text(const ReplaySummary& summary, const fdcg_contact& contact, std::uint64_t clock_ns) {
  const std::uint64_t touching = summary.ticks - summary.in_state[FDCG_FREE];
  std::string text = "ticks            " + grouped(summary.ticks) + ", ";
  text += touching == 0 ? "never in contact: the path touches nothing\n"
                        : percent(touching, summary.ticks) + " in contact, " + percent(summary.slipping, touching) +
                              " of these slipping\n";
  text += "states          ";
  for (int state = FDCG_FREE; state <= FDCG_VERTEX; ++state) {
    text += std::string(state == 0 ? " " : ", ") + state_name(state) + " " + grouped(summary.in_state[state]);
  }
  text += "\ntransitions      p50 " + grouped(summary.transitions.quantile(0.5)) + ", p99.9 " +
          grouped(summary.transitions.quantile(0.999)) + ", max " + grouped(summary.transitions.largest()) + " a step\n";
  text += "step time        " + quantiles(summary.step_ns, " ns") + "\n";
  if (touching != 0) text += "  in contact     " + quantiles(summary.contact_ns, " ns") + "\n";
  text +=
      "  (the clock's own " + grouped(clock_ns) + " ns, a median, subtracted from each)\n" + histogram_text(summary.step_ns);
  if (touching != 0) {
    text += "largest force    " + short_number(summary.largest_force_n) + " N\n";
    text += "friction ratio   " + short_number(summary.largest_ratio) + " at most on faces (tangential over normal force)\n";
  }
  const auto counted = [&text](std::uint64_t ticks, const char* what) {
    if (ticks != 0) text += grouped(ticks) + (ticks == 1 ? " tick " : " ticks ") + what + "\n";
  };
  counted(contact.non_finite_ticks, "with a HIP that is NaN or infinite: no force");
  counted(contact.transition_bound_ticks, "reached the bound on transitions and went on in the next tick");
  counted(contact.sweep_bound_ticks, "reached the bound on the sweep and went on in the next tick");
  return text;
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
    if (tools::is_same_file(*input, arguments.written_path))
      return fail(kUsage, "--write-path " + arguments.written_path + " would overwrite an input");
  }
  if (!arguments.log.empty() && arguments.log == arguments.written_path)
    return fail(kUsage, "-o and --write-path name one file: " + arguments.log);
  return kClean;
}

// `given`: the options of a graph's replay that stand on the command line.
int run_session(const ReplayArguments& arguments, const std::string& given) {
  if (!given.empty()) return fail(kUsage, given + " is not for a session's log: the log has all that is replayed");
  return replay_session(
      {arguments.graph, arguments.graphs, arguments.log, arguments.touches, arguments.rewritten, arguments.quiet});
}

// Opens the graph, or returns fail's code. `otherwise`: what the file could have been instead.
int open_graph(const std::string& path, fdcg_graph* graph, const std::string& otherwise = {}) {
  fdcg_error error{};
  if (fdcg_open_file(path.c_str(), FDCG_VERIFY_SAFE, graph, &error) == FDCG_OK) return kClean;
  if (!tools::is_stream(path) && tools::has_ending(path, tools::mesh_endings())) {
    const std::string stem = path.substr(0, path.rfind('.'));
    return fail(kFile, "'" + path + "' is a mesh; compile it first: fdcg compile " + path + " -o " + stem + ".fdcg");
  }
  return fail(kFile, otherwise + error.message);
}

// Refuses a command line that is no replay of a graph.
int check_inputs(const ReplayArguments& arguments) {
  if (arguments.trajectory.empty() && arguments.path.empty()) {
    fdcg_graph graph{};
    if (const int code = open_graph(arguments.graph, &graph, "neither a session's log nor a graph: "); code != kClean)
      return code;
    fdcg_close(&graph);
    return fail(kUsage, "--trajectory is required, or --path: '" + arguments.graph +
                            "' is no session's log, and a graph needs a path of the hand");
  }
  if (!arguments.graphs.empty() || !arguments.touches.empty() || !arguments.rewritten.empty()) {
    return fail(kUsage, "--graphs, --touches and --write are for a session's log, and '" + arguments.graph + "' is none");
  }
  return check_arguments(arguments);
}

// The path: from its file, or made for the graph and written where that was asked for.
int get_path(const ReplayArguments& arguments, const fdcg_graph& graph, std::vector<TrajectoryPoint>* points) {
  std::string message;
  if (arguments.path.empty()) {
    if (!read_trajectory(arguments.trajectory, *points, message)) return fail(kFile, message);
    warn_of_non_finite(arguments.trajectory, *points);
    return kClean;
  }
  *points = slide_path(graph, &message);
  if (points->empty()) return fail(kFile, arguments.graph + ": " + message);
  AtomicFile file(arguments.written_path);
  file.write(trajectory_csv(*points));
  return tools::commit_all({&file});
}

int take_materials(ReplayArguments& arguments, const fdcg_graph& graph) {
  fdcg_error error{};
  if (const std::string problem = arguments.friction.apply(graph, arguments.params); !problem.empty())
    return fail(kUsage, arguments.graph + ": " + problem);
  if (const std::string problem = arguments.relief.open(graph); !problem.empty())
    return fail(kUsage, arguments.graph + ": --relief image: " + problem);
  if (const std::string problem = arguments.effect.effects().open(graph, arguments.params.tick_s); !problem.empty())
    return fail(kUsage, arguments.graph + ": --effect: " + problem);
  return fdcg_check_params(&arguments.params, &error) == FDCG_OK ? kClean : fail(kUsage, error.message);
}

int run_replay(ReplayArguments& arguments) {
  if (const int code = check_inputs(arguments); code != kClean) return code;
  AtomicFile log(arguments.log);
  if (!log.ok()) return fail(kFile, log.error());
  fdcg_graph graph{};
  if (const int code = open_graph(arguments.graph, &graph); code != kClean) return code;
  tools::ProgressBar bar(!arguments.quiet);
  std::vector<TrajectoryPoint> points;
  if (const int code = take_materials(arguments, graph); code != kClean) {
    fdcg_close(&graph);
    return code;
  }
  if (const int code = get_path(arguments, graph, &points); code != kClean) {
    fdcg_close(&graph);
    return code;
  }
  const std::uint64_t clock_ns = clock_cost_ns();
  fdcg_contact contact{};
  const ReplaySummary summary = replay(graph, arguments, points, contact, clock_ns, log, bar);
  if (summary.in_state[FDCG_FREE] == summary.ticks) warn_of_nothing_touched(graph, points, arguments.trajectory);
  fdcg_close(&graph);
  if (const int code = tools::commit_all({&log}); code != kClean) return code;
  if (!arguments.quiet)
    std::fputs(replay_text(summary, contact, clock_ns).c_str(),
               tools::is_stream(arguments.log) || tools::is_stream(arguments.written_path) ? stderr : stdout);
  return kClean;
}

void add_graph_options(CLI::App& command, ReplayArguments& arguments) {
  constexpr double kLargest = 1e9;  // fdcg_check_params
  const tools::OptionGroup path(command, "Path of the hand"), contact(command, "Contact");
  CLI::Option* const trajectory = path.text("--trajectory", "FILE", arguments.trajectory,
                                            "Recorded HIP: a CSV file with columns t, x, y and z. - is standard input.");
  CLI::Option* const kind =
      path.choice<std::string>("--path", "KIND", {{"slide", "slide"}}, arguments.path,
                               "Make a path for this graph: approach, press, slide there and back, lift.", "");
  kind->excludes(trajectory);
  path.text("--write-path", "FILE", arguments.written_path, "Write the path that --path made to FILE (CSV).")->needs(kind);
  fdcg_params& params = arguments.params;
  contact.number("--mu-s", "MU", params.mu_static, {0, kLargest}, "Coefficient of static friction, not below --mu-d.", "0.6");
  contact.number("--mu-d", "MU", params.mu_dynamic, {0, kLargest}, "Coefficient of dynamic friction.", "0.4");
  contact.number("--stiffness", "K", params.stiffness_n_per_m, {0, kLargest, " N/m"}, "Stiffness of the spring, N/m.", "1000");
  contact.number("--damping", "D", params.damping_n_s_per_m, {0, kLargest, " N s/m"},
                 "Damping along the spring, N s/m, at 1,000 ticks a second.", "0");
  contact.choice<std::uint32_t>(
      "--edge-friction", "RULE", {{"wedge", FDCG_EDGE_WEDGE}, {"paper", FDCG_EDGE_PAPER}}, params.edge_friction,
      "Friction in a groove: by the load on both faces, or by the distance from the edge, as in the 2004 paper.");
  arguments.friction.declare(contact, params);
  arguments.relief.declare(contact);
  arguments.effect.declare(contact);
}

}  // namespace

Command add_replay(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("replay", "Run the step over a path of the hand, or replay the log of a session.");
  command->footer(R"(Examples:
  fdcg-servo replay bunny.fdcg --path slide
  fdcg-servo replay bunny.fdcg --path slide --write-path hip.csv -o log.csv
  fdcg-servo replay bunny.fdcg --trajectory hip.csv -o - --mu-s 0 --mu-d 0 | head
  fdcg-servo replay bunny.fdcg --trajectory hip.csv --stiffness 2000 --edge-friction paper
  fdcg-servo replay session.fdcglog -o session.csv --touches touches.csv

The trajectory's header names at least t, x, y and z: seconds, and metres in the object's frame. Replaying twice gives the
same log, byte for byte. Without -o only the summary is printed. A path that touches nothing gives a warning.

The log of a session (from fdcg-servo run) holds all that is needed: every recorded input goes through the same code again, and
every output is compared bit for bit.

)" + tools::exit_codes("success; of a log: every output is the same", "of a log: an output differs, or ticks are missing"));
  const auto arguments = std::make_shared<ReplayArguments>();
  tools::required_argument(*command, "graph", "GRAPH", arguments->graph, "FDCG file, or the log of a session.");
  add_graph_options(*command, *arguments);
  const tools::OptionGroup output(*command, "Output"), session(*command, "Log of a session");
  output.text("-o,--output", "FILE", arguments->log, "Write a row for each tick to FILE (CSV). - is standard output.");
  output.flag("-q,--quiet", arguments->quiet, "Print no summary.");
  session.text("--graphs", "FOLDER", arguments->graphs, "Folder of the graphs.", "where they were");
  session.text("--touches", "FILE", arguments->touches, "Write a row for each touch of each contact to FILE (CSV).");
  session.text("--write", "FILE", arguments->rewritten, "Write the log anew, from the replay, to FILE.");
  return {command, [arguments, command] {
            arguments->has_mu_dynamic = command->count("--mu-d") != 0;
            if (!dev::is_session_log(arguments->graph)) return run_replay(*arguments);
            std::string given;
            for (const char* const name : {"--trajectory", "--path", "--write-path", "--mu-s", "--mu-d", "--stiffness",
                                           "--damping", "--edge-friction", "--relief"})
              if (given.empty() && command->count(name) != 0) given = name;
            for (const char* const name : kFrictionOptions)
              if (given.empty() && command->count(name) != 0) given = name;
            return run_session(*arguments, given);
          }};
}

}  // namespace fdcg::servo
