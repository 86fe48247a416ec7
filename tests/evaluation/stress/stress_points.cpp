// SPDX-License-Identifier: Apache-2.0
#include "stress_points.hpp"

#include "pointed_bodies.hpp"

namespace fdcg::test {

Body pointed_bodies(Random& random, bake::Precision precision) {
  constexpr int kSides[] = {100, 200, 500, 1000, 3000, 10'000};
  const PointedKind kind = kPointedKinds[random.below(std::size(kPointedKinds))];
  const int sides = kSides[random.below(std::size(kSides))];
  PointedBody pointed = pointed_body(kind, sides, random_rotation(random.bits()));
  Body body;
  constexpr std::uint32_t kMostTips = 20;
  for (std::uint32_t i = 0; i < kMostTips && i < pointed.tips.size(); ++i) {
    const Hip& tip = pointed.tips[random.below(static_cast<std::uint32_t>(pointed.tips.size()))].point;
    for (std::uint32_t v = 0; v < pointed.soup.points.size(); ++v) {
      const Vec3& p = pointed.soup.points[v];
      if (p.x == tip[0] && p.y == tip[1] && p.z == tip[2]) body.focus.push_back(v);
    }
  }
  body.options.precision = precision;
  body.options.coplanar.kind = bake::Coplanar::Kind::exact;
  body.options.merge = random.chance(0.5);
  body.options.store_planes = random.chance(0.5);
  body.options.jobs = 1;
  body.options.without = {"source-map", "info"};
  body.description = std::string(name_of(kind)) + ", " + std::to_string(sides) + " sides, turned" +
                     (body.options.merge ? ", merged" : "") + (body.options.store_planes ? "" : ", planes derived");
  body.soup = std::move(pointed.soup);
  return body;
}

}  // namespace fdcg::test
