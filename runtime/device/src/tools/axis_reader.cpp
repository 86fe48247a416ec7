// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/threads.hpp"
#include "fdcg/device_tools.hpp"
#include "host/make_transport.hpp"
#include "profile/kinematics.hpp"
#include "profile/report_codec.hpp"
#include "scene/scene_json.hpp"

namespace fdcg::dev {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::uint64_t kStaleNs = 150'000'000;
constexpr const char* kGone = "the device is gone; plug it in again";
constexpr double kWorkspaceShare = 0.98;  // of what was reached

Field* axis_field(Profile& profile, int axis) {
  for (int i = 0; i < profile.input.field_count; ++i) {
    Field& field = profile.input.fields[i];
    if (field.role == Role::kAxis && field.axis == axis) return &field;
  }
  return nullptr;
}

}  // namespace

struct AxisReader::Impl {
  DeviceConfig config;
  std::unique_ptr<Transport> transport;
  std::uint32_t sequence = 0;

  // Devices that answer only what they are sent get zeros.
  void send_zero() {
    if (!config.profile.has_output) return;
    Command zero;
    zero.sequence = ++sequence;
    std::uint8_t report[kMaxReportBytes];
    transport->write(report, encode_output(config.profile, zero, report));
  }
  void take(const Sample& sample, AxisMeasure* measure);
};

AxisReader::AxisReader() : impl_(std::make_unique<Impl>()) {}
AxisReader::~AxisReader() {
  if (impl_->transport) impl_->transport->close();
}

std::string AxisReader::open(const std::string& scene_file, const std::string& device) {
  HostConfig scene;
  if (std::string problem = read_scene(scene_file, &scene); !problem.empty()) return problem;
  const auto found = std::find_if(scene.devices.begin(), scene.devices.end(),
                                  [&](const DeviceConfig& one) { return device.empty() || one.name == device; });
  if (found == scene.devices.end()) return scene_file + ": has no device '" + device + "'";
  if (device.empty() && scene.devices.size() > 1) return scene_file + ": has several devices; say which by --device";
  if (found->source != DeviceSource::kHid && found->source != DeviceSource::kSerial)
    return scene_file + ": device '" + found->name +
           "' has no profile of its own to calibrate; that is for HID and serial devices";
  impl_->config = *found;
  impl_->transport = make_transport(impl_->config, scene.loop);
  return impl_->transport->open();
}

int AxisReader::axis_count() const {
  return impl_->config.profile.axis_count;
}

const char* AxisReader::unit() const {
  return impl_->config.profile.kinematics.kind == KinematicsKind::kCartesian ? "m" : "rad";
}

std::string AxisReader::profile_text() const {
  return impl_->config.profile_text;
}

void AxisReader::set_scale(int axis, double scale, double bias) {
  Field* const field = axis_field(impl_->config.profile, axis);
  if (field == nullptr) return;
  field->scale = scale;
  field->bias = bias;
}

void AxisReader::Impl::take(const Sample& sample, AxisMeasure* measure) {
  const bool is_first = measure->reports++ == 0;
  for (int axis = 0; axis < measure->axis_count; ++axis) {
    const Field& field = *axis_field(config.profile, axis);
    const double raw = (sample.axis[axis] - field.bias) / field.scale;
    measure->mean[axis] += (raw - measure->mean[axis]) / static_cast<double>(measure->reports);
    measure->least[axis] = is_first ? raw : std::min(raw, measure->least[axis]);
    measure->most[axis] = is_first ? raw : std::max(raw, measure->most[axis]);
  }
  TipPose tip;
  if (!tip_pose(config.profile.kinematics, config.profile.axis_count, sample.axis, &tip)) return;
  for (int i = 0; i < 3; ++i) {
    measure->tip_least_m[i] = is_first ? tip.position_m[i] : std::min(tip.position_m[i], measure->tip_least_m[i]);
    measure->tip_most_m[i] = is_first ? tip.position_m[i] : std::max(tip.position_m[i], measure->tip_most_m[i]);
  }
}

std::string AxisReader::measure(double seconds, AxisMeasure* measure) {
  *measure = {};
  measure->axis_count = axis_count();
  std::uint8_t data[kMaxReportBytes + 1];
  // what has queued up is of before, and what stood behind it too
  for (const std::uint64_t fresh_ns = monotonic_ns() + kStaleNs; monotonic_ns() < fresh_ns;) {
    if (impl_->transport->read(data, sizeof data, 1).status == ReadStatus::kLost) return kGone;
    impl_->send_zero();
  }
  const std::uint64_t until_ns = monotonic_ns() + static_cast<std::uint64_t>(seconds * 1e9);
  std::uint64_t bad = 0;
  while (monotonic_ns() < until_ns) {
    const ReadResult read = impl_->transport->read(data, sizeof data, 1);
    if (read.status == ReadStatus::kLost) return kGone;
    impl_->send_zero();
    if (read.status != ReadStatus::kReport) continue;
    Sample sample;
    if (decode_input(impl_->config.profile, data, read.bytes, &sample) == Verdict::kGood) {
      impl_->take(sample, measure);
    } else {
      ++bad;
    }
  }
  if (measure->reports > 0) return {};
  return bad > 0 ? "none of " + std::to_string(bad) + " reports is as the profile lays them out; is it the right profile?"
                 : "the device sends no report";
}

std::string calibrated_profile(const std::string& profile_text, const std::vector<AxisScale>& axes,
                               const AxisMeasure* workspace, std::string* json) {
  Json profile = Json::parse(profile_text, nullptr, false);
  if (!profile.is_object()) return "the profile is no object of JSON";
  for (Json& field : profile["input"]["fields"]) {
    if (field.value("role", "") != "axis") continue;
    const AxisScale& axis = axes[field["axis"].get<std::size_t>()];
    const bool turns_round = axis.scale * field["scale"].get<double>() < 0;
    field["scale"] = axis.scale;
    field["bias"] = axis.bias;
    if (!turns_round || !profile.contains("output")) continue;
    for (Json& effort : profile["output"]["fields"]) {
      if (effort.value("role", "") == "effort" && effort["axis"] == field["axis"])
        effort["scale"] = -effort["scale"].get<double>();
    }
  }
  if (workspace != nullptr) {
    Json min = Json::array(), max = Json::array();
    for (int i = 0; i < 3; ++i) {
      const double middle = (workspace->tip_least_m[i] + workspace->tip_most_m[i]) / 2;
      const double half = (workspace->tip_most_m[i] - workspace->tip_least_m[i]) / 2 * kWorkspaceShare;
      min.push_back(middle - half);
      max.push_back(middle + half);
    }
    profile["limits"]["workspace_m"] = {{"min", min}, {"max", max}};
  }
  *json = profile.dump(2) + "\n";
  return {};
}

}  // namespace fdcg::dev
