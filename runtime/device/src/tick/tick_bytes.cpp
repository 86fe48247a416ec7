// SPDX-License-Identifier: Apache-2.0
// Each struct's fields are listed once, in a visit function; writing, reading and comparing are visitors.
#include "tick/tick_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <type_traits>
#include <vector>

namespace fdcg::dev {
namespace {

template <std::size_t bytes>
using Bits = std::conditional_t<
    bytes == 1, std::uint8_t,
    std::conditional_t<bytes == 2, std::uint16_t, std::conditional_t<bytes == 4, std::uint32_t, std::uint64_t>>>;

class TickWriter {
 public:
  static constexpr bool kReads = false;
  explicit TickWriter(std::uint8_t* to) : begin_(to), at_(to) {}
  template <class T>
  void operator()(const char*, const T& value) {
    const auto bits = std::bit_cast<Bits<sizeof(T)>>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i)
      *at_++ = static_cast<std::uint8_t>(static_cast<std::uint64_t>(bits) >> (8 * i));
  }
  void raw(const std::uint8_t* data, std::size_t bytes) {
    std::memcpy(at_, data, bytes);
    at_ += bytes;
  }
  bool require(bool) { return true; }
  void group(const char*, int) {}
  std::size_t bytes() const { return static_cast<std::size_t>(at_ - begin_); }

 private:
  std::uint8_t *begin_, *at_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  Reader(const std::uint8_t* from, std::size_t bytes) : begin_(from), at_(from), end_(from + bytes) {}
  template <class T>
  void operator()(const char*, T& value) {
    if (!has(sizeof(T))) return;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits |= static_cast<std::uint64_t>(*at_++) << (8 * i);
    if constexpr (std::is_same_v<T, bool>) {
      is_good_ = is_good_ && bits <= 1;
      value = bits == 1;
    } else {
      value = std::bit_cast<T>(static_cast<Bits<sizeof(T)>>(bits));
    }
  }
  void raw(std::uint8_t* data, std::size_t bytes) {
    if (!has(bytes)) return;
    std::memcpy(data, at_, bytes);
    at_ += bytes;
  }
  bool require(bool condition) { return is_good_ = is_good_ && condition; }
  void group(const char*, int) {}
  std::size_t bytes() const { return is_good_ ? static_cast<std::size_t>(at_ - begin_) : 0; }

 private:
  bool has(std::size_t bytes) { return is_good_ = is_good_ && static_cast<std::size_t>(end_ - at_) >= bytes; }
  const std::uint8_t *begin_, *at_, *end_;
  bool is_good_ = true;
};

// Text of every field, in order.
class Describer {
 public:
  [[maybe_unused]] static constexpr bool kReads = false;
  struct Named {
    std::string name, value;
    std::uint64_t bits;
  };
  std::vector<Named> fields;
  static bool require(bool condition) { return condition; }
  // Names the fields that follow: "bodies[2].x".
  void group(const char* name, int index) { group_ = std::string(name) + "[" + std::to_string(index) + "]."; }
  template <class T>
  void operator()(const char* name, const T& value) {
    char text[40];
    if constexpr (std::is_same_v<T, double>) {
      std::snprintf(text, sizeof text, "%.17g", value);
    } else {
      std::snprintf(text, sizeof text, "%u", static_cast<unsigned>(value));
    }
    fields.push_back({group_ + name, text, static_cast<std::uint64_t>(std::bit_cast<Bits<sizeof(T)>>(value))});
  }

