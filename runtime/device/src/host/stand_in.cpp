// SPDX-License-Identifier: Apache-2.0
#include "host/stand_in.hpp"

namespace fdcg::dev {

namespace {

constexpr std::uint64_t kLookNs = 200'000'000;  // often enough to see a stop, even if its wake were lost

}  // namespace

void StandIn::request_stop() {
  is_stopping_.store(true, std::memory_order_release);
  wake_.signal();
}

// Once a stall. The gate has disarmed by then.
void StandIn::run() {
  std::uint64_t seen = 0;
  while (!is_stopping_.load(std::memory_order_acquire)) {
    wake_.wait(kLookNs);
    const std::uint64_t stall = writer_.stall();
    if (stall == 0 || stall == seen) continue;
    seen = stall;
    if (!link_.enter(Link::kStandIn)) continue;
    send_zero(emergency_);
    link_.leave(Link::kStandIn);
  }
}

}  // namespace fdcg::dev
