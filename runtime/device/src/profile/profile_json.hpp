// SPDX-License-Identifier: Apache-2.0
// Device profiles as JSON, by schemas/device-profile.schema.json. Load time only; allocates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "profile/profile.hpp"
#include "shared/json/reader.hpp"

namespace fdcg::dev {

// Empty: *profile is the whole of it. Otherwise one line that names file_name, the field, what was found and what is expected;
// *profile is then not to be used. `warnings` (may be null) gets, for a device that could push, a line for each limit that is
// not known, since it is then read but never pushes, and one for a rate at which it would not stay armed.
std::string parse_profile(std::string_view text, const std::string& file_name, Profile* profile,
                          std::vector<std::string>* warnings = nullptr);

// "limits" of a profile, or of a device of a scene. Throws json::Refusal.
void read_limits(const json::Value& json, int axis_count, DeviceLimits* limits);

// A warning for a device that reports so seldom that the gate counts it as silent; empty: none.
std::string rate_warning(double rate_hz);

// The profiles of runtime/device/profiles, by their files' names without ".json", in alphabetical order.
struct BuiltinProfile {
  std::string_view name;  // "fdcg-reference"
  std::string_view text;  // of the file
};
const std::vector<BuiltinProfile>& builtin_profiles();
const BuiltinProfile* find_builtin_profile(std::string_view name);  // null: there is none of that name

}  // namespace fdcg::dev