 private:
  std::string group_;
};

constexpr const char* kForceNames[] = {"force_n[0]", "force_n[1]", "force_n[2]"};
constexpr const char* kEffortNames[] = {"effort[0]", "effort[1]", "effort[2]"};
constexpr const char* kHipNames[] = {"hip_world_m[0]", "hip_world_m[1]", "hip_world_m[2]"};
constexpr const char* kWantedNames[] = {"wanted_force_n[0]", "wanted_force_n[1]", "wanted_force_n[2]"};
constexpr const char* kAxisNames[] = {"sample.axis[0]", "sample.axis[1]", "sample.axis[2]"};
static_assert(kMaxAxes == 3);

template <class Archive, class Output>
void visit_force(Archive& archive, Output& output) {
  for (int i = 0; i < 3; ++i)
    archive(kForceNames[i], output.force_n[i]);
  for (int i = 0; i < kMaxAxes; ++i)
    archive(kEffortNames[i], output.effort[i]);
}

template <class Archive, class Output>
void visit_contact(Archive& archive, Output& output) {
  for (int i = 0; i < 3; ++i)
    archive(kWantedNames[i], output.wanted_force_n[i]);
  archive("state", output.state);
}

template <class Archive, class Output>
void visit_place(Archive& archive, Output& output) {
  for (int i = 0; i < 3; ++i)
    archive(kHipNames[i], output.hip_world_m[i]);
}

template <class Archive, class Output>
void visit_sample(Archive& archive, Output& output) {
  auto& sample = output.sample;
  for (int i = 0; i < kMaxAxes; ++i)
    archive(kAxisNames[i], sample.axis[i]);
  archive("sample.sequence", sample.sequence);
  archive("sample.echo", sample.echo);
  archive("sample.time_s", sample.time_s);
  archive("sample.buttons", sample.buttons);
  archive("sample.has_fault", sample.has_fault);
  archive("sample.is_enabled", sample.is_enabled);
  archive("echo", output.echo);
  archive("round_trip_s", output.round_trip_s);
}

template <class Archive, class Output>
void visit_state(Archive& archive, Output& output) {
  archive("phase", output.phase);
  archive("fault", output.fault);
  archive("is_enabled", output.is_enabled);
  archive("arming_refused", output.arming_refused);
  archive("has_sample", output.has_sample);
}

constexpr const char* kBodyNames[] = {"x", "y", "z", "qx", "qy", "qz", "qw"};

template <class Archive, class Output>
void visit_bodies(Archive& archive, Output& output) {
  archive("body_count", output.body_count);
  if (!archive.require(output.body_count <= kMaxBodies)) return;
  for (int body = 0; body < output.body_count; ++body) {
    archive.group("bodies", body);
    for (int i = 0; i < 3; ++i)
      archive(kBodyNames[i], output.bodies[body].translation_m[i]);
    for (int i = 0; i < 4; ++i)
      archive(kBodyNames[3 + i], output.bodies[body].rotation_xyzw[i]);
  }
}

template <class Archive, class Output>
void visit_stability(Archive& archive, Output& output) {
  archive("calmed", output.calmed);
  archive("damping_n_s_per_m", output.damping_n_s_per_m);
  archive("is_hot", output.is_hot);
}

enum Part : std::uint8_t { kForce = 1, kContact = 2, kPlace = 4, kSample = 8, kStability = 16, kBodies = 32, kAllParts = 63 };

template <class Archive, class Output>
void visit_part(Archive& archive, Output& output, Part part) {
  if (part == kForce) visit_force(archive, output);
  if (part == kContact) visit_contact(archive, output);
  if (part == kPlace) visit_place(archive, output);
  if (part == kSample) visit_sample(archive, output);
  if (part == kStability) visit_stability(archive, output);
  if (part == kBodies) visit_bodies(archive, output);
}
constexpr Part kParts[] = {kForce, kContact, kPlace, kSample, kStability, kBodies};

enum InputFlag : std::uint8_t { kArm = 1, kDisarm = 2, kBegins = 4, kWriteFailed = 8, kSentEnabled = 16, kAllFlags = 31 };

template <class Archive>
void visit_pose(Archive& archive, std::conditional_t<Archive::kReads, fdcg_pose, const fdcg_pose>& pose) {
  for (auto& x : pose.rotation_xyzw)
    archive("", x);
  for (auto& x : pose.translation_m)
    archive("", x);
  archive("", pose.scale);
}

template <class Archive>
void visit_report(Archive& archive, std::conditional_t<Archive::kReads, RawReport, const RawReport>& report) {
  archive("", report.host_ns);
  archive("", report.bytes);
  if (!archive.require(report.bytes <= kMaxReportBytes + 1)) return;
  archive.raw(report.data, std::min<std::size_t>(report.bytes, kMaxReportBytes));
}

}  // namespace

void log_output(const TickOutput& output, LoggedOutput* to) {
  LoggedOutput& plain = *to;
  std::copy(output.force.effort(), output.force.effort() + kMaxAxes, plain.effort);
  std::copy(output.force.force_n(), output.force.force_n() + 3, plain.force_n);
  plain.is_enabled = output.force.is_enabled();
  plain.arming_refused = output.arming_refused;
  plain.has_sample = output.has_sample;
  plain.phase = static_cast<std::uint8_t>(output.phase);
  plain.fault = static_cast<std::uint8_t>(output.fault);
  plain.echo = output.echo;
  plain.round_trip_s = output.round_trip_s;
  plain.calmed = output.calmed;
  plain.damping_n_s_per_m = output.damping_n_s_per_m;
  plain.is_hot = output.is_hot;
  plain.state = output.state;
  std::copy(output.hip_world_m, output.hip_world_m + 3, plain.hip_world_m);
  std::copy(output.wanted_force_n, output.wanted_force_n + 3, plain.wanted_force_n);
  plain.sample = output.sample;
  plain.body_count = static_cast<std::uint8_t>(output.body_count);
  for (std::uint32_t i = 0; i < output.body_count; ++i)
    plain.bodies[i] = output.bodies[i];
}

