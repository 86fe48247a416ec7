// SPDX-License-Identifier: Apache-2.0
// A session frame by frame, as a page has it: at first a frame a tick; where that becomes too many, a frame is two ticks, four,
// and so on. What lasted a tick only is then still seen: a frame has the largest force, and slip and faults of any of its
// ticks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fdcg/session_view.hpp"

namespace fdcg::page {

inline constexpr std::size_t kMostFrames = 60'000;
inline constexpr std::size_t kMostSoftBytes = 24'000'000;  // of all samples of one soft object

// Numbers of a device's frame, before those of its contacts: the scene's force, the force sent, the largest size of the former.
inline constexpr std::size_t kDeviceNumbers = 7;
// Of a contact: HIP, god-object, force, normal.
inline constexpr std::size_t kContactNumbers = 12;

struct DeviceFrames {
  std::size_t contacts = 0;
  std::vector<float> numbers;
  // A word of the device: state, slip << 2, phase << 3, fault << 5; and one of each contact: state, slip << 2, object << 3.
  std::vector<std::uint32_t> words;
};

// The positions of a soft object's corners, from their places; of some frames.
struct SoftFrames {
  std::size_t object = 0, corners = 0;
  std::uint64_t every = 16;  // ticks
  std::vector<double> time_s;
  std::vector<float> moved_m;
};

// Of devices that feel one scene.
class WorldFrames {
 public:
  WorldFrames(const dev::ViewedScene& scene, std::size_t world);

  // Views of the world's devices in their order, tick by tick.
  void add(const dev::ViewedTick& view);

  [[nodiscard]] std::size_t first_device() const { return first_device_; }
  [[nodiscard]] std::uint64_t ticks_per_frame() const { return ticks_per_frame_; }
  [[nodiscard]] const std::vector<double>& time_s() const { return time_s_; }
  [[nodiscard]] const std::vector<DeviceFrames>& devices() const { return devices_; }
  [[nodiscard]] const std::vector<std::size_t>& moving() const { return moving_; }  // objects
  [[nodiscard]] const std::vector<float>& poses() const { return poses_; }  // of those: translation, rotation x, y, z, w
  [[nodiscard]] const std::vector<SoftFrames>& soft() const { return soft_; }

 private:
  void begin_frame(const dev::ViewedTick& view);
  void set_poses(const dev::ViewedTick& view);
  void add_soft(const dev::ViewedTick& view);
  void halve();

  std::size_t first_device_ = 0;
  std::uint64_t ticks_ = 0, ticks_per_frame_ = 1;
  std::vector<double> time_s_;
  std::vector<DeviceFrames> devices_;
  std::vector<std::size_t> moving_;
  std::vector<float> poses_;
  std::vector<SoftFrames> soft_;
};

}  // namespace fdcg::page
