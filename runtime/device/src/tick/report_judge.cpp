// SPDX-License-Identifier: Apache-2.0
// Sequence and age of reports: judge_report of report_codec.hpp.
#include <algorithm>
#include <cmath>

#include "profile/report_codec.hpp"

namespace fdcg::dev {
namespace {

// The fastest report defines age zero. It is forgotten faster than clocks drift apart, but not much faster, since a persistent
// queue would otherwise not be detected.
constexpr double kCreep = 1.25 * kMostDrift;
// A report cannot arrive before it was made. A lead of this much over the fastest so far means that the clock has restarted.
constexpr double kMostLeadS = 0.1;
// A jump of the sequence is loss up to this and so many times what the rate explains; else it is a new sequence (or noise).
constexpr std::uint32_t kMostLost = 65536;
constexpr double kMostLostRates = 16;

const Field* find(const ReportLayout& layout, Role role) {
  for (int i = 0; i < layout.field_count; ++i) {
    if (layout.fields[i].role == role) return &layout.fields[i];
  }
  return nullptr;
}

// The fields that give the order of reports, and their ranges before they wrap.
struct Counters {
  const Field* sequence;
  const Field* time;
  std::uint32_t sequence_mask = 0;
  double round_s = 0;

  explicit Counters(const ReportLayout& layout) : sequence(find(layout, Role::kSequence)), time(find(layout, Role::kTime)) {
    if (sequence != nullptr) sequence_mask = mask_of(*sequence);
    if (time != nullptr) round_s = time->scale * (mask_of(*time) + 1.0);
  }
  std::uint32_t steps(std::uint32_t from, std::uint32_t to) const { return (to - from) & sequence_mask; }
  bool is_ahead(std::uint32_t step) const { return step <= sequence_mask / 2; }
  double seconds(double from_s, double to_s) const { return to_s >= from_s ? to_s - from_s : to_s - from_s + round_s; }
  bool is_ahead_s(double step_s) const { return step_s < round_s / 2; }
};

void adopt(const Sample& sample, double host_s, ReportJudge* judge) {
  judge->has_last = true;
  judge->last_sequence = sample.sequence;
  judge->last_raw_time_s = judge->last_time_s = sample.time_s;
  judge->last_host_s = judge->last_good_host_s = host_s;
  judge->has_offset = true;
  judge->least_offset_s = host_s - sample.time_s;
  judge->outsiders = 0;
}

// Against the report before. A gap of the sequence goes to *lost.
Verdict order(const Counters& counters, double rate_hz, const Sample& sample, double host_s, const ReportJudge& judge,
              std::uint32_t* lost) {
  if (counters.sequence != nullptr) {
    const std::uint32_t step = counters.steps(judge.last_sequence, sample.sequence);
    if (step == 0) return Verdict::kRepeated;
    const double explained = kMostLost + kMostLostRates * rate_hz * (host_s - judge.last_good_host_s);
    if (!counters.is_ahead(step) || step > explained) return Verdict::kOutOfOrder;
    *lost = step - 1;
  }
  if (counters.time == nullptr) return Verdict::kGood;
  const double step_s = counters.seconds(judge.last_raw_time_s, sample.time_s);
  const bool is_clock_fine = counters.time->scale * rate_hz <= 1;
  if (step_s == 0 && counters.sequence == nullptr && is_clock_fine) return Verdict::kRepeated;
  if (host_s - judge.last_host_s > counters.round_s / 2) return Verdict::kGood;  // any number of rounds may have passed
  if (!counters.is_ahead_s(step_s)) return Verdict::kOutOfOrder;
  const double offset_s = host_s - (judge.last_time_s + step_s);
  return judge.has_offset && offset_s < judge.least_offset_s - kMostLeadS ? Verdict::kOutOfOrder : Verdict::kGood;
}

// One more report that is out of order: true where there have been enough of them, in order among themselves.
bool is_restart(const Counters& counters, const Sample& sample, ReportJudge* judge) {
  bool follows = judge->outsiders > 0;
  if (follows && counters.sequence != nullptr) {
    const std::uint32_t step = counters.steps(judge->outsider_sequence, sample.sequence);
    follows = step != 0 && step <= kMostLost && counters.is_ahead(step);
  }
  if (follows && counters.time != nullptr)
    follows = counters.is_ahead_s(counters.seconds(judge->outsider_raw_time_s, sample.time_s));
  judge->outsiders = follows ? judge->outsiders + 1 : 1;
  judge->outsider_sequence = sample.sequence;
  judge->outsider_raw_time_s = sample.time_s;
  return judge->outsiders > kRestartReports;
}

// Of a report in order.
Verdict age(const Counters& counters, const Sample& sample, double host_s, ReportJudge* judge) {
  const double elapsed_s = host_s - judge->last_host_s;
  if (elapsed_s > counters.round_s / 2) {  // the clock may have wrapped unseen, and queued reports may be as old
    judge->has_offset = false;
    judge->settled_host_s = host_s + kSettleS;
  }
  judge->last_time_s += counters.seconds(judge->last_raw_time_s, sample.time_s);
  const double offset_s = host_s - judge->last_time_s;
  judge->least_offset_s = judge->has_offset ? std::min(offset_s, judge->least_offset_s + kCreep * elapsed_s) : offset_s;
  judge->has_offset = true;
  const bool is_fresh = host_s >= judge->settled_host_s && offset_s - judge->least_offset_s <= kMaxAgeS;
  return is_fresh ? Verdict::kGood : Verdict::kStale;
}

}  // namespace

Verdict judge_report(const Profile& profile, const Sample& sample, double host_s, ReportJudge* judge) {
  const Counters counters(profile.input);
  if (!judge->has_last) {
    adopt(sample, host_s, judge);
    return Verdict::kGood;
  }
  std::uint32_t lost = 0;
  const Verdict verdict = order(counters, profile.rate_hz, sample, host_s, *judge, &lost);
  if (verdict == Verdict::kRepeated) return verdict;
  if (verdict == Verdict::kOutOfOrder) {
    if (!is_restart(counters, sample, judge)) return verdict;
    ++judge->restarts;
    adopt(sample, host_s, judge);
    return Verdict::kGood;
  }
  judge->outsiders = 0;
  judge->lost += lost;
  const Verdict fresh = counters.time == nullptr ? Verdict::kGood : age(counters, sample, host_s, judge);
  judge->last_sequence = sample.sequence;
  judge->last_raw_time_s = sample.time_s;
  judge->last_host_s = host_s;
  if (fresh == Verdict::kGood) judge->last_good_host_s = host_s;
  return fresh;
}

}  // namespace fdcg::dev
