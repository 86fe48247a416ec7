// SPDX-License-Identifier: Apache-2.0
#include "transport/serial_frames.hpp"

#include <algorithm>
#include <cstring>

#include "fdcg_cobs.h"

namespace fdcg::dev {

static_assert(kMaxFrameBytes >= static_cast<int>(FDCG_COBS_FRAME_BYTES(kMaxReportBytes)) + 1);

int make_frame(bool is_text, const std::uint8_t* report, int bytes, std::uint8_t* frame) {
  frame[0] = frame_end(is_text);
  if (!is_text) return 1 + static_cast<int>(fdcg_cobs_encode(report, static_cast<std::size_t>(bytes), frame + 1));
  std::copy_n(report, bytes, frame + 1);
  return 1 + bytes;
}

bool FrameReader::next(std::uint8_t* report, int capacity, int* bytes) {
  for (;;) {
    const std::uint8_t* const begin = data_ + read_;
    const auto* const end =
        static_cast<const std::uint8_t*>(std::memchr(begin, frame_end(is_text_), static_cast<std::size_t>(bytes_ - read_)));
    if (end == nullptr) break;
    const int length = static_cast<int>(end - begin);
    read_ += length + 1;
    const bool was_too_long = is_too_long_;
    is_too_long_ = false;
    if (length == 0 && !was_too_long) continue;  // between two ends
    if (was_too_long || (is_text_ && length > kMaxReportBytes)) {
      *bytes = kMaxReportBytes + 1;
      std::memset(report, 0, static_cast<std::size_t>(capacity));
      return true;
    }
    const auto room = static_cast<std::size_t>(std::min(capacity, kMaxReportBytes));
    std::size_t decoded = is_text_ ? 0 : fdcg_cobs_decode(begin, static_cast<std::size_t>(length), report, room);
    if (decoded == 0) {
      decoded = std::min(static_cast<std::size_t>(length), room);
      std::memcpy(report, begin, decoded);
    }
    *bytes = static_cast<int>(decoded);
    return true;
  }
  if (read_ == 0 && bytes_ == kMaxFrameBytes) {
    is_too_long_ = true;
    bytes_ = 0;
  }
  std::memmove(data_, data_ + read_, static_cast<std::size_t>(bytes_ - read_));
  bytes_ -= read_;
  read_ = 0;
  return false;
}

}  // namespace fdcg::dev
