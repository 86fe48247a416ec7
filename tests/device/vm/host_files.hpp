// SPDX-License-Identifier: Apache-2.0
// What the host program is given: the built-in reference profile at this scenario's rate, and a scene with one object.
#pragma once

#include <string>
#include <vector>

namespace fdcg::vm {

struct RigOptions;

inline constexpr char kSmallDisk[] = "/full";  // a file system of kSmallDiskKb
inline constexpr int kSmallDiskKb = 2048;
inline constexpr char kGraph[] = "/tmp/cube.fdcg";
inline constexpr double kStatusPeriodS = 0.1;

// Into /tmp of the guest. Throws std::runtime_error.
void write_host_files(const RigOptions& options);
std::vector<std::string> host_command(const RigOptions& options);
// Of a scene in which the device stands twice.
std::vector<std::string> command_with_node_twice();

}  // namespace fdcg::vm
