// SPDX-License-Identifier: Apache-2.0
#include "step_watch.hpp"

constinit thread_local fdcg::test::StepWatch fdcg::test::step_watch{};
