// SPDX-License-Identifier: Apache-2.0
// Paths as URI references (RFC 3986), for reports that are read on other machines.
#pragma once

#include <string>
#include <string_view>

namespace fdcg::bake {

// Of `path`, seen from the absolute folder `root`: relative where the file lies in it ("meshes/my%20part.obj"), else absolute
// ("file:///data/a.stl"). Without a root relative paths stay relative. Bytes outside of RFC 3986's unreserved ones and "/" are
// percent-encoded, whatever their encoding. Does not access the file system.
[[nodiscard]] std::string file_uri(const std::string& path, const std::string& root);

[[nodiscard]] inline bool is_relative_uri(std::string_view uri) {
  return !uri.starts_with("file:");
}

}  // namespace fdcg::bake
