// SPDX-License-Identifier: Apache-2.0
#include "transport/plugin_transport.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "profile/report_codec.hpp"
#include "shared/text.hpp"

namespace fdcg::dev {
namespace {

constexpr double kMetresPerCount = 1e-9, kSecondsPerCount = 1e-6;
constexpr double kFarthest_m = 2;  // what a count of 32 bits holds
constexpr std::uint8_t kInputId = 1, kOutputId = 2;

class Plugin final : public PluginTransport {
 public:
  Plugin(const Profile& profile, std::string file, std::string settings)
      : profile_(profile), file_(std::move(file)), settings_(std::move(settings)) {}
  ~Plugin() override {
    Plugin::close();
    if (is_set_ && device_.destroy != nullptr) device_.destroy(device_.self);
  }

  void set(const fdcg_transport& transport) override {
    device_ = transport;
    is_set_ = true;
  }
  void allow() override { is_allowed_ = true; }
  std::string open() override;
  void close() override;
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override;
  bool write(const std::uint8_t* data, int bytes) override;
  bool write_feature(const std::uint8_t*, int) override { return false; }
  EmergencyCall emergency_call() const override {
    return device_.emergency != nullptr ? EmergencyCall{send_emergency, const_cast<Plugin*>(this)} : EmergencyCall{};
  }

 private:
  std::string load();
  static void send_emergency(void* self, const std::uint8_t*, int) {
    const fdcg_transport& device = static_cast<Plugin*>(self)->device_;
    device.emergency(device.self);
  }

  const Profile profile_;
  const std::string file_, settings_;
  fdcg_transport device_{};
  bool is_set_ = false, is_open_ = false, is_allowed_ = false;
};

// The file stays loaded until the process ends: a thread of its own may still be in it.
std::string Plugin::load() {
  if (file_.empty()) return "the program has not handed over its transport (fdcg_host_set_transport)";
  if (!is_allowed_) return one_line(file_) + ": a plugin is code; --plugins (fdcg_host_allow_plugins) lets it be loaded";
  void* const file = dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (file == nullptr) {
    const char* const reason = dlerror();
    return "the plugin cannot be loaded: " + one_line(reason != nullptr ? reason : file_);
  }
  const auto create = reinterpret_cast<fdcg_transport_create_function>(dlsym(file, FDCG_TRANSPORT_CREATE));
  if (create == nullptr) return one_line(file_) + ": has no function " FDCG_TRANSPORT_CREATE " (fdcg/transport.h)";
  fdcg_transport device{};
  device.struct_bytes = sizeof device;
  fdcg_host_message why{};
  if (create(FDCG_TRANSPORT_ABI, settings_.c_str(), &device, &why) != FDCG_TRANSPORT_OK) {
    why.text[sizeof why.text - 1] = 0;
    return one_line(file_) + ": " +
           (why.text[0] != 0 ? one_line(why.text) : "refuses its settings, or this version of the host");
  }
  if (device.open == nullptr || device.close == nullptr || device.read == nullptr || device.write == nullptr)
    return one_line(file_) + ": lacks open, close, read or write";
  set(device);
  return {};
}

std::string Plugin::open() {
  if (!is_set_) {
    if (std::string problem = load(); !problem.empty()) return problem;
  }
  fdcg_host_message why{};
  is_open_ = device_.open(device_.self, &why) == FDCG_TRANSPORT_OK;
  why.text[sizeof why.text - 1] = 0;
  if (is_open_) return {};
  return why.text[0] != 0 ? one_line(why.text) : "the plugin could not open its device";
}

void Plugin::close() {
  if (is_open_) device_.close(device_.self);
  is_open_ = false;
}

ReadResult Plugin::read(std::uint8_t* data, int capacity, int timeout_ms) {
  fdcg_transport_sample from{};
  const int answer = device_.read(device_.self, timeout_ms, &from);
  if (answer != FDCG_TRANSPORT_SAMPLE || capacity < profile_.input.bytes)
    return {answer == FDCG_TRANSPORT_OK ? ReadStatus::kTimeout : ReadStatus::kLost, 0};
  Sample sample;
  for (int i = 0; i < 3; ++i)
    sample.axis[i] = from.position_m[i];
  sample.sequence = from.sequence;
  sample.echo = from.echo;
  sample.time_s = std::isfinite(from.time_s) ? from.time_s : 0;
  sample.buttons = from.buttons;
  // a count holds neither NaN nor more than so much: such a place is a fault of the device
  const bool is_place = std::all_of(from.position_m, from.position_m + 3, [](double p) { return std::fabs(p) <= kFarthest_m; });
  sample.has_fault = (from.flags & FDCG_TRANSPORT_FAULT) != 0 || !is_place;
  sample.is_enabled = (from.flags & FDCG_TRANSPORT_ENABLED) != 0;
  encode_input(profile_, sample, data);
  return {ReadStatus::kReport, profile_.input.bytes};
}

bool Plugin::write(const std::uint8_t* data, int bytes) {
  Command command;
  if (!decode_output(profile_, data, bytes, &command)) return false;
  fdcg_transport_force force{};
  for (int i = 0; i < 3; ++i)
    force.force_n[i] = command.is_enabled ? command.effort[i] : 0;
  force.sequence = command.sequence;
  force.answers = command.echo;
  force.is_enabled = command.is_enabled ? 1 : 0;
  return device_.write(device_.self, &force) == FDCG_TRANSPORT_OK;
}

void add(ReportLayout* layout, Role role, NumberType type, double scale = 1, std::uint8_t axis = 0) {
  Field& field = layout->fields[layout->field_count++];
  field.role = role;
  field.type = type;
  field.scale = scale;
  field.axis = axis;
  field.offset = layout->bytes;
  layout->bytes = static_cast<std::uint16_t>(layout->bytes + bytes_of(type));
}

}  // namespace

Profile plugin_profile(double rate_hz, const DeviceLimits& limits) {
  Profile profile;
  std::snprintf(profile.name, sizeof profile.name, "plugin");
  profile.rate_hz = rate_hz;
  profile.axis_count = 3;
  profile.limits = limits;
  profile.has_output = true;
  profile.input.id = kInputId;
  profile.output.id = kOutputId;
  profile.input.bytes = profile.output.bytes = 1;
  add(&profile.input, Role::kSequence, NumberType::kU32);
  add(&profile.input, Role::kTime, NumberType::kU32, kSecondsPerCount);
  for (std::uint8_t axis = 0; axis < 3; ++axis)
    add(&profile.input, Role::kAxis, NumberType::kI32, kMetresPerCount, axis);
  add(&profile.input, Role::kEcho, NumberType::kU32);
  add(&profile.input, Role::kButtons, NumberType::kU32);
  add(&profile.input, Role::kStatus, NumberType::kU8);
  Field& status = profile.input.fields[profile.input.field_count - 1];
  status.constant = FDCG_TRANSPORT_FAULT;
  status.enabled = FDCG_TRANSPORT_ENABLED;
  add(&profile.output, Role::kSequence, NumberType::kU32);
  for (std::uint8_t axis = 0; axis < 3; ++axis)
    add(&profile.output, Role::kEffort, NumberType::kF32, 1, axis);
  add(&profile.output, Role::kEcho, NumberType::kU32);
  add(&profile.output, Role::kEnable, NumberType::kU8);
  profile.output.fields[profile.output.field_count - 1].constant = 1;
  return profile;
}

std::unique_ptr<PluginTransport> make_plugin_transport(const Profile& profile, const std::string& file,
                                                       const std::string& settings) {
  return std::make_unique<Plugin>(profile, file, settings);
}

}  // namespace fdcg::dev
