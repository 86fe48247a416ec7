// SPDX-License-Identifier: Apache-2.0
#include "profile/profile_reports.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "profile/crc.hpp"
#include "profile/report_codec.hpp"
#include "profile/text_report.hpp"

namespace fdcg::dev {
namespace {

// A clock with coarser steps makes fresh reports look old; one that wraps sooner cannot show a report's age.
constexpr double kMostTimeStepS = kMaxAgeS / 2;
constexpr double kLeastTimeRoundS = 10 * kMaxAgeS;

// In the order of NumberType, Role and CrcKind.
constexpr json::Keys kTypes{"u8", "i8", "u16", "i16", "u32", "i32", "f32", "u24", "i24"};
constexpr json::Keys kRoles{"axis", "effort", "sequence", "time", "echo", "buttons", "status", "enable", "constant"};
constexpr json::Keys kCrcKinds{"none", "crc16-ccitt-false", "crc16-modbus", "crc32", "crc8", "sum8", "xor8"};
constexpr json::Keys kEndians{"little", "big"};
constexpr json::Keys kFormats{"bytes", "text"};
constexpr json::Keys kSeparators{"space", "comma", "semicolon"};

const char* name_of(Role role) {
  return kRoles.begin()[static_cast<int>(role)];
}

bool is_unsigned(NumberType type) {
  return type == NumberType::kU8 || type == NumberType::kU16 || type == NumberType::kU24 || type == NumberType::kU32;
}

std::string byte_range(int offset, int bytes) {
  return bytes == 1 ? "byte " + std::to_string(offset)
                    : "bytes " + std::to_string(offset) + " to " + std::to_string(offset + bytes - 1);
}

// One report while it is read.
class Report {
 public:
  Report(const json::Value& json, bool is_input, KinematicsKind kinematics, ReportLayout* layout)
      : json_(json), is_input_(is_input), is_cartesian_(kinematics == KinematicsKind::kCartesian), layout_(layout) {}

  void read() {
    const bool is_text = json_["format"].choice_or(0, kFormats) == 1;
    if (is_text) return read_text();
    json_.allow_only({"format", "report_id", "bytes", "fields", "crc"}, " of a report that is bytes");
    layout_->id = static_cast<std::uint8_t>(json_["report_id"].id(0xFF));
    layout_->bytes = static_cast<std::uint16_t>(json_["bytes"].integer(1, kMaxReportBytes));
    owners_.assign(8 * layout_->bytes, "");
    if (layout_->id != 0) std::fill_n(owners_.begin(), 8, json_["report_id"].path());
    read_fields();
    if (json_["crc"]) read_crc(json_["crc"].object({"kind", "offset", "first", "bytes", "endian"}));
  }

  // The axes (or efforts) 0, 1, ... up to the largest stand there once each; how many.
  int count_axes(Role role) const {
    int count = 0;
    for (int axis = 0; axis < kMaxAxes; ++axis) {
      if (found_[axis] == 0) continue;
      if (axis == count)
        ++count;
      else
        json_["fields"].fail(std::string("have ") + name_of(role) + " " + std::to_string(axis) + " but no " + name_of(role) +
                             " " + std::to_string(count) + "; number them from 0 on");
    }
    return count;
  }

 private:
  static constexpr json::Keys kFieldKeys{"role",   "axis",  "offset", "column", "type",       "bit",          "bits",
                                         "endian", "scale", "bias",   "unit",   "fault_mask", "enabled_mask", "value"};

  void read_text() {
    json_.allow_only({"format", "columns", "separator", "fields"}, " of a report that is text");
    layout_->columns = static_cast<std::uint8_t>(json_["columns"].integer(1, kMaxColumns));
    layout_->separator = " ,;"[json_["separator"].choice_or(0, kSeparators)];
    owners_.assign(layout_->columns, "");
    read_fields();
    const int longest = longest_line(*layout_);
    if (longest > kMaxReportBytes)
      json_["columns"].fail("make lines of up to " + std::to_string(longest) + " bytes; " + std::to_string(kMaxReportBytes) +
                            " are taken");
    layout_->bytes = kMaxReportBytes;
  }

  void read_fields() {
    for (const json::Value& field : json_["fields"].objects(1, kMaxFields, kFieldKeys))
      read_field(field, &layout_->fields[layout_->field_count++]);
  }

  // Where a field stands, and as what.
  void place(const json::Value& json, Field* field) {
    return layout_->is_text() ? place_column(json, field) : place_bytes(json, field);
  }

  void place_column(const json::Value& json, Field* field) {
    field->offset = static_cast<std::uint16_t>(json["column"].integer(0, layout_->columns - 1));
    std::string& owner = owners_[field->offset];
    if (!owner.empty()) json["column"].fail("is " + std::to_string(field->offset) + ", which is " + owner + " too");
    owner = json["column"].path();
    const bool is_whole = field->role != Role::kAxis && field->role != Role::kEffort && field->role != Role::kConstant;
    field->type = NumberType::kU32;
    if (json["type"] && is_whole) field->type = static_cast<NumberType>(json["type"].choice(kTypes));
  }

