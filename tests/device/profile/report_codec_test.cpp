// SPDX-License-Identifier: Apache-2.0
// Reports to values and back by a profile's table, and checksums against their published values.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "catch.hpp"
#include "profile/crc.hpp"
#include "profile/report_codec.hpp"
#include "random_profile.hpp"

namespace {

using namespace fdcg::dev;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One axis, and one effort, at offset 1 of a report with id 7; axis 1 and 2 where they are asked for.
Profile single(NumberType type, bool is_big_endian, double scale, double bias) {
  Profile profile;
  profile.axis_count = 1;
  profile.rate_hz = 1000;
  profile.has_output = true;
  for (ReportLayout* layout : {&profile.input, &profile.output}) {
    layout->id = 7;
    layout->bytes = static_cast<std::uint16_t>(1 + bytes_of(type));
    layout->field_count = 1;
    Field& field = layout->fields[0];
    field.role = layout == &profile.input ? Role::kAxis : Role::kEffort;
    field.type = type;
    field.is_big_endian = is_big_endian;
    field.offset = 1;
    field.scale = scale;
    field.bias = bias;
  }
  return profile;
}

std::vector<std::uint8_t> encoded(const Profile& profile, double effort) {
  Command command;
  command.effort[0] = effort;
  std::vector<std::uint8_t> data(profile.output.bytes);
  encode_output(profile, command, data.data());
  return data;
}

using Bytes = std::vector<std::uint8_t>;

// The largest error that rounding to the field's counts makes, for values within its range.
double half_count(const Field& field, double value) {
  if (field.type != NumberType::kF32) return std::fabs(field.scale) * 0.5000001;
  return (std::fabs(value) + std::fabs(field.bias)) * 1.2e-7 + std::fabs(field.scale) * 1e-37;
}

// A value in the middle half of the field's range.
double value_within(const Field& field, std::mt19937_64& random) {
  const double most = field.type == NumberType::kF32 ? 1000 : mask_of(field) / 2;
  const bool is_signed = field.type != NumberType::kU8 && field.type != NumberType::kU16 && field.type != NumberType::kU24 &&
                         field.type != NumberType::kU32;
  const double raw = std::uniform_real_distribution<double>(is_signed ? -most : 0, most)(random);
  return raw * field.scale + field.bias;
}

const Field* field_of(const ReportLayout& layout, Role role) {
  const Field* end = layout.fields + layout.field_count;
  const Field* found = std::find_if(layout.fields, end, [role](const Field& field) { return field.role == role; });
  return found == end ? nullptr : found;
}

void check_numbers(const ReportLayout& layout, Role role, const double* in, const double* out) {
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    if (field.role == role) CHECK(std::fabs(out[field.axis] - in[field.axis]) <= half_count(field, in[field.axis]));
  }
}

void check_counter(const ReportLayout& layout, Role role, std::uint32_t in, std::uint32_t out) {
  const Field* field = field_of(layout, role);
  CHECK(out == (field == nullptr ? 0 : in & mask_of(*field)));
}

}  // namespace

TEST_CASE("checksums have their published check values") {
  const auto* digits = reinterpret_cast<const std::uint8_t*>("123456789");
  CHECK(crc_of(CrcKind::kCrc16CcittFalse, digits, 9) == 0x29B1);
  CHECK(crc_of(CrcKind::kCrc16Modbus, digits, 9) == 0x4B37);
  CHECK(crc_of(CrcKind::kCrc32, digits, 9) == 0xCBF43926);
  CHECK(crc_of(CrcKind::kCrc8, digits, 9) == 0xF4);
  CHECK(crc_of(CrcKind::kSum8, digits, 9) == 0xDD);
  CHECK(crc_of(CrcKind::kXor8, digits, 9) == 0x31);
  CHECK(crc_of(CrcKind::kNone, digits, 9) == 0);
  CHECK(crc_of(CrcKind::kCrc16CcittFalse, digits, 0) == 0xFFFF);
  CHECK(crc_of(CrcKind::kCrc32, digits, 0) == 0);
}

