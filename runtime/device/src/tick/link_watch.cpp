// SPDX-License-Identifier: Apache-2.0
#include "tick/link_watch.hpp"

#include <algorithm>

#include "base/time.hpp"

namespace fdcg::dev {
namespace {

constexpr std::uint32_t kUnheard = 64;  // outputs that may have been taken before the servo thread hears of the write
constexpr double kFewest = 4;           // reports that kCountedS must hold at the profile's rate to be judged

std::uint64_t slot_of(std::uint64_t now_ns, int slots) {
  return now_ns / static_cast<std::uint64_t>(kCountedS * 1e9 / slots);
}

}  // namespace

double most_round_trip_s(double rate_hz) {
  return std::max(kMostRoundTripS, kMostRoundTripPeriods / rate_hz);
}

void LinkWatch::begin(const Profile& profile, bool has_echo) {
  *this = LinkWatch();
  if (profile.rate_hz > 0) period_s_ = 1 / profile.rate_hz;
  const double expected = profile.rate_hz * kCountedS;
  least_count_ = expected >= kFewest ? kLeastShare * expected : 0;
  bool sends_sequence = false;
  for (int i = 0; i < profile.output.field_count; ++i)
    sends_sequence = sends_sequence || profile.output.fields[i].role == Role::kSequence;
  for (int i = 0; i < profile.input.field_count; ++i) {
    const Field& field = profile.input.fields[i];
    if (field.role == Role::kEcho && sends_sequence && has_echo) mask_ = mask_of(field);
    if (field.role == Role::kStatus && field.enabled != 0) tells_enabled_ = true;
  }
}

void LinkWatch::open(std::uint64_t now_ns) {
  sent_count_ = trip_count_ = 0;
  report_ns_ = 0;
  is_heard_ = false;
  round_trip_s_ = 0;
  unapplied_ns_ = foreign_ns_ = 0;
  opened_ns_ = now_ns;
  slot_ = slot_of(now_ns, kSlots);
  std::fill_n(counts_, kSlots, 0);
}

void LinkWatch::note_sent(const SentReport& sent) {
  if (mask_ == 0 || sent.ns == 0) return;
  if (sent_count_ > 0 && sent_[(sent_count_ - 1) % kSent].sequence == sent.sequence) return;
  sent_[sent_count_++ % kSent] = sent;
}

bool LinkWatch::is_ahead(std::uint32_t from, std::uint32_t to) const {
  return ((to - from) & mask_) <= mask_ / 2;
}

// Null: too old, or the servo thread has not heard of it (it learns of one write a tick).
const SentReport* LinkWatch::find_sent(std::uint32_t sequence) const {
  const std::uint32_t known = std::min<std::uint32_t>(sent_count_, kSent);
  for (std::uint32_t i = 1; i <= known; ++i) {
    const SentReport& sent = sent_[(sent_count_ - i) % kSent];
    if (((sent.sequence ^ sequence) & mask_) == 0) return &sent;
  }
  return nullptr;
}

void LinkWatch::note_report(const Sample& sample, std::uint64_t host_ns) {
  if (opened_ns_ == 0) opened_ns_ = host_ns;
  count(host_ns);
  report_ns_ = host_ns;
  if (mask_ != 0 && sent_count_ > 0) take_echo(sample, host_ns);
}

// A device's echo may go ahead, up to the newest that was sent. Before one of ours was heard it may be anything: what its last
// host left there.
void LinkWatch::take_echo(const Sample& sample, std::uint64_t host_ns) {
  const SentReport* const sent = find_sent(sample.echo);
  if (!is_heard_ && sent == nullptr) return;
  const std::uint32_t newest = sent_[(sent_count_ - 1) % kSent].sequence;
  const bool goes_back = is_heard_ && !is_ahead(echo_, sample.echo & mask_);
  if (goes_back || !is_ahead(sample.echo, newest + kUnheard)) {
    foreign_ns_ = host_ns;
    return;
  }
  const bool is_new = !is_heard_ || echo_ != (sample.echo & mask_);
  is_heard_ = true;
  echo_ = sample.echo & mask_;
  if (sent == nullptr) return;
  if (is_new) {
    round_trip_s_ = seconds(sent->ns, host_ns);
    trips_s_[trip_count_++ % kTrips] = round_trip_s_;
  }
  const bool is_unapplied = tells_enabled_ && sent->is_enabled && !sample.is_enabled;
  if (!is_unapplied) unapplied_ns_ = 0;
  if (is_unapplied && unapplied_ns_ == 0) unapplied_ns_ = host_ns;
}

void LinkWatch::count(std::uint64_t now_ns) {
  const std::uint64_t slot = std::max(slot_of(now_ns, kSlots), slot_);
  for (std::uint64_t skipped = std::min<std::uint64_t>(slot - slot_, kSlots); skipped > 0; --skipped)
    counts_[(slot - skipped + 1) % kSlots] = 0;
  slot_ = slot;
  ++counts_[slot % kSlots];
}

// As of the newest report: of the outputs that the device had not echoed the oldest was sent too long before, or it took one
// and did not apply it. That no reports come any more is the gate's to see (Fault::kSilence).
bool LinkWatch::is_untaken() const {
  if (mask_ == 0 || sent_count_ == 0) return false;
  if (unapplied_ns_ != 0 && seconds(unapplied_ns_, report_ns_) >= kTakenS) return true;
  const std::uint32_t known = std::min<std::uint32_t>(sent_count_, kSent);
  for (std::uint32_t i = known; i >= 1; --i) {
    const SentReport& sent = sent_[(sent_count_ - i) % kSent];
    const bool is_taken = is_heard_ && is_ahead(sent.sequence & mask_, echo_);
    if (!is_taken) return seconds(sent.ns, report_ns_) >= kTakenS;
  }
  return false;
}

// In the slot that is being counted, which is not over, and those before it.
bool LinkWatch::is_sparse(std::uint64_t now_ns) const {
  if (least_count_ <= 0 || seconds(opened_ns_, now_ns) < 2 * kCountedS) return false;
  const std::uint64_t first = std::max(slot_of(now_ns, kSlots), slot_) - kSlots + 1;
  double total = 0;
  for (std::uint64_t slot = first; slot <= slot_; ++slot)
    total += counts_[slot % kSlots];
  return total < least_count_ * (1 - 1.0 / kSlots);
}

Fault LinkWatch::fault(std::uint64_t now_ns, bool wants_force) const {
  if (foreign_ns_ != 0 && seconds(foreign_ns_, now_ns) < kOtherHostS) return Fault::kOtherHost;
  if (wants_force && is_untaken()) return Fault::kNotTaken;
  if (wants_force && trip_count_ >= kTrips && lags()) return Fault::kLag;
  return wants_force && is_sparse(now_ns) ? Fault::kReportsLost : Fault::kNone;
}

bool LinkWatch::lags() const {
  if (mask_ == 0) return false;
  const std::uint32_t known = std::min<std::uint32_t>(trip_count_, kTrips);
  if (known == 0) return true;  // nothing of ours has come back
  return *std::min_element(trips_s_, trips_s_ + known) > most_round_trip_s(1 / period_s_);
}

}  // namespace fdcg::dev
