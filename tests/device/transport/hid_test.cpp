// SPDX-License-Identifier: Apache-2.0
// Devices over hidapi: selection, reports, and messages on failure. hidapi is a fake library, found before the real one on this
// program's run path (tests/device/vm tests the real one on a real kernel).
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <fstream>

#include "catch.hpp"
#include "fake_hidapi.h"
#include "transport/hid_devices.hpp"
#include "transport/make_transport.hpp"

using namespace fdcg::dev;

namespace {

// A state at its start, of the fake that answers for a back end.
fake_hidapi& fresh(HidBackend backend) {
  std::string problem;
  REQUIRE(hid_library(backend, &problem) != nullptr);
  void* const file = dlopen(backend == HidBackend::kLibusb ? "libhidapi-libusb.so.0" : "libhidapi-hidraw.so.0", RTLD_NOW);
  REQUIRE(file != nullptr);
  const auto state = reinterpret_cast<fake_hidapi* (*)()>(dlsym(file, "fake_hidapi_state"));
  REQUIRE(state != nullptr);  // else this is the real one
  std::memset(state(), 0, sizeof(fake_hidapi));
  std::snprintf(state()->path, sizeof state()->path, "%s", backend == HidBackend::kLibusb ? "1-2" : "hid_test_node");
  state()->interfaces = 1;
  state()->usage_page = backend == HidBackend::kLibusb ? 0 : 0xff00;
  return *state();
}

DeviceConfig config_with_ids(bool has_ids) {
  DeviceConfig config;
  config.profile.match.vendor = 0x1209;
  config.profile.match.product = 0xf001;
  config.profile.input.id = has_ids ? 1 : 0;
  config.profile.output.id = has_ids ? 2 : 0;
  config.profile.output.bytes = 4;
  config.profile.has_output = true;
  return config;
}

LoopConfig loop_with(HidBackend backend) {
  LoopConfig loop;
  loop.backend = backend;
  return loop;
}

// root may do everything, so the check runs in a process that has dropped its privileges.
std::string problem_of_nobody(const HidDevice& device) {
  if (geteuid() != 0) return permission_problem(device);
  constexpr uid_t kNobody = 65534;
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    if (setgid(kNobody) != 0 || setuid(kNobody) != 0) _exit(1);
    const std::string problem = permission_problem(device);
    _exit(write(ends[1], problem.data(), problem.size()) < 0);
  }
  close(ends[1]);
  char text[1000];
  const ssize_t bytes = read(ends[0], text, sizeof text);
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return std::string(text, bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
}

const std::uint8_t kReport[4] = {2, 7, 8, 9};

}  // namespace

TEST_CASE("hidraw gets two handles, one to read and one to write, libusb one for both") {
  for (const HidBackend backend : {HidBackend::kHidraw, HidBackend::kLibusb}) {
    fake_hidapi& fake = fresh(backend);
    const auto transport = make_hid_transport(config_with_ids(true), loop_with(backend));
    CHECK(fake.lists == 0);  // nothing is touched before it is opened
    REQUIRE(transport->open() == "");
    CHECK(fake.opened == (backend == HidBackend::kHidraw ? 2 : 1));
    CHECK(fake.lists == fake.freed_lists);
    std::uint8_t data[64];
    transport->read(data, sizeof data, 1);
    REQUIRE(transport->write(kReport, 4));
    CHECK((fake.last_read_handle != fake.last_write_handle) == (backend == HidBackend::kHidraw));
    transport->close();
    transport->close();
    CHECK(fake.closed == fake.opened);
    REQUIRE(transport->open() == "");
  }
}

