// SPDX-License-Identifier: Apache-2.0
// Device profiles: what is read, and that everything wrong is refused by name. testdata/profiles/refused.json has an edit of
// full.json for each error; profile_schema_test.py holds the schema against the same list.
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "catch.hpp"
#include "profile/kinematics.hpp"
#include "profile/profile_json.hpp"
#include "profile/report_codec.hpp"
#include "shared/json/reader.hpp"

namespace {

using namespace fdcg::dev;
using Json = nlohmann::json;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string testdata(const char* name) {
  return read_file(std::filesystem::path(FDCG_SOURCE_DIR) / "testdata" / "profiles" / name);
}

Json full() {
  return Json::parse(testdata("full.json"));
}

Profile parsed(const Json& json, std::vector<std::string>* warnings = nullptr) {
  Profile profile;
  REQUIRE(parse_profile(json.dump(), "p.json", &profile, warnings) == "");
  return profile;
}

std::string refusal(const std::string& text) {
  Profile profile;
  return parse_profile(text, "p.json", &profile);
}

void edit(Json& json, const Json& edit) {
  const Json::json_pointer place(edit[1].get<std::string>());
  if (edit[0] == "set") {
    json[place] = edit[2];
    return;
  }
  REQUIRE(edit[0] == "remove");
  Json& parent = json.at(place.parent_pointer());
  if (parent.is_array())
    parent.erase(std::stoul(place.back()));
  else
    REQUIRE(parent.erase(place.back()) == 1);
}

}  // namespace

TEST_CASE("every built-in profile is read, and has the text of its file") {
  std::vector<std::string> names;
  for (const BuiltinProfile& builtin : builtin_profiles()) {
    INFO(builtin.name);
    const auto path =
        std::filesystem::path(FDCG_SOURCE_DIR) / "runtime/device/profiles" / (std::string(builtin.name) + ".json");
    CHECK(builtin.text == read_file(path));
    Profile profile;
    CHECK(parse_profile(builtin.text, std::string(builtin.name), &profile) == "");
    CHECK(profile.has_output);
    CHECK(Json::parse(builtin.text).contains("source"));
    CHECK(find_builtin_profile(builtin.name) == &builtin);
    names.emplace_back(builtin.name);
  }
  CHECK(names == std::vector<std::string>{"fdcg-reference", "ffbeast-wheel", "openffboard", "teensy-rawhid", "woodenhaptics"});
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(FDCG_SOURCE_DIR) / "runtime/device/profiles")) {
    if (file.path().extension() == ".json") CHECK(find_builtin_profile(file.path().stem().string()) != nullptr);
  }
  CHECK(find_builtin_profile("fdcg") == nullptr);
}

TEST_CASE("of the built-in profiles the reference device alone has every limit") {
  for (const BuiltinProfile& builtin : builtin_profiles()) {
    INFO(builtin.name);
    Profile profile;
    std::vector<std::string> warnings;
    REQUIRE(parse_profile(builtin.text, "b", &profile, &warnings) == "");
    CHECK(warnings.empty() == (builtin.name == "fdcg-reference"));
  }
}

TEST_CASE("a profile is translated to its table") {
  std::vector<std::string> warnings;
  const Profile p = parsed(full(), &warnings);
  CHECK(warnings.empty());
  CHECK(std::string(p.name) == "every key");
  CHECK(p.match.vendor == 0x1209);
  CHECK(p.match.product == 1);
  CHECK(p.match.usage_page == 0xFF48);
  CHECK(p.match.usage == 1);
  CHECK(p.match.interface_number == 2);
  CHECK(p.rate_hz == 2000);
  CHECK(p.axis_count == 3);
  CHECK(p.input.id == 1);
  CHECK(p.input.bytes == 36);
  REQUIRE(p.input.field_count == 10);
  CHECK(p.input.fields[0].role == Role::kSequence);
  CHECK(p.input.fields[0].is_big_endian);
  CHECK(p.input.fields[1].role == Role::kTime);
  CHECK(p.input.fields[1].scale == 1e-6);
  CHECK_FALSE(p.input.fields[1].is_big_endian);
  CHECK(p.input.fields[2].bias == -0.5);
  CHECK(p.input.fields[3].axis == 1);
  CHECK(p.input.fields[3].offset == 11);
  CHECK(p.input.fields[3].scale == -1e-6);
  CHECK(p.input.fields[4].type == NumberType::kF32);
  CHECK(p.input.fields[7].constant == 0x8001);
  CHECK(p.input.fields[9].constant == 0xCAFEF00D);
  CHECK(p.input.crc.kind == CrcKind::kCrc32);
  CHECK(p.input.crc.is_big_endian);
  CHECK(p.input.crc.offset == 32);
  CHECK(p.input.crc.bytes == 32);
  CHECK(p.has_output);
  CHECK(p.output.id == 2);
  CHECK(p.output.fields[5].role == Role::kEnable);
  CHECK(p.output.fields[5].constant == 170);
  CHECK(p.output.crc.kind == CrcKind::kCrc16Modbus);
  CHECK(p.output.crc.first == 1);
  REQUIRE(p.init_count == 2);
  CHECK(p.init[0].is_feature);
  CHECK(p.init[0].bytes == 2);
  CHECK(std::memcmp(p.init[0].data, "\x03\x01", 2) == 0);
  CHECK_FALSE(p.init[1].is_feature);
  CHECK(std::memcmp(p.init[1].data, "\x02\xFF", 2) == 0);
  CHECK(p.safe_stop_count == 1);
  CHECK(p.limits.force_n == 3);
  CHECK(p.limits.effort[2] == 1);
  CHECK(p.limits.slew_n_per_s == 1000);
  CHECK(p.limits.velocity_m_per_s == 1.5);
  CHECK(p.limits.workspace_min_m[1] == -0.2);
  CHECK(p.limits.workspace_max_m[2] == 0.3);
  CHECK(p.limits.device_watchdog_s == 0.02);
}

