// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "validate/check_rules.hpp"
#include "validate/self_intersection.hpp"

namespace fdcg::bake::checks {

void self_intersection(const Subject& subject, Findings& out) {
  const SelfIntersections found = find_self_intersections(
      subject.mesh, subject.geometry, {out.max_elements(), subject.jobs, subject.progress, &subject.topology});
  // The part of the search in which the limit was reached goes beyond it.
  const std::uint64_t counted = found.crossing + found.touching;
  const std::uint64_t total = found.has_more ? std::min(counted, kMostMeetingPairs) : counted;
  const std::size_t listed = std::min<std::uint64_t>(found.listed.size(), total);
  for (std::size_t i = 0; i < listed; ++i)
    out.at_pair(found.listed[i].a, found.listed[i].b, found.listed[i].point);
  out.count_more(total - listed);
  const std::string remedy = ". " + std::string(find_rule("self-intersection")->remedy);
  if (found.has_more) {
    out.say_at_least("at least " + std::to_string(total) + " pairs of faces meet, where the count ends" + remedy);
  } else if (total == 1) {
    out.say((found.crossing == 1 ? "1 pair of faces meets: they cross" : "1 pair of faces meets: they only touch") + remedy);
  } else if (total > 1) {
    out.say(std::to_string(total) + " pairs of faces meet: " + std::to_string(found.crossing) + " cross, " +
            std::to_string(found.touching) + " only touch" + remedy);
  }
}

}  // namespace fdcg::bake::checks
