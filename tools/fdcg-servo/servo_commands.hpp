// SPDX-License-Identifier: Apache-2.0
// The subcommands of fdcg-servo: each declares its options on the app and hands back what runs when it was chosen.
#pragma once

#include "../common/options.hpp"
#include "../common/program.hpp"

namespace fdcg::servo {

using tools::Command;
using tools::fail;
using enum tools::ExitCode;

// --hid: `backend` as fdcg/device_tools.hpp names it.
inline void add_hid_option(const tools::OptionGroup& group, std::string& backend, const std::string& shown_default) {
  group.choice<std::string>("--hid", "BACKEND", {{"hidraw", "hidraw"}, {"libusb", "libusb"}}, backend, "Back end of hidapi.",
                            shown_default);
}

Command add_replay(CLI::App& app);
Command add_run(CLI::App& app);
Command add_devices(CLI::App& app);
Command add_check(CLI::App& app);
Command add_latency(CLI::App& app);
Command add_calibrate(CLI::App& app);

}  // namespace fdcg::servo
