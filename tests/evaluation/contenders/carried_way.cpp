// SPDX-License-Identifier: Apache-2.0
#include "carried_way.hpp"

#include "point.hpp"

namespace fdcg::test {

using namespace plain;

namespace {

constexpr int kMostStayed = 20;  // ticks; work that gets no farther is no work

}  // namespace

OnWay CarriedWay::next(const Way& way, std::size_t tick, const std::vector<Feel>& felt,
                       const std::vector<TrueBody::Tick>& truth) {
  if (!felt[tick].is_carried) {
    is_known_ = false;
    return OnWay::yes;
  }
  if (tick == 0 || !felt[tick - 1].is_carried) {
    begin(way, tick, felt, truth);
  } else if (is_known_ && way[tick] != end_.hip) {
    go_on(way[tick], felt[tick - 1]);
  }
  if (!is_known_) return OnWay::unknown;
  if (advance(felt[tick])) return OnWay::yes;
  is_known_ = false;
  return is_tied_ ? OnWay::unknown : OnWay::no;
}

void CarriedWay::begin(const Way& way, std::size_t tick, const std::vector<Feel>& felt,
                       const std::vector<TrueBody::Tick>& truth) {
  const bool was_there = tick > 0 && length(felt[tick - 1].god_object - truth[tick - 1].feel.god_object) < kApart_m;
  is_known_ = body_.can_visit() && was_there && !truth[tick].visit.features.empty();
  if (!is_known_) return;
  way_ = truth[tick].visit.features;
  is_tied_ = truth[tick].visit.margin < tie_;
  end_ = {{truth[tick].state, truth[tick].feature}, truth[tick].feel.god_object, way[tick]};
  at_ = 0;
  stayed_ = 0;
}

// The HIP has moved meanwhile. On the surface the god-object turns to where it is now; a way through free space goes to its end
// first.
void CarriedWay::go_on(const Point& hip_m, const Feel& before) {
  std::vector<TrueBody::Feature> rest;
  if (before.in_contact) {
    end_ = {way_[at_], before.god_object, end_.hip};
  } else {
    rest.assign(way_.begin() + static_cast<std::ptrdiff_t>(at_), way_.end());
  }
  const TrueBody::Visit more = body_.visit(&end_, hip_m, friction_);
  is_tied_ = is_tied_ || more.margin < tie_;
  rest.insert(rest.end(), more.features.begin(), more.features.end());
  way_ = std::move(rest);
  at_ = 0;
}

bool CarriedWay::advance(const Feel& felt) {
  for (std::size_t k = at_; k < way_.size(); ++k) {
    const auto& [state, feature] = way_[k];
    const bool is_here = state == FDCG_FREE ? !felt.in_contact
                                            : felt.in_contact && body_.distance_to(state, feature, felt.god_object) < kApart_m;
    if (!is_here) continue;
    stayed_ = k > at_ ? 0 : stayed_ + 1;
    at_ = k;
    return stayed_ < kMostStayed;
  }
  return false;
}

}  // namespace fdcg::test
