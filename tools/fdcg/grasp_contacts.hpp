// SPDX-License-Identifier: Apache-2.0
// Files of contacts: JSON or CSV, told apart by their first character.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// What a file says of a contact. What it leaves out comes from the command line.
struct NamedContact {
  std::string name;  // "contact 0" where the file has none
  bake::Vec3 point_m{};
  std::optional<bake::Vec3> inward;  // unit length
  std::optional<double> mu, torsion_m, cap_n;
  std::optional<double> pad_radius_m;  // in place of torsion_m, which is mu times it
};

// JSON: {"contacts": [{"point": [x, y, z], "mu": .., "torsion": .., "pad_radius": .., "cap": .., "normal": [..], "name": ".."},
// ..]}, or the array alone. CSV: a header that names x, y, z and any of mu, torsion, pad_radius, cap, nx, ny, nz, name. Other
// members and columns are refused, so that no misspelt one goes unread. At most 16 MiB. The failure's exit code is 3.
bake::Result<std::vector<NamedContact>> read_contacts(const std::string& path);

// The same from a file's text; `path` is for messages.
bake::Result<std::vector<NamedContact>> parse_contacts(const std::string& text, const std::string& path);

}  // namespace fdcg::tools
