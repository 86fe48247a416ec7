/* SPDX-License-Identifier: Apache-2.0 */
#include "fdcg_firmware.h"

#include <string.h>

/* The logical range of 32-bit fields is all of int32: HID's items have no other way to say "every pattern of 32 bits". */
const uint8_t fdcg_fw_report_descriptor[FDCG_FW_DESCRIPTOR_BYTES] = {
    0x06, 0x48, 0xFF,             /* Usage Page (Vendor Defined 0xFF48) */
    0x09, 0x01,                   /* Usage (0x01: force-feedback device) */
    0xA1, 0x01,                   /* Collection (Application) */
    0x85, 0x01,                   /*   Report ID (1): input */
    0x17, 0x00, 0x00, 0x00, 0x80, /*   Logical Minimum (-2147483648) */
    0x27, 0xFF, 0xFF, 0xFF, 0x7F, /*   Logical Maximum (2147483647) */
    0x75, 0x20,                   /*   Report Size (32) */
    0x95, 0x06,                   /*   Report Count (6) */
    0x09, 0x10,                   /*   Usage (0x10: sequence) */
    0x09, 0x11,                   /*   Usage (0x11: device time) */
    0x09, 0x12,                   /*   Usage (0x12: position 0) */
    0x09, 0x13,                   /*   Usage (0x13: position 1) */
    0x09, 0x14,                   /*   Usage (0x14: position 2) */
    0x09, 0x15,                   /*   Usage (0x15: echo) */
    0x81, 0x02,                   /*   Input (Data, Variable, Absolute) */
    0x15, 0x00,                   /*   Logical Minimum (0) */
    0x26, 0xFF, 0x00,             /*   Logical Maximum (255) */
    0x75, 0x08,                   /*   Report Size (8) */
    0x95, 0x02,                   /*   Report Count (2) */
    0x09, 0x16,                   /*   Usage (0x16: buttons) */
    0x09, 0x17,                   /*   Usage (0x17: status) */
    0x81, 0x02,                   /*   Input (Data, Variable, Absolute) */
    0x27, 0xFF, 0xFF, 0x00, 0x00, /*   Logical Maximum (65535) */
    0x75, 0x10,                   /*   Report Size (16) */
    0x95, 0x01,                   /*   Report Count (1) */
    0x09, 0x18,                   /*   Usage (0x18: CRC) */
    0x81, 0x02,                   /*   Input (Data, Variable, Absolute) */
    0x85, 0x02,                   /*   Report ID (2): output */
    0x17, 0x00, 0x00, 0x00, 0x80, /*   Logical Minimum (-2147483648) */
    0x27, 0xFF, 0xFF, 0xFF, 0x7F, /*   Logical Maximum (2147483647) */
    0x75, 0x20,                   /*   Report Size (32) */
    0x95, 0x05,                   /*   Report Count (5) */
    0x09, 0x20,                   /*   Usage (0x20: sequence) */
    0x09, 0x21,                   /*   Usage (0x21: force 0, a float's bits) */
    0x09, 0x22,                   /*   Usage (0x22: force 1) */
    0x09, 0x23,                   /*   Usage (0x23: force 2) */
    0x09, 0x24,                   /*   Usage (0x24: sequence of the input report answered) */
    0x91, 0x02,                   /*   Output (Data, Variable, Absolute) */
    0x15, 0x00,                   /*   Logical Minimum (0) */
    0x26, 0xFF, 0x00,             /*   Logical Maximum (255) */
    0x75, 0x08,                   /*   Report Size (8) */
    0x95, 0x01,                   /*   Report Count (1) */
    0x09, 0x25,                   /*   Usage (0x25: flags) */
    0x91, 0x02,                   /*   Output (Data, Variable, Absolute) */
    0x27, 0xFF, 0xFF, 0x00, 0x00, /*   Logical Maximum (65535) */
    0x75, 0x10,                   /*   Report Size (16) */
    0x09, 0x26,                   /*   Usage (0x26: CRC) */
    0x91, 0x02,                   /*   Output (Data, Variable, Absolute) */
    0x85, 0x03,                   /*   Report ID (3): feature */
    0x26, 0xFF, 0x00,             /*   Logical Maximum (255) */
    0x75, 0x08,                   /*   Report Size (8) */
    0x95, 0x2F,                   /*   Report Count (47) */
    0x09, 0x30,                   /*   Usage (0x30: what the device is) */
    0xB1, 0x02,                   /*   Feature (Data, Variable, Absolute) */
    0xC0,                         /* End Collection */
};

