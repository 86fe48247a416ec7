// SPDX-License-Identifier: Apache-2.0
// A device profile as the loop uses it: a fixed table, no string, no pointer, no heap. profile_json.hpp fills it from JSON;
// report_codec.hpp reads and writes reports by it. Lengths in metres, angles in radians, forces in newtons, torques in newton
// metres, times in seconds. Offsets and lengths count from the report's first byte, the report id where there is one (id 0:
// the device has none, and its reports begin with data).
#pragma once

#include <cstdint>

namespace fdcg::dev {

inline constexpr int kMaxAxes = 3;
inline constexpr int kMaxFields = 24;  // of one report
inline constexpr int kMaxReportBytes = 128;
inline constexpr int kMaxFixedReports = 8;  // init, and as many to stop safely
inline constexpr int kProfileNameBytes = 64;
inline constexpr double kSilenceS = 0.010;  // without a good report: the gate disarms

enum class NumberType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kF32, kU24, kI24 };
int bytes_of(NumberType type);

// What a field is. Input: axis, sequence, time, echo, buttons, status, constant. Output: effort, sequence, echo, enable,
// constant.
enum class Role : std::uint8_t { kAxis, kEffort, kSequence, kTime, kEcho, kButtons, kStatus, kEnable, kConstant };

struct Field {
  Role role = Role::kConstant;
  NumberType type = NumberType::kU8;
  bool is_big_endian = false;
  std::uint8_t axis = 0;     // of kAxis and kEffort
  std::uint16_t offset = 0;  // bytes; in a line of text the column
  double scale = 1;  // value = raw * scale + bias; kEffort: raw = (value - bias) / scale, rounded to nearest, held in range
  double bias = 0;
  std::uint32_t constant = 0;  // kConstant: the raw value; kEnable: the raw value while armed (0 otherwise); kStatus: mask of
                               // the bits that say that the device has a fault
  std::uint32_t enabled = 0;   // kStatus: mask of the bits that say that the device applies the force; 0: it does not tell
  std::uint8_t bits = 0;       // so many from `bit` of the byte at offset on, upwards, the least bit being 0; 0: whole bytes
  std::uint8_t bit = 0;
};

// All bits of a field's raw value.
std::uint32_t mask_of(const Field& field);

enum class CrcKind : std::uint8_t { kNone, kCrc16CcittFalse, kCrc16Modbus, kCrc32, kCrc8, kSum8, kXor8 };

struct Crc {
  CrcKind kind = CrcKind::kNone;
  bool is_big_endian = false;
  std::uint16_t offset = 0;            // where it stands
  std::uint16_t first = 0, bytes = 0;  // what it covers
};

// Bytes, or a line of text: numbers in columns, apart by the separator, a line's end after them (text_report.hpp).
struct ReportLayout {
  std::uint8_t id = 0;       // 0 of text
  std::uint16_t bytes = 0;   // exact length of a valid report, id included where it is not 0; of text the longest
  std::uint8_t columns = 0;  // of text; 0: bytes
  char separator = ' ';      // of text; ' ' stands for any number of spaces and tabs
  std::uint8_t field_count = 0;
  Field fields[kMaxFields];
  Crc crc;

  bool is_text() const { return columns != 0; }
};

// A report sent as it stands: to initialise the device, or to make it safe.
struct FixedReport {
  bool is_feature = false;  // a feature report; otherwise an output report
  std::uint16_t bytes = 0;  // the first is the report id, 0 where the device has none
  std::uint8_t data[kMaxReportBytes] = {};
};

// Of a HID device; vendor 0: the profile is of a device on a serial line.
struct Match {
  std::uint16_t vendor = 0, product = 0;
  std::int32_t usage_page = -1, usage = -1, interface_number = -1;  // -1: any
};

enum class KinematicsKind : std::uint8_t { kCartesian, kRotary, kSerialArm, kDelta };

// Parameters by kind (kinematics.hpp says what each means).
struct KinematicsParams {
  KinematicsKind kind = KinematicsKind::kCartesian;
  double lengths_m[6] = {};
  double angles_rad[6] = {};
};

// Limits of the device and the hand, in the device's frame. A limit that is not known (0, not finite) means no force.
struct DeviceLimits {
  double force_n = 0;
  double effort[kMaxAxes] = {};  // of each axis: N (cartesian) or N m
  double slew_n_per_s = 0;
  double velocity_m_per_s = 0;
  double workspace_min_m[3] = {}, workspace_max_m[3] = {};  // of the tip
  double device_watchdog_s = 0;                             // the device drops its force by itself after this; 0: it has none
  // Known of some; 0: not known, and not judged.
  double continuous_force_n = 0;  // that the motors stand for hours
  double heat_s = 0;              // time constant of their heat, with continuous_force_n
  double damping_n_s_per_m = 0;   // of the mechanism: what a stiffness may rest on (K T / 2 <= b)
  double stiffness_n_per_m = 0;   // the largest that the maker allows
};

struct Profile {
  char name[kProfileNameBytes] = {};
  Match match;
  double rate_hz = 0;  // of input reports
  int axis_count = 0;
  ReportLayout input, output;
  bool has_output = false;
  int init_count = 0, safe_stop_count = 0;
  FixedReport init[kMaxFixedReports], safe_stop[kMaxFixedReports];
  KinematicsParams kinematics;
  DeviceLimits limits;
};

}  // namespace fdcg::dev
