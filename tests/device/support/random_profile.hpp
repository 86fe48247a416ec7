// SPDX-License-Identifier: Apache-2.0
// Random profiles that are in order: fields in any order and of any type with gaps between them, with and without an id,
// counters, constants and a checksum.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "profile/crc.hpp"
#include "profile/profile.hpp"

namespace fdcg::dev {

class RandomProfile {
 public:
  explicit RandomProfile(std::mt19937_64& random) : random_(random) {}

  Profile make() {
    Profile profile;
    profile.match = {0x1209, 1, -1, -1, -1};
    profile.rate_hz = 100 + below(8000);
    profile.axis_count = 1 + below(kMaxAxes);
    profile.has_output = true;
    lay_out({Role::kSequence, Role::kTime, Role::kEcho, Role::kButtons, Role::kStatus}, Role::kAxis, profile.axis_count,
            &profile.input);
    lay_out({Role::kSequence, Role::kEcho, Role::kEnable}, Role::kEffort, profile.axis_count, &profile.output);
    return profile;
  }

 private:
  int below(int end) { return static_cast<int>(random_() % static_cast<unsigned>(end)); }

  Field number(Role role, int axis) {
    Field field;
    field.role = role;
    field.axis = static_cast<std::uint8_t>(axis);
    field.type = static_cast<NumberType>(below(9));
    field.scale = std::pow(10.0, -8 + below(9)) * (1 + below(9)) * (below(2) == 0 ? 1 : -1);
    field.bias = below(2) == 0 ? 0 : (below(2001) - 1000) * 1e-3;
    return field;
  }

  Field counter(Role role) {
    constexpr NumberType kTypes[] = {NumberType::kU8, NumberType::kU16, NumberType::kU24, NumberType::kU32};
    Field field;
    field.role = role;
    field.type = kTypes[below(4)];
    if (role == Role::kTime) field.scale = 1e-3;
    field.constant = 1 + below(255);
    return field;
  }

  // Some of the type's bits, enough for a constant and a clock.
  void pack(Field* field) {
    const int width = 8 * bytes_of(field->type);
    field->is_big_endian = false;
    field->bit = static_cast<std::uint8_t>(below(8));
    field->bits = static_cast<std::uint8_t>(8 + below(width - 7));
  }

  void lay_out(const std::vector<Role>& counters, Role numbers, int axis_count, ReportLayout* layout) {
    std::vector<Field> fields;
    for (int axis = 0; axis < axis_count; ++axis)
      fields.push_back(number(numbers, axis));
    for (const Role role : counters) {
      if (below(3) != 0) fields.push_back(counter(role));
    }
    for (int i = below(4); i > 0; --i)
      fields.push_back(counter(Role::kConstant));
    std::shuffle(fields.begin(), fields.end(), random_);
    layout->id = static_cast<std::uint8_t>(below(2) * below(256));
    int end = layout->id != 0 ? 1 : 0;
    for (Field& field : fields) {
      end += below(5) == 0 ? below(6) : 0;
      field.offset = static_cast<std::uint16_t>(end);
      field.is_big_endian = below(2) == 0;
      if (below(5) == 0 && field.type != NumberType::kF32) pack(&field);
      end += field.bits != 0 ? (field.bit + field.bits + 7) / 8 : bytes_of(field.type);
      layout->fields[layout->field_count++] = field;
    }
    Crc& crc = layout->crc;
    crc.kind = static_cast<CrcKind>(below(7));
    if (crc.kind != CrcKind::kNone) {
      crc.is_big_endian = below(2) == 0;
      crc.offset = static_cast<std::uint16_t>(end);
      crc.first = static_cast<std::uint16_t>(below(end));
      crc.bytes = static_cast<std::uint16_t>(1 + below(end - crc.first));
      end += bytes_of(crc.kind);
    }
    layout->bytes = static_cast<std::uint16_t>(end + below(4));
  }

  std::mt19937_64& random_;
};

inline Profile random_profile(std::mt19937_64& random) {
  return RandomProfile(random).make();
}

}  // namespace fdcg::dev
