// SPDX-License-Identifier: Apache-2.0
#include "stress_run.hpp"

#include <bit>
#include <cstring>
#include <stdexcept>

#include "squashed.hpp"

namespace fdcg::test {
namespace {

constexpr double kHoldAgain = 0.05;  // ticks whose HIP is held once more

std::uint64_t hashed(std::uint64_t hash, const fdcg_contact& contact, const fdcg_result& result) {
  for (const double x : contact.god_object)
    hash = mixed(hash, std::bit_cast<std::uint64_t>(x));
  for (const double x : result.force_n)
    hash = mixed(hash, std::bit_cast<std::uint64_t>(x));
  hash = mixed(hash, std::uint64_t{result.state} << 32 | result.feature);
  return mixed(hash, std::uint64_t{result.transitions} << 32 | result.flags << 8 | result.slipping);
}

std::uint64_t seed_of(const BlockName& name, std::uint64_t number) {
  std::uint64_t hash = mixed(name.seed, static_cast<std::uint64_t>(name.precision));
  for (const char c : name.stress_case->name)
    hash = mixed(hash, static_cast<unsigned char>(c));
  return mixed(hash, number);
}

// One block as it goes.
class Block {
 public:
  Block(const BlockName& name, const Specimen& specimen, const OnFinding& found)
      : name_(name),
        specimen_(specimen),
        found_(found),
        random_(seed_of(name, name.block)),
        hand_(specimen, random_.bits()),
        judge_(specimen, name.stress_case->owes_force) {
    path_.reserve(2 * Hand::kMostTicks);
  }

  BlockResult run() {
    while (result_.ticks < kBlockTicks)
      episode();
    return result_;
  }

 private:
  void episode() {
    const auto& motions = name_.stress_case->motions;
    const std::uint32_t ticks = hand_.begin(motions[random_.below(static_cast<std::uint32_t>(motions.size()))]);
    const auto& drawn = kFrictionPairs[random_.below(std::size(kFrictionPairs))];
    const auto& mu = name_.variation.is_frictionless ? kFrictionPairs[0] : drawn;
    params_ = contact_params(mu[0], mu[1], random_.chance(0.8) ? FDCG_EDGE_WEDGE : FDCG_EDGE_PAPER);
    contact_ = {};
    path_.clear();
    judge_.begin(params_);
    for (std::uint32_t i = 0; i < ticks && result_.ticks < kBlockTicks; ++i) {
      const Hip hip =
          hand_.next({contact_.god_object[0], contact_.god_object[1], contact_.god_object[2]}, contact_.state == FDCG_FREE);
      tick(hip);
      if (random_.chance(kHoldAgain) && result_.ticks < kBlockTicks) tick(hip);
    }
  }

  void tick(const Hip& hip_m) {
    path_.push_back(hip_m);
    const fdcg_contact before = contact_;
    fdcg_result out;
    fdcg_step(&specimen_.graph(), &params_, &contact_, hip_m.data(), &out);
    const std::uint32_t faults = judge_.judge(before, hip_m, contact_, out, result_.verdicts);
    ++result_.ticks;
    result_.contact_ticks += out.state != FDCG_FREE;
    result_.transitions += out.transitions;
    result_.hash = hashed(result_.hash, contact_, out);
    if (faults != 0) report(faults);
    if ((out.flags & FDCG_RESULT_TRANSITION_BOUND) != 0) look_where_work_ends(hip_m);
  }

  // Work that was carried over, on a copy: the HIP held, until it is done or the judge says that it never will be.
  void look_where_work_ends(const Hip& hip_m) {
    constexpr int kMostHeld = 8;
    const std::size_t ticks = path_.size();
    Judge judge = judge_;
    fdcg_contact contact = contact_;
    Verdicts verdicts;
    bool is_stalled = false;
    for (int i = 0; (i < kMostHeld || judge.is_slow()) && !is_stalled; ++i) {
      const fdcg_contact before = contact;
      fdcg_result out;
      fdcg_step(&specimen_.graph(), &params_, &contact, hip_m.data(), &out);
      path_.push_back(hip_m);
      is_stalled = (judge.judge(before, hip_m, contact, out, verdicts) & bit(Fault::stalled)) != 0;
      if ((out.flags & FDCG_RESULT_TRANSITION_BOUND) == 0) break;
    }
    if (is_stalled) {
      ++result_.verdicts.count[static_cast<std::size_t>(Fault::stalled)];
      report(bit(Fault::stalled));
    }
    path_.resize(ticks);
  }

  void report(std::uint32_t faults) {
    constexpr std::uint32_t kRules = 1u << static_cast<unsigned>(Fault::rule_bound);
    constexpr std::uint32_t kSweeps = 1u << static_cast<unsigned>(Fault::sweep_bound);
    const StressCase& c = *name_.stress_case;
    const std::uint32_t allowed = !c.may_carry ? 0 : c.owes_force ? kRules : kRules | kSweeps;
    result_.bounds_allowed += static_cast<std::uint64_t>(std::popcount(faults & allowed));
    faults &= ~allowed;
    for (std::size_t i = 0; i < kFaults; ++i) {
      if ((faults >> i & 1) != 0) found_({name_, static_cast<Fault>(i), result_.ticks - 1, &specimen_, params_, &path_});
    }
  }

  BlockName name_;
  const Specimen& specimen_;
  const OnFinding& found_;
  Random random_;
  Hand hand_;
  Judge judge_;
  fdcg_params params_{};
  fdcg_contact contact_{};
  std::vector<Hip> path_;
  BlockResult result_;
};

}  // namespace

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15u;
  return hash ^ hash >> 29;
}

void BlockResult::add(const BlockResult& other) {
  ticks += other.ticks;
  contact_ticks += other.contact_ticks;
  transitions += other.transitions;
  bounds_allowed += other.bounds_allowed;
  hash = mixed(hash, other.hash);
  verdicts.add(other.verdicts);
}

std::shared_ptr<const Specimen> SpecimenShelf::get(const BlockName& name) {
  const std::uint64_t key = seed_of(name, ~(name.block / name.stress_case->blocks_per_body));
  if (!has_made_ || key != key_) {
    Random random(key);
    last_.reset();
    has_made_ = true;
    key_ = key;
    Body body = name.stress_case->make(random, name.precision);
    const Variation& v = name.variation;
    if (v.stretch != 1) {
      body.soup = stretched(body.soup, v.axis, v.stretch);
      body.description += ", axis " + std::to_string(v.axis) + " times " + std::to_string(v.stretch);
    }
    try {
      last_ = std::make_shared<const Specimen>(std::move(body));
    } catch (const std::runtime_error&) {
      if (v.stretch == 1) throw;
    }
  }
  return last_;
}

BlockResult run_block(const BlockName& name, const Specimen& specimen, const OnFinding& found) {
  return Block(name, specimen, found).run();
}

}  // namespace fdcg::test
