// SPDX-License-Identifier: Apache-2.0
// Any bytes as a device profile: refused in one short line that begins with the file's name, or a table that the loop can rely
// on without looking.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "profile/profile_json.hpp"
#include "profile_in_order.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace fdcg::dev;
  constexpr std::size_t kLongest = 1200;
  Profile profile;
  std::vector<std::string> warnings;
  const std::string error =
      parse_profile(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz", &profile, &warnings);
  const char* trouble = error.empty() ? trouble_of(profile) : nullptr;
  warnings.push_back(error);
  for (const std::string& line : warnings) {
    const bool is_line = line.size() < kLongest && line.find_first_of("\r\n") == std::string::npos;
    if (!is_line || (!line.empty() && line.rfind("fuzz: ", 0) != 0)) trouble = "a message";
  }
  if (trouble == nullptr) return 0;
  std::fprintf(stderr, "%s: %s\n", trouble, error.c_str());
  std::abort();
}
