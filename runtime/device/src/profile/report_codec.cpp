// SPDX-License-Identifier: Apache-2.0
#include "profile/report_codec.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "profile/crc.hpp"

namespace fdcg::dev {
namespace {

// ---- Bytes, whatever the machine's own order and alignment

std::uint32_t load(const std::uint8_t* data, int bytes, bool is_big_endian) {
  std::uint32_t raw = 0;
  for (int i = 0; i < bytes; ++i)
    raw |= std::uint32_t{data[i]} << 8 * (is_big_endian ? bytes - 1 - i : i);
  return raw;
}

void store(std::uint32_t raw, int bytes, bool is_big_endian, std::uint8_t* data) {
  for (int i = 0; i < bytes; ++i)
    data[i] = static_cast<std::uint8_t>(raw >> 8 * (is_big_endian ? bytes - 1 - i : i));
}

std::uint32_t load(const Field& field, const std::uint8_t* report) {
  return load(report + field.offset, bytes_of(field.type), field.is_big_endian);
}

void store(const Field& field, std::uint32_t raw, std::uint8_t* report) {
  store(raw, bytes_of(field.type), field.is_big_endian, report + field.offset);
}

// ---- Raw bits and numbers

// By NumberType.
struct TypeInfo {
  int bytes;
  double least, most;
};
template <class Number>
constexpr TypeInfo info_of() {
  return {sizeof(Number), std::numeric_limits<Number>::lowest(), std::numeric_limits<Number>::max()};
}
constexpr TypeInfo kTypeInfos[] = {info_of<std::uint8_t>(), info_of<std::int8_t>(),   info_of<std::uint16_t>(),
                                   info_of<std::int16_t>(), info_of<std::uint32_t>(), info_of<std::int32_t>(),
                                   info_of<float>()};

const TypeInfo& info_of(NumberType type) {
  return kTypeInfos[static_cast<int>(type)];
}

// `raw` has no bits beyond the type's own.
double number_of(NumberType type, std::uint32_t raw) {
  if (type == NumberType::kF32) return static_cast<double>(std::bit_cast<float>(raw));
  const TypeInfo& info = info_of(type);
  return raw > info.most ? raw - std::ldexp(1.0, 8 * info.bytes) : raw;
}

// Clamped to the type's range. Never NaN: that is 0.
std::uint32_t raw_of(NumberType type, double number) {
  const TypeInfo& range = info_of(type);
  if (std::isnan(number)) number = 0;
  number = number < range.least ? range.least : number > range.most ? range.most : number;
  if (type == NumberType::kF32) return std::bit_cast<std::uint32_t>(static_cast<float>(number));
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::nearbyint(number)));
}

double value_of(const Field& field, std::uint32_t raw) {
  return number_of(field.type, raw) * field.scale + field.bias;
}

// Of a value that is not a number: the raw value of 0.
std::uint32_t raw_of_value(const Field& field, double value) {
  return raw_of(field.type, ((std::isnan(value) ? 0 : value) - field.bias) / field.scale);
}

// The device's clock wraps.
std::uint32_t raw_of_time(const Field& field, double time_s) {
  const double round = std::ldexp(1.0, 8 * bytes_of(field.type));
  const double ticks = std::fmod(std::nearbyint(time_s / field.scale), round);
  return raw_of(NumberType::kU32, ticks < 0 ? ticks + round : ticks);
}

// ---- Whole reports

Verdict check_frame(const ReportLayout& layout, const std::uint8_t* data, int bytes) {
  if (bytes != layout.bytes) return Verdict::kLength;
  if (layout.id != 0 && data[0] != layout.id) return Verdict::kId;
  const Crc& crc = layout.crc;
  if (crc.kind != CrcKind::kNone &&
      load(data + crc.offset, bytes_of(crc.kind), crc.is_big_endian) != crc_of(crc.kind, data + crc.first, crc.bytes))
    return Verdict::kCrc;
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    if (field.role == Role::kConstant && load(field, data) != field.constant) return Verdict::kConstant;
  }
  return Verdict::kGood;
}