  void place_bytes(const json::Value& json, Field* field) {
    field->type = static_cast<NumberType>(json["type"].choice(kTypes));
    field->is_big_endian = json["endian"].choice_or(0, kEndians) == 1;
    field->offset = static_cast<std::uint16_t>(json["offset"].integer(0, layout_->bytes - 1));
    const int width = 8 * bytes_of(field->type);
    if (!json["bits"]) {
      if (json["bit"]) json["bit"].fail("stands without bits, of which it is the first; give both");
      return claim(json, "offset", field->offset, bytes_of(field->type));
    }
    field->bit = static_cast<std::uint8_t>(json["bit"].integer_or(0, 0, 7));
    field->bits = static_cast<std::uint8_t>(json["bits"].integer(1, width));
    if (field->type == NumberType::kF32) json["bits"].fail("are of an f32, which is whole; leave them out");
    if (field->is_big_endian) json["endian"].fail("is \"big\", and bits follow upwards, as HID has them; leave it out");
    claim_bits(json, "offset", 8 * field->offset + field->bit, field->bits);
  }

  // They are within the report, and no other field uses them.
  void claim_bits(const json::Value& json, const char* key, int first, int bits) {
    const int last_byte = (first + bits - 1) / 8, offset = first / 8;
    if (last_byte >= layout_->bytes) {
      json[key].fail("is " + std::to_string(offset) + "; the report has " + std::to_string(layout_->bytes) +
                     " bytes, and the " + std::to_string(bits) + " bits end in byte " + std::to_string(last_byte));
      return;
    }
    for (int i = first; i < first + bits; ++i) {
      std::string& owner = owners_[static_cast<std::size_t>(i)];
      if (!owner.empty()) {
        json[key].fail("is " + std::to_string(offset) + "; bit " + std::to_string(i % 8) + " of byte " + std::to_string(i / 8) +
                       " is " + owner + " too");
        return;
      }
      owner = json[key].path();
    }
  }

  // The bytes are within the report, and no other field uses them.
  void claim(const json::Value& json, const char* key, int offset, int bytes) {
    const int last = layout_->bytes - bytes;
    if (offset > last) {
      json[key].fail("is " + std::to_string(offset) + "; the report has " + std::to_string(layout_->bytes) + " bytes, and " +
                     std::to_string(bytes) + " from there on " +
                     (last < 0 ? "do not fit anywhere" : "fit at 0 to " + std::to_string(last)));
      return;
    }
    for (int i = 8 * offset; i < 8 * (offset + bytes); ++i) {
      std::string& owner = owners_[static_cast<std::size_t>(i)];
      if (!owner.empty()) {
        json[key].fail("is " + std::to_string(offset) + "; " + byte_range(offset, bytes) + " overlap " + owner);
        return;
      }
      owner = json[key].path() + " (" + byte_range(offset, bytes) + ")";
    }
  }

  void read_field(const json::Value& json, Field* field) {
    const Role role = field->role = static_cast<Role>(json["role"].choice(kRoles));
    place(json, field);
    switch (role) {
      case Role::kAxis:
      case Role::kEffort:
        read_number(json, field);
        break;
      case Role::kTime:
        allow(json, role, {"scale", "unit"});
        read_time(json, field);
        break;
      case Role::kStatus:
        allow(json, role, {"fault_mask", "enabled_mask"});
        field->constant = json["fault_mask"].id(mask_of(*field));
        field->enabled = json["enabled_mask"] ? json["enabled_mask"].id(mask_of(*field)) : 0;
        if (field->constant == 0) json["fault_mask"].fail("is 0; set the bits that say that the device has a fault");
        break;
      case Role::kEnable:
      case Role::kConstant:
        allow(json, role, {"value"});
        field->constant =
            layout_->is_text() && role == Role::kConstant ? word(json["value"]) : json["value"].id(mask_of(*field));
        if (role == Role::kEnable && field->constant == 0)
          json["value"].fail("is 0; name what stands there while forces are on");
        break;
      case Role::kSequence:
      case Role::kEcho:
      case Role::kButtons:
        allow(json, role, {});
        break;
    }
    check_role(json, *field);
  }

  // Beside the keys of its place.
  void allow(const json::Value& json, Role role, json::Keys own) const {
    static constexpr json::Keys kInBytes{"role", "offset", "type", "bit", "bits", "endian"}, kInText{"role", "column", "type"},
        kNumberInText{"role", "column"};
    const bool has_no_type = role == Role::kAxis || role == Role::kEffort || role == Role::kConstant;
    const json::Keys placed = !layout_->is_text() ? kInBytes : has_no_type ? kNumberInText : kInText;
    std::vector<std::string> keys(placed.begin(), placed.end());
    keys.insert(keys.end(), own.begin(), own.end());
    json.allow_only(keys, (std::string(" of ") + name_of(role) + " fields").c_str());
  }

  // Of a constant column.
  static std::uint32_t word(const json::Value& json) {
    const std::string text = json.text(kWordBytes);
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const auto letter = static_cast<unsigned char>(text[i]);
      if (letter <= ' ' || letter > '~' || letter == ',' || letter == ';')
        json.fail("is " + json.shown() + "; a word has up to " + std::to_string(kWordBytes) +
                  " letters, digits or signs but , and ;");
      word |= std::uint32_t{letter} << 8 * i;
    }
    return word;
  }

