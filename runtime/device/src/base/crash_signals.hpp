// SPDX-License-Identifier: Apache-2.0
// The signals that a thread's own fault raises. No thread of the host blocks them: a blocked one ends the process without its
// handler, and so without its zero force.
#pragma once

#include <signal.h>

namespace fdcg::dev {

inline constexpr int kCrashSignals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};

}  // namespace fdcg::dev