TEST_CASE("hid: an output report is preceded by 0 if the device has no report ids") {
  for (const bool has_ids : {true, false}) {
    fake_hidapi& fake = fresh(HidBackend::kHidraw);
    const auto transport = make_hid_transport(config_with_ids(has_ids), loop_with(HidBackend::kHidraw));
    REQUIRE(transport->open() == "");
    for (const bool is_feature : {false, true}) {
      REQUIRE((is_feature ? transport->write_feature(kReport, 4) : transport->write(kReport, 4)));
      CHECK(fake.last_bytes == (has_ids ? 4 : 5));
      if (!has_ids) CHECK(fake.last[0] == 0);
      CHECK(std::memcmp(fake.last + (has_ids ? 0 : 1), kReport, 4) == 0);
    }
    CHECK(fake.writes == 1);
    CHECK(fake.features == 1);
    CHECK_FALSE(transport->write(kReport, 0));
    CHECK_FALSE(transport->write(kReport, kMaxReportBytes + 1));
    fake.refuses_writes = 1;
    CHECK_FALSE(transport->write(kReport, 4));
  }
}

TEST_CASE("hid: reads distinguish a report, a time-out and a loss") {
  fake_hidapi& fake = fresh(HidBackend::kHidraw);
  const auto transport = make_hid_transport(config_with_ids(true), loop_with(HidBackend::kHidraw));
  REQUIRE(transport->open() == "");
  std::uint8_t data[8] = {};
  CHECK(transport->read(data, sizeof data, 0).status == ReadStatus::kTimeout);
  fake.input_bytes = 5;
  fake.input[4] = 77;
  const ReadResult read = transport->read(data, sizeof data, 0);
  CHECK(read.status == ReadStatus::kReport);
  CHECK(read.bytes == 5);
  CHECK(data[4] == 77);
  fake.is_gone = 1;
  CHECK(transport->read(data, sizeof data, 0).status == ReadStatus::kLost);
}

TEST_CASE("hid: init reports are sent at each opening, and a failed one closes the device") {
  fake_hidapi& fake = fresh(HidBackend::kHidraw);
  DeviceConfig config = config_with_ids(false);
  config.profile.init_count = 2;
  config.profile.init[0].bytes = config.profile.init[1].bytes = 3;
  config.profile.init[1].is_feature = true;
  config.profile.init[1].data[2] = 5;
  const auto transport = make_hid_transport(config, loop_with(HidBackend::kHidraw));
  REQUIRE(transport->open() == "");
  CHECK(fake.writes == 1);
  CHECK(fake.features == 1);
  CHECK(fake.last_bytes == 3);
  CHECK(fake.last[2] == 5);
  transport->close();
  fake.refuses_writes = 1;
  CHECK(transport->open().find("init report 1") != std::string::npos);
  CHECK(fake.opened == fake.closed);
}

TEST_CASE("hid: the message for a missing device has what was sought and what was found") {
  fake_hidapi& hidraw = fresh(HidBackend::kHidraw);
  fresh(HidBackend::kLibusb).is_absent = 1;
  DeviceConfig config = config_with_ids(true);
  config.profile.match.product = 0xf002;
  config.serial = "X";
  std::string problem = make_hid_transport(config, loop_with(HidBackend::kHidraw))->open();
  CHECK(problem.find("1209:f002") != std::string::npos);
  CHECK(problem.find("serial 'X'") != std::string::npos);
  CHECK(problem.find("hid_test_node (1209:f001, usage page ff00, usage 0001, interface 0, serial 'S\u00e41', 'Fake?Device')") !=
        std::string::npos);
  hidraw.is_absent = 1;
  problem = make_hid_transport(config, loop_with(HidBackend::kAny))->open();  // both are asked
  CHECK(problem.find("hidraw: ") == 0);
  CHECK(problem.find("libusb: ") != std::string::npos);
  CHECK(problem.find("none is seen") != std::string::npos);
}

TEST_CASE("hid: with any back end allowed, hidraw is tried first") {
  fake_hidapi& hidraw = fresh(HidBackend::kHidraw);
  fake_hidapi& libusb = fresh(HidBackend::kLibusb);
  const auto transport = make_hid_transport(config_with_ids(true), loop_with(HidBackend::kAny));
  REQUIRE(transport->open() == "");
  CHECK(hidraw.opened == 2);
  CHECK(libusb.opened == 0);
  transport->close();
  hidraw.is_absent = 1;
  REQUIRE(transport->open() == "");
  CHECK(libusb.opened == 1);
  transport->close();
}

