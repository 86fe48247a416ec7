/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/transport.h
 * Devices of one's own: what fdcg_device asks of a device that is not HID. A plugin is a shared object that a scene names; a
 * program may hand one over itself (fdcg_host_set_transport). The host's judge, gate, watchdogs and log are the same for all
 * devices.
 *
 *     static int my_open(void* self, fdcg_host_message* why) { ... return 0; }
 *     int fdcg_transport_create(uint32_t abi, const char* settings, fdcg_transport* transport, fdcg_host_message* why) {
 *       if (abi != FDCG_TRANSPORT_ABI) return FDCG_TRANSPORT_FAILED;
 *       transport->open = my_open; ...
 *       return FDCG_TRANSPORT_OK;
 *     }
 *
 *     cc -shared -fPIC -o my_device.so my_device.c
 *
 * **Threads.** open and close are called by one thread, never while another function is inside. read is called by the servo
 * thread, write by a second one, both at once. read and write take no lock that the other holds, and read allocates nothing.
 *
 * **Units and frame.** Metres, newtons, newton metres, seconds, in the device's own right-handed frame. The scene maps it into
 * the world.
 */
#ifndef FDCG_TRANSPORT_H
#define FDCG_TRANSPORT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FDCG_TRANSPORT_ABI 1u /**< of this header: a plugin refuses any other */

/** One line for the user: what is wrong, where, and what to do. Empty where there is nothing to say. */
typedef struct fdcg_host_message {
  char text[1024]; /**< zero-terminated */
} fdcg_host_message;

/** What the functions of a transport return. */
enum {
  FDCG_TRANSPORT_FAILED = -1, /**< open: with a message. read: the device is gone. write: not taken */
  FDCG_TRANSPORT_OK = 0,      /**< read: nothing came within the time */
  FDCG_TRANSPORT_SAMPLE = 1   /**< read: *sample is the oldest that was not read yet */
};

/** What a device says once a period. All zeros before read is called. */
typedef struct fdcg_transport_sample {
  double position_m[3];       /**< of the tip, within 2 m of the origin: farther, or NaN, is a fault of the device */
  double orientation_xyzw[4]; /**< of the handle, real part last; zeros: not measured. Kept for later: not used yet */
  double time_s;              /**< of the device's own clock, for the age of samples */
  uint32_t sequence;          /**< one more with every sample that the device makes, sent or not; wraps */
  uint32_t echo;              /**< sequence of the last force that it took; 0: none yet */
  uint32_t buttons;           /**< bit n: button n is pressed */
  uint32_t flags;             /**< FDCG_TRANSPORT_FAULT, FDCG_TRANSPORT_ENABLED */
} fdcg_transport_sample;

enum {
  FDCG_TRANSPORT_FAULT = 1,  /**< the device gives no force, for a reason of its own */
  FDCG_TRANSPORT_ENABLED = 2 /**< it applies the last force that it took */
};

/** What the motors are to do until the next one. */
typedef struct fdcg_transport_force {
  double force_n[3];   /**< on the hand; within the limits of the scene and the profile */
  double torque_nm[3]; /**< zeros: kept for later */
  uint32_t sequence;   /**< one more with every force that is sent; begins with 1 */
  uint32_t answers;    /**< sequence of the sample that it was computed from */
  uint32_t is_enabled; /**< 0: no force, whatever stands above */
  uint32_t reserved;   /**< 0 */
} fdcg_transport_force;

/** A device. The host fills struct_bytes, zeroes the rest, and keeps a copy. What is marked so may be NULL. */
typedef struct fdcg_transport {
  uint32_t struct_bytes; /**< sizeof(fdcg_transport) of the host */
  uint32_t reserved;     /**< 0 */
  void* self;            /**< handed to each function */
  /** Opens the device, and says in `why` what is missing. May take as long as it needs; it is tried again. */
  int (*open)(void* self, fdcg_host_message* why);
  /** Closes it. Only called while it is open. */
  void (*close)(void* self);
  /** Waits up to timeout_ms (0: not at all). After FDCG_TRANSPORT_FAILED the device is closed, and opened when it is back. */
  int (*read)(void* self, int32_t timeout_ms, fdcg_transport_sample* sample);
  /** May block; after 5 ms in it the gate disarms. */
  int (*write)(void* self, const fdcg_transport_force* force);
  /** May be NULL. Zero force as the last act of a process that dies of a signal, and where the thread that writes hangs:
   * async-signal-safe, from any thread, at any moment while the device is open. */
  void (*emergency)(void* self);
  /** May be NULL. After the last call of any other. */
  void (*destroy)(void* self);
} fdcg_transport;

/** The one function of a plugin. `settings`: the scene's object of that name as JSON text, "{}" without. */
typedef int (*fdcg_transport_create_function)(uint32_t abi, const char* settings, fdcg_transport* transport,
                                              fdcg_host_message* why);
#define FDCG_TRANSPORT_CREATE "fdcg_transport_create" /**< its name */

#ifdef __cplusplus
}
#endif

#endif /* FDCG_TRANSPORT_H */
