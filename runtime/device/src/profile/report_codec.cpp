// SPDX-License-Identifier: Apache-2.0
#include "profile/report_codec.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "profile/crc.hpp"
#include "profile/text_report.hpp"

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

// Up to 32 bits from a byte's bit on, upwards.
std::uint32_t load_bits(const Field& field, const std::uint8_t* data) {
  std::uint64_t raw = 0;
  for (int i = 0; i < (field.bit + field.bits + 7) / 8; ++i)
    raw |= std::uint64_t{data[i]} << 8 * i;
  return static_cast<std::uint32_t>(raw >> field.bit) & mask_of(field);
}

// The bytes are 0 there.
void store_bits(const Field& field, std::uint32_t raw, std::uint8_t* data) {
  const std::uint64_t bits = std::uint64_t{raw & mask_of(field)} << field.bit;
  for (int i = 0; i < (field.bit + field.bits + 7) / 8; ++i)
    data[i] = static_cast<std::uint8_t>(data[i] | bits >> 8 * i);
}

std::uint32_t load(const Field& field, const std::uint8_t* report) {
  if (field.bits != 0) return load_bits(field, report + field.offset);
  return load(report + field.offset, bytes_of(field.type), field.is_big_endian);
}

void store(const Field& field, std::uint32_t raw, std::uint8_t* report) {
  if (field.bits != 0) return store_bits(field, raw, report + field.offset);
  store(raw, bytes_of(field.type), field.is_big_endian, report + field.offset);
}

// ---- Raw bits and numbers

bool is_signed(NumberType type) {
  return type == NumberType::kI8 || type == NumberType::kI16 || type == NumberType::kI24 || type == NumberType::kI32;
}

// `raw` has no bits beyond the field's own.
double number_of(const Field& field, std::uint32_t raw) {
  if (field.type == NumberType::kF32) return static_cast<double>(std::bit_cast<float>(raw));
  const std::uint32_t mask = mask_of(field);
  return is_signed(field.type) && raw > mask / 2 ? raw - (mask + 1.0) : raw;
}

// Clamped to the field's range. Never NaN: that is 0.
std::uint32_t raw_of(const Field& field, double number) {
  if (std::isnan(number)) number = 0;
  if (field.type == NumberType::kF32) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return std::bit_cast<std::uint32_t>(static_cast<float>(std::clamp(number, -kMost, kMost)));
  }
  const double all = mask_of(field), half = (all + 1) / 2;
  number = is_signed(field.type) ? std::clamp(number, -half, half - 1) : std::clamp(number, 0.0, all);
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::nearbyint(number)));
}

double value_of(const Field& field, std::uint32_t raw) {
  return number_of(field, raw) * field.scale + field.bias;
}

// In counts, not rounded; of a value that is not a number, those of 0.
double count_of_value(const Field& field, double value) {
  return ((std::isnan(value) ? 0 : value) - field.bias) / field.scale;
}

std::uint32_t raw_of_value(const Field& field, double value) {
  return raw_of(field, count_of_value(field, value));
}

// The device's clock wraps.
std::uint32_t raw_of_time(const Field& field, double time_s) {
  const double round = mask_of(field) + 1.0;
  const double ticks = std::fmod(std::nearbyint(time_s / field.scale), round);
  return raw_of(field, ticks < 0 ? ticks + round : ticks);
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
  for (int i = 0; i < layout.field_count; ++i)
    store(layout.fields[i], raw_of_field(layout.fields[i]), data);
  const Crc& crc = layout.crc;
  if (crc.kind != CrcKind::kNone)
    store(crc_of(crc.kind, data + crc.first, crc.bytes), bytes_of(crc.kind), crc.is_big_endian, data + crc.offset);
}

void read_into(const Field& field, std::uint32_t raw, Sample* sample) {
  if (field.role == Role::kSequence) sample->sequence = raw;
  if (field.role == Role::kEcho) sample->echo = raw;
  if (field.role == Role::kTime) sample->time_s = raw * field.scale;
  if (field.role == Role::kButtons) sample->buttons = raw;
  if (field.role == Role::kStatus) {
    sample->has_fault = sample->has_fault || (raw & field.constant) != 0;
    sample->is_enabled = sample->is_enabled || (raw & field.enabled) != 0;
  }
}

void read_into(const Field& field, std::uint32_t raw, Command* command) {
  if (field.role == Role::kSequence) command->sequence = raw;
  if (field.role == Role::kEcho) command->echo = raw;
  if (field.role == Role::kEnable && raw != field.constant) command->is_enabled = false;
}

