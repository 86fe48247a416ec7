// SPDX-License-Identifier: Apache-2.0
#include "import/beside.hpp"

#include <algorithm>
#include <system_error>

namespace fdcg::bake {

bool stays_beneath(const std::filesystem::path& path, const std::string& text) {
  if (path.empty() || path.is_absolute() || path.has_root_path()) return false;
  if (text.find(':') != std::string::npos || text.find('\\') != std::string::npos || text.find('\0') != std::string::npos)
    return false;
  return std::none_of(path.begin(), path.end(), [](const std::filesystem::path& part) { return part == ".."; });
}

bool lies_beneath(const std::filesystem::path& path, const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  if (error) return false;
  const std::filesystem::path root = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) return false;
  return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
}

}  // namespace fdcg::bake