TEST_CASE("hid: serial and path select among equal devices") {
  std::vector<HidDevice> devices(3);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    devices[i].vendor = 1;
    devices[i].product = 2;
    devices[i].usage_page = 0xff00;
    devices[i].path = "/dev/hidraw" + std::to_string(i);
    devices[i].serial = "S" + std::to_string(i);
  }
  Match match;
  match.vendor = 1;
  match.product = 2;
  std::string problem;
  CHECK(choose_hid_device(devices, match, "", "", &problem) == &devices[0]);
  CHECK(choose_hid_device(devices, match, "S2", "", &problem) == &devices[2]);
  CHECK(choose_hid_device(devices, match, "", "/dev/hidraw1", &problem) == &devices[1]);
  CHECK(choose_hid_device(devices, match, "S2", "/dev/hidraw1", &problem) == nullptr);
  match.usage_page = 0xff01;
  CHECK(choose_hid_device(devices, match, "", "", &problem) == nullptr);
  devices[1].usage_page = 0xff01;
  CHECK(choose_hid_device(devices, match, "", "", &problem) == &devices[1]);
  match.usage = 4;
  CHECK(choose_hid_device(devices, match, "", "", &problem) == nullptr);
  devices[1].usage = 4;
  devices[1].interface_number = 3;
  match.interface_number = 2;
  CHECK(choose_hid_device(devices, match, "", "", &problem) == nullptr);
  match.interface_number = 3;
  CHECK(choose_hid_device(devices, match, "", "", &problem) == &devices[1]);
}

TEST_CASE("hid: libusb reports no usages, so none of several interfaces is guessed") {
  fake_hidapi& fake = fresh(HidBackend::kLibusb);
  DeviceConfig config = config_with_ids(true);
  config.profile.match.usage_page = 0xff00;
  const auto transport = make_hid_transport(config, loop_with(HidBackend::kLibusb));
  REQUIRE(transport->open() == "");  // the only one
  transport->close();
  fake.interfaces = 2;
  const std::string problem = transport->open();
  CHECK(problem.find("\"interface\"") != std::string::npos);
  CHECK(problem.find("\"path\"") != std::string::npos);
  config.profile.match.interface_number = 1;
  const auto exact = make_hid_transport(config, loop_with(HidBackend::kLibusb));
  CHECK(exact->open() == "");
  exact->close();
  config.profile.match.interface_number = -1;
  config.path = "1-2:1.1";
  const auto placed = make_hid_transport(config, loop_with(HidBackend::kLibusb));
  CHECK(placed->open() == "");
}

TEST_CASE("hid: a permission error names the node, its owner, the user's groups and the remedy") {
  HidDevice device;
  device.path = "/dev/null";
  CHECK(permission_problem(device) == "");
  device.path = "/no/such/node";
  CHECK(permission_problem(device).find("/no/such/node") == 0);
  device.path = "1-2:1.0";
  CHECK(device_node(device) == "");
  char path[] = "/tmp/fdcg_hid_test_XXXXXX";
  const int descriptor = mkstemp(path);
  REQUIRE(descriptor >= 0);
  REQUIRE(fchmod(descriptor, 0400) == 0);
  close(descriptor);
  device.path = path;
  const std::string problem = problem_of_nobody(device);
  unlink(path);
  INFO(problem);
  CHECK(problem.find(path) == 0);
  CHECK(problem.find("mode 0400") != std::string::npos);
  CHECK(problem.find("you are in ") != std::string::npos);
  CHECK(problem.find("--udev") != std::string::npos);
}

TEST_CASE("hid: a device in use, or one that cannot be opened, gives that reason") {
  fake_hidapi& fake = fresh(HidBackend::kHidraw);
  std::ofstream(fake.path) << "a file that may be read and written";
  fake.refuses_open = 1;
  std::string path = std::string("./") + fake.path;
  std::snprintf(fake.path, sizeof fake.path, "%s", path.c_str());
  const auto transport = make_hid_transport(config_with_ids(true), loop_with(HidBackend::kHidraw));
  CHECK(transport->open().find("cannot be opened") != std::string::npos);
  CHECK(fake.opened == fake.closed);
  std::remove(fake.path);
}
