// SPDX-License-Identifier: Apache-2.0
// Any bytes as a request's Host and Origin (apart by a line feed): who is let in names this computer in both.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "dashboard/visitors.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view host = text.substr(0, end), origin = text.substr(std::min(end + 1, text.size()));
  if (!fdcg::tools::may_come(host, origin)) return 0;
  const auto names = [](std::string_view place) {
    for (const std::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
      if (!place.starts_with(name)) continue;
      const std::string_view rest = place.substr(name.size());
      if (rest.empty() ||
          (rest[0] == ':' && rest.size() <= 6 && rest.find_first_not_of("0123456789", 1) == std::string_view::npos))
        return true;
    }
    return false;
  };
  if (names(host) && (origin.empty() || (origin.starts_with("http://") && names(origin.substr(7))))) return 0;
  std::fprintf(stderr, "let in: %.*s\n", static_cast<int>(size), text.data());
  std::abort();
}
