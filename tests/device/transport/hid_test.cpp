// SPDX-License-Identifier: Apache-2.0
// Devices over hidapi: selection, reports, and messages on failure. hidapi is a fake library, found before the real one on this
// program's run path (tests/device/vm tests the real one on a real kernel).
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <fstream>

#include "catch.hpp"
#include "fake_hidapi.h"
#include "fdcg_firmware.h"
#include "host/make_transport.hpp"
#include "profile/profile_json.hpp"
#include "transport/device_identity.hpp"
#include "transport/hid_devices.hpp"

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

TEST_CASE("hid: a device node has one owner, who is named") {
  fake_hidapi& fake = fresh(HidBackend::kHidraw);
  char node[] = "/tmp/fdcg-hid-node-XXXXXX";
  const int file = mkstemp(node);
  REQUIRE(file >= 0);
  close(file);
  std::snprintf(fake.path, sizeof fake.path, "%s", node);
  const auto first = make_hid_transport(config_with_ids(true), loop_with(HidBackend::kAny));
  const auto second = make_hid_transport(config_with_ids(true), loop_with(HidBackend::kAny));
  REQUIRE(first->open() == "");
  const int opened = fake.opened;
  const std::string problem = second->open();
  CHECK(problem.find(node) != std::string::npos);
  CHECK(problem.find("another device of this scene") != std::string::npos);
  CHECK(fake.opened == opened);  // not touched, by libusb neither
  first->close();
  // another process
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const auto other = make_hid_transport(config_with_ids(true), loop_with(HidBackend::kHidraw));
    const bool is_open = other->open().empty();
    if (write(ends[1], is_open ? "y" : "n", 1) != 1) _exit(1);
    pause();
    _exit(0);
  }
  char answer = 0;
  REQUIRE(read(ends[0], &answer, 1) == 1);
  CHECK(answer == 'y');
  CHECK(second->open().find("process " + std::to_string(child)) != std::string::npos);
  kill(child, SIGKILL);  // and its claim is gone with it
  waitpid(child, nullptr, 0);
  CHECK(second->open() == "");
  second->close();
  close(ends[0]);
  close(ends[1]);
  std::remove(node);
}

namespace {

// The feature report of the protocol's own example, as its reference profile has it.
struct Identity {
  Profile profile;
  fdcg_fw_config config{};
  std::uint8_t report[FDCG_FW_FEATURE_BYTES] = {};

  Identity() {
    REQUIRE(parse_profile(find_builtin_profile("fdcg-reference")->text, "it", &profile, nullptr) == "");
    config.counts_per_unit = 1'000'000;
    const std::int16_t box[3] = {80, 60, 50};
    for (int i = 0; i < 3; ++i) {
      config.workspace_max_mm[i] = box[i];
      config.workspace_min_mm[i] = static_cast<std::int16_t>(-box[i]);
    }
    config.peak_force_n = 3.3f;
    config.continuous_force_n = 0.9f;
    config.rate_hz = 1000;
    config.watchdog_ms = 20;
    config.dof = 3;
  }
  std::string problem() {
    fdcg_fw firmware;
    REQUIRE(fdcg_fw_init(&firmware, &config));
    fdcg_fw_feature(&firmware, report);
    return identity_problem(profile, report, sizeof report);
  }
};

}  // namespace

TEST_CASE("hid: what a device says of itself is compared with the profile") {
  Identity it;
  REQUIRE(describes_itself(it.profile));
  CHECK(it.problem() == "");
  CHECK(identity_problem(it.profile, it.report, 20).find("48 expected") != std::string::npos);
  it.report[7] ^= 1;
  CHECK(identity_problem(it.profile, it.report, sizeof it.report).find("CRC") != std::string::npos);
  const auto refused = [](const char* words, const auto& change) {
    Identity changed;
    change(changed.config);
    const std::string problem = changed.problem();
    INFO(problem);
    CHECK(problem.find(words) != std::string::npos);
  };
  refused("counts_per_unit 2000000, the profile 1000000", [](fdcg_fw_config& c) { c.counts_per_unit = 2'000'000; });
  refused("dof 2, the profile 3", [](fdcg_fw_config& c) { c.dof = 2; });
  refused("measures angles", [](fdcg_fw_config& c) { c.axes = FDCG_FW_ANGLES; });
  refused("rate 4000 Hz, the profile 1000 Hz", [](fdcg_fw_config& c) { c.rate_hz = 4000; });
  refused("peak_force 2 N, the profile 3.3 N", [](fdcg_fw_config& c) { c.peak_force_n = 2; });
  refused("workspace_min -0.04 m", [](fdcg_fw_config& c) { c.workspace_min_mm[1] = -40; });
  refused("workspace_max 0.04 m", [](fdcg_fw_config& c) { c.workspace_max_mm[2] = 40; });
  refused("watchdog 0.5 s", [](fdcg_fw_config& c) { c.watchdog_ms = 500; });
}

TEST_CASE("hid: a device that is not what the profile says is not opened, by no back end") {
  Identity it;
  DeviceConfig config;
  config.profile = it.profile;
  config.profile.match = {0x1209, 0xf001, 0xFF48, 1, -1};
  fake_hidapi& fake = fresh(HidBackend::kHidraw);
  fake_hidapi& other = fresh(HidBackend::kLibusb);
  fake.usage_page = 0xFF48;
  const auto transport = make_hid_transport(config, loop_with(HidBackend::kAny));
  CHECK(transport->open().find("does not answer GET_REPORT") != std::string::npos);
  REQUIRE(it.problem() == "");
  std::memcpy(fake.feature, it.report, sizeof it.report);
  fake.feature_bytes = sizeof it.report;
  CHECK(transport->open() == "");
  transport->close();
  it.config.counts_per_unit = 1000;
  REQUIRE(it.problem() != "");
  std::memcpy(fake.feature, it.report, sizeof it.report);
  CHECK(transport->open().find("counts_per_unit 1000") != std::string::npos);
  CHECK(fake.opened == fake.closed);
  CHECK(other.opened == 0);
}
