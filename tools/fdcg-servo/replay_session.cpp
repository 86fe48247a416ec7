// SPDX-License-Identifier: Apache-2.0
#include "replay_session.hpp"

#include <chrono>
#include <cstdio>
#include <optional>

#include "../common/atomic_file.hpp"
#include "../common/terminal.hpp"
#include "fdcg/device_tools.hpp"
#include "fdcg/fdcg.h"
#include "servo_commands.hpp"

namespace fdcg::servo {
namespace {

using tools::AtomicFile;
using tools::grouped;

constexpr std::size_t kChunkBytes = 1 << 16;
constexpr std::uint64_t kReportEvery = 1024;  // ticks
// An output in chunks.
class Output {
 public:
  explicit Output(const std::string& path) : file(path) {}

  void add(std::string_view text) {
    text_ += text;
    if (text_.size() >= kChunkBytes) flush();
  }
  void flush() {
    file.write(text_);
    text_.clear();
  }

  AtomicFile file;

 private:
  std::string text_;
};

std::string summary(const dev::LogReplay& replay, double seconds) {
  std::string text;
  std::uint64_t ticks = 0;
  for (const dev::DeviceReplay& device : replay.devices()) {
    ticks += device.ticks;
    text += device.name + ": " + grouped(device.ticks) + " ticks";
    if (!device.is_over) text += ", every output the same bit for bit";
    if (!device.difference.empty()) text += "; the last one differs: " + device.difference;
    if (!device.ended_by.empty()) {
      text += ", the same bit for bit; the replay ends with that of '" + device.ended_by + "', whose scene it shares";
    }
    if (device.has_gap) {
      text += ", the same bit for bit; then the log lacks ticks from " + grouped(device.gap_at) +
              " on (its ring was full: a busy disk), and the replay ends there";
    }
    text += "\n";
  }
  if (replay.ends_at_limit()) text += "the log ends at its limit of bytes; the session went on\n";
  if (replay.has_strays()) text += "there are ticks of devices that the scene has not\n";
  if (const std::string damage = replay.damage(); !damage.empty()) text += damage + "\n";
  char time[64];
  std::snprintf(time, sizeof time, "%.3g s, %.3g us a tick\n", seconds,
                ticks == 0 ? 0 : seconds * 1e6 / static_cast<double>(ticks));
  return text + time;
}

// Of a difference, and a version of the program that is not the one that wrote the log.
std::string version_note(const dev::LogReplay& replay) {
  const std::string program = replay.program();
  if (program == FDCG_VERSION_STRING) return {};
  return "the log was written by version " + program + ", this is " FDCG_VERSION_STRING "\n";
}

int check_outputs(const ReplaySessionArguments& arguments) {
  const std::pair<const char*, std::string> outputs[] = {
      {"-o", arguments.csv}, {"--touches", arguments.touches}, {"--write", arguments.rewritten}};
  for (std::size_t i = 0; i < std::size(outputs); ++i) {
    const auto& [name, file] = outputs[i];
    if (tools::is_same_file(arguments.session, file)) return fail(kUsage, "'" + file + "' would overwrite the session");
    for (std::size_t k = 0; k < i; ++k)
      if (!file.empty() && file == outputs[k].second)
        return fail(kUsage, std::string(outputs[k].first) + " and " + name + " name one file: " + file);
  }
  return kClean;
}

// The graphs are known when the log is open; nothing takes its name before the replay is over.
int check_graphs(const ReplaySessionArguments& arguments, const dev::LogReplay& replay) {
  for (const auto& [object, graph] : replay.graph_files())
    for (const std::string* const file : {&arguments.csv, &arguments.touches, &arguments.rewritten})
      if (tools::is_same_file(graph, *file))
        return fail(kUsage, "'" + *file + "' would overwrite the graph of '" + object + "'");
  return kClean;
}

}  // namespace

int replay_session(const ReplaySessionArguments& arguments) {
  if (const int code = check_outputs(arguments); code != kClean) return code;
  Output csv(arguments.csv), touches(arguments.touches), rewritten(arguments.rewritten);
  for (const Output* output : {&csv, &touches, &rewritten})
    if (!output->file.ok()) return fail(kFile, output->file.error());
  dev::LogReplay replay;
  if (const std::string problem = replay.open(arguments.session, arguments.graphs); !problem.empty())
    return fail(kFile, problem);
  if (const int code = check_graphs(arguments, replay); code != kClean) return code;
  const auto started = std::chrono::steady_clock::now();
  csv.add(replay.csv_header());
  touches.add(replay.touches_header());
  rewritten.add(replay.header_bytes());
  tools::ProgressBar bar(!arguments.quiet);
  for (std::uint64_t tick = 0; replay.next(); ++tick) {
    if (tick % kReportEvery == 0) bar.update("replay", replay.fraction());
    if (csv.file.is_wanted()) csv.add(replay.csv_row());
    if (touches.file.is_wanted()) touches.add(replay.touches_rows());
    if (rewritten.file.is_wanted()) rewritten.add(replay.record_bytes());
  }
  bar.wipe();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  rewritten.add(replay.end_bytes());
  for (Output* output : {&csv, &touches, &rewritten})
    output->flush();
  if (const int code = tools::commit_all({&csv.file, &touches.file, &rewritten.file}); code != kClean) return code;
  const bool is_to_error =
      tools::is_stream(arguments.csv) || tools::is_stream(arguments.touches) || tools::is_stream(arguments.rewritten);
  const bool is_same = replay.is_same();
  if (!arguments.quiet || !is_same) {
    const std::string text = summary(replay, seconds) + (is_same ? std::string() : version_note(replay));
    std::fputs(text.c_str(), is_to_error || arguments.quiet ? stderr : stdout);
  }
  return is_same ? kClean : kFindings;
}

}  // namespace fdcg::servo