TEST_CASE("report codec: numbers are encoded by type and byte order") {
  CHECK(encoded(single(NumberType::kU8, false, 1, 0), 200) == Bytes{7, 200});
  CHECK(encoded(single(NumberType::kI8, false, 1, 0), -2) == Bytes{7, 0xFE});
  CHECK(encoded(single(NumberType::kU16, false, 1, 0), 0x1234) == Bytes{7, 0x34, 0x12});
  CHECK(encoded(single(NumberType::kU16, true, 1, 0), 0x1234) == Bytes{7, 0x12, 0x34});
  CHECK(encoded(single(NumberType::kI16, false, 0.5, 1), -1) == Bytes{7, 0xFC, 0xFF});
  CHECK(encoded(single(NumberType::kI32, true, -1, 0), 2) == Bytes{7, 0xFF, 0xFF, 0xFF, 0xFE});
  CHECK(encoded(single(NumberType::kU32, false, 1e-3, 0), 4294967.295) == Bytes{7, 0xFF, 0xFF, 0xFF, 0xFF});
  CHECK(encoded(single(NumberType::kF32, false, 1, 0), -1.25) == Bytes{7, 0, 0, 0xA0, 0xBF});
  CHECK(encoded(single(NumberType::kF32, true, 2, 1), -1.5) == Bytes{7, 0xBF, 0xA0, 0, 0});
}

TEST_CASE("report codec: numbers of 24 bits, and of bits between others") {
  CHECK(encoded(single(NumberType::kU24, false, 1, 0), 0x123456) == Bytes{7, 0x56, 0x34, 0x12});
  CHECK(encoded(single(NumberType::kI24, true, 1, 0), -2) == Bytes{7, 0xFF, 0xFF, 0xFE});
  CHECK(encoded(single(NumberType::kI24, false, 1, 0), 1e9) == Bytes{7, 0xFF, 0xFF, 0x7F});
  Profile profile = single(NumberType::kI16, false, 1, 0);
  Field& field = profile.output.fields[0];
  field.bit = 4;
  field.bits = 12;
  CHECK(encoded(profile, 1) == Bytes{7, 0x10, 0});
  CHECK(encoded(profile, -1) == Bytes{7, 0xF0, 0xFF});
  CHECK(encoded(profile, 5000) == Bytes{7, 0xF0, 0x7F});   // 2047
  CHECK(encoded(profile, -5000) == Bytes{7, 0x00, 0x80});  // -2048
  Field second = field;                                    // the four bits before it
  second.role = Role::kSequence;
  second.type = NumberType::kU8;
  second.bit = 0;
  second.bits = 4;
  profile.output.fields[profile.output.field_count++] = second;
  Command command;
  command.effort[0] = -3;
  command.sequence = 0x1F;  // its least four
  Bytes data(3);
  encode_output(profile, command, data.data());
  CHECK(data == Bytes{7, 0xDF, 0xFF});
  Command back;
  REQUIRE(decode_output(profile, data.data(), 3, &back));
  CHECK((back.effort[0] == -3 && back.sequence == 0xF));
}

namespace {

// "P <sequence> <x> <y> <z> <buttons>" and "F,<sequence>,<x>,<y>,<z>,<enable>".
Profile text_profile() {
  Profile profile;
  profile.axis_count = 3;
  profile.rate_hz = 1000;
  profile.has_output = true;
  const auto add = [](ReportLayout* layout, Role role, int column, double scale, std::uint32_t constant, int axis) {
    Field& field = layout->fields[layout->field_count++];
    field.role = role;
    field.type = NumberType::kU32;
    field.offset = static_cast<std::uint16_t>(column);
    field.scale = scale;
    field.constant = constant;
    field.axis = static_cast<std::uint8_t>(axis);
  };
  ReportLayout &in = profile.input, &out = profile.output;
  in.columns = out.columns = 6;
  in.bytes = out.bytes = kMaxReportBytes;
  out.separator = ',';
  add(&in, Role::kConstant, 0, 1, 'P', 0);
  add(&in, Role::kSequence, 1, 1, 0, 0);
  add(&out, Role::kConstant, 0, 1, 'F' | 'o' << 8, 0);
  add(&out, Role::kSequence, 1, 1, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    add(&in, Role::kAxis, 2 + axis, 1e-3, 0, axis);
    add(&out, Role::kEffort, 2 + axis, 1, 0, axis);
  }
  add(&in, Role::kButtons, 5, 1, 0, 0);
  add(&out, Role::kEnable, 5, 1, 1, 0);
  return profile;
}

Verdict read_line(const Profile& profile, const std::string& line, Sample* sample) {
  return decode_input(profile, reinterpret_cast<const std::uint8_t*>(line.data()), static_cast<int>(line.size()), sample);
}

}  // namespace

