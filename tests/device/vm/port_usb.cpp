// SPDX-License-Identifier: Apache-2.0
// A USB device over USB/IP: the kernel's vhci_hcd is the host controller, and the wire is a socket pair whose other end is
// here. The kernel sends requests (URBs) with a number each; a request stays with us until the device has something to say to
// it, so holding back an interrupt OUT request is a device that answers NAK.
#include <arpa/inet.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "port.hpp"

namespace fdcg::vm {
namespace {

constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4;  // USB/IP's commands
constexpr int kHighSpeed = 3;                                                     // enum usb_device_speed
constexpr int kHubPort = 0;                                                       // the first high-speed port of vhci_hcd
constexpr int kPacketBytes = 64;
constexpr int kControllerPriority = 95;  // above the device and the host
constexpr char kAttach[] = "/sys/devices/platform/vhci_hcd.0/attach", kStatus[] = "/sys/devices/platform/vhci_hcd.0/status";

// usbip_header of the kernel's Documentation/usb/usbip_protocol.rst; every number big-endian.
struct Header {
  std::uint32_t command = 0, number = 0, device = 0, is_in = 0, endpoint = 0;
  std::uint32_t argument[5] =
      {};  // submit: flags, length, ...; submitted: status, length, ...; unlink: number; unlinked: status
  std::uint8_t setup[8] = {};
};
static_assert(sizeof(Header) == 48);

struct Request {
  std::uint32_t number = 0;
  Bytes data;            // OUT
  std::size_t room = 0;  // IN
};

class UsbPort final : public Port {
 public:
  explicit UsbPort(PortIdentity identity) : identity_(std::move(identity)) {}
  ~UsbPort() override { unplug(); }

  void plug() override {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends)) throw std::runtime_error("no socket pair for the USB device");
    await_free_port();
    std::ofstream attach(kAttach);
    attach << kHubPort << ' ' << ends[1] << " 65537 " << kHighSpeed << std::flush;  // 65537: bus 1, device 1
    close(ends[1]);                                                                 // the kernel has its own reference
    if (!attach) throw std::runtime_error(std::string(kAttach) + " refuses the device");
    fd_ = ends[0];
    hurry_controller();
    waiting_in_.clear();
    waiting_out_.clear();
    fresh_.reset();
    unread_.clear();
  }

  void unplug() override {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }

  int fd() const override { return fd_; }

  // Requests that were held back are taken as they are: so does a device that begins to acknowledge again.
  void take_output(bool takes) override { takes_output_ = takes; }

  void send(const Bytes& report) override {
    if (fd_ < 0) return;
    if (waiting_in_.empty()) {
      fresh_ = report;  // the endpoint's buffer: the newest, until the host asks
      return;
    }
    const Request request = waiting_in_.front();
    waiting_in_.pop_front();
    answer_in(request, report);
  }

  void receive(PortUser& user) override {
    while (takes_output_ && !waiting_out_.empty()) {
      const Request request = waiting_out_.front();
      waiting_out_.pop_front();
      take(request, user);
    }
    std::uint8_t bytes[4096];
    const ssize_t count = fd_ < 0 ? 0 : recv(fd_, bytes, sizeof bytes, MSG_DONTWAIT);
    if (count < 0) return;  // nothing
    if (count == 0) return unplug();
    unread_.insert(unread_.end(), bytes, bytes + count);
    while (handle_message(user))
      continue;
  }

 private:
  // What was unplugged takes a moment to be forgotten.
  static void await_free_port() {
    constexpr int kFree = 4;  // VDEV_ST_NULL
    for (int attempt = 0; attempt < 5000; ++attempt) {
      std::ifstream in(kStatus);
      std::string line;
      std::getline(in, line);  // names of the columns
      std::string hub;
      int port = -1, state = -1;
      while (port != kHubPort && in >> hub >> port >> state)
        std::getline(in, line);
      if (port == kHubPort && state == kFree) return;
      usleep(1000);
    }
    throw std::runtime_error(std::string(kStatus) + ": the port does not become free");
  }

