// SPDX-License-Identifier: Apache-2.0
// Who may come to the dashboard's server: any page that a browser shows may knock at this computer's ports.
#pragma once

#include <string_view>

namespace fdcg::tools {

// "localhost:8080", "127.0.0.1", "[::1]:9": what a browser asks for where it means this computer. A name of another site that
// is made to lead here (DNS rebinding) is none of these.
bool is_of_this_computer(std::string_view host);
// By the headers of a request: Host, and Origin, which only web pages have (empty: there is none).
bool may_come(std::string_view host, std::string_view origin);

}  // namespace fdcg::tools
