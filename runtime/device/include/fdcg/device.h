/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The device host: force-feedback devices, each with a servo thread, a writer thread and a safety gate, that feel a scene;
 * those that press on the same bodies share one servo thread (the scene's "shared"). The whole of it on one screen:
 *
 *   fdcg_host* host;
 *   fdcg_host_message message;
 *   fdcg_host_open("scene.json", &host, &message);                    graphs, profiles, limits; no thread yet
 *   fdcg_host_start(host, &message);                                  devices are opened as they appear
 *   fdcg_host_arm(host, FDCG_ALL_DEVICES);                            each gate decides: hand near, nothing pressed
 *   while (!fdcg_host_wait(host, 100)) { fdcg_host_get_status(host, 0, &status); }
 *   fdcg_host_stop(host, &message);                                   zero force; within 6 s, whatever a device does
 *   fdcg_host_close(host);
 *
 * Scenes are JSON (schemas/servo-scene.schema.json), devices are described by profiles (schemas/device-profile.schema.json).
 * One thread at a time is in a host, but for fdcg_host_request_stop. Everything here may allocate and wait: the loop itself is
 * on threads of the host's own and does neither.
 *
 * Safety: no force before fdcg_host_arm, none after a fault until it is armed anew, never more than the profile and the scene
 * allow. A fault is told by fdcg_device_status. Of devices that share a scene, one that is gone, silent or disarmed by a fault
 * takes its fingers out of it; the others go on, each within its own limits. One that is not armed yet, or was disarmed by
 * fdcg_host_disarm, leaves them in: a hand that gets no force still moves what it presses.
 */
#ifndef FDCG_DEVICE_H
#define FDCG_DEVICE_H

#include "fdcg/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fdcg_host fdcg_host;

/* One line for the user: what is wrong, where, and what to do. Empty where there is nothing to say. */
typedef struct fdcg_host_message {
  char text[1024];
} fdcg_host_message;

/* ---- open, start, stop. `message` may be NULL, and is filled in by every function that takes one. ---------------------- */

/* A host that is NULL is FDCG_E_ARGUMENT where there is a status; the other functions do nothing, or return zeros, and
 * fdcg_host_wait 1: there is nothing to wait for. */

/* FDCG_E_ARGUMENT with the message, and *host NULL, where the scene, a profile or a graph is not right; FDCG_E_IO where the
 * host's threads or its log cannot be started. */
fdcg_status fdcg_host_open(const char* scene_file, fdcg_host** host, fdcg_host_message* message);
/* The same for a scene in memory. `name` stands for the file's in messages, and files are named from its folder. */
fdcg_status fdcg_host_open_text(const char* scene, uint64_t bytes, const char* name, fdcg_host** host,
                                fdcg_host_message* message);
/* A device that is not there is no error: it is waited for. */
fdcg_status fdcg_host_start(fdcg_host* host, fdcg_host_message* message);
/* Zero force, then each profile's safe-stop reports, threads ended, devices closed, log written. FDCG_E_IO with the message
 * where a device did not let go or the log is not whole: the host has stopped all the same. Harmless when it does not run. */
fdcg_status fdcg_host_stop(fdcg_host* host, fdcg_host_message* message);
/* Stops and frees. NULL: nothing. */
void fdcg_host_close(fdcg_host* host);

/* Sleeps up to that long. Not 0: a stop was asked for, or every device has ended (recordings). */
int fdcg_host_wait(fdcg_host* host, int milliseconds);
/* Any thread's, and a signal handler's. */
void fdcg_host_request_stop(fdcg_host* host);
/* For a process that a signal ends: handlers that send zero force as its last act where the way to the device allows (hidraw).
 * Of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS), which they pass on to the handlers that there were,
 * and of every other signal that ends a process by default (SIGINT, SIGTERM, SIGQUIT, SIGUSR1 ...), where nobody handles or
 * ignores it. The process dies of its signal. Once a process; from its main thread, which gets a stack for handlers unless it
 * has one. */
void fdcg_device_install_crash_handlers(void);

/* ---- while it runs ------------------------------------------------------------------------------------------------------ */

#define FDCG_ALL_DEVICES (-1)

int32_t fdcg_host_get_device_count(const fdcg_host* host);
/* As the scene has it; NULL for an index out of range. Valid until the host is closed. */
const char* fdcg_host_get_device_name(const fdcg_host* host, int32_t device);

void fdcg_host_arm(fdcg_host* host, int32_t device);
void fdcg_host_disarm(fdcg_host* host, int32_t device);
/* Of an object that the scene calls driven, by its name. From each device's next tick on. */
fdcg_status fdcg_host_set_pose(fdcg_host* host, const char* object, const fdcg_pose* pose, fdcg_host_message* message);

typedef enum fdcg_device_phase {
  FDCG_DISARMED = 0, /* no force */
  FDCG_RAMPING = 1,  /* armed a moment ago: the force comes up */
  FDCG_ARMED = 2,
  FDCG_FADING = 3 /* reports are missing: the force goes down */
} fdcg_device_phase;

typedef struct fdcg_device_status {
  uint32_t struct_bytes; /* the caller's sizeof(fdcg_device_status) */
  uint32_t is_open;
  uint32_t phase; /* fdcg_device_phase */
  uint32_t fault; /* why it was disarmed last; 0: armed. fdcg_fault_text says it in words. A recording's end: read failed */
  uint32_t arming_refused;
  uint32_t state; /* fdcg_state, of the contact with the largest force */
  double tip_world_m[3];
  double force_n[3];        /* device's frame, as it was sent */
  double wanted_force_n[3]; /* world, before the gate */
  uint64_t ticks, late, lost, rejected, write_failures, opened, log_dropped;
  double elapsed_s;
  double interval_p50_s, interval_p999_s; /* between good reports */
  double work_p50_s, work_p999_s;         /* of a tick */
  fdcg_host_message problem;              /* why it is not open; empty: it is, or nobody has tried yet */
} fdcg_device_status;

/* Some 20 ms old at most. Set struct_bytes before. FDCG_E_ARGUMENT: no such device, a null pointer, or struct_bytes is no
 * multiple of 8. */
fdcg_status fdcg_host_get_status(fdcg_host* host, int32_t device, fdcg_device_status* status);
/* Static text, one line: what happened and what to do. Never NULL. */
const char* fdcg_fault_text(uint32_t fault);

/* ---- profiles that are built in ------------------------------------------------------------------------------------------ */

uint32_t fdcg_device_get_profile_count(void);
const char* fdcg_device_get_profile_name(uint32_t index); /* NULL for an index out of range */

#ifdef __cplusplus
}
#endif

#endif /* FDCG_DEVICE_H */
