// SPDX-License-Identifier: Apache-2.0
// What systemd-udevd does for libusb: tells the programs that listen (libudev's monitors) of devices that come and go. The
// kernel's own messages are passed on in the form that libudev expects; there are no rules to apply.
#include "udev_stand_in.hpp"

#include <arpa/inet.h>
#include <linux/netlink.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fdcg::vm {
namespace {

constexpr std::uint32_t kFromKernel = 1, kFromUdev = 2;  // groups of NETLINK_KOBJECT_UEVENT
constexpr std::uint32_t kMagic = 0xFEEDCAFE;

struct MonitorHeader {
  char prefix[8] = "libudev";
  std::uint32_t magic = htonl(kMagic);
  std::uint32_t header_bytes = sizeof(MonitorHeader), properties_offset = sizeof(MonitorHeader), properties_bytes = 0;
  std::uint32_t subsystem_hash = 0, devtype_hash = 0;  // big-endian: monitors filter by them
  std::uint32_t tags_high = 0, tags_low = 0;
};

// MurmurHash2 with seed 0, by which monitors know subsystems.
std::uint32_t hash(std::string_view text) {
  constexpr std::uint32_t kMix = 0x5BD1E995;
  auto result = static_cast<std::uint32_t>(text.size());
  for (; text.size() >= 4; text.remove_prefix(4)) {
    std::uint32_t word;
    std::memcpy(&word, text.data(), 4);
    word *= kMix;
    word ^= word >> 24;
    result = result * kMix ^ word * kMix;
  }
  for (std::size_t i = text.size(); i > 0; --i)
    result ^= std::uint32_t{static_cast<unsigned char>(text[i - 1])} << 8 * (i - 1);
  if (!text.empty()) result *= kMix;
  result = (result ^ result >> 13) * kMix;
  return result ^ result >> 15;
}

// The value of NAME in "NAME=value\0NAME=value\0...".
std::string_view property(std::string_view properties, std::string_view name) {
  while (!properties.empty()) {
    const std::string_view one = properties.substr(0, properties.find('\0'));
    if (one.starts_with(name) && one.substr(name.size()).starts_with("=")) return one.substr(name.size() + 1);
    properties.remove_prefix(std::min(properties.size(), one.size() + 1));
  }
  return {};
}

int open_netlink(std::uint32_t groups) {
  const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_KOBJECT_UEVENT);
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = groups;
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address))
    throw std::runtime_error("no socket for the kernel's device events");
  return fd;
}

void pass_on(std::string_view properties, int to) {
  MonitorHeader header;
  header.properties_bytes = static_cast<std::uint32_t>(properties.size());
  header.subsystem_hash = htonl(hash(property(properties, "SUBSYSTEM")));
  const std::string_view devtype = property(properties, "DEVTYPE");
  header.devtype_hash = devtype.empty() ? 0 : htonl(hash(devtype));
  std::string message(reinterpret_cast<const char*>(&header), sizeof header);
  message += properties;
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = kFromUdev;
  // refused where nobody listens: fine
  sendto(to, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

}  // namespace

void start_udev_stand_in() {
  const int from = open_netlink(kFromKernel), to = open_netlink(0);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork fails");
  if (child > 0) {
    close(from);
    close(to);
    return;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::vector<char> event(8192);
  for (;;) {
    const ssize_t bytes = recv(from, event.data(), event.size(), 0);
    if (bytes <= 0) continue;
    const std::string_view all(event.data(), static_cast<std::size_t>(bytes));
    const std::size_t title = all.find('\0');  // "add@/devices/...": the properties say it too
    if (title != std::string_view::npos) pass_on(all.substr(title + 1), to);
  }
}

}  // namespace fdcg::vm
