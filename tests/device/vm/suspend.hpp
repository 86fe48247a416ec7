// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "clock.hpp"

namespace fdcg::vm {

// The host's clock of suspended time, from its next reading on. Before the first host is started: 0 makes the file.
void add_to_boot_clock(Nanoseconds more);

// The guest, until it is woken from outside. Throws where the kernel does not.
void suspend_to_memory();

}  // namespace fdcg::vm
