// SPDX-License-Identifier: Apache-2.0
// Shell completions. `pages`: the program's own, then its commands'.
#pragma once

#include <string>
#include <vector>

#include "help_page.hpp"

namespace fdcg::tools {

std::string bash_completion(const std::vector<HelpPage>& pages);
std::string zsh_completion(const std::vector<HelpPage>& pages);

}  // namespace fdcg::tools