TEST_CASE("profile: optional fields have their defaults") {
  Json json = full();
  for (const char* key : {"$schema", "source", "notes", "output", "init", "safe_stop", "limits"})
    json.erase(key);
  json["match"] = {{"vendor_id", 1}, {"product_id", 0}};
  json["input"].erase("crc");
  json["input"]["report_id"] = 0;
  std::vector<std::string> warnings;
  const Profile p = parsed(json, &warnings);
  CHECK(warnings.empty());  // without output reports there are no forces to be limited
  CHECK(p.match.usage_page == -1);
  CHECK(p.match.usage == -1);
  CHECK(p.match.interface_number == -1);
  CHECK_FALSE(p.has_output);
  CHECK(p.input.crc.kind == CrcKind::kNone);
  CHECK(p.input.id == 0);
  CHECK(p.init_count == 0);
  CHECK(p.limits.force_n == 0);
}

TEST_CASE("profile: kinematic parameters are stored where kinematics reads them") {
  Json json = full();
  for (int axis = 0; axis < 3; ++axis) {
    json["input"]["fields"][2 + axis]["unit"] = "rad";
    json["output"]["fields"][1 + axis]["unit"] = "N.m";
  }
  json["kinematics"] = {
      {"kind", "delta"}, {"base_radius_m", 0.2}, {"upper_m", 0.3}, {"lower_m", 0.4}, {"platform_radius_m", 0.1}};
  json["kinematics"]["origin_z_m"] = 0.15;
  json["kinematics"]["azimuths_rad"] = {0.1, 2.1, 4.1};
  const KinematicsParams delta = parsed(json).kinematics;
  CHECK(delta.kind == KinematicsKind::kDelta);
  CHECK(std::vector<double>(delta.lengths_m, delta.lengths_m + 5) == std::vector<double>{0.2, 0.3, 0.4, 0.1, 0.15});
  CHECK(std::vector<double>(delta.angles_rad, delta.angles_rad + 3) == std::vector<double>{0.1, 2.1, 4.1});
  json["kinematics"] = {{"kind", "serial-arm"}, {"shoulder_height_m", 0.1}, {"upper_m", 0.2}, {"forearm_m", 0.3}};
  json["kinematics"]["origin_m"] = {1, 2, 3};
  json["kinematics"]["elbow_coupling"] = 1;
  const KinematicsParams arm = parsed(json).kinematics;
  CHECK(arm.kind == KinematicsKind::kSerialArm);
  CHECK(std::vector<double>(arm.lengths_m, arm.lengths_m + 6) == std::vector<double>{0.1, 0.2, 0.3, 1, 2, 3});
  CHECK(arm.angles_rad[0] == 1);
}

