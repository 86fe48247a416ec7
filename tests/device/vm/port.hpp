// SPDX-License-Identifier: Apache-2.0
// The virtual device's plug: how its reports reach the kernel. One is /dev/uhid (port_uhid.cpp), the other a USB device of our
// own on vhci_hcd (port_usb.cpp); behind both the kernel's own HID core, hidraw and usbhid do what they do for any device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fdcg::vm {

using Bytes = std::vector<std::uint8_t>;

// What the port asks of the device behind it.
class PortUser {
 public:
  virtual ~PortUser() = default;
  virtual void on_output(const std::uint8_t* data, int bytes) = 0;  // an output report, its id first
  virtual Bytes on_get_feature(int report_id) = 0;                  // empty: there is none
};

class Port {
 public:
  virtual ~Port() = default;
  // Attaches the device; the kernel then asks it who it is. Throws std::runtime_error where the kernel refuses.
  virtual void plug() = 0;
  virtual void unplug() = 0;
  // To be polled for reading; -1: nothing to wait for.
  virtual int fd() const = 0;
  // Handles what the kernel has sent.
  virtual void receive(PortUser& user) = 0;
  // An input report, exactly as given: too short, too long and garbled ones too.
  virtual void send(const Bytes& report) = 0;
  // False: output reports stay where they are (USB: NAK) until it is true again.
  virtual void take_output(bool takes) = 0;
};

struct PortIdentity {
  std::uint16_t vendor = 0x1209, product = 0x0001;
  std::string maker = "fdcg", name = "Virtual haptic device", serial = "VM0001";
  Bytes report_descriptor;
};
std::unique_ptr<Port> make_uhid_port(PortIdentity identity);
std::unique_ptr<Port> make_usb_port(PortIdentity identity);

}  // namespace fdcg::vm
