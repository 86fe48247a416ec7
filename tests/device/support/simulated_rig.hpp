// SPDX-License-Identifier: Apache-2.0
// A simulated device and a minimal host, with the host's own codec and judge, in one thread.
#pragma once

#include <cstring>
#include <memory>
#include <vector>

#include "catch.hpp"
#include "profile/report_codec.hpp"
#include "transport/make_transport.hpp"
#include "transport/simulated_device.hpp"

namespace fdcg::test {

using namespace fdcg::dev;
using Verdicts = std::vector<Verdict>;

// In virtual time, with a hand that stays where it is.
inline SimulationConfig still() {
  SimulationConfig config;
  config.amplitude_m[2] = 0;
  config.is_real_time = false;
  return config;
}

inline SimulatedFault fault(SimulatedFaultKind kind, double at_s, double for_s = 0, int reports = 1) {
  SimulatedFault f;
  f.kind = kind;
  f.at_s = at_s;
  f.for_s = for_s;
  f.reports = reports;
  return f;
}

// A minimal host: one output report per read, enabled from the second on.
struct SmallHost {
  SimulationConfig config;
  std::shared_ptr<SimulationRecord> record = std::make_shared<SimulationRecord>();
  Profile profile;
  std::unique_ptr<Transport> transport;
  ReportJudge judge;
  Sample sample;
  std::uint32_t sequence = 0;
  double clock_s = 0;
  double force_n[3] = {0.5, 0, -0.25};

  explicit SmallHost(const SimulationConfig& given) : config(given), profile(simulated_profile(given)) {
    config.record = record;
    DeviceConfig device;
    device.source = DeviceSource::kSimulated;
    device.simulation = config;
    transport = make_simulated_transport(device);
    REQUIRE(transport->open() == "");
  }
  Verdict read(ReadStatus* status = nullptr) {
    std::uint8_t data[kMaxReportBytes];
    const ReadResult result = transport->read(data, sizeof data, 100);
    if (status != nullptr) *status = result.status;
    if (result.status != ReadStatus::kReport) return Verdict::kGood;
    clock_s += 1 / config.rate_hz;
    const Verdict verdict = decode_input(profile, data, result.bytes, &sample);
    return verdict == Verdict::kGood ? judge_report(profile, sample, clock_s, &judge) : verdict;
  }
  bool write(bool is_enabled = true) {
    Command command;
    std::memcpy(command.effort, force_n, sizeof force_n);
    command.sequence = ++sequence;
    command.echo = sample.sequence;
    command.is_enabled = is_enabled;
    std::uint8_t data[kMaxReportBytes];
    encode_output(profile, command, data);
    return transport->write(data, profile.output.bytes);
  }
  Verdicts run(int ticks) {
    Verdicts verdicts;
    for (int i = 0; i < ticks; ++i) {
      ReadStatus status;
      const Verdict verdict = read(&status);
      if (status == ReadStatus::kLost) break;
      if (status == ReadStatus::kTimeout) continue;
      verdicts.push_back(verdict);
      if (verdict == Verdict::kGood) write(sequence > 0);
    }
    return verdicts;
  }
};

}  // namespace fdcg::test
