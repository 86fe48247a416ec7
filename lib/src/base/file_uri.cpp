// SPDX-License-Identifier: Apache-2.0
#include "base/file_uri.hpp"

#include <filesystem>

namespace fdcg::bake {
namespace {

std::string percent_encoded(std::string_view bytes) {
  constexpr std::string_view kKept = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (kKept.find(c) != std::string_view::npos) {
      out += c;
    } else {
      out += '%';
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15u];
    }
  }
  return out;
}

bool leads_out(const std::filesystem::path& relative) {
  return relative.empty() || *relative.begin() == "..";
}

}  // namespace

std::string file_uri(const std::string& path, const std::string& root) {
  namespace fs = std::filesystem;
  const fs::path given = fs::path(path).lexically_normal();
  if (root.empty() && given.is_relative()) return percent_encoded(given.generic_string());
  const fs::path whole = (fs::path(root) / given).lexically_normal();
  const fs::path relative = root.empty() ? fs::path() : whole.lexically_relative(fs::path(root).lexically_normal());
  if (!leads_out(relative)) return percent_encoded(relative.generic_string());
  return "file://" + percent_encoded(whole.generic_string());
}

}  // namespace fdcg::bake
