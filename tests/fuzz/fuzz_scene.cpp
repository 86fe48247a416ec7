// SPDX-License-Identifier: Apache-2.0
// Any bytes as a scene: refused in one short line that begins with the file's name; or accepted, and then it is written, reads
// back and is written the same, and every number that a loop relies on is in its range.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "host/host.hpp"
#include "scene/scene_build.hpp"
#include "scene/scene_json.hpp"

namespace {

using namespace fdcg::dev;

bool is_finite(const double* x, int count) {
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(x[i])) return false;
  return true;
}

// Null, or what of an accepted scene is out of order.
const char* trouble_of(const HostConfig& config) {
  if (config.devices.empty() || config.devices.size() > kMaxDevices) return "the number of devices";
  int moving = 0, bodies = 0;
  for (const ObjectConfig& object : config.objects) {
    fdcg_params params = object.params;
    params.tick_s = 0.001;
    fdcg_error error{};
    if (fdcg_check_params(&params, &error) != FDCG_OK) return "an object's parameters";
    const fdcg_pose pose = pose_at(object, 12345.678);
    if (!is_finite(pose.rotation_xyzw, 4) || !is_finite(pose.translation_m, 3) || !(pose.scale > 0)) return "a pose";
    moving += is_moved(object.motion);
    bodies += object.motion.kind == MotionKind::kBody;
    if (object.is_surface && fdcg_check_surface(&object.surface, &error) != FDCG_OK) return "a surface";
  }
  if (bodies > kMaxBodies || (bodies > 0 && config.devices.size() > 1)) return "the number of bodies";
  if (!is_finite(config.gravity_m_per_s2, 3) || !is_finite(config.ground.normal, 3)) return "gravity or the ground";
  if (moving > kMaxDriven) return "the number of motions";
  for (const DeviceConfig& device : config.devices) {
    if (device.contact_count < 1 || device.contact_count > kMaxContacts) return "the number of contacts";
    if (!is_finite(&device.contacts_m[0][0], 3 * kMaxContacts)) return "a contact";
    if (!is_finite(&device.grip.closed_m[0][0], 3 * kMaxContacts) || !is_finite(device.grip.turn_xyzw, 4)) return "a grip";
    if (!(device.grip.close.seconds > 0) || !(device.grip.turn.seconds > 0)) return "a grip's seconds";
    if (!is_finite(device.mapping.rotation, 9) || !is_finite(device.mapping.offset_m, 3)) return "a mapping";
    if (!(device.mapping.scale > 0) || !(device.most_force_n >= 0) || !(device.profile.rate_hz > 0)) return "a device";
  }
  return nullptr;
}

const char* trouble_of_writing(const HostConfig& config, std::string* error) {
  const std::string text = write_scene(config);
  HostConfig back;
  *error = parse_scene(text, "fuzz", &back, nullptr, {false});
  if (!error->empty()) return "it does not read back";
  return write_scene(back) == text ? nullptr : "it is not written the same again";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  constexpr std::size_t kLongest = 2000;
  HostConfig config;
  std::vector<std::string> warnings;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::string error = parse_scene(text, "fuzz", &config, &warnings, {false});
  const char* trouble = nullptr;
  if (error.empty()) {
    trouble = trouble_of(config);
    if (trouble == nullptr) trouble = trouble_of_writing(config, &error);
  } else if (error.rfind("fuzz: ", 0) != 0) {
    trouble = "a message without the file";
  }
  warnings.push_back(error);
  for (const std::string& line : warnings)
    if (line.size() >= kLongest || line.find_first_of("\r\n") != std::string::npos) trouble = "a message that is no short line";
  if (trouble == nullptr) return 0;
  std::fprintf(stderr, "%s: %s\n", trouble, error.c_str());
  std::abort();
}
