// SPDX-License-Identifier: Apache-2.0
#include "snapshot_text.hpp"

#include <nlohmann/json.hpp>

#include "fdcg/device_status.hpp"
#include "status_text.hpp"

namespace fdcg::servo {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kGatePhases[] = {"disarmed", "ramping", "armed", "fading"};

Json list_of(const double (&values)[3]) {
  return {values[0], values[1], values[2]};
}

Json contact_json(const SnapshotNames& names, const fdcg_snapshot_contact& contact) {
  const auto object = static_cast<std::size_t>(contact.object);
  const bool is_free = contact.object < 0 || object >= names.objects.size();
  Json json;
  json["state"] = state_name(contact.state);
  json["slipping"] = contact.is_slipping != 0;
  json["object"] = is_free ? Json() : Json(names.objects[object]);
  json["feature"] = is_free ? Json() : Json(contact.feature);
  json["hip_m"] = list_of(contact.hip_m);
  json["god_object_m"] = list_of(contact.god_object_m);
  json["force_n"] = list_of(contact.force_n);
  return json;
}

Json device_json(const SnapshotNames& names, std::size_t device, const fdcg_snapshot& tick) {
  Json json;
  json["name"] = names.devices[device];
  json["tick"] = tick.tick;
  json["time_s"] = tick.time_s;
  json["phase"] = kGatePhases[tick.phase & 3];
  json["fault"] = dev::fault_name(static_cast<dev::Fault>(tick.fault));
  json["buttons"] = tick.buttons;
  json["tip_m"] = list_of(tick.tip_world_m);
  json["wanted_force_n"] = list_of(tick.wanted_force_n);
  json["force_n"] = list_of(tick.force_n);
  json["given_j"] = tick.given_j;
  json["round_trip_s"] = tick.round_trip_s > 0 ? Json(tick.round_trip_s) : Json();
  json["contacts"] = Json::array();
  for (std::uint32_t i = 0; i < tick.contact_count; ++i)
    json["contacts"].push_back(contact_json(names, tick.contacts[i]));
  json["bodies"] = Json::array();
  for (std::uint32_t i = 0; i < tick.body_count && i < names.bodies.size(); ++i) {
    const fdcg_pose& pose = tick.bodies[i];
    const double* const q = pose.rotation_xyzw;
    json["bodies"].push_back({{"name", names.bodies[i]},
                              {"translation_m", list_of(pose.translation_m)},
                              {"rotation_xyzw", {q[0], q[1], q[2], q[3]}}});
  }
  return json;
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string snapshots_json(const SnapshotNames& names, const std::vector<const fdcg_snapshot*>& newest, double seconds,
                           bool is_recording) {
  Json json;
  json["event"] = "snapshot";
  json["time_s"] = seconds;
  json["recording"] = is_recording;
  json["devices"] = Json::array();
  for (std::size_t i = 0; i < newest.size(); ++i)
    if (newest[i] != nullptr) json["devices"].push_back(device_json(names, i, *newest[i]));
  return text_of(json);
}

std::string tick_json(const SnapshotNames& names, std::size_t device, const fdcg_snapshot& tick) {
  return text_of(device_json(names, device, tick));
}

std::string said_json(double seconds, const std::string& text) {
  return text_of({{"event", "said"}, {"time_s", seconds}, {"text", text}});
}

}  // namespace fdcg::servo