// `raw` of each field; the rest of the report is zero.
template <class RawOf>
void write_frame(const ReportLayout& layout, std::uint8_t* data, RawOf raw_of_field) {
  std::memset(data, 0, layout.bytes);
  if (layout.id != 0) data[0] = layout.id;
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    store(field, field.role == Role::kConstant ? field.constant : raw_of_field(field), data);
  }
  const Crc& crc = layout.crc;
  if (crc.kind != CrcKind::kNone)
    store(crc_of(crc.kind, data + crc.first, crc.bytes), bytes_of(crc.kind), crc.is_big_endian, data + crc.offset);
}

void read_into(const Field& field, std::uint32_t raw, Sample* sample) {
  if (field.role == Role::kAxis) sample->axis[field.axis] = value_of(field, raw);
  if (field.role == Role::kSequence) sample->sequence = raw;
  if (field.role == Role::kEcho) sample->echo = raw;
  if (field.role == Role::kTime) sample->time_s = number_of(field.type, raw) * field.scale;
  if (field.role == Role::kButtons) sample->buttons = raw;
  if (field.role == Role::kStatus) {
    sample->has_fault = sample->has_fault || (raw & field.constant) != 0;
    sample->is_enabled = sample->is_enabled || (raw & field.enabled) != 0;
  }
}

}  // namespace

int bytes_of(NumberType type) {
  return info_of(type).bytes;
}

Verdict decode_input(const Profile& profile, const std::uint8_t* data, int bytes, Sample* sample) {
  const ReportLayout& layout = profile.input;
  *sample = {};
  const Verdict verdict = check_frame(layout, data, bytes);
  if (verdict != Verdict::kGood) return verdict;
  for (int i = 0; i < layout.field_count; ++i)
    read_into(layout.fields[i], load(layout.fields[i], data), sample);
  for (const double value : sample->axis) {
    if (!std::isfinite(value)) return Verdict::kNotFinite;
  }
  return Verdict::kGood;
}

void encode_output(const Profile& profile, const Command& command, std::uint8_t* data) {
  write_frame(profile.output, data, [&command](const Field& field) -> std::uint32_t {
    if (field.role == Role::kEffort) return raw_of_value(field, command.effort[field.axis]);
    if (field.role == Role::kSequence) return command.sequence;
    if (field.role == Role::kEcho) return command.echo;
    return field.role == Role::kEnable && command.is_enabled ? field.constant : 0;
  });
}

void encode_input(const Profile& profile, const Sample& sample, std::uint8_t* data) {
  write_frame(profile.input, data, [&sample](const Field& field) -> std::uint32_t {
    if (field.role == Role::kAxis) return raw_of_value(field, sample.axis[field.axis]);
    if (field.role == Role::kSequence) return sample.sequence;
    if (field.role == Role::kEcho) return sample.echo;
    if (field.role == Role::kTime) return raw_of_time(field, sample.time_s);
    if (field.role == Role::kButtons) return sample.buttons;
    if (field.role != Role::kStatus) return 0;
    return (sample.has_fault ? field.constant : 0) | (sample.is_enabled ? field.enabled : 0);
  });
}

bool decode_output(const Profile& profile, const std::uint8_t* data, int bytes, Command* command) {
  const ReportLayout& layout = profile.output;
  *command = {};
  if (check_frame(layout, data, bytes) != Verdict::kGood) return false;
  command->is_enabled = true;  // unless a field says otherwise
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    const std::uint32_t raw = load(field, data);
    if (field.role == Role::kEffort) command->effort[field.axis] = value_of(field, raw);
    if (field.role == Role::kSequence) command->sequence = raw;
    if (field.role == Role::kEcho) command->echo = raw;
    if (field.role == Role::kEnable && raw != field.constant) command->is_enabled = false;
  }
  for (const double effort : command->effort) {
    if (!std::isfinite(effort)) return false;
  }
  return true;
}

}  // namespace fdcg::dev