  // A real host controller interrupts whatever runs; vhci_hcd has two threads of ordinary priority, which would wait for any
  // program that writes a file.
  static void hurry_controller() {
    sched_param parameters{};
    parameters.sched_priority = kControllerPriority;
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      std::string name;
      std::getline(std::ifstream(process.path() / "comm"), name);
      if (name == "vhci_rx" || name == "vhci_tx")
        sched_setscheduler(std::stoi(process.path().filename()), SCHED_FIFO, &parameters);
    }
  }

  // False: the next message is not there in full yet.
  bool handle_message(PortUser& user) {
    Header header;
    if (unread_.size() < sizeof header) return false;
    std::memcpy(&header, unread_.data(), sizeof header);
    const bool is_submit = ntohl(header.command) == kSubmit;
    const std::size_t length = is_submit ? ntohl(header.argument[1]) : 0;
    const std::size_t total = sizeof header + (is_submit && header.is_in == 0 ? length : 0);
    if (unread_.size() < total) return false;
    Request request{ntohl(header.number), Bytes(unread_.begin() + sizeof header, unread_.begin() + static_cast<long>(total)),
                    length};
    unread_.erase(unread_.begin(), unread_.begin() + static_cast<long>(total));
    if (is_submit) on_submit(header, std::move(request), user);
    if (ntohl(header.command) == kUnlink) on_unlink(header);
    return fd_ >= 0;
  }

  void reply(std::uint32_t number, std::int32_t status, std::size_t length, const Bytes& data = {},
             std::uint32_t command = kSubmitted) {
    Header header;
    header.command = htonl(command);
    header.number = htonl(number);
    header.argument[0] = htonl(static_cast<std::uint32_t>(status));
    header.argument[1] = htonl(static_cast<std::uint32_t>(length));
    Bytes message(sizeof header + data.size());
    std::memcpy(message.data(), &header, sizeof header);
    std::copy(data.begin(), data.end(), message.begin() + sizeof header);
    if (::send(fd_, message.data(), message.size(), MSG_NOSIGNAL) < 0) unplug();
  }

  // A packet that is longer than the buffer is an overflow, and no data: so a real host controller reports it.
  void answer_in(const Request& request, const Bytes& report) {
    if (report.size() > request.room) return reply(request.number, -EOVERFLOW, 0);
    reply(request.number, 0, report.size(), report);
  }

  void take(const Request& request, PortUser& user) {
    user.on_output(request.data.data(), static_cast<int>(request.data.size()));
    reply(request.number, 0, request.data.size());
  }

  void on_submit(const Header& header, Request request, PortUser& user) {
    const bool is_in = header.is_in != 0;
    if (ntohl(header.endpoint) == 0) return on_control(header, request, user);
    if (!is_in && takes_output_) return take(request, user);
    if (!is_in) return waiting_out_.push_back(std::move(request));
    if (!fresh_) return waiting_in_.push_back(std::move(request));
    const Bytes report = *fresh_;
    fresh_.reset();
    answer_in(request, report);
  }

  // Status -ECONNRESET says that the request was still with us and is gone; 0 that it had been answered before.
  void on_unlink(const Header& header) {
    const std::uint32_t number = ntohl(header.argument[0]);
    bool was_here = false;
    for (auto* queue : {&waiting_in_, &waiting_out_})
      was_here |= std::erase_if(*queue, [&](const Request& request) { return request.number == number; }) > 0;
    reply(ntohl(header.number), was_here ? -ECONNRESET : 0, 0, {}, kUnlinked);
  }

  void on_control(const Header& header, const Request& request, PortUser& user) {
    const std::uint8_t* setup = header.setup;
    const int value = setup[2] | setup[3] << 8;
    const std::size_t asked = std::min<std::size_t>(setup[6] | setup[7] << 8, request.room);
    if (!(setup[0] & 0x80)) {  // to the device: address, configuration, idle: all accepted; SET_REPORT of an output report
      if (setup[0] == 0x21 && setup[1] == 9 && value >> 8 == 2)
        user.on_output(request.data.data(), static_cast<int>(request.data.size()));
      return reply(request.number, 0, request.data.size());
    }
    Bytes data;
    if (setup[0] == 0x80 && setup[1] == 0) data = {0, 0};  // GET_STATUS
    if (setup[0] == 0x80 && setup[1] == 6) data = descriptor(value >> 8, value & 0xFF);
    if (setup[0] == 0x81 && setup[1] == 6 && value >> 8 == 0x22) data = identity_.report_descriptor;
    if (setup[0] == 0xA1 && setup[1] == 1 && value >> 8 == 3) data = user.on_get_feature(value & 0xFF);
    if (data.empty()) return reply(request.number, -EPIPE, 0);  // STALL
    data.resize(std::min(data.size(), asked));
    reply(request.number, 0, data.size(), data);
  }

  Bytes descriptor(int type, int index) const {
    const auto low = [](std::size_t x) { return static_cast<std::uint8_t>(x & 0xFF); };
    const auto high = [](std::size_t x) { return static_cast<std::uint8_t>(x >> 8 & 0xFF); };
    const auto vendor = identity_.vendor, product = identity_.product;
    const std::size_t report_bytes = identity_.report_descriptor.size();
    // clang-format off
    if (type == 1)  // device: USB 2.0, one configuration, strings 1 to 3
      return {18, 1, 0, 2, 0, 0, 0, 64, low(vendor), high(vendor), low(product), high(product), 0, 1, 1, 2, 3, 1};
    if (type == 2)
      return {9, 2, 41, 0, 1, 1, 0, 0x80, 50,                                        // configuration: bus-powered, 100 mA
              9, 4, 0, 0, 2, 3, 0, 0, 0,                                             // interface 0: HID, two endpoints
              9, 0x21, 0x11, 1, 0, 1, 0x22, low(report_bytes), high(report_bytes),   // HID 1.11, one report descriptor
              7, 5, 0x81, 3, kPacketBytes, 0, 1,                                     // interrupt IN 1, every microframe
              7, 5, 0x01, 3, kPacketBytes, 0, 1};                                    // interrupt OUT 1
    // clang-format on
    if (type == 3 && index == 0) return {4, 3, 9, 4};  // strings are in English
    if (type != 3 || index > 3) return {};
    const std::string& text = index == 1 ? identity_.maker : index == 2 ? identity_.name : identity_.serial;
    Bytes data = {low(2 + 2 * text.size()), 3};
    for (const char letter : text)
      data.insert(data.end(), {static_cast<std::uint8_t>(letter), 0});
    return data;
  }

  PortIdentity identity_;
  int fd_ = -1;
  bool takes_output_ = true;
  std::deque<Request> waiting_in_, waiting_out_;
  std::optional<Bytes> fresh_;
  Bytes unread_;
};

}  // namespace

std::unique_ptr<Port> make_usb_port(PortIdentity identity) {
  return std::make_unique<UsbPort>(std::move(identity));
}

}  // namespace fdcg::vm
