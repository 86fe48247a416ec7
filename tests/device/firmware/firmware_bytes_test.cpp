// SPDX-License-Identifier: Apache-2.0
// The bytes of schemas/fdcg-hid.md: its dumps, its descriptors, its CRC, against the firmware core.
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "firmware_rig.hpp"
#include "profile/profile_json.hpp"
#include "profile/report_codec.hpp"

namespace {

using namespace fdcg::test;

// The blocks of hexadecimal numbers between ``` lines, and within them between empty lines.
std::vector<Bytes> dumps() {
  std::ifstream file(FDCG_SOURCE_DIR "/schemas/fdcg-hid.md");
  std::vector<Bytes> found;
  bool is_inside = false, is_new = true;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("```", 0) == 0) is_inside = !is_inside;
    if (line.empty() || line.rfind("```", 0) == 0) {
      is_new = true;
    } else if (is_inside) {
      if (is_new) found.emplace_back();
      is_new = false;
      std::istringstream words(line);
      for (unsigned byte; words >> std::hex >> byte;)
        found.back().push_back(static_cast<std::uint8_t>(byte));
    }
  }
  return found;
}

}  // namespace

TEST_CASE("firmware: the core writes and accepts the document's dumps") {
  const std::vector<Bytes> dump = dumps();
  REQUIRE(dump.size() == 6);  // two descriptors, feature, two outputs, input
  CHECK(dump[1] == Bytes(std::begin(fdcg_fw_report_descriptor), std::end(fdcg_fw_report_descriptor)));
  Device device;
  Bytes feature(FDCG_FW_FEATURE_BYTES);
  fdcg_fw_feature(&device.fw, feature.data());
  CHECK(dump[2] == feature);
  for (int i = 0; i < 258; ++i)
    device.input();
  CHECK(dump[3] == output(500, kZero, 257, 0));
  CHECK(dump[4] == output(501, kPush, 258, FDCG_FW_ENABLE));
  device.time_us = 258000;
  CHECK(device.take(dump[3]) == FDCG_FW_TAKEN);
  CHECK(device.take(dump[4]) == FDCG_FW_TAKEN);
  CHECK(device.force() == kPush);
  device.time_us = 259000;
  CHECK(dump[5] == device.input());
}

TEST_CASE("firmware: the built-in profile reads and writes the document's dumps") {
  using namespace fdcg::dev;
  const BuiltinProfile* builtin = find_builtin_profile("fdcg-reference");
  REQUIRE(builtin != nullptr);
  Profile profile;
  REQUIRE(parse_profile(builtin->text, "fdcg-reference.json", &profile) == "");
  const std::vector<Bytes> dump = dumps();
  Sample sample;
  REQUIRE(decode_input(profile, dump.at(5).data(), static_cast<int>(dump[5].size()), &sample) == Verdict::kGood);
  CHECK(sample.sequence == 259);
  CHECK(sample.time_s == Approx(0.259));
  CHECK(sample.axis[0] == Approx(0.012));
  CHECK(sample.axis[1] == Approx(-0.0035));
  CHECK(sample.axis[2] == Approx(0.00025));
  CHECK(sample.echo == 501);
  CHECK(sample.buttons == 1);
  CHECK_FALSE(sample.has_fault);
  Command command;
  command.sequence = 501;
  command.echo = 258;
  command.effort[1] = 0.5;
  command.effort[2] = -1.25;
  command.is_enabled = true;
  Bytes bytes(profile.output.bytes);
  encode_output(profile, command, bytes.data());
  CHECK(bytes == dump[4]);
  // each status bit that takes the force away is a fault to the host
  fdcg_fw fw;
  REQUIRE(fdcg_fw_init(&fw, &kConfig));
  for (int bit = 0; bit < 8; ++bit) {
    Bytes input(FDCG_FW_INPUT_BYTES);
    fw.status = static_cast<std::uint8_t>(1 << bit);
    fdcg_fw_make_input(&fw, 0, kCounts, 0, input.data());
    REQUIRE(decode_input(profile, input.data(), static_cast<int>(input.size()), &sample) == Verdict::kGood);
    CHECK(sample.has_fault == (((FDCG_FW_FAULTS | FDCG_FW_WATCHDOG) & 1u << bit) != 0));
  }
}

