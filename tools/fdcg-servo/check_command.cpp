// SPDX-License-Identifier: Apache-2.0
// fdcg-servo check: scenes and device profiles, as far as they can be judged without a device.
#include <algorithm>
#include <cstdio>

#include "fdcg/device_tools.hpp"
#include "servo_commands.hpp"

namespace fdcg::servo {
namespace {

int check_files(const std::vector<std::string>& files) {
  int code = kClean;
  for (const std::string& file : files) {
    const dev::FileCheck check = dev::check_file(file);
    if (check.is_unreadable) {
      code = fail(kFile, check.problem);
      continue;
    }
    if (!check.problem.empty()) {
      std::printf("%s\n", check.problem.c_str());
      code = std::max<int>(code, kFindings);
      continue;
    }
    std::printf("%s: %s: ok\n", file.c_str(), check.what.c_str());
    for (const std::string& warning : check.warnings)
      std::printf("%s: warning: %s\n", file.c_str(), warning.c_str());
  }
  return code;
}

}  // namespace

Command add_check(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("check", "Check scenes and device profiles without a device.");
  command->footer(R"(Examples:
  fdcg-servo check scene.json
  fdcg-servo check my-device.json scenes/*.json

The first problem of each file is reported with its field, value and limit. The graphs of a scene are opened. Warnings do not
fail.

)" + tools::exit_codes("every file is fine", "a file is not; one that is not JSON counts as one that cannot be read"));
  const auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("files", *files, "Scenes and device profiles.")->required()->type_name("FILE...");
  return {command, [files] { return check_files(*files); }};
}

}  // namespace fdcg::servo