  void read_number(const json::Value& json, Field* field) {
    allow(json, field->role, {"axis", "scale", "bias", "unit"});
    field->axis = static_cast<std::uint8_t>(json["axis"].integer(0, kMaxAxes - 1));
    field->scale = json["scale"].number({-1e6, 1e6});
    if (std::fabs(field->scale) < 1e-12) json["scale"].fail("is too near 0 (1e-12 at least); it is the value of one count");
    field->bias = json["bias"].number_or(0, {-1e6, 1e6});
    const bool is_axis = field->role == Role::kAxis;
    const std::string wanted = is_cartesian_ ? is_axis ? "m" : "N" : is_axis ? "rad" : "N.m";
    const std::string unit = json["unit"].text(16);
    if (unit != wanted)
      json["unit"].fail("is \"" + unit + "\"; " + (is_axis ? "axes" : "efforts") + " of a " +
                        (is_cartesian_ ? "cartesian" : "jointed") + " device are in \"" + wanted + "\": convert by the scale");
    if (found_[field->axis]++ > 0)
      json["axis"].fail("is " + std::to_string(field->axis) + ", which another field has too; each stands there once");
  }

  static void read_time(const json::Value& json, Field* field) {
    field->scale = json["scale"].number({0, kMostTimeStepS, false, "s"});
    if (const std::string unit = json["unit"].text(16); unit != "s") json["unit"].fail("is \"" + unit + "\"; it must be \"s\"");
    const double round_s = field->scale * (mask_of(*field) + 1.0);
    if (round_s < kLeastTimeRoundS)
      json["scale"].fail("lets the clock go round in " + std::to_string(round_s) + " s; the age of reports shows from " +
                         std::to_string(kLeastTimeRoundS) + " s on: leave the field out");
  }

  void check_role(const json::Value& json, const Field& field) {
    const Role role = field.role;
    const bool is_of_input = role == Role::kAxis || role == Role::kTime || role == Role::kButtons || role == Role::kStatus;
    const bool is_of_output = role == Role::kEffort || role == Role::kEnable;
    if (is_input_ ? is_of_output : is_of_input)
      json["role"].fail(std::string("is ") + name_of(role) + ", which only an " + (is_input_ ? "output" : "input") +
                        " report has");
    const bool is_number = role == Role::kAxis || role == Role::kEffort;
    if (!is_number && !is_unsigned(field.type))
      json["type"].fail(std::string("of a ") + name_of(role) + " field must be u8, u16, u24 or u32");
    const bool may_repeat = is_number || role == Role::kStatus || role == Role::kConstant;
    for (const Field* other = layout_->fields; !may_repeat && other != &field; ++other) {
      if (other->role == role)
        json["role"].fail(std::string("is ") + name_of(role) + ", which another field has too; one is read");
    }
  }

  void read_crc(const json::Value& json) {
    Crc& crc = layout_->crc;
    crc.kind = static_cast<CrcKind>(json["kind"].choice(kCrcKinds));
    if (crc.kind == CrcKind::kNone) {
      json.allow_only({"kind"}, " where there is no CRC");
      return;
    }
    crc.is_big_endian = json["endian"].choice_or(0, kEndians) == 1;
    crc.offset = static_cast<std::uint16_t>(json["offset"].integer(0, layout_->bytes - 1));
    crc.first = static_cast<std::uint16_t>(json["first"].integer(0, layout_->bytes - 1));
    crc.bytes = static_cast<std::uint16_t>(json["bytes"].integer(1, layout_->bytes - crc.first));
    claim(json, "offset", crc.offset, bytes_of(crc.kind));
    if (crc.offset + bytes_of(crc.kind) > crc.first && crc.offset < crc.first + crc.bytes)
      json["offset"].fail("is " + std::to_string(crc.offset) + ", within the " + byte_range(crc.first, crc.bytes) +
                          " that it is computed over");
  }

  const json::Value& json_;
  bool is_input_, is_cartesian_;
  ReportLayout* layout_;
  std::vector<std::string> owners_;  // of each byte: which key, for the message
  int found_[kMaxAxes] = {};
};

}  // namespace

void read_input(const json::Value& json, KinematicsKind kinematics, ReportLayout* layout, int* axis_count) {
  Report report(json, true, kinematics, layout);
  report.read();
  *axis_count = report.count_axes(Role::kAxis);
  if (*axis_count == 0) json["fields"].fail("have no axis: say where the device's positions are");
}

void read_output(const json::Value& json, KinematicsKind kinematics, int axis_count, ReportLayout* layout) {
  Report report(json, false, kinematics, layout);
  report.read();
  const int efforts = report.count_axes(Role::kEffort);
  if (efforts != axis_count)
    json["fields"].fail("have " + std::to_string(efforts) + " efforts; the input report has " + std::to_string(axis_count) +
                        " axes, and each of them needs one");
}

}  // namespace fdcg::dev
