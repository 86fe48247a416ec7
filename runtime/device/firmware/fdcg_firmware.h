/* SPDX-License-Identifier: Apache-2.0 */
/* The device's side of the reference protocol (schemas/fdcg-hid.md) for a force-feedback device's firmware: C11, no heap, no
 * dependency but memcpy. It makes and judges the bytes, keeps the watchdog, and says which force the motors may have; USB,
 * encoders, motors and their currents are the firmware's own.
 *
 *   at reset                    fdcg_fw_init(&fw, &config)
 *   every 1 / rate_hz           fdcg_fw_make_input(&fw, time_us, counts, buttons, report): hand it to the IN endpoint
 *   a packet on the OUT endpoint  fdcg_fw_take_output(&fw, time_us, packet, n)
 *   every step of the motors    fdcg_fw_force(&fw, time_us, force): drive exactly that
 *   GET_REPORT(Feature, 3)      fdcg_fw_feature(&fw, report)
 *   USB reset, suspend, unplug  fdcg_fw_stop(&fw)
 *
 * Times are of any clock of the device in microseconds that wraps at 2^32. fdcg_fw_force is called at least once in half an
 * hour, and in truth far more often. Not re-entrant: where these are called from interrupts of different priority, mask the
 * higher ones around each call (the longest takes the time of a CRC over 29 bytes). */
#ifndef FDCG_FIRMWARE_H
#define FDCG_FIRMWARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_FW_VERSION 1u
#define FDCG_FW_USAGE_PAGE 0xFF48u
#define FDCG_FW_USAGE 0x01u

#define FDCG_FW_INPUT_ID 1u
#define FDCG_FW_OUTPUT_ID 2u
#define FDCG_FW_FEATURE_ID 3u
#define FDCG_FW_INPUT_BYTES 29u /* with the report id, as all lengths here */
#define FDCG_FW_OUTPUT_BYTES 24u
#define FDCG_FW_FEATURE_BYTES 48u
#define FDCG_FW_DESCRIPTOR_BYTES 131u

/* Bits of an input report's status. */
#define FDCG_FW_WATCHDOG 0x01u       /* it has tripped: no force until a report with enable clear comes */
#define FDCG_FW_ENABLED 0x02u        /* the force of the last report taken is applied */
#define FDCG_FW_NOT_CALIBRATED 0x04u /* positions mean nothing yet */
#define FDCG_FW_TOO_HOT 0x08u
#define FDCG_FW_POWER_OFF 0x10u /* of the motors: an emergency stop, say */
#define FDCG_FW_FAULT 0x20u     /* anything else that is wrong with the device */
#define FDCG_FW_CLIPPED 0x40u   /* the force asked for was beyond the peak force */
/* What the firmware itself reports with fdcg_fw_set_faults: while any of it is set there is no force. */
#define FDCG_FW_FAULTS (FDCG_FW_NOT_CALIBRATED | FDCG_FW_TOO_HOT | FDCG_FW_POWER_OFF | FDCG_FW_FAULT)

#define FDCG_FW_ENABLE 0x01u /* the one bit of an output report's flags; the others are 0 */

enum { FDCG_FW_CARTESIAN = 0, FDCG_FW_ANGLES = 1 };

typedef struct fdcg_fw_config {
  uint32_t counts_per_unit;                         /* of a position: a metre, or a radian where axes are angles */
  int16_t workspace_min_mm[3], workspace_max_mm[3]; /* of the tip */
  float peak_force_n, continuous_force_n;           /* norm of the three; N m where axes are angles */
  uint16_t rate_hz;                                 /* of input reports */
  uint16_t watchdog_ms;                             /* 20 unless there is a reason */
  uint8_t dof;                                      /* 1 to 3 axes */
  uint8_t axes;                                     /* FDCG_FW_CARTESIAN or FDCG_FW_ANGLES */
} fdcg_fw_config;

/* What became of an output report. All from FDCG_FW_LENGTH on: it is not used, and the watchdog does not see it. */
typedef enum fdcg_fw_verdict {
  FDCG_FW_TAKEN = 0,
  FDCG_FW_HELD = 1, /* taken and echoed, but it asks for force before one with enable clear has come, or in a fault */
  FDCG_FW_LENGTH = 2,
  FDCG_FW_ID = 3,
  FDCG_FW_CRC = 4,
  FDCG_FW_FLAGS = 5, /* a bit that has no meaning is set */
  FDCG_FW_NOT_FINITE = 6,
  FDCG_FW_OLD = 7,  /* its sequence number is not ahead of the last one */
  FDCG_FW_STALE = 8 /* it answers an input report that is older than the watchdog's time, or one not yet sent */
} fdcg_fw_verdict;

/* All that the protocol remembers. The members are the protocol's own: use the functions. */
typedef struct fdcg_fw {
  fdcg_fw_config config;
  float force_n[3];
  uint32_t sequence; /* of the last input report made */
  uint32_t echo;     /* sequence of the last output report taken */
  uint32_t taken_us; /* when */
  uint32_t watchdog_us;
  uint32_t most_behind; /* input reports that go in the watchdog's time */
  uint8_t status;
  bool is_held;  /* no force until a report with enable clear */
  bool is_valid; /* the configuration makes sense */
} fdcg_fw;

/* The HID report descriptor, as GET_DESCRIPTOR(Report) answers it. */
extern const uint8_t fdcg_fw_report_descriptor[FDCG_FW_DESCRIPTOR_BYTES];

/* False: the configuration makes no sense (a force that is not positive and finite, a rate, watchdog or resolution of 0, dof
 * not 1 to 3); the device then reports FDCG_FW_FAULT and never gives force. No force until a host has asked for it. */
bool fdcg_fw_init(fdcg_fw* fw, const fdcg_fw_config* config);
/* No force, as after power-up. The sequence of input reports goes on. */
void fdcg_fw_stop(fdcg_fw* fw);
/* All the device's own faults at this moment, of FDCG_FW_FAULTS; 0: none. While there are any there is no force, and afterwards
 * not before a report with enable clear. */
void fdcg_fw_set_faults(fdcg_fw* fw, uint8_t faults);
/* The next input report, FDCG_FW_INPUT_BYTES of them. counts: of config.dof axes, the others are 0. */
void fdcg_fw_make_input(fdcg_fw* fw, uint32_t time_us, const int32_t counts[3], uint8_t buttons, uint8_t* report);
/* Bytes that came, the report id first. */
fdcg_fw_verdict fdcg_fw_take_output(fdcg_fw* fw, uint32_t time_us, const uint8_t* bytes, size_t count);
/* What the motors may have now: finite, no longer than peak_force_n, zero once the watchdog's time has passed. */
void fdcg_fw_force(fdcg_fw* fw, uint32_t time_us, float force_n[3]);
/* The feature report, FDCG_FW_FEATURE_BYTES of them. */
void fdcg_fw_feature(const fdcg_fw* fw, uint8_t* report);
/* CRC-16/CCITT-FALSE: polynomial 0x1021, from 0xFFFF, no reflection; of "123456789" it is 0x29B1. */
uint16_t fdcg_fw_crc16(const uint8_t* bytes, size_t count);

#ifdef __cplusplus
}
#endif

#endif
