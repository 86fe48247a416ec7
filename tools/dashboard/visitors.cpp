// SPDX-License-Identifier: Apache-2.0
#include "visitors.hpp"

#include <algorithm>

namespace fdcg::tools {

bool is_of_this_computer(std::string_view host) {
  const std::size_t colon = host.rfind(':'), bracket = host.rfind(']');
  if (colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)) {
    const std::string_view port = host.substr(colon + 1);
    if (port.empty() || port.size() > 5 || !std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; }))
      return false;
    host = host.substr(0, colon);
  }
  return host == "localhost" || host == "127.0.0.1" || host == "[::1]";
}

bool may_come(std::string_view host, std::string_view origin) {
  constexpr std::string_view kHttp = "http://";
  if (!is_of_this_computer(host)) return false;
  return origin.empty() || (origin.starts_with(kHttp) && is_of_this_computer(origin.substr(kHttp.size())));
}

}  // namespace fdcg::tools