TEST_CASE("report codec: lines of text") {
  const Profile profile = text_profile();
  Sample sample;
  for (const char* line : {"P 17 1.5 -2 +3e1 5\n", "P 17 1.5 -2 30 5\r\n", "  P\t17  1.5 -2 30 5  "}) {
    REQUIRE(read_line(profile, line, &sample) == Verdict::kGood);
    CHECK((sample.sequence == 17 && sample.buttons == 5));
    CHECK((sample.axis[0] == 0.0015 && sample.axis[1] == -0.002 && sample.axis[2] == Approx(0.03)));
  }
  CHECK(read_line(profile, "", &sample) == Verdict::kLength);
  CHECK(read_line(profile, "\n", &sample) == Verdict::kLength);
  CHECK(read_line(profile, "P 17 1 2 3", &sample) == Verdict::kLength);
  CHECK(read_line(profile, "P 17 1 2 3 4 5", &sample) == Verdict::kLength);
  CHECK(read_line(profile, "P 17 1 2 3 4" + std::string(200, ' '), &sample) == Verdict::kLength);
  CHECK(read_line(profile, "Q 17 1 2 3 4", &sample) == Verdict::kConstant);
  CHECK(read_line(profile, "PPPPP 17 1 2 3 4", &sample) == Verdict::kConstant);
  CHECK(read_line(profile, std::string("P\0\0 17 1 2 3 4", 15), &sample) == Verdict::kConstant);
  for (const char* line : {"P 17 nan 2 3 4", "P 17 inf 2 3 4", "P 17 1e999 2 3 4", "P 17 1,5 2 3 4", "P 17 0x1 2 3 4",
                           "P -1 1 2 3 4", "P 1.0 1 2 3 4", "P 4294967296 1 2 3 4", "P 17 1 2 - 4", "P 17 1 2 + 4"})
    CHECK(read_line(profile, line, &sample) == Verdict::kNotFinite);

  Command command;
  command.effort[0] = 0.1;
  command.effort[1] = -1.0 / 3;
  command.effort[2] = kNan;
  command.sequence = 4294967295U;
  command.is_enabled = true;
  std::uint8_t data[kMaxReportBytes];
  const int bytes = encode_output(profile, command, data);
  CHECK(std::string(data, data + bytes) == "Fo,4294967295,0.1,-0.333333333,0,1\n");
  Command back;
  REQUIRE(decode_output(profile, data, bytes, &back));
  CHECK((back.sequence == command.sequence && back.is_enabled && back.effort[0] == 0.1));
  const std::string empty_column = "Fo,1,0.1,,0,1";
  CHECK_FALSE(decode_output(profile, reinterpret_cast<const std::uint8_t*>(empty_column.data()), 13, &back));
}

TEST_CASE("report codec: a random line is read, or refused, and a written one is read back") {
  const Profile profile = text_profile();
  std::mt19937_64 random(11);
  constexpr char kLetters[] = "P 0123456789.-+e,\n\r\tinfa";
  for (int i = 0; i < 20'000; ++i) {
    std::string line;
    for (auto length = random() % 140; length > 0; --length)
      line += kLetters[random() % (sizeof kLetters - 1)];
    Sample sample;
    if (read_line(profile, line, &sample) == Verdict::kGood) CHECK(std::isfinite(sample.axis[0]));
    for (double& axis : sample.axis)
      axis = std::ldexp(static_cast<double>(random()) - 9e18, -60 - static_cast<int>(random() % 20));
    sample.sequence = static_cast<std::uint32_t>(random());
    std::uint8_t data[kMaxReportBytes];
    const int bytes = encode_input(profile, sample, data);
    Sample back;
    REQUIRE(decode_input(profile, data, bytes, &back) == Verdict::kGood);
    CHECK(back.sequence == sample.sequence);
    for (int axis = 0; axis < 3; ++axis)
      REQUIRE(std::fabs(back.axis[axis] - sample.axis[axis]) <= 1e-8 * std::fabs(sample.axis[axis]));
  }
}

