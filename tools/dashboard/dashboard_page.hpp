// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fdcg::tools {

// What a browser shows at the server's address: every device with its phase, contact and force, and buttons for the commands.
extern const char* const kDashboardPage;

}  // namespace fdcg::tools
