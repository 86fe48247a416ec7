// SPDX-License-Identifier: Apache-2.0
// Profiles changed at random are accepted, and then in order, or refused by the name of a field. 100,000 of them (a tenth where
// the build is slow), or FDCG_RANDOM_PROFILES if set: a million take a minute and a half.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "profile/profile_json.hpp"
#include "profile/report_codec.hpp"
#include "profile_in_order.hpp"

namespace {

using namespace fdcg::dev;
using Json = nlohmann::json;

#if !defined(NDEBUG) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr long kCount = 10000;
#else
constexpr long kCount = 100000;
#endif

// A value within a document, and how a message would name it.
struct Place {
  Json* parent = nullptr;  // null: the whole
  std::string key;         // within an object
  std::size_t index = 0;   // within a list
  std::string path;

  Json& value() const { return parent->is_array() ? (*parent)[index] : (*parent)[key]; }
};

void collect(Json& json, const std::string& path, std::vector<Place>* places) {
  if (json.is_object()) {
    for (auto& [key, value] : json.items()) {
      const std::string inner = path.empty() ? key : path + "." + key;
      places->push_back({&json, key, 0, inner});
      collect(value, inner, places);
    }
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      const std::string inner = path + "[" + std::to_string(i) + "]";
      places->push_back({&json, "", i, inner});
      collect(json[i], inner, places);
    }
  }
}

class Mutator {
 public:
  explicit Mutator(std::mt19937_64& random) : random_(random) {}

  // One change somewhere; the place that became null, where it is that, or else "".
  std::string change(Json& json) {
    places_.clear();
    collect(json, "", &places_);
    const Place& place = places_[below(places_.size())];
    switch (below(8)) {
      case 0:
        place.value() = nullptr;
        return place.path;
      case 1:
        place.value() = scalar();
        break;
      case 2:
        remove(place);
        break;
      case 3:
        nudge(place.value());
        break;
      case 4: {
        const Json copy = places_[below(places_.size())].value();
        place.value() = copy;
        break;
      }
      case 5:
        repeat(place);
        break;
      case 6:
        rename(place);
        break;
      default:
        add(place.value());
    }
    return "";
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }

  Json scalar() {
    static const std::vector<Json> values = {true,
                                             false,
                                             0,
                                             1,
                                             -1,
                                             2,
                                             3,
                                             7,
                                             127,
                                             128,
                                             255,
                                             256,
                                             65535,
                                             65536,
                                             4294967295U,
                                             4294967296,
                                             18446744073709551615U,
                                             0.5,
                                             -0.0,
                                             1e-300,
                                             1e300,
                                             -1e300,
                                             1e-6,
                                             "",
                                             "x",
                                             "m",
                                             "rad",
                                             "N",
                                             "N.m",
                                             "s",
                                             "u8",
                                             "u16",
                                             "u32",
                                             "i8",
                                             "i16",
                                             "i32",
                                             "f32",
                                             "little",
                                             "big",
                                             "axis",
                                             "effort",
                                             "sequence",
                                             "time",
                                             "echo",
                                             "buttons",
                                             "status",
                                             "enable",
                                             "constant",
                                             "none",
                                             "crc32",
                                             "crc8",
                                             "sum8",
                                             "cartesian",
                                             "rotary",
                                             "serial-arm",
                                             "delta",
                                             "0x0",
                                             "0xFFFF",
                                             "0xFFFFFFFF",
                                             "0x123456789",
                                             "00",
                                             "zz",
                                             "a\nb",
                                             Json::array(),
                                             Json::object()};
    return values[below(values.size())];
  }

  void remove(const Place& place) {
    if (place.parent->is_array())
      place.parent->erase(place.index);
    else
      place.parent->erase(place.key);
  }

  void nudge(Json& value) {
    if (!value.is_number()) return;
    const double number = value.get<double>();
    const double changed[] = {number + 1, number - 1, -number, number * 10, number / 10, number * 1.5, number + 4, number - 4};
    const double next = changed[below(std::size(changed))];
    if (next == std::floor(next) && std::fabs(next) < 1e15)
      value = static_cast<std::int64_t>(next);
    else
      value = next;
  }