TEST_CASE("an effort is rounded to the nearest count and held in the range of its field") {
  CHECK(encoded(single(NumberType::kI16, false, 1, 0), 1.4) == Bytes{7, 1, 0});
  CHECK(encoded(single(NumberType::kI16, false, 1, 0), -1.6) == Bytes{7, 0xFE, 0xFF});
  for (const double large : {1e9, 1e300, kInfinity}) {
    CHECK(encoded(single(NumberType::kI16, false, 1, 0), large) == Bytes{7, 0xFF, 0x7F});
    CHECK(encoded(single(NumberType::kI16, false, 1, 0), -large) == Bytes{7, 0, 0x80});
    CHECK(encoded(single(NumberType::kI16, false, -1, 0), large) == Bytes{7, 0, 0x80});
    CHECK(encoded(single(NumberType::kU8, false, 1, 0), -large) == Bytes{7, 0});
    CHECK(encoded(single(NumberType::kU32, false, 1e-3, 0), large) == Bytes{7, 0xFF, 0xFF, 0xFF, 0xFF});
    CHECK(encoded(single(NumberType::kI32, false, 1e-3, 0), -large) == Bytes{7, 0, 0, 0, 0x80});
  }
  CHECK(encoded(single(NumberType::kF32, false, 1, 0), 1e300) == Bytes{7, 0xFF, 0xFF, 0x7F, 0x7F});
  CHECK(encoded(single(NumberType::kF32, false, 1, 0), kInfinity) == Bytes{7, 0xFF, 0xFF, 0x7F, 0x7F});
}

TEST_CASE("report codec: a NaN effort gives no force") {
  CHECK(encoded(single(NumberType::kI16, false, 1, 0), kNan) == Bytes{7, 0, 0});
  CHECK(encoded(single(NumberType::kF32, false, 1, 0), kNan) == Bytes{7, 0, 0, 0, 0});
  CHECK(encoded(single(NumberType::kU8, false, 1, -128), kNan) == Bytes{7, 128});  // where 128 is the raw value of no force
}

TEST_CASE("report codec: a report is refused with the kind of error") {
  Profile profile = single(NumberType::kF32, false, 1, 0);
  ReportLayout& layout = profile.input;
  layout.bytes = 9;
  layout.fields[1] = {Role::kConstant, NumberType::kU16, true, 0, 5, 1, 0, 0xBEEF};
  layout.field_count = 2;
  layout.crc = {CrcKind::kCrc16CcittFalse, true, 7, 0, 7};
  Sample sample;
  sample.axis[0] = 0.25;
  Bytes good(9);
  encode_input(profile, sample, good.data());
  CHECK(decode_input(profile, good.data(), 9, &sample) == Verdict::kGood);
  CHECK(sample.axis[0] == 0.25);
  for (const int bytes : {-1, 0, 1, 8, 10, 128, 129})
    CHECK(decode_input(profile, Bytes(200).data(), bytes, &sample) == Verdict::kLength);
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bad = good;
      bad[i] = static_cast<std::uint8_t>(bad[i] ^ 1 << bit);
      CHECK(decode_input(profile, bad.data(), 9, &sample) == (i == 0 ? Verdict::kId : Verdict::kCrc));
    }
  }
  layout.crc.kind = CrcKind::kNone;
  Bytes bad = good;
  bad[6] ^= 1;
  CHECK(decode_input(profile, bad.data(), 9, &sample) == Verdict::kConstant);
  for (const float number : {float(kNan), float(kInfinity), -float(kInfinity)}) {
    bad = good;
    std::memcpy(&bad[1], &number, 4);
    CHECK(decode_input(profile, bad.data(), 9, &sample) == Verdict::kNotFinite);
  }
}

TEST_CASE("status bits of the mask are a fault, others are not; several fields add up") {
  Profile profile;
  profile.input.bytes = 3;
  profile.input.fields[0] = {Role::kStatus, NumberType::kU16, true, 0, 0, 1, 0, 0x0180};
  profile.input.fields[1] = {Role::kStatus, NumberType::kU8, false, 0, 2, 1, 0, 0x04};
  profile.input.field_count = 2;
  const auto has_fault = [&profile](Bytes data) {
    Sample sample;
    CHECK(decode_input(profile, data.data(), 3, &sample) == Verdict::kGood);
    return sample.has_fault;
  };
  CHECK_FALSE(has_fault({0, 0, 0}));
  CHECK_FALSE(has_fault({0xFE, 0x7F, 0xFB}));
  CHECK(has_fault({0x01, 0, 0}));
  CHECK(has_fault({0, 0x80, 0}));
  CHECK(has_fault({0, 0, 0x04}));
}

