// SPDX-License-Identifier: Apache-2.0
// A device on a serial line: its profile's reports in frames, or as lines of text (serial_frames.hpp). One descriptor: reads
// and writes of a terminal do not hinder each other. By termios: libserialport does not open a pseudo-terminal, which is what
// firmware on a computer, and the tests, stand behind.
#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "base/threads.hpp"
#include "transport/device_claim.hpp"
#include "transport/serial_frames.hpp"
#include "transport/transports.hpp"

namespace fdcg::dev {

namespace {

constexpr std::uint64_t kMs = 1'000'000;
constexpr int kMostReads = 16;  // of bytes that make no report, in one call: noise holds nobody up
constexpr std::uint64_t kLongestWriteNs = 5000 * kMs;

struct Speed {
  int baud;
  speed_t speed;
};
constexpr Speed kSpeeds[] = {{9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
                             {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
                             {921600, B921600},   {1000000, B1000000}, {1500000, B1500000}, {2000000, B2000000},
                             {3000000, B3000000}, {4000000, B4000000}};

class SerialTransport final : public Transport {
 public:
  SerialTransport(const Profile& profile, SerialAccess access)
      : profile_(profile), access_(std::move(access)), frames_(profile.input.is_text()) {}
  ~SerialTransport() override { SerialTransport::close(); }

  std::string open() override;
  void close() override;
  ReadResult read(std::uint8_t* data, int capacity, int timeout_ms) override;
  bool write(const std::uint8_t* data, int bytes) override;
  bool write_feature(const std::uint8_t*, int) override { return false; }
  EmergencyCall emergency_call() const override { return {send_emergency, const_cast<SerialTransport*>(this)}; }

 private:
  static void send_emergency(void* self, const std::uint8_t* report, int bytes);
  std::string set_up() const;
  std::string send_init();
  std::string problem(const std::string& what) const { return access_.port + ": " + what + ": " + std::strerror(errno); }

  const Profile profile_;
  const SerialAccess access_;
  DeviceClaim claim_;
  std::atomic<int> descriptor_{-1};
  FrameReader frames_;
  std::uint8_t frame_[kMaxFrameBytes];  // the writer's
};

std::string SerialTransport::open() {
  if (std::string claimed = claim_.take(access_.port); !claimed.empty()) return claimed;
  const int descriptor = ::open(access_.port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  descriptor_.store(descriptor);
  std::string failure = descriptor < 0 ? problem("cannot be opened") : set_up();
  if (failure.empty()) {
    frames_.clear();
    failure = send_init();
  }
  if (!failure.empty()) close();
  return failure;
}

// Bytes as they are, eight of them, no flow control.
std::string SerialTransport::set_up() const {
  const int descriptor = descriptor_.load();
  termios line{};
  if (tcgetattr(descriptor, &line) != 0) return problem("is no serial line");
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
  const auto* const speed =
      std::find_if(std::begin(kSpeeds), std::end(kSpeeds), [this](const Speed& s) { return s.baud == access_.baud; });
  if (cfsetispeed(&line, speed->speed) != 0 || cfsetospeed(&line, speed->speed) != 0 ||
      tcsetattr(descriptor, TCSANOW, &line) != 0)
    return problem("does not take " + std::to_string(access_.baud) + " baud");
  tcflush(descriptor, TCIOFLUSH);  // what came before is old
  return {};
}

std::string SerialTransport::send_init() {
  for (int i = 0; i < profile_.init_count; ++i) {
    const FixedReport& report = profile_.init[i];
    const int skipped = report.data[0] == 0 ? 1 : 0;
    if (report.is_feature || !write(report.data + skipped, report.bytes - skipped))
      return access_.port + ": init report " + std::to_string(i + 1) + " of the profile was not taken" +
             (report.is_feature ? ": a serial line has no feature reports" : "; is it the right port?");
  }
  return {};
}

void SerialTransport::close() {
  if (const int descriptor = descriptor_.exchange(-1); descriptor >= 0) ::close(descriptor);
  claim_.release();
}

ReadResult SerialTransport::read(std::uint8_t* data, int capacity, int timeout_ms) {
  const int descriptor = descriptor_.load();
  const std::uint64_t until_ns = timeout_ms > 0 ? monotonic_ns() + static_cast<std::uint64_t>(timeout_ms) * kMs : 0;
  for (int bytes = 0, reads = 0;;) {
    if (frames_.next(data, capacity, &bytes)) return {ReadStatus::kReport, bytes};
    const ssize_t got = ::read(descriptor, frames_.room(), static_cast<std::size_t>(frames_.room_bytes()));
    if (got > 0) {
      frames_.added(static_cast<int>(got));
      if (++reads == kMostReads) return {};
      continue;
    }
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) return {ReadStatus::kLost, 0};
    const std::uint64_t now_ns = timeout_ms > 0 ? monotonic_ns() : 0;
    if (now_ns >= until_ns) return {};
    const timespec left{static_cast<time_t>((until_ns - now_ns) / 1'000'000'000),
                        static_cast<long>((until_ns - now_ns) % 1'000'000'000)};
    pollfd wanted{descriptor, POLLIN, 0};
    if (ppoll(&wanted, 1, &left, nullptr) > 0 && (wanted.revents & POLLIN) == 0) return {ReadStatus::kLost, 0};
  }
}

bool SerialTransport::write(const std::uint8_t* data, int bytes) {
  const int descriptor = descriptor_.load();
  if (bytes <= 0 || bytes > kMaxReportBytes) return false;
  const int count = make_frame(profile_.output.is_text(), data, bytes, frame_);
  const std::uint64_t until_ns = monotonic_ns() + kLongestWriteNs;
  for (int sent = 0; sent < count;) {
    const ssize_t put = ::write(descriptor, frame_ + sent, static_cast<std::size_t>(count - sent));
    if (put > 0) sent += static_cast<int>(put);
    if (put > 0) continue;
    if (put == 0 || (errno != EAGAIN && errno != EINTR)) return false;
    const std::uint64_t now_ns = monotonic_ns();
    pollfd wanted{descriptor, POLLOUT, 0};
    if (now_ns >= until_ns || poll(&wanted, 1, static_cast<int>((until_ns - now_ns) / kMs) + 1) < 0) return false;
    if ((wanted.revents & (POLLERR | POLLHUP)) != 0) return false;
  }
  return true;
}

// Whatever the writer has sent of a frame ends with the first byte of this one.
void SerialTransport::send_emergency(void* self, const std::uint8_t* report, int bytes) {
  const auto& serial = *static_cast<const SerialTransport*>(self);
  const int descriptor = serial.descriptor_.load();
  if (descriptor < 0 || bytes <= 0 || bytes > kMaxReportBytes) return;
  std::uint8_t frame[kMaxFrameBytes];
  const int count = make_frame(serial.profile_.output.is_text(), report, bytes, frame);
  const ssize_t ignored = ::write(descriptor, frame, static_cast<std::size_t>(count));
  static_cast<void>(ignored);  // the process is ending
}

}  // namespace

std::vector<int> serial_speeds() {
  std::vector<int> bauds;
  for (const Speed& speed : kSpeeds)
    bauds.push_back(speed.baud);
  return bauds;
}

std::unique_ptr<Transport> make_serial_transport(const Profile& profile, const SerialAccess& access) {
  return std::make_unique<SerialTransport>(profile, access);
}

}  // namespace fdcg::dev
