// SPDX-License-Identifier: Apache-2.0
#include "host/status.hpp"

#include <algorithm>
#include <bit>

namespace fdcg::dev {
namespace {

constexpr int kFirstDoubling = 6;  // 64 ns
constexpr int kBinsADoubling = 4;
// 2^(1/4), 2^(2/4), 2^(3/4), times 2^16
constexpr std::uint64_t kQuarters[] = {77936, 92682, 110218};

// The upper end of a bin; a time that is equal to it belongs to the next.
std::uint64_t upper_end(int bin) {
  const int doubling = kFirstDoubling + bin / kBinsADoubling, quarter = bin % kBinsADoubling;
  if (quarter == kBinsADoubling - 1) return std::uint64_t{1} << (doubling + 1);
  return (kQuarters[quarter] << doubling) >> 16;
}

int bin_of(std::uint64_t ns) {
  if (ns < (std::uint64_t{1} << kFirstDoubling)) return 0;
  const int doubling = std::bit_width(ns) - 1;
  if (doubling >= kFirstDoubling + TimeHistogram::kBins / kBinsADoubling) return TimeHistogram::kBins - 1;
  int bin = (doubling - kFirstDoubling) * kBinsADoubling;
  while (ns >= upper_end(bin))
    ++bin;
  return bin;
}

static_assert(TimeHistogram::kBins % kBinsADoubling == 0 && kFirstDoubling + TimeHistogram::kBins / kBinsADoubling + 17 < 64);

}  // namespace

std::uint64_t TimeHistogram::upper_end_ns(int bin) {
  return upper_end(bin);
}

void TimeHistogram::add(std::uint64_t ns) {
  ++counts[bin_of(ns)];
  ++total;
  largest_ns = std::max(largest_ns, ns);
}

std::uint64_t TimeHistogram::quantile(double share) const {
  if (total == 0) return 0;
  std::uint64_t seen = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    seen += counts[bin];
    // no more than the largest: of few values it is the better bound
    if (static_cast<double>(seen) >= share * static_cast<double>(total)) return std::min(upper_end(bin), largest_ns);
  }
  return largest_ns;
}

void tell_standstill(double now_s, DeviceStatus* status) {
  if (now_s - status->elapsed_s < kStandstillS) return;
  if (status->last.phase != Phase::kDisarmed) {
    status->last.fault = Fault::kHostLate;
    ++status->counters.disarmed[static_cast<int>(Fault::kHostLate)];
  }
  status->last.phase = Phase::kDisarmed;
  status->last.force = GatedForce();
}

}  // namespace fdcg::dev
