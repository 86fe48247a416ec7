// SPDX-License-Identifier: Apache-2.0
// fdcg-servo replay of a session's log.
#pragma once

#include <string>

namespace fdcg::servo {

struct ReplaySessionArguments {
  std::string session;
  std::string graphs;  // folder; empty: where they were
  std::string csv, touches, rewritten;
  bool quiet = false;
};
int replay_session(const ReplaySessionArguments& arguments);  // the exit code

}  // namespace fdcg::servo
