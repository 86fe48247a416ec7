// SPDX-License-Identifier: Apache-2.0
#include "hip_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fdcg::test {

HipWalk::HipWalk(const bake::PolygonSoup& soup, std::uint64_t seed) : soup_(soup), random_(seed) {
  Hip low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (std::uint32_t i = 0; i < soup.points.size(); ++i) {
    const Hip p = corner(i);
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    centre_[k] = (low[k] + high[k]) / 2;
    size_ = std::max(size_, (high[k] - low[k]) / 2);
  }
  hip_ = somewhere();
}

Hip HipWalk::corner(std::uint32_t index) const {
  const bake::Vec3& p = soup_.points[index];
  return {p.x, p.y, p.z};
}

std::uint32_t HipWalk::random_corner_slot() {
  return random_.below(static_cast<std::uint32_t>(soup_.corners.size()));
}

Hip HipWalk::somewhere() {
  Hip p = centre_;
  for (double& c : p)
    c += size_ * random_.uniform(-1.3, 1.3);
  return p;
}

void HipWalk::add(Hip& hip, double distance) {
  const bake::Vec3 d = random_.direction();
  hip[0] += distance * d.x;
  hip[1] += distance * d.y;
  hip[2] += distance * d.z;
}

void HipWalk::begin_stretch() {
  habit_ = static_cast<Habit>(random_.below(static_cast<std::uint32_t>(Habit::count)));
  left_ = 1 + random_.below(habit_ == Habit::jumps || habit_ == Habit::goes_home ? 8 : 60);
  anchor_ = random_.chance(0.5) ? hip_ : corner(soup_.corners[random_corner_slot()]);
  const bake::Vec3 d = random_.direction();
  const double speed = size_ * std::pow(10, random_.uniform(-4, -1));
  heading_ = {d.x * speed, d.y * speed, d.z * speed};
}

void HipWalk::put_on_edge(std::uint32_t slot) {
  const auto after_face = std::upper_bound(soup_.face_first.begin(), soup_.face_first.end(), slot);
  const std::uint32_t next = slot + 1 < *after_face ? slot + 1 : *(after_face - 1);
  const Hip a = corner(soup_.corners[slot]), b = corner(soup_.corners[next]);
  const double part = random_.below(5) / 4.0;
  for (std::size_t k = 0; k < 3; ++k)
    hip_[k] = a[k] + part * (b[k] - a[k]);
}

void HipWalk::put_on_face() {
  const std::uint32_t f = random_.below(static_cast<std::uint32_t>(soup_.face_count()));
  const std::uint32_t first = soup_.face_first[f], last = soup_.face_first[f + 1];
  hip_ = {};
  for (std::uint32_t i = first; i < last; ++i) {
    const Hip p = corner(soup_.corners[i]);
    for (std::size_t k = 0; k < 3; ++k)
      hip_[k] += p[k] / (last - first);
  }
}

Hip HipWalk::next(const Hip& god_object) {
  if (left_ == 0) begin_stretch();
  --left_;
  if (habit_ == Habit::hovers_about_god_object) hip_ = god_object;
  move();
  const bool keeps = habit_ == Habit::holds || habit_ == Habit::creeps;
  const bool is_put = habit_ >= Habit::meets_corners && habit_ <= Habit::goes_home;
  is_on_feature_ = is_put || (keeps && is_on_feature_);
  return hip_;
}

void HipWalk::move() {
  const std::uint32_t slot = random_corner_slot();
  switch (habit_) {
    case Habit::strolls:
      add(hip_, size_ * std::pow(10, random_.uniform(-4, -1)));
      for (std::size_t k = 0; k < 3; ++k) {  // home again from far outside
        if (std::abs(hip_[k] - centre_[k]) > 1.5 * size_) hip_[k] = centre_[k];
      }
      break;
    case Habit::creeps:
      add(hip_, size_ * 1e-12);
      break;
    case Habit::hovers_about_god_object:
      add(hip_, size_ * std::pow(10, random_.uniform(-6, -1)));
      break;
    case Habit::presses:
      for (std::size_t k = 0; k < 3; ++k)
        hip_[k] += heading_[k];
      break;
    case Habit::trembles:
      hip_ = anchor_;
      add(hip_, size_ * 0.002 * random_.unit());
      break;
    case Habit::jumps:
      hip_ = somewhere();
      break;
    case Habit::meets_corners:
      hip_ = corner(soup_.corners[slot]);
      break;
    case Habit::meets_edges:
      put_on_edge(slot);
      break;
    case Habit::meets_faces:
      put_on_face();
      break;
    case Habit::meets_planes:
      add(hip_, size_ * 0.03);
      hip_[slot % 3] = corner(soup_.corners[slot])[slot % 3];
      break;
    case Habit::goes_home:
      hip_ = left_ % 2 == 0 ? corner(soup_.corners[slot]) : anchor_;
      break;
    case Habit::rounds:
      add(hip_, size_ * 0.003);
      for (double& c : hip_)
        c = std::round(c / (size_ * 0x1p-10)) * (size_ * 0x1p-10);
      break;
    case Habit::holds:
    case Habit::count:
      break;
  }
}

}  // namespace fdcg::test