TEST_CASE("report codec: output reports enable forces only if the gate is armed") {
  Profile profile = single(NumberType::kI16, false, 1, 0);
  profile.output.bytes = 4;
  profile.output.fields[1] = {Role::kEnable, NumberType::kU8, false, 0, 3, 1, 0, 0xAA};
  profile.output.field_count = 2;
  Command command;
  Bytes data(4, 0x55);
  encode_output(profile, command, data.data());
  CHECK(data == Bytes{7, 0, 0, 0});
  command.is_enabled = true;
  encode_output(profile, command, data.data());
  CHECK(data == Bytes{7, 0, 0, 0xAA});
  CHECK(decode_output(profile, data.data(), 4, &command));
  CHECK(command.is_enabled);
  data[3] = 0xAB;
  CHECK(decode_output(profile, data.data(), 4, &command));
  CHECK_FALSE(command.is_enabled);
  CHECK_FALSE(decode_output(profile, data.data(), 3, &command));
  data[0] = 8;
  CHECK_FALSE(decode_output(profile, data.data(), 4, &command));
}

TEST_CASE("report codec: random profiles decode what they encode, and fields do not overlap") {
  const unsigned seed = 20260101;
  std::mt19937_64 random(seed);
  for (int i = 0; i < 20000; ++i) {
    INFO("seed " << seed << ", profile " << i);
    const Profile profile = random_profile(random);
    Sample sample;
    for (int f = 0; f < profile.input.field_count; ++f) {
      const Field& field = profile.input.fields[f];
      if (field.role == Role::kAxis) sample.axis[field.axis] = value_within(field, random);
    }
    sample.sequence = static_cast<std::uint32_t>(random());
    sample.echo = static_cast<std::uint32_t>(random());
    sample.buttons = static_cast<std::uint32_t>(random());
    sample.has_fault = random() % 2 != 0;
    sample.time_s = std::uniform_real_distribution<double>(0, 1e6)(random);
    std::vector<std::uint8_t> data(profile.input.bytes);
    encode_input(profile, sample, data.data());
    Sample read;
    REQUIRE(decode_input(profile, data.data(), profile.input.bytes, &read) == Verdict::kGood);
    check_numbers(profile.input, Role::kAxis, sample.axis, read.axis);
    check_counter(profile.input, Role::kSequence, sample.sequence, read.sequence);
    check_counter(profile.input, Role::kEcho, sample.echo, read.echo);
    check_counter(profile.input, Role::kButtons, sample.buttons, read.buttons);
    CHECK(read.has_fault == (sample.has_fault && field_of(profile.input, Role::kStatus) != nullptr));
    if (const Field* time = field_of(profile.input, Role::kTime)) {
      const double round_s = time->scale * (mask_of(*time) + 1.0);
      const double off = std::remainder(read.time_s - sample.time_s, round_s);
      CHECK(std::fabs(off) <= time->scale * 0.5 + 1e-8);
    }

    Command command;
    for (int f = 0; f < profile.output.field_count; ++f) {
      const Field& field = profile.output.fields[f];
      if (field.role == Role::kEffort) command.effort[field.axis] = value_within(field, random);
    }
    command.sequence = static_cast<std::uint32_t>(random());
    command.echo = static_cast<std::uint32_t>(random());
    command.is_enabled = random() % 2 != 0;
    data.resize(profile.output.bytes);
    encode_output(profile, command, data.data());
    Command taken;
    REQUIRE(decode_output(profile, data.data(), profile.output.bytes, &taken));
    check_numbers(profile.output, Role::kEffort, command.effort, taken.effort);
    check_counter(profile.output, Role::kSequence, command.sequence, taken.sequence);
    check_counter(profile.output, Role::kEcho, command.echo, taken.echo);
    CHECK(taken.is_enabled == (command.is_enabled || field_of(profile.output, Role::kEnable) == nullptr));
  }
}
