// SPDX-License-Identifier: Apache-2.0
#include "transport/make_transport.hpp"

namespace fdcg::dev {

std::unique_ptr<Transport> make_transport(const DeviceConfig& config, const LoopConfig& loop) {
  switch (config.source) {
    case DeviceSource::kHid:
      return make_hid_transport(config, loop);
    case DeviceSource::kSimulated:
      return make_simulated_transport(config);
    case DeviceSource::kRecorded:
      return make_recorded_transport(config);
  }
  return nullptr;  // no other source
}

}  // namespace fdcg::dev
