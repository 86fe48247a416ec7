// SPDX-License-Identifier: Apache-2.0
// What holds for a contender that goes on with a tick's work in the next: it is on the way that the contact model goes in that
// tick, no farther back than it was, and gets on.
#pragma once

#include <cstddef>
#include <vector>

#include "contender.hpp"
#include "truth.hpp"
#include "ways.hpp"

namespace fdcg::test {

enum class OnWay {
  yes,
  no,
  unknown  // it was not where the truth was when it began, a tie leads elsewhere, or the truth is not by brute force
};

class CarriedWay {
 public:
  CarriedWay(const TrueBody& body, const ReferenceFriction& friction, double tie)
      : body_(body), friction_(friction), tie_(tie) {}

  // Of the next tick of the way. Ticks that are not carried are `yes`.
  OnWay next(const Way& way, std::size_t tick, const std::vector<Feel>& felt, const std::vector<TrueBody::Tick>& truth);

 private:
  void begin(const Way& way, std::size_t tick, const std::vector<Feel>& felt, const std::vector<TrueBody::Tick>& truth);
  void go_on(const Ground::Point& hip_m, const Feel& before);
  bool advance(const Feel& felt);

  const TrueBody& body_;
  ReferenceFriction friction_;
  double tie_;
  bool is_known_ = false, is_tied_ = false;
  std::vector<TrueBody::Feature> way_;  // what the model visits until the HIP is reached
  TrueBody::Place end_;                 // of that
  std::size_t at_ = 0;                  // in way_: where the contender was last
  int stayed_ = 0;                      // ticks in a row that it has been there
};

}  // namespace fdcg::test
