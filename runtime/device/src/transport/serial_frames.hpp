// SPDX-License-Identifier: Apache-2.0
// Reports on a serial line: frames of bytes (fdcg_cobs.h), or lines of text where the profile's reports are text. Pure; no
// heap.
#pragma once

#include <cstdint>

#include "profile/profile.hpp"

namespace fdcg::dev {

inline constexpr int kMaxFrameBytes = 2 * kMaxReportBytes + 8;

// What ends a frame.
inline std::uint8_t frame_end(bool is_text) {
  return is_text ? '\n' : 0;
}
// The bytes of a report as they go over the line, after an end: so that what was cut off before it is no part of it. Returns
// how many; frame has room for kMaxFrameBytes.
int make_frame(bool is_text, const std::uint8_t* report, int bytes, std::uint8_t* frame);

// Takes bytes as they come and gives reports.
class FrameReader {
 public:
  explicit FrameReader(bool is_text) : is_text_(is_text) {}
  void clear() { bytes_ = read_ = 0; }
  // Room for what is read next; never none after next() was false.
  std::uint8_t* room() { return data_ + bytes_; }
  int room_bytes() const { return kMaxFrameBytes - bytes_; }
  void added(int bytes) { bytes_ += bytes; }
  // The next whole report, of at least a byte. What is no frame comes as what it is, for the judge to count; what is too long
  // for a report as kMaxReportBytes + 1 bytes, of which capacity are written. False: none is there yet.
  bool next(std::uint8_t* report, int capacity, int* bytes);

 private:
  bool is_text_;
  std::uint8_t data_[kMaxFrameBytes];
  int bytes_ = 0, read_ = 0;
  bool is_too_long_ = false;
};

}  // namespace fdcg::dev
