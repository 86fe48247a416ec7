// SPDX-License-Identifier: Apache-2.0
// Manual pages and shell completions, made from the options that the parser knows.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace fdcg::tools {

// Writes into FOLDER: man1/PROGRAM.1 and man1/PROGRAM-COMMAND.1, bash-completion/completions/PROGRAM and
// zsh/site-functions/_PROGRAM: the folders below share/ of an installation. `date` stands in the manual pages. Empty: fine.
std::string write_manuals(const CLI::App& app, const std::string& version, const std::string& folder, const std::string& date);

}  // namespace fdcg::tools
