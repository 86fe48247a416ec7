// SPDX-License-Identifier: Apache-2.0
#include "session_frames.hpp"

#include <algorithm>
#include <cmath>

namespace fdcg::page {
namespace {

constexpr std::size_t kPoseNumbers = 7;
constexpr std::size_t kPeak = 6;
constexpr std::uint32_t kSlip = 4, kFaultShift = 5;

void put(std::vector<float>& numbers, const double (&values)[3]) {
  for (const double value : values)
    numbers.push_back(static_cast<float>(value));
}

double square(const double (&v)[3]) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

// Of the contact that pushes most: what the device feels.
const dev::ViewedContact& strongest(const dev::ViewedTick& view) {
  return *std::max_element(view.contacts.begin(), view.contacts.end(), [](const auto& a, const auto& b) {
    return std::pair(a.state != 0, square(a.force_n)) < std::pair(b.state != 0, square(b.force_n));
  });
}

std::vector<float> numbers_of(const dev::ViewedTick& view) {
  std::vector<float> numbers;
  put(numbers, view.wanted_force_n);
  put(numbers, view.sent_force_n);
  numbers.push_back(static_cast<float>(std::sqrt(square(view.wanted_force_n))));
  for (const dev::ViewedContact& contact : view.contacts) {
    put(numbers, contact.hip_m);
    put(numbers, contact.god_object_m);
    put(numbers, contact.force_n);
    put(numbers, contact.normal);
  }
  return numbers;
}

std::vector<std::uint32_t> words_of(const dev::ViewedTick& view) {
  const dev::ViewedContact& felt = strongest(view);
  std::vector<std::uint32_t> words{felt.state | felt.slipping << 2 | view.phase << 3 | view.fault << kFaultShift};
  for (const dev::ViewedContact& contact : view.contacts)
    words.push_back(contact.state | contact.slipping << 2 | static_cast<std::uint32_t>(contact.object) << 3);
  return words;
}

// The later of two frames takes in what the earlier one had for a moment: the largest force, slip, a fault.
void take_in(float* numbers, std::uint32_t* word, const float* earlier, std::uint32_t earlier_word) {
  numbers[kPeak] = std::max(numbers[kPeak], earlier[kPeak]);
  *word |= earlier_word & kSlip;
  if (*word >> kFaultShift == 0) *word |= earlier_word >> kFaultShift << kFaultShift;
}

// Of records of `size` every second one, the last of each pair; an odd one at the end stays.
template <class T>
void keep_every_second(std::vector<T>& records, std::size_t size) {
  if (size == 0) return;
  const std::size_t count = records.size() / size;
  std::size_t kept = 0;
  for (std::size_t i = 1; i < count + count % 2; i += 2, ++kept) {
    const std::size_t from = std::min(i, count - 1);
    std::copy_n(records.begin() + static_cast<std::ptrdiff_t>(from * size), size,
                records.begin() + static_cast<std::ptrdiff_t>(kept * size));
  }
  records.resize(kept * size);
}

}  // namespace

WorldFrames::WorldFrames(const dev::ViewedScene& scene, std::size_t world) {
  for (std::size_t i = 0; i < scene.devices.size(); ++i) {
    if (scene.devices[i].world != world) continue;
    if (devices_.empty()) first_device_ = i;
    devices_.emplace_back();
    devices_.back().contacts = scene.devices[i].pads_m.size();
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const dev::ViewedMotion motion = scene.objects[i].motion;
    if (motion == dev::ViewedMotion::kMoved || motion == dev::ViewedMotion::kBody) moving_.push_back(i);
  }
}

void WorldFrames::add(const dev::ViewedTick& view) {
  const std::size_t place = view.device - first_device_;
  const bool is_first = place == 0, is_last = place + 1 == devices_.size();
  const bool is_new = ticks_ % ticks_per_frame_ == 0;
  if (is_first && is_new) begin_frame(view);
  DeviceFrames& device = devices_[place];
  std::vector<float> numbers = numbers_of(view);
  std::vector<std::uint32_t> words = words_of(view);
  if (!is_new) {
    const std::size_t at = device.numbers.size() - numbers.size(), word = device.words.size() - words.size();
    take_in(numbers.data(), words.data(), device.numbers.data() + at, device.words[word]);
    device.numbers.resize(at);
    device.words.resize(word);
  }
  device.numbers.insert(device.numbers.end(), numbers.begin(), numbers.end());
  device.words.insert(device.words.end(), words.begin(), words.end());
  if (!is_last) return;
  time_s_.back() = view.t_s;
  set_poses(view);
  add_soft(view);
  ++ticks_;
  if (time_s_.size() > kMostFrames && ticks_ % ticks_per_frame_ == 0) halve();
}

void WorldFrames::begin_frame(const dev::ViewedTick& view) {
  time_s_.push_back(view.t_s);
  poses_.resize(poses_.size() + kPoseNumbers * moving_.size());
}

void WorldFrames::set_poses(const dev::ViewedTick& view) {
  float* to = poses_.data() + poses_.size() - kPoseNumbers * moving_.size();
  for (const std::size_t object : moving_) {
    const fdcg_pose& pose = view.poses[object];
    for (const double x : pose.translation_m)
      *to++ = static_cast<float>(x);
    for (const double x : pose.rotation_xyzw)
      *to++ = static_cast<float>(x);
  }
}

void WorldFrames::add_soft(const dev::ViewedTick& view) {
  if (soft_.empty()) {
    for (const dev::ViewedSoft& from : view.soft) {
      soft_.emplace_back();
      soft_.back().object = from.object;
      soft_.back().corners = from.corners;
    }
  }
  for (std::size_t i = 0; i < soft_.size(); ++i) {
    SoftFrames& soft = soft_[i];
    if (ticks_ % soft.every != 0) continue;
    soft.time_s.push_back(view.t_s);
    for (std::size_t corner = 0; corner < soft.corners; ++corner)
      put(soft.moved_m, view.soft[i].moved_m[corner]);
    if (soft.moved_m.size() * sizeof(float) <= kMostSoftBytes || soft.time_s.size() < 2) continue;
    keep_every_second(soft.time_s, 1);
    keep_every_second(soft.moved_m, 3 * soft.corners);
    soft.every *= 2;
  }
}

void WorldFrames::halve() {
  for (DeviceFrames& device : devices_) {
    const std::size_t numbers = kDeviceNumbers + kContactNumbers * device.contacts, words = 1 + device.contacts;
    for (std::size_t i = 1; i < time_s_.size(); i += 2)
      take_in(device.numbers.data() + i * numbers, device.words.data() + i * words, device.numbers.data() + (i - 1) * numbers,
              device.words[(i - 1) * words]);
    keep_every_second(device.numbers, numbers);
    keep_every_second(device.words, words);
  }
  keep_every_second(poses_, kPoseNumbers * moving_.size());
  keep_every_second(time_s_, 1);
  ticks_per_frame_ *= 2;
}

}  // namespace fdcg::page
