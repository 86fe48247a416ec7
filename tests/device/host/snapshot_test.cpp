// SPDX-License-Identifier: Apache-2.0
// Snapshots: each tick once and in order, what is in them, and that one who does not take them holds nothing up.
#include "base/ring.hpp"

#include <thread>

#include "catch.hpp"
#include "hosted.hpp"

using namespace fdcg::dev;
using namespace fdcg::dev::test;

namespace {

std::vector<fdcg_snapshot> taken(Host& host, std::size_t most = 100'000) {
  std::vector<fdcg_snapshot> all, some(97);
  for (std::size_t count = 1; count > 0 && all.size() < most;) {
    count = host.take_snapshots(0, some.data(), some.size());
    all.insert(all.end(), some.begin(), some.begin() + static_cast<long>(count));
  }
  return all;
}

}  // namespace

TEST_CASE("snapshots: every tick once, with contact, force and energy") {
  Hosted hosted;
  REQUIRE(hosted.host.open(hosted.config) == "");
  hosted.host.keep_snapshots(100'000);
  REQUIRE(hosted.host.start() == "");
  REQUIRE(within_ms(5000, [&] { return hosted.device().echo > 2; }));
  hosted.press();
  sleep_ms(50);
  REQUIRE(hosted.host.stop() == "");
  const std::vector<fdcg_snapshot> all = taken(hosted.host);
  REQUIRE(all.size() > 200);
  CHECK(hosted.host.dropped_snapshots(0) == 0);
  std::size_t pressed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const fdcg_snapshot& one = all[i];
    REQUIRE(one.tick == i);
    if (i > 0) REQUIRE(one.time_s >= all[i - 1].time_s);
    REQUIRE(one.contact_count == 1);
    const fdcg_snapshot_contact& contact = one.contacts[0];
    CHECK((contact.object == -1) == (contact.state == FDCG_FREE));
    if (contact.state == FDCG_FREE) continue;
    CHECK(contact.object == 0);
    for (int k = 0; k < 3; ++k)
      CHECK(contact.force_n[k] == one.wanted_force_n[k]);  // the only one
    CHECK(contact.hip_m[2] == one.tip_world_m[2]);
    CHECK(contact.god_object_m[2] >= contact.hip_m[2]);
    pressed += one.phase == FDCG_ARMED && one.force_n[2] > 0.1 && one.given_j <= 0;
  }
  CHECK(pressed > 10);
}

TEST_CASE("snapshots: nobody takes them, and the loop goes on; without being asked for there are none") {
  Hosted hosted;
  REQUIRE(hosted.host.open(hosted.config) == "");
  hosted.host.keep_snapshots(8);
  REQUIRE(hosted.host.start() == "");
  REQUIRE(within_ms(20'000, [&] { return hosted.host.status(0).counters.ticks > 300; }));
  REQUIRE(hosted.host.stop() == "");
  CHECK(taken(hosted.host).size() == 8);
  CHECK(hosted.host.dropped_snapshots(0) > 200);
  Hosted plain;
  plain.start();
  sleep_ms(50);
  REQUIRE(plain.host.stop() == "");
  CHECK(taken(plain.host).empty());
  CHECK(plain.host.dropped_snapshots(0) == 0);
  CHECK(plain.host.take_snapshots(7, nullptr, 3) == 0);
}

TEST_CASE("ring: a million values from one thread to another arrive whole and in order, or are counted as dropped") {
  struct Value {
    std::uint64_t first = 0, padding[9] = {}, last = 0;
  };
  constexpr std::uint64_t kCount = 1'000'000;
  Ring<Value> ring;
  ring.resize(64);
  std::thread sender([&] {
    for (std::uint64_t i = 1; i <= kCount; ++i) {
      Value* const slot = ring.next();
      if (slot == nullptr) continue;
      slot->first = slot->last = i;
      ring.put();
    }
  });
  std::uint64_t last = 0, seen = 0;
  Value values[17];
  const auto take = [&] {
    const std::size_t count = ring.take(values, 17);
    for (std::size_t i = 0; i < count; ++i) {
      REQUIRE(values[i].first == values[i].last);
      REQUIRE(values[i].first > last);
      last = values[i].first;
    }
    seen += count;
    return count;
  };
  while (seen + ring.dropped() < kCount)
    take();
  sender.join();
  while (take() > 0) {
  }
  CHECK(seen + ring.dropped() == kCount);
}