  void repeat(const Place& place) {
    if (!place.parent->is_array()) return;
    const Json copy = place.value();
    place.parent->insert(place.parent->begin() + static_cast<std::ptrdiff_t>(below(place.parent->size())), copy);
  }

  void rename(const Place& place) {
    if (!place.parent->is_object()) return;
    std::string key = place.key;
    key[below(key.size())] = static_cast<char>('a' + below(26));
    const Json value = place.value();
    place.parent->erase(place.key);
    (*place.parent)[key] = value;
  }

  void add(Json& value) {
    static const std::vector<std::string> keys = {
        "scale",   "bias",  "unit",       "axis", "offset", "type", "crc",      "bytes",     "radius_m", "kind",      "endian",
        "upper_m", "value", "fault_mask", "name", "effort", "init", "origin_m", "report_id", "rate_hz",  "unheard_of"};
    if (value.is_object()) value[keys[below(keys.size())]] = scalar();
    if (value.is_array()) value.push_back(scalar());
  }

  std::mt19937_64& random_;
  std::vector<Place> places_;
};

void require_in_order(const Profile& profile, std::mt19937_64& random) {
  if (const char* trouble = trouble_of(profile)) FAIL(trouble);
  std::uint8_t data[kMaxReportBytes];
  for (std::uint8_t& byte : data)
    byte = static_cast<std::uint8_t>(random());
  Sample sample;
  decode_input(profile, data, profile.input.bytes, &sample);
  encode_input(profile, sample, data);
  if (!profile.has_output) return;
  const Command command{{1e3, -1e3, 0.1}, 1, 2, true};
  encode_output(profile, command, data);
  Command taken;
  REQUIRE(decode_output(profile, data, profile.output.bytes, &taken));
}

// "r.json: input.fields[3].offset is ...", "r.json: 'naem' is no key ...".
bool names_a_field(const std::string& message) {
  static const std::set<std::string> known = {"fdcg_profile", "name",   "source", "notes",     "match",      "rate_hz",
                                              "input",        "output", "init",   "safe_stop", "kinematics", "limits"};
  const std::string start = "r.json: ";
  if (message.rfind(start, 0) != 0 || message.find('\n') != std::string::npos || message.size() > 1100) return false;
  const std::string rest = message.substr(start.size());
  if (rest[0] == '\'') return rest.find("' is no key") != std::string::npos;
  return known.count(rest.substr(0, rest.find_first_of(" .["))) == 1;
}

std::vector<Json> originals() {
  std::vector<Json> all;
  for (const BuiltinProfile& builtin : builtin_profiles())
    all.push_back(Json::parse(builtin.text));
  std::ifstream file(std::string(FDCG_SOURCE_DIR) + "/testdata/profiles/full.json");
  all.push_back(Json::parse(file));
  for (Json& json : all) {
    json.erase("$schema");  // which nothing reads
    json["notes"] = {"short"};
  }
  return all;
}

}  // namespace

TEST_CASE("profiles changed at random are accepted and in order, or refused by the name of a field") {
  const char* asked = std::getenv("FDCG_RANDOM_PROFILES");
  const long count = asked != nullptr ? std::atol(asked) : kCount;
  REQUIRE(count > 0);
  const std::vector<Json> all = originals();
  std::mt19937_64 random(6);
  Mutator mutator(random);
  long accepted = 0;
  for (long i = 0; i < count; ++i) {
    Json json = all[random() % all.size()];
    const int changes = 1 + static_cast<int>(random() % 3);
    std::string null_place;
    for (int c = 0; c < changes; ++c)
      null_place = mutator.change(json);
    const std::string text = json.dump();
    Profile profile;
    const std::string error = parse_profile(text, "r.json", &profile);
    if (error.empty()) {
      ++accepted;
      require_in_order(profile, random);
      continue;
    }
    if (!names_a_field(error)) FAIL(i << ": " << error << "\n" << text);
    if (changes == 1 && !null_place.empty() && error.rfind("r.json: " + null_place + " is null", 0) != 0)
      FAIL(i << ": " << error << " should be of " << null_place);
  }
  // Both valid and invalid profiles must be frequent, or little is tested.
  CHECK(accepted > count / 20);
  CHECK(accepted < count / 2);
}