// What stands in a field that is no number with a fraction.
std::uint32_t raw_of(const Field& field, const Sample& sample) {
  if (field.role == Role::kSequence) return sample.sequence;
  if (field.role == Role::kEcho) return sample.echo;
  if (field.role == Role::kTime) return raw_of_time(field, sample.time_s);
  if (field.role == Role::kButtons) return sample.buttons;
  if (field.role == Role::kStatus) return (sample.has_fault ? field.constant : 0) | (sample.is_enabled ? field.enabled : 0);
  return field.role == Role::kConstant ? field.constant : 0;
}

std::uint32_t raw_of(const Field& field, const Command& command) {
  if (field.role == Role::kSequence) return command.sequence;
  if (field.role == Role::kEcho) return command.echo;
  if (field.role == Role::kEnable) return command.is_enabled ? field.constant : 0;
  return field.role == Role::kConstant ? field.constant : 0;
}

bool is_number(const Field& field) {
  return field.role == Role::kAxis || field.role == Role::kEffort;
}

bool are_finite(const double* values) {
  return std::all_of(values, values + kMaxAxes, [](double value) { return std::isfinite(value); });
}

// To a Sample and its axes, or to a Command and its efforts.
template <class Content>
Verdict read_text(const ReportLayout& layout, const std::uint8_t* data, int bytes, double* values, Content* content) {
  TextColumns columns(layout, data, bytes);
  if (!columns.are_as_laid_out()) return Verdict::kLength;
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    std::uint32_t raw = 0;
    if (field.role == Role::kConstant) {
      if (!columns.is_word(field)) return Verdict::kConstant;
    } else if (is_number(field)) {
      double number = 0;
      if (!columns.number(field, &number)) return Verdict::kNotFinite;
      values[field.axis] = number * field.scale + field.bias;
    } else if (columns.count(field, &raw)) {
      read_into(field, raw & mask_of(field), content);
    } else {
      return Verdict::kNotFinite;
    }
  }
  return are_finite(values) ? Verdict::kGood : Verdict::kNotFinite;
}

template <class Content>
Verdict read_bytes(const ReportLayout& layout, const std::uint8_t* data, int bytes, double* values, Content* content) {
  const Verdict verdict = check_frame(layout, data, bytes);
  if (verdict != Verdict::kGood) return verdict;
  for (int i = 0; i < layout.field_count; ++i) {
    const Field& field = layout.fields[i];
    const std::uint32_t raw = load(field, data);
    if (is_number(field)) values[field.axis] = value_of(field, raw);
    read_into(field, raw, content);
  }
  return are_finite(values) ? Verdict::kGood : Verdict::kNotFinite;
}

template <class Content>
Verdict read_report(const ReportLayout& layout, const std::uint8_t* data, int bytes, double* values, Content* content) {
  return layout.is_text() ? read_text(layout, data, bytes, values, content) : read_bytes(layout, data, bytes, values, content);
}

template <class Content>
int write_report(const ReportLayout& layout, const double* values, const Content& content, std::uint8_t* data) {
  if (!layout.is_text()) {
    write_frame(layout, data, [&](const Field& field) {
      return is_number(field) ? raw_of_value(field, values[field.axis]) : raw_of(field, content);
    });
    return layout.bytes;
  }
  TextLine line(layout, data);
  for (int column = 0; column < layout.columns; ++column) {
    const Field* const field = field_at(layout, column);
    if (field == nullptr) {
      line.add(0U);
    } else if (field->role == Role::kConstant) {
      line.add_word(*field);
    } else if (is_number(*field)) {
      line.add(count_of_value(*field, values[field->axis]));
    } else {
      line.add(raw_of(*field, content) & mask_of(*field));
    }
  }
  return line.end();
}

}  // namespace

int bytes_of(NumberType type) {
  constexpr int kBytes[] = {1, 1, 2, 2, 4, 4, 4, 3, 3};
  return kBytes[static_cast<int>(type)];
}

std::uint32_t mask_of(const Field& field) {
  return 0xFFFFFFFFU >> (32 - (field.bits != 0 ? field.bits : 8 * bytes_of(field.type)));
}

Verdict decode_input(const Profile& profile, const std::uint8_t* data, int bytes, Sample* sample) {
  *sample = {};
  return read_report(profile.input, data, bytes, sample->axis, sample);
}

int encode_output(const Profile& profile, const Command& command, std::uint8_t* data) {
  return write_report(profile.output, command.effort, command, data);
}

int encode_input(const Profile& profile, const Sample& sample, std::uint8_t* data) {
  return write_report(profile.input, sample.axis, sample, data);
}

bool decode_output(const Profile& profile, const std::uint8_t* data, int bytes, Command* command) {
  *command = {};
  command->is_enabled = true;  // unless a field says otherwise
  return read_report(profile.output, data, bytes, command->effort, command) == Verdict::kGood;
}

}  // namespace fdcg::dev
