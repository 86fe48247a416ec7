// SPDX-License-Identifier: Apache-2.0
// What a device of the fdcg HID protocol says that it is (its feature report, schemas/fdcg-hid.md), against the profile that is
// to drive it. A difference would be a force in the wrong unit or a place in the wrong scale.
#pragma once

#include <cstdint>
#include <string>

#include "profile/profile.hpp"

namespace fdcg::dev {

// The profile is of such a device: by its usage page and usage.
bool describes_itself(const Profile& profile);
// data: the feature report, its id first. Empty: it agrees with the profile. Otherwise the first difference, with both values.
std::string identity_problem(const Profile& profile, const std::uint8_t* data, int bytes);

}  // namespace fdcg::dev