TEST_CASE("firmware: CRC-16/CCITT-FALSE") {
  CHECK(fdcg_fw_crc16(reinterpret_cast<const std::uint8_t*>("123456789"), 9) == 0x29B1);
  CHECK(fdcg_fw_crc16(nullptr, 0) == 0xFFFF);
}

// USB 2.0, 9.6, and HID 1.11, 6.2.1: each piece begins with its length and its type.
TEST_CASE("firmware: the document's configuration descriptor has room for the reports") {
  const Bytes bytes = dumps().at(0);
  REQUIRE(bytes.size() == 41);
  CHECK((bytes[2] | bytes[3] << 8) == 41);
  std::vector<unsigned> types;
  for (std::size_t at = 0; at < bytes.size(); at += bytes[at]) {
    REQUIRE(bytes[at] >= 7);
    REQUIRE(at + bytes[at] <= bytes.size());
    types.push_back(bytes[at + 1]);
    if (types.back() == 0x21) CHECK((bytes[at + 7] | bytes[at + 8] << 8) == FDCG_FW_DESCRIPTOR_BYTES);
    if (types.back() == 0x05) CHECK((bytes[at + 4] | bytes[at + 5] << 8) >= static_cast<int>(FDCG_FW_INPUT_BYTES));
  }
  CHECK(types == std::vector<unsigned>{2, 4, 0x21, 5, 5});
}

// A second reading of HID 1.11, 6.2.2: sums the bits of each report.
TEST_CASE("firmware: the report descriptor describes reports of the core's lengths") {
  unsigned size = 0, count = 0, id = 0, usages = 0, depth = 0;
  unsigned bits[4] = {8, 8, 8, 8};  // the id
  std::size_t at = 0;
  while (at < FDCG_FW_DESCRIPTOR_BYTES) {
    const unsigned tag = fdcg_fw_report_descriptor[at++], length = (tag & 3) == 3 ? 4 : tag & 3;
    REQUIRE(at + length <= FDCG_FW_DESCRIPTOR_BYTES);
    std::uint32_t value = 0;
    for (unsigned i = 0; i < length; ++i)
      value |= std::uint32_t{fdcg_fw_report_descriptor[at++]} << 8 * i;
    switch (tag & 0xFC) {
      case 0x04:
        CHECK(value == FDCG_FW_USAGE_PAGE);
        break;
      case 0x74:
        size = value;
        break;
      case 0x94:
        count = value;
        break;
      case 0x84:
        id = value;
        break;
      case 0x08:
        ++usages;
        break;
      case 0xA0:
        ++depth;
        usages = 0;
        break;
      case 0xC0:
        --depth;
        break;
      case 0x80:
      case 0x90:
      case 0xB0:
        CHECK((tag & 0xFC) == (id == 1 ? 0x80u : id == 2 ? 0x90u : 0xB0u));
        CHECK(value == 2);                       // data, variable, absolute
        CHECK(usages == (id == 3 ? 1 : count));  // one a field
        bits[id] += size * count;
        usages = 0;
        break;
      default:
        CHECK(((tag & 0xFC) == 0x14 || (tag & 0xFC) == 0x24));  // logical minimum, maximum
    }
  }
  CHECK(depth == 0);
  CHECK(bits[1] == 8 * FDCG_FW_INPUT_BYTES);
  CHECK(bits[2] == 8 * FDCG_FW_OUTPUT_BYTES);
  CHECK(bits[3] == 8 * FDCG_FW_FEATURE_BYTES);
}
