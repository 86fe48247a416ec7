// SPDX-License-Identifier: Apache-2.0
#include "host/writer.hpp"

#include <algorithm>

#include "profile/report_codec.hpp"

namespace fdcg::dev {

namespace {

constexpr std::uint64_t kSilenceNs = static_cast<std::uint64_t>(kSilenceS * 1e9);
constexpr std::uint64_t kStalledNs = static_cast<std::uint64_t>(kWriterStuckS * 1e9);
constexpr std::uint64_t kAwakeNs = 100'000'000;  // with nothing to do: often enough to see a stop, even if its wake were lost
// A write may block the thread for 5.1 s, and a host must stop within 6 s: after a failed write there is no other attempt.
constexpr std::uint64_t kGoodbyeNs = 800'000'000;

}  // namespace

Writer::Writer(const Profile& profile, Transport& transport, Link& link)
    : profile_(profile), transport_(transport), link_(link) {}

void Writer::put(const GatedForce& force, std::uint32_t echo, std::uint64_t made_ns) {
  // The wait for the writer begins here, not with the tick: in between, this thread itself may have been stopped.
  if (done_.load(std::memory_order_acquire) >= put_number_) progress_ns_ = monotonic_ns();
  Letter letter;
  letter.force = force;
  letter.echo = echo;
  letter.number = ++put_number_;
  letter.made_ns = made_ns;
  letters_.put(letter);
  put_.store(put_number_, std::memory_order_release);
}

std::uint64_t Writer::busy_ns(std::uint64_t now_ns) {
  const std::uint64_t began_ns = began_ns_.load(std::memory_order_acquire);
  const std::uint64_t done = done_.load(std::memory_order_acquire);
  if (done != seen_done_ || done >= put_number_) {
    seen_done_ = done;
    progress_ns_ = now_ns;
  }
  const std::uint64_t writing_ns = began_ns == 0 || now_ns < began_ns ? 0 : now_ns - began_ns;
  const std::uint64_t waiting_ns = now_ns - progress_ns_;
  const std::uint64_t busy_ns = std::max(writing_ns, waiting_ns);
  const bool was_stalled = stall() != 0;
  const bool is_stalled = busy_ns >= kStalledNs && is_pushing_.load(std::memory_order_acquire);
  if (is_stalled != was_stalled) stall_.store(is_stalled ? ++stalls_ : 0, std::memory_order_release);
  return busy_ns;
}

void Writer::request_stop() {
  stop_ns_.store(monotonic_ns(), std::memory_order_release);
  is_stopping_.store(true, std::memory_order_release);
  wake_.signal();
}

void Writer::flush_within(std::uint64_t timeout_ns) {
  constexpr std::uint64_t kStepNs = 500'000;
  const std::uint64_t until_ns = monotonic_ns() + timeout_ns;
  const std::uint64_t wanted = put_.load(std::memory_order_acquire);
  Event never;
  while (done_.load(std::memory_order_acquire) < wanted && monotonic_ns() < until_ns)
    never.wait(kStepNs);
}

void Writer::run() {
  Letter letter;
  bool is_zeroed = true;  // the last force sent was zero, or none was sent
  while (!is_stopping_.load(std::memory_order_acquire)) {
    if (letters_.take(&letter)) {
      is_zeroed = monotonic_ns() >= letter.made_ns + kSilenceNs;
      send(is_zeroed ? GatedForce() : letter.force, letter.echo);
      done_.store(letter.number, std::memory_order_release);
    } else if (!wake_.wait(is_zeroed ? kAwakeNs : kSilenceNs) && !is_zeroed) {
      send(GatedForce(), letter.echo);
      is_zeroed = true;
    }
    const std::uint64_t now_ns = monotonic_ns();
    if (now_ns - published_ns_ >= kPublishNs) publish(now_ns);
  }
  say_goodbye();
  publish(monotonic_ns());
}

bool Writer::send(const GatedForce& force, std::uint32_t echo) {
  if (!profile_.has_output) return true;
  Command command;
  command.is_enabled = force.is_enabled() && stall() == 0;  // back from a stall, with a force from before it
  for (int axis = 0; axis < profile_.axis_count && command.is_enabled; ++axis)
    command.effort[axis] = force.effort()[axis];
  command.echo = echo;
  return timed([&] {
    command.sequence = sequence_.fetch_add(1, std::memory_order_relaxed);
    const bool is_taken = transport_.write(report_, encode_output(profile_, command, report_));
    is_pushing_.store(command.is_enabled, std::memory_order_release);
    if (is_taken) sent_.put({began_ns_.load(std::memory_order_relaxed), command.sequence, command.is_enabled});
    return is_taken;
  });
}

// A fixed report begins with its id, or with 0 where the device has none: a transport takes it without that 0.
bool Writer::send_fixed(const FixedReport& report) {
  const int skipped = report.bytes > 0 && report.data[0] == 0 ? 1 : 0;
  return timed([&] {
    return report.is_feature ? transport_.write_feature(report.data + skipped, report.bytes - skipped)
                             : transport_.write(report.data + skipped, report.bytes - skipped);
  });
}

// True also if the device is absent: the reader reports that.
template <class Write>
bool Writer::timed(const Write& write) {
  if (!link_.enter(Link::kWriter)) return true;
  const std::uint64_t began_ns = monotonic_ns();
  began_ns_.store(began_ns);  // in one order with is_muted_: a crash sees this write, or this write sees the crash
  const bool is_sent = is_muted_.load() || write();
  has_failed_.store(!is_sent, std::memory_order_release);  // before it is no longer busy: one of the two is seen
  began_ns_.store(0, std::memory_order_release);
  link_.leave(Link::kWriter);
  ++counts_.writes;
  counts_.failures += !is_sent;
  counts_.write.add(monotonic_ns() - began_ns);
  return is_sent;
}

void Writer::publish(std::uint64_t now_ns) {
  published_ns_ = now_ns;
  status_.put(counts_);
}

void Writer::say_goodbye() {
  const auto has_time = [&] { return monotonic_ns() - stop_ns_.load(std::memory_order_acquire) < kGoodbyeNs; };
  // After a blocked write that the device took in the end it takes this one too.
  bool is_taken = (!has_failed() || has_time()) && send(GatedForce(), 0);
  has_left_zero_.store(is_taken || !link_.is_open(), std::memory_order_release);
  for (int i = 0; i < profile_.safe_stop_count && (is_taken || has_time()); ++i) {
    is_taken = send_fixed(profile_.safe_stop[i]);
  }
}

}  // namespace fdcg::dev
