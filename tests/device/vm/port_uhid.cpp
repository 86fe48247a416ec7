// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <linux/uhid.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "port.hpp"

namespace fdcg::vm {
namespace {

constexpr std::uint16_t kBusUsb = 3;

class UhidPort final : public Port {
 public:
  explicit UhidPort(PortIdentity identity) : identity_(std::move(identity)) {}
  ~UhidPort() override { unplug(); }

  void plug() override {
    fd_ = open("/dev/uhid", O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (fd_ < 0) throw std::runtime_error(std::string("/dev/uhid does not open: ") + std::strerror(errno));
    uhid_event event{};
    event.type = UHID_CREATE2;
    auto& create = event.u.create2;
    identity_.name.copy(reinterpret_cast<char*>(create.name), sizeof create.name - 1);
    identity_.serial.copy(reinterpret_cast<char*>(create.uniq), sizeof create.uniq - 1);
    create.rd_size = static_cast<std::uint16_t>(identity_.report_descriptor.size());
    std::copy(identity_.report_descriptor.begin(), identity_.report_descriptor.end(), create.rd_data);
    create.bus = kBusUsb;
    create.vendor = identity_.vendor;
    create.product = identity_.product;
    if (!put(event, sizeof event)) throw std::runtime_error(std::string("uhid refuses the device: ") + std::strerror(errno));
  }

  void unplug() override {
    if (fd_ < 0) return;
    uhid_event event{};
    event.type = UHID_DESTROY;
    put(event, sizeof event.type);
    close(fd_);
    fd_ = -1;
  }

  int fd() const override { return takes_output_ ? fd_ : -1; }
  void take_output(bool takes) override { takes_output_ = takes; }

  // Refused by the kernel before it has started the device, as on a wire that nobody listens to: not an error.
  void send(const Bytes& report) override {
    uhid_event event;
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<std::uint16_t>(report.size());
    std::copy(report.begin(), report.end(), event.u.input2.data);
    put(event, offsetof(uhid_event, u.input2.data) + report.size());
  }

  void receive(PortUser& user) override {
    uhid_event event;
    while (fd_ >= 0 && takes_output_ && read(fd_, &event, sizeof event) > 0) {
      if (event.type == UHID_OUTPUT) user.on_output(event.u.output.data, event.u.output.size);
      if (event.type == UHID_GET_REPORT) answer_get(user, event.u.get_report);
      if (event.type == UHID_SET_REPORT) answer_set(user, event.u.set_report);
    }
  }

 private:
  bool put(const uhid_event& event, std::size_t bytes) { return write(fd_, &event, bytes) == static_cast<ssize_t>(bytes); }

  void answer_get(PortUser& user, const uhid_get_report_req& request) {
    uhid_event event{};
    event.type = UHID_GET_REPORT_REPLY;
    auto& reply = event.u.get_report_reply;
    const Bytes data = request.rtype == UHID_FEATURE_REPORT ? user.on_get_feature(request.rnum) : Bytes{};
    reply.id = request.id;
    reply.err = data.empty() ? EIO : 0;
    reply.size = static_cast<std::uint16_t>(data.size());
    std::copy(data.begin(), data.end(), reply.data);
    put(event, sizeof event);
  }

  void answer_set(PortUser& user, const uhid_set_report_req& request) {
    if (request.rtype == UHID_OUTPUT_REPORT) user.on_output(request.data, request.size);
    uhid_event event{};
    event.type = UHID_SET_REPORT_REPLY;
    event.u.set_report_reply.id = request.id;
    put(event, sizeof event);
  }

  PortIdentity identity_;
  int fd_ = -1;
  bool takes_output_ = true;
};

}  // namespace

std::unique_ptr<Port> make_uhid_port(PortIdentity identity) {
  return std::make_unique<UhidPort>(std::move(identity));
}

}  // namespace fdcg::vm