LoggedOutput logged(const TickOutput& output) {
  LoggedOutput plain;
  log_output(output, &plain);
  return plain;
}

std::size_t encode_tick_input(const TickInput& input, std::uint8_t* to) {
  TickWriter writer(to);
  const int flags = (input.arm ? kArm : 0) | (input.disarm ? kDisarm : 0) | (input.begins ? kBegins : 0) |
                    (input.write_failed ? kWriteFailed : 0) | (input.sent.is_enabled ? kSentEnabled : 0);
  writer("", input.now_ns);
  writer("", input.slept_ns);
  writer("", input.write_busy_ns);
  writer("", input.sent.ns);
  writer("", input.sent.sequence);
  writer("", static_cast<std::uint8_t>(input.read));
  writer("", static_cast<std::uint8_t>(flags));
  writer("", static_cast<std::uint8_t>(input.pose_count));
  writer("", static_cast<std::uint8_t>(input.report_count));
  for (std::uint32_t i = 0; i < input.pose_count; ++i)
    visit_pose(writer, input.poses[i]);
  for (std::uint32_t i = 0; i < input.report_count; ++i)
    visit_report(writer, input.reports[i]);
  return writer.bytes();
}

std::size_t decode_tick_input(const std::uint8_t* from, std::size_t bytes, TickInput* input) {
  Reader reader(from, bytes);
  std::uint8_t read = 0, flags = 0, poses = 0, reports = 0;
  reader("", input->now_ns);
  reader("", input->slept_ns);
  reader("", input->write_busy_ns);
  reader("", input->sent.ns);
  reader("", input->sent.sequence);
  reader("", read);
  reader("", flags);
  reader("", poses);
  reader("", reports);
  if (!reader.require(read <= static_cast<std::uint8_t>(ReadStatus::kLost) && flags <= kAllFlags && poses <= kMaxDriven &&
                      reports <= kMaxDrain)) {
    return 0;
  }
  input->read = static_cast<ReadStatus>(read);
  input->arm = (flags & kArm) != 0;
  input->disarm = (flags & kDisarm) != 0;
  input->begins = (flags & kBegins) != 0;
  input->write_failed = (flags & kWriteFailed) != 0;
  input->sent.is_enabled = (flags & kSentEnabled) != 0;
  input->pose_count = poses;
  input->report_count = reports;
  for (std::uint32_t i = 0; i < poses; ++i)
    visit_pose(reader, input->poses[i]);
  for (std::uint32_t i = 0; i < reports; ++i)
    visit_report(reader, input->reports[i]);
  return reader.bytes();
}

std::size_t encode_tick_output(const LoggedOutput& output, std::uint8_t* to) {
  TickWriter writer(to);
  writer("", std::uint8_t{0});
  visit_state(writer, output);
  std::uint8_t present = 0;
  for (const Part part : kParts) {
    std::uint8_t text[sizeof(LoggedOutput)];
    TickWriter trial(text);
    visit_part(trial, output, part);
    if (std::all_of(text, text + trial.bytes(), [](std::uint8_t byte) { return byte == 0; })) continue;
    present = static_cast<std::uint8_t>(present | part);
    writer.raw(text, trial.bytes());
  }
  to[0] = present;
  return writer.bytes();
}

std::size_t decode_tick_output(const std::uint8_t* from, std::size_t bytes, LoggedOutput* output) {
  Reader reader(from, bytes);
  *output = LoggedOutput{};
  std::uint8_t present = 0;
  reader("", present);
  visit_state(reader, *output);
  if (!reader.require(present <= kAllParts && output->phase <= static_cast<std::uint8_t>(Phase::kFading) &&
                      output->fault < kFaults)) {
    return 0;
  }
  for (const Part part : kParts)
    if ((present & part) != 0) visit_part(reader, *output, part);
  return reader.bytes();
}

std::string first_difference(const LoggedOutput& in_log, const LoggedOutput& in_replay) {
  Describer sides[2];
  for (int i = 0; i < 2; ++i) {
    const LoggedOutput& output = i == 0 ? in_log : in_replay;
    visit_state(sides[i], output);
    for (const Part part : kParts)
      visit_part(sides[i], output, part);
  }
  // bodies are the last part, after their count: where the counts differ, it is told before a list ends
  for (std::size_t i = 0; i < sides[0].fields.size(); ++i) {
    const Describer::Named &a = sides[0].fields[i], &b = sides[1].fields[i];
    if (a.bits != b.bits) return a.name + ": " + a.value + " in the log, " + b.value + " in the replay";
  }
  return {};
}

}  // namespace fdcg::dev