// Against the maker's own formulas (haptikfabrikenapi, src/kinematics.cpp), written anew.
TEST_CASE("WoodenHaptics counts become the maker's position, and forces the maker's currents") {
  Profile profile;
  REQUIRE(parse_profile(find_builtin_profile("woodenhaptics")->text, "w", &profile) == "");
  const double turn = 2 * std::acos(-1.0) / 2000;
  for (const auto& [a, b, c] : {std::array<int, 3>{0, 0, 6000}, {500, -300, 5000}, {-1234, 1500, 7000}}) {
    INFO(a << " " << b << " " << c);
    const std::int16_t counts[7] = {
        static_cast<std::int16_t>(a), static_cast<std::int16_t>(b), static_cast<std::int16_t>(c), 0, 0, 0, 0};
    std::uint8_t report[14];
    for (int i = 0; i < 7; ++i) {
      report[2 * i] = static_cast<std::uint8_t>(counts[i]);
      report[2 * i + 1] = static_cast<std::uint8_t>(counts[i] >> 8);
    }
    Sample sample;
    REQUIRE(decode_input(profile, report, 14, &sample) == Verdict::kGood);
    TipPose tip;
    REQUIRE(tip_pose(profile.kinematics, profile.axis_count, sample.axis, &tip));
    const double ta = a * turn / 16, tb = b * turn / 12, tc = c * turn / 12;
    const double reach = 0.205 * std::sin(tb) + 0.245 * std::sin(tc);
    CHECK(tip.position_m[0] == Approx(std::cos(ta) * reach - 0.22).margin(1e-12));
    CHECK(tip.position_m[1] == Approx(std::sin(ta) * reach).margin(1e-12));
    CHECK(tip.position_m[2] == Approx(0.205 * std::cos(tb) - 0.245 * std::cos(tc)).margin(1e-12));
    const double f[3] = {1.5, -0.5, 2};
    Command command;
    for (int axis = 0; axis < 3; ++axis)
      command.effort[axis] = tip.jacobian[0][axis] * f[0] + tip.jacobian[1][axis] * f[1] + tip.jacobian[2][axis] * f[2];
    encode_output(profile, command, report);
    const double torque[3] = {reach * (-std::sin(ta) * f[0] + std::cos(ta) * f[1]),
                              0.205 * ((std::cos(ta) * f[0] + std::sin(ta) * f[1]) * std::cos(tb) - std::sin(tb) * f[2]),
                              0.245 * ((std::cos(ta) * f[0] + std::sin(ta) * f[1]) * std::cos(tc) + std::sin(tc) * f[2])};
    const double gear[3] = {16, 12, 12};
    for (int axis = 0; axis < 3; ++axis) {
      const auto current_ma = static_cast<std::int16_t>(report[2 * axis] | report[2 * axis + 1] << 8);
      CHECK(current_ma == Approx(torque[axis] / gear[axis] / 0.0259 * 1000).margin(0.5001));
    }
  }
}

TEST_CASE("every error of a profile is one line that names the file, the field and the value") {
  const Json cases = Json::parse(testdata("refused.json"));
  CHECK(cases.size() > 100);
  for (const Json& one : cases) {
    INFO(one.dump());
    std::string text = one.value("text", "");
    if (one.contains("edits")) {
      Json json = full();
      for (const Json& e : one["edits"])
        edit(json, e);
      text = json.dump();
    }
    const std::string said = refusal(text);
    CHECK(said.rfind("p.json: " + one["says"].get<std::string>(), 0) == 0);
    CHECK(said.find('\n') == std::string::npos);
    CAPTURE(said);
  }
}

TEST_CASE("a text beyond the limit of bytes is refused") {
  CHECK(refusal(std::string(fdcg::json::Limits{}.bytes + 1, ' ')) == "p.json: has 1000001 bytes; the limit is 1000000");
}

TEST_CASE("profile: each unknown limit is a warning, and zero") {
  for (const char* key : {"force_n", "effort", "slew_n_per_s", "velocity_m_per_s", "workspace_m", "device_watchdog_s"}) {
    INFO(key);
    Json json = full();
    json["limits"].erase(key);
    std::vector<std::string> warnings;
    const Profile p = parsed(json, &warnings);
    REQUIRE(warnings.size() == 1);
    const std::string name = key;
    const std::string text =
        name == "device_watchdog_s" ? "p.json: limits." + name + " is not known" : "p.json: not known: limits." + name + ": ";
    CHECK(warnings[0].rfind(text, 0) == 0);
    CHECK((p.limits.force_n == 0) == (name == "force_n"));
    CHECK((p.limits.effort[0] == 0) == (name == "effort"));
    CHECK((p.limits.slew_n_per_s == 0) == (name == "slew_n_per_s"));
    CHECK((p.limits.velocity_m_per_s == 0) == (name == "velocity_m_per_s"));
    CHECK((p.limits.workspace_max_m[0] == 0) == (name == "workspace_m"));
    CHECK((p.limits.device_watchdog_s == 0) == (name == "device_watchdog_s"));
  }
  Json json = full();
  json.erase("limits");
  std::vector<std::string> warnings;
  parsed(json, &warnings);
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].rfind("p.json: not known: limits.force_n, limits.effort, limits.slew_n_per_s, limits.velocity_m_per_s, "
                          "limits.workspace_m: ",
                          0) == 0);
}

TEST_CASE("a file that cannot be read is refused with a reason") {
  using fdcg::json::read_text_file;
  std::string text;
  const std::filesystem::path folder = std::filesystem::path(FDCG_SOURCE_DIR) / "testdata" / "profiles";
  CHECK(read_text_file((folder / "full.json").string(), fdcg::json::Limits{}.bytes, &text) == "");
  CHECK(text == testdata("full.json"));
  CHECK(read_text_file((folder / "full.json").string(), text.size(), &text) == "");
  CHECK(read_text_file((folder / "full.json").string(), text.size() - 1, &text).find("has more than ") != std::string::npos);
  CHECK(read_text_file(folder.string(), 10, &text) == folder.string() + ": is a directory; name a file in it");
  CHECK(read_text_file("no/such/file", 10, &text) == "no/such/file: does not exist; check the path");
}
