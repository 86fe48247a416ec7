/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file fdcg/device.h
 * The device host: force-feedback devices that feel a scene, each with a servo thread, a writer thread and a safety gate. Those
 * that press on the same bodies share one servo thread (the scene's "shared"). On one screen:
 *
 *     fdcg_host* host;
 *     fdcg_host_message message;
 *     fdcg_host_open("scene.json", &host, &message);                    graphs, profiles, limits; no thread yet
 *     fdcg_host_start(host, &message);                                  devices are opened as they appear
 *     fdcg_host_arm(host, FDCG_ALL_DEVICES);                            each gate decides: hand near, nothing pressed
 *     while (!fdcg_host_wait(host, 100)) { fdcg_host_get_status(host, 0, &status); }
 *     fdcg_host_stop(host, &message);                                   zero force; within 6 s, whatever a device does
 *     fdcg_host_close(host);
 *
 * Scenes are JSON (schemas/servo-scene.schema.json), devices are described by profiles (schemas/device-profile.schema.json).
 *
 * **Safety.** No force before fdcg_host_arm, none after a fault until it is armed anew, never more than the profile and the
 * scene allow. fdcg_device_status reports a fault. Of devices that share a scene, one that is gone, silent or disarmed by a
 * fault takes its fingers out of it; the others go on, each within its own limits. One that is not armed yet, or was disarmed
 * by fdcg_host_disarm, leaves them in: a hand that gets no force still moves what it presses.
 *
 * **Frames, units, handedness.** SI units. A device's frame is that of its profile, mapped into the right-handed world by the
 * scene; each field says which it is in.
 *
 * **Ownership.** A host is freed by fdcg_host_close. Strings that functions return live as long as the host, or for ever where
 * they say static. Structs are the caller's. Everything here may allocate and wait; the servo loop, on threads of the host's
 * own, does neither.
 *
 * **Threads.** One thread at a time is in a host, except for fdcg_host_request_stop.
 *
 * **Null pointers.** A host that is NULL is FDCG_E_ARGUMENT where there is a status; other functions do nothing or return
 * zeros, and fdcg_host_wait returns 1. `message` may be NULL; every function that takes one fills it in.
 */
#ifndef FDCG_DEVICE_H
#define FDCG_DEVICE_H

#include "fdcg/scene.h"
#include "fdcg/transport.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The devices of a scene, their threads and their log. */
typedef struct fdcg_host fdcg_host;

/* ---- open, start, stop ------------------------------------------------------------------------------------------------- */

/** Reads a scene file and what it names. FDCG_E_ARGUMENT with the message, and *host NULL, where the scene, a profile or a
 * graph is not right; FDCG_E_IO where the host's threads or its log cannot be started. */
fdcg_status fdcg_host_open(const char* scene_file, fdcg_host** host, fdcg_host_message* message);
/** Does the same for a scene in memory. `name` stands for the file's in messages, and files are named from its folder. */
fdcg_status fdcg_host_open_text(const char* scene, uint64_t bytes, const char* name, fdcg_host** host,
                                fdcg_host_message* message);
/** Before fdcg_host_start: a device whose source in the scene is "plugin" without a file. The table is copied, what it points
 * to must outlive the host. FDCG_E_ARGUMENT with the message: no such device, another source, a table that lacks a function. */
fdcg_status fdcg_host_set_transport(fdcg_host* host, int32_t device, const fdcg_transport* transport,
                                    fdcg_host_message* message);
/** Before fdcg_host_start: lets the host load the plugins that the scene names. They are code, and run as the program itself.
 */
void fdcg_host_allow_plugins(fdcg_host* host);
/** Starts the threads. A device that is not there is no error: it is opened when it appears. */
fdcg_status fdcg_host_start(fdcg_host* host, fdcg_host_message* message);
/** Stops: zero force, then each profile's safe-stop reports, threads ended, devices closed, log written. FDCG_E_IO with the
 * message where a device did not let go or the log is not whole: the host has stopped all the same. Harmless when it does not
 * run. */
fdcg_status fdcg_host_stop(fdcg_host* host, fdcg_host_message* message);
/** Stops and frees. */
void fdcg_host_close(fdcg_host* host);

/** Sleeps up to that long. Not 0: a stop was asked for, or every device has ended (recordings). */
int fdcg_host_wait(fdcg_host* host, int milliseconds);
/** Asks for a stop: fdcg_host_wait returns. From any thread, and from a signal handler. */
void fdcg_host_request_stop(fdcg_host* host);
/** Installs handlers for a process that a signal ends: they send zero force as its last act where the way to the device allows
 * (hidraw). They are for crashes (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS), which they pass on to the
 * handlers that there were, and for every other signal that ends a process by default (SIGINT, SIGTERM, SIGQUIT, SIGUSR1 ...)
 * and is neither handled nor ignored. The process dies of its signal. Call it once a process, from its main thread, which gets
 * a stack for handlers unless it has one. */
void fdcg_device_install_crash_handlers(void);

/* ---- while it runs ------------------------------------------------------------------------------------------------------ */

#define FDCG_ALL_DEVICES (-1) /**< in place of a device's index */

/** Devices of the scene, present or not. */
int32_t fdcg_host_get_device_count(const fdcg_host* host);
/** A device's name in the scene; NULL for an index out of range. Valid until the host is closed. */
const char* fdcg_host_get_device_name(const fdcg_host* host, int32_t device);

/** Asks a device's gate to arm, in its next tick; fdcg_device_status says whether it did. */
void fdcg_host_arm(fdcg_host* host, int32_t device);
/** Disarms a device: zero force in its next tick. */
void fdcg_host_disarm(fdcg_host* host, int32_t device);
/** Sets the pose of an object that the scene calls driven, by its name. From each device's next tick on. */
fdcg_status fdcg_host_set_pose(fdcg_host* host, const char* object, const fdcg_pose* pose, fdcg_host_message* message);

/** What a device's gate lets through. */
typedef enum fdcg_device_phase {
  FDCG_DISARMED = 0, /**< no force */
  FDCG_RAMPING = 1,  /**< armed a moment ago: the force comes up */
  FDCG_ARMED = 2,    /**< full force within the limits */
  FDCG_FADING = 3    /**< reports are missing: the force goes down */
} fdcg_device_phase;

/** What a device does. */
typedef struct fdcg_device_status {
  uint32_t struct_bytes; /**< the caller's sizeof(fdcg_device_status) */
  uint32_t is_open;      /**< 1: it is there, and was opened */
  uint32_t phase;        /**< fdcg_device_phase */
  uint32_t fault; /**< why it was disarmed last; 0: armed. fdcg_fault_text says it in words. A recording's end: read failed */
  uint32_t arming_refused;   /**< 1: the last request to arm was refused */
  uint32_t state;            /**< fdcg_state, of the contact with the largest force */
  double tip_world_m[3];     /**< the haptic interface point */
  double force_n[3];         /**< device's frame, as it was sent */
  double wanted_force_n[3];  /**< world, before the gate */
  uint64_t ticks;            /**< since the start, as the counts below */
  uint64_t late;             /**< reports more than 1.5 periods after the one before */
  uint64_t lost;             /**< reports missing in the device's sequence */
  uint64_t rejected;         /**< reports that were not good */
  uint64_t write_failures;   /**< writes that the device did not take */
  uint64_t opened;           /**< times that the device was opened */
  uint64_t log_dropped;      /**< records that the log had no room for */
  double elapsed_s;          /**< since the start */
  double interval_p50_s;     /**< between good reports: median */
  double interval_p999_s;    /**< between good reports: exceeded by one in a thousand */
  double work_p50_s;         /**< work of a tick: median */
  double work_p999_s;        /**< work of a tick: exceeded by one in a thousand */
  fdcg_host_message problem; /**< why it is not open; empty: it is open, or no attempt was made yet */
  double round_trip_p50_s;   /**< from a write to its echo: median; 0: the device does not echo */
  double round_trip_p999_s;  /**< from a write to its echo: exceeded by one in a thousand */
} fdcg_device_status;

/** Reads a device's status, some 20 ms old at most. Set struct_bytes before. FDCG_E_ARGUMENT: no such device, a null pointer,
 * or struct_bytes is no multiple of 8. */
fdcg_status fdcg_host_get_status(fdcg_host* host, int32_t device, fdcg_device_status* status);
#define FDCG_SNAPSHOT_CONTACTS 8 /**< contacts of a device, at most */
#define FDCG_SNAPSHOT_BODIES 16  /**< bodies of a scene, at most */

/** A contact in a tick. World, metres and newtons. */
typedef struct fdcg_snapshot_contact {
  uint32_t state;         /**< fdcg_state */
  uint32_t is_slipping;   /**< 1: dynamic friction holds */
  int32_t object;         /**< in the scene's order: what it touches, and of several what pushes most; -1: nothing */
  uint32_t feature;       /**< of the object, as in fdcg_touch */
  double hip_m[3];        /**< where the hand is */
  double god_object_m[3]; /**< where it would be, were nothing passed through */
  double force_n[3];      /**< of all that it touches, on the hand */
} fdcg_snapshot_contact;

/** A tick of a device. */
typedef struct fdcg_snapshot {
  uint64_t tick;            /**< since the start, with a report or without; one more each time */
  double time_s;            /**< since the start */
  uint32_t phase;           /**< fdcg_device_phase */
  uint32_t fault;           /**< why it was disarmed last; 0: armed */
  uint32_t buttons;         /**< a bit each */
  uint32_t has_report;      /**< 1: a good report came in this tick */
  uint32_t contact_count;   /**< of contacts */
  uint32_t body_count;      /**< of bodies */
  double tip_world_m[3];    /**< the haptic interface point */
  double wanted_force_n[3]; /**< world, before the gate */
  double force_n[3];        /**< device's frame, as it was sent */
  double given_j;           /**< energy that the hand was given since the device was armed, joules; falls where it gives back */
  double round_trip_s;      /**< newest, from a write to its echo; 0: not known */
  fdcg_snapshot_contact contacts[FDCG_SNAPSHOT_CONTACTS]; /**< of the device, in the scene's order */
  fdcg_pose bodies[FDCG_SNAPSHOT_BODIES];                 /**< world, after the tick; in the scene's order */
} fdcg_snapshot;

/** Before fdcg_host_start: so many ticks of each device are kept until they are taken; 0, the default: none, at no cost. A tick
 * takes 2 KB. */
fdcg_status fdcg_host_keep_snapshots(fdcg_host* host, uint32_t ticks, fdcg_host_message* message);
/** Takes the oldest ticks that were not taken yet, up to `most`; returns how many. The servo thread never waits for it: what
 * finds no room is dropped, and the ticks' numbers show where. */
uint32_t fdcg_host_take_snapshots(fdcg_host* host, int32_t device, fdcg_snapshot* snapshots, uint32_t most);
/** Ticks of a device that were dropped since the start. */
uint64_t fdcg_host_get_dropped_snapshots(const fdcg_host* host, int32_t device);

/** A fault in words; static text, one line: what happened and what to do. Never NULL. */
const char* fdcg_fault_text(uint32_t fault);

/* ---- profiles that are built in ------------------------------------------------------------------------------------------ */

/** How many profiles are built in. */
uint32_t fdcg_device_get_profile_count(void);
const char* fdcg_device_get_profile_name(uint32_t index); /**< NULL for an index out of range */

#ifdef __cplusplus
}
#endif

#endif /* FDCG_DEVICE_H */
