// SPDX-License-Identifier: Apache-2.0
#include "replay_session.hpp"

#include <charconv>
#include <chrono>
#include <cstdio>
#include <optional>

#include "../common/atomic_file.hpp"
#include "../common/terminal.hpp"
#include "command.hpp"
#include "session_replay.hpp"

namespace fdcg::servo {
namespace {

using tools::AtomicFile;
using tools::grouped;

constexpr std::size_t kChunkBytes = 1 << 16;
constexpr const char* kStates[] = {"free", "face", "edge", "vertex"};
constexpr const char* kPhases[] = {"disarmed", "ramping", "armed", "fading"};
constexpr const char* kCsvHeader =
    "t,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions,device,tick,phase,fault,sent_fx,sent_fy,sent_"
    "fz\n";

// An output in chunks; nothing where it was not asked for.
class Output {
 public:
  explicit Output(const std::string& path) {
    if (!path.empty()) file_.emplace(path);
  }
  bool ok() const { return !file_ || file_->ok(); }
  std::string error() const { return file_ ? file_->error() : std::string(); }
  bool is_wanted() const { return file_.has_value(); }
  void add(std::string_view text) {
    if (!file_) return;
    text_ += text;
    if (text_.size() >= kChunkBytes) flush();
  }
  bool commit() {
    if (!file_) return true;
    flush();
    return file_->commit();
  }

 private:
  void flush() {
    file_->write(text_);
    text_.clear();
  }
  std::optional<AtomicFile> file_;
  std::string text_;
};

void append(std::string& line, double value) {
  char digits[40];
  line.append(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17).ptr);
  line += ',';
}

void append(std::string& line, const double (&values)[3]) {
  for (const double value : values)
    append(line, value);
}

// What the tip touches: of the contact with the largest force, the object that gives it the most.
const fdcg_touch* strongest_touch(const dev::DeviceState& device) {
  const fdcg_touch* best = nullptr;
  double best_square = -1;
  for (int i = 0; i < device.setup.contact_count; ++i) {
    fdcg_finger_result finger{};
    if (fdcg_scene_result(device.setup.scene, device.setup.fingers[i], &finger, nullptr) != FDCG_OK) continue;
    for (std::uint32_t k = 0; k < finger.touch_count; ++k) {
      const double* const f = finger.touches[k].force_n;
      const double square = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
      if (square <= best_square || finger.touches[k].state == FDCG_FREE) continue;
      best = &finger.touches[k];
      best_square = square;
    }
  }
  return best;
}

std::string csv_row(const dev::ReplayedTick& tick, std::uint64_t first_ns) {
  const dev::LoggedOutput& output = *tick.output;
  const fdcg_touch* const touch = strongest_touch(*tick.state);
  std::string line;
  append(line, static_cast<double>(tick.input->now_ns - first_ns) * 1e-9);
  append(line, output.hip_world_m);
  append(line, touch == nullptr ? output.hip_world_m : touch->god_object_m);
  append(line, output.wanted_force_n);
  line += touch == nullptr ? "free,-1,0,0,"
                           : std::string(kStates[touch->state & 3]) + "," + std::to_string(touch->feature) + "," +
                                 std::to_string(touch->slipping) + "," + std::to_string(touch->transitions) + ",";
  line += std::to_string(tick.device) + "," + std::to_string(tick.tick) + "," + kPhases[output.phase & 3] + "," +
          dev::fault_name(static_cast<dev::Fault>(output.fault)) + ",";
  append(line, output.force_n);
  line.back() = '\n';
  return line;
}

std::string summary(const dev::SessionReplay& replay, double seconds) {
  std::string text;
  std::uint64_t ticks = 0;
  for (const dev::DeviceReplay& device : replay.devices()) {
    ticks += device.ticks;
    text += device.name + ": " + grouped(device.ticks) + " ticks";
    if (!device.is_over) text += ", every output the same bit for bit";
    if (!device.difference.empty()) text += "; the last one differs: " + device.difference;
    if (device.has_gap) {
      text += ", the same bit for bit; then the log lacks ticks from " + grouped(device.gap_at) +
              " on (its ring was full: a busy disk), and the replay ends there";
    }
    text += "\n";
  }
  if (replay.reader().ending() == dev::Ending::kEnded && replay.reader().end().reason == dev::EndReason::kLimit) {
    text += "the log ends at its limit of bytes; the session went on\n";
  }
  if (replay.has_strays()) text += "there are ticks of devices that the scene has not\n";
  if (replay.reader().ending() != dev::Ending::kEnded) text += replay.reader().damage() + "\n";
  char time[64];
  std::snprintf(time, sizeof time, "%.3g s, %.3g us a tick\n", seconds,
                ticks == 0 ? 0 : seconds * 1e6 / static_cast<double>(ticks));
  return text + time;
}

// Of a difference, and a version of the program that is not the one that wrote the log.
std::string version_note(const dev::SessionReplay& replay) {
  const std::string& program = replay.reader().header().program;
  if (program == FDCG_VERSION_STRING) return {};
  return "the log was written by version " + program + ", this is " FDCG_VERSION_STRING "\n";
}

int check_outputs(const ReplaySessionArguments& arguments) {
  for (const std::string& output : {arguments.csv, arguments.rewritten}) {
    if (tools::is_same_file(arguments.session, output)) return fail(kUsage, "'" + output + "' would overwrite the session");
  }
  if (!arguments.csv.empty() && arguments.csv == arguments.rewritten) {
    return fail(kUsage, "-o and --write name one file: " + arguments.csv);
  }
  return kClean;
}

}  // namespace

int replay_session(const ReplaySessionArguments& arguments) {
  if (const int code = check_outputs(arguments); code != kClean) return code;
  Output csv(arguments.csv), rewritten(arguments.rewritten);
  for (const Output* output : {&csv, &rewritten})
    if (!output->ok()) return fail(kFile, output->error());
  const auto replay = std::make_unique<dev::SessionReplay>();
  if (const std::string problem = replay->open(arguments.session, arguments.graphs); !problem.empty())
    return fail(kFile, problem);
  const auto started = std::chrono::steady_clock::now();
  csv.add(kCsvHeader);
  rewritten.add(replay->header_bytes());
  std::uint64_t first_ns = 0;
  for (dev::ReplayedTick tick; replay->next(&tick);) {
    if (first_ns == 0) first_ns = tick.input->now_ns;
    if (csv.is_wanted() && tick.output->has_sample) csv.add(csv_row(tick, first_ns));
    const std::vector<std::uint8_t>& record = replay->record();
    rewritten.add({reinterpret_cast<const char*>(record.data()), record.size()});
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  if (replay->reader().ending() == dev::Ending::kEnded) rewritten.add(replay->end_bytes());
  if (!csv.commit()) return fail(kFile, csv.error());
  if (!rewritten.commit()) return fail(kFile, rewritten.error());
  const bool is_to_error = tools::is_stream(arguments.csv) || tools::is_stream(arguments.rewritten);
  const bool is_same = replay->is_same();
  if (!arguments.quiet || !is_same) {
    const std::string text = summary(*replay, seconds) + (is_same ? std::string() : version_note(*replay));
    std::fputs(text.c_str(), is_to_error || arguments.quiet ? stderr : stdout);
  }
  return is_same ? kClean : kFindings;
}

}  // namespace fdcg::servo