/* Four bits at a time: 32 bytes of table, a quarter of the time of bit by bit. */
uint16_t fdcg_fw_crc16(const uint8_t* bytes, size_t count) {
  static const uint16_t table[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5, 0x60C6, 0x70E7,
                                     0x8108, 0x9129, 0xA14A, 0xB16B, 0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};
  uint16_t crc = 0xFFFF;
  for (size_t i = 0; i < count; ++i) {
    crc = (uint16_t)(crc << 4) ^ table[(crc >> 12) ^ (bytes[i] >> 4)];
    crc = (uint16_t)(crc << 4) ^ table[(crc >> 12) ^ (bytes[i] & 15)];
  }
  return crc;
}

/* Byte by byte: fields are not aligned, and the processor may be of either byte order. */
static uint8_t* put16(uint8_t* at, uint32_t value) {
  at[0] = (uint8_t)value;
  at[1] = (uint8_t)(value >> 8);
  return at + 2;
}

static uint8_t* put32(uint8_t* at, uint32_t value) {
  return put16(put16(at, value), value >> 16);
}

static uint32_t get32(const uint8_t* at) {
  return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void drop_force(fdcg_fw* fw) {
  fw->force_n[0] = fw->force_n[1] = fw->force_n[2] = 0;
  fw->status &= (uint8_t) ~(FDCG_FW_ENABLED | FDCG_FW_CLIPPED);
}

static void look_after_watchdog(fdcg_fw* fw, uint32_t time_us) {
  if (!(fw->status & FDCG_FW_ENABLED) || time_us - fw->taken_us < fw->watchdog_us) return;
  drop_force(fw);
  fw->status |= FDCG_FW_WATCHDOG;
  fw->is_held = true;
}

bool fdcg_fw_init(fdcg_fw* fw, const fdcg_fw_config* config) {
  memset(fw, 0, sizeof *fw);
  fw->config = *config;
  /* the comparisons are false for a NaN; 1e6 keeps thousandths within 32 bits */
  fw->is_valid = config->counts_per_unit > 0 && config->peak_force_n > 0 && config->peak_force_n <= 1e6f &&
                 config->continuous_force_n > 0 && config->continuous_force_n <= config->peak_force_n && config->rate_hz > 0 &&
                 config->watchdog_ms > 0 && config->dof >= 1 && config->dof <= 3 && config->axes <= FDCG_FW_ANGLES;
  fw->watchdog_us = config->watchdog_ms * 1000u;
  fw->most_behind = ((uint32_t)config->watchdog_ms * config->rate_hz + 999u) / 1000u;
  fw->is_held = true;
  if (!fw->is_valid) fw->status = FDCG_FW_FAULT;
  return fw->is_valid;
}

void fdcg_fw_stop(fdcg_fw* fw) {
  drop_force(fw);
  fw->status &= (uint8_t)~FDCG_FW_WATCHDOG;
  fw->is_held = true;
}

void fdcg_fw_set_faults(fdcg_fw* fw, uint8_t faults) {
  faults &= FDCG_FW_FAULTS;
  if (!fw->is_valid) faults |= FDCG_FW_FAULT;
  fw->status = (uint8_t)((fw->status & ~FDCG_FW_FAULTS) | faults);
  if (faults == 0) return;
  drop_force(fw);
  fw->is_held = true;
}

void fdcg_fw_make_input(fdcg_fw* fw, uint32_t time_us, const int32_t counts[3], uint8_t buttons, uint8_t* report) {
  look_after_watchdog(fw, time_us);
  uint8_t* at = report;
  *at++ = FDCG_FW_INPUT_ID;
  at = put32(at, ++fw->sequence);
  at = put32(at, time_us);
  for (int i = 0; i < 3; ++i)
    at = put32(at, i < fw->config.dof ? (uint32_t)counts[i] : 0);
  at = put32(at, fw->echo);
  *at++ = buttons;
  *at++ = fw->status;
  put16(at, fdcg_fw_crc16(report, FDCG_FW_INPUT_BYTES - 2));
}

/* The norm is found on numbers of at most 1, so that no square overflows, and by Newton's method: no libm. */
static void set_force(fdcg_fw* fw, float force_n[3]) {
  const float peak_n = fw->config.peak_force_n * (1.0f - 0x1p-20f); /* roundings must not lift it above the peak */
  float largest = 0;
  for (int i = 0; i < 3; ++i) {
    if (i >= fw->config.dof) force_n[i] = 0;
    const float size = force_n[i] < 0 ? -force_n[i] : force_n[i];
    if (size > largest) largest = size;
  }
  float share = 1;
  if (largest > peak_n * 0.5f) { /* below, even three of them are shorter than the peak */
    float squares = 0;
    for (int i = 0; i < 3; ++i)
      squares += (force_n[i] / largest) * (force_n[i] / largest);
    float norm = 1.5f; /* of a square between 1 and 3: four steps are exact to a float's last bits */
    for (int i = 0; i < 4; ++i)
      norm = 0.5f * (norm + squares / norm);
    share = peak_n / largest / norm;
  }
  fw->status &= (uint8_t)~FDCG_FW_CLIPPED;
  if (share < 1) fw->status |= FDCG_FW_CLIPPED;
  for (int i = 0; i < 3; ++i)
    fw->force_n[i] = share < 1 ? force_n[i] * share : force_n[i];
}

static bool read_force(const uint8_t* at, float force_n[3]) {
  for (int i = 0; i < 3; ++i) {
    const uint32_t bits = get32(at + 4 * i);
    if ((bits & 0x7F800000u) == 0x7F800000u) return false; /* infinite or not a number */
    memcpy(&force_n[i], &bits, sizeof bits);
  }
  return true;
}

fdcg_fw_verdict fdcg_fw_take_output(fdcg_fw* fw, uint32_t time_us, const uint8_t* bytes, size_t count) {
  look_after_watchdog(fw, time_us); /* a report that comes too late must find it tripped, whichever call is first */
  if (count != FDCG_FW_OUTPUT_BYTES) return FDCG_FW_LENGTH;
  if (bytes[0] != FDCG_FW_OUTPUT_ID) return FDCG_FW_ID;
  const uint16_t crc = fdcg_fw_crc16(bytes, FDCG_FW_OUTPUT_BYTES - 2);
  if (bytes[22] != (uint8_t)crc || bytes[23] != (uint8_t)(crc >> 8)) return FDCG_FW_CRC;
  const uint8_t flags = bytes[21];
  if (flags & ~FDCG_FW_ENABLE) return FDCG_FW_FLAGS;
  float force_n[3];
  if (!read_force(bytes + 5, force_n)) return FDCG_FW_NOT_FINITE;

  const uint32_t sequence = get32(bytes + 1);
  if (!(flags & FDCG_FW_ENABLE)) { /* zero force is safe: accepted with any sequence number, e.g. from a restarted host */
    drop_force(fw);
    fw->status &= (uint8_t)~FDCG_FW_WATCHDOG;
    fw->is_held = false;
  } else {
    const uint32_t ahead = sequence - fw->echo;
    if (ahead == 0 || ahead > 0x7FFFFFFFu) return FDCG_FW_OLD;
    if (fw->sequence - get32(bytes + 17) > fw->most_behind) return FDCG_FW_STALE;
  }
  fw->echo = sequence;
  fw->taken_us = time_us;
  if (!(flags & FDCG_FW_ENABLE)) return FDCG_FW_TAKEN;
  if (fw->is_held || (fw->status & FDCG_FW_FAULTS)) return FDCG_FW_HELD;
  fw->status |= FDCG_FW_ENABLED;
  set_force(fw, force_n);
  return FDCG_FW_TAKEN;
}

void fdcg_fw_force(fdcg_fw* fw, uint32_t time_us, float force_n[3]) {
  look_after_watchdog(fw, time_us);
  memcpy(force_n, fw->force_n, sizeof fw->force_n);
}

void fdcg_fw_feature(const fdcg_fw* fw, uint8_t* report) {
  const fdcg_fw_config* config = &fw->config;
  memset(report, 0, FDCG_FW_FEATURE_BYTES);
  uint8_t* at = report;
  *at++ = FDCG_FW_FEATURE_ID;
  at = put16(at, FDCG_FW_VERSION);
  *at++ = config->dof;
  *at++ = config->axes;
  at = put32(at, config->counts_per_unit);
  for (int i = 0; i < 3; ++i)
    at = put16(at, (uint16_t)config->workspace_min_mm[i]);
  for (int i = 0; i < 3; ++i)
    at = put16(at, (uint16_t)config->workspace_max_mm[i]);
  at = put32(at, fw->is_valid ? (uint32_t)(config->peak_force_n * 1000 + 0.5f) : 0);
  at = put32(at, fw->is_valid ? (uint32_t)(config->continuous_force_n * 1000 + 0.5f) : 0);
  at = put16(at, config->rate_hz);
  put16(at, config->watchdog_ms);
  put16(report + FDCG_FW_FEATURE_BYTES - 2, fdcg_fw_crc16(report, FDCG_FW_FEATURE_BYTES - 2));
}
