// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fdcg::vm {

// A process that lives as long as this one. Throws std::runtime_error.
void start_udev_stand_in();

}  // namespace fdcg::vm
