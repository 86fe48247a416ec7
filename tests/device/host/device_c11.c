/* SPDX-License-Identifier: Apache-2.0 */
/* device.h is C11, and a C program runs a host with it. */
#include "device_c11.h"

#include <string.h>

#include "fdcg/device.h"

static int fails_with(fdcg_status status, const fdcg_host_message* message, const char* part) {
  return status != FDCG_OK && strstr(message->text, part) != NULL;
}

int refuses_from_c(void) {
  fdcg_host* host = (fdcg_host*)1;
  fdcg_host_message message;
  const char* const bad = "{\"objects\": 7}";
  if (!fails_with(fdcg_host_open("no/such/scene.json", &host, &message), &message, "no/such/scene.json") || host) return 1;
  if (!fails_with(fdcg_host_open(NULL, &host, &message), &message, "NULL") || host) return 2;
  if (!fails_with(fdcg_host_open_text(bad, strlen(bad), "here.json", &host, &message), &message, "here.json") || host) return 3;
  if (fdcg_host_open("no/such/scene.json", &host, NULL) == FDCG_OK) return 4;
  if (!fails_with(fdcg_host_open(bad, NULL, &message), &message, "host is NULL")) return 7;
  if (!fails_with(fdcg_host_start(NULL, &message), &message, "host is NULL")) return 8;
  if (!fails_with(fdcg_host_stop(NULL, &message), &message, "host is NULL")) return 9;
  if (!fails_with(fdcg_host_set_pose(NULL, "cube", NULL, &message), &message, "host is NULL")) return 22;
  if (fdcg_host_get_status(NULL, 0, NULL) != FDCG_E_ARGUMENT || fdcg_host_wait(NULL, 1) != 1) return 23;
  if (fdcg_host_get_device_count(NULL) != 0 || fdcg_host_get_device_name(NULL, 0) != NULL) return 24;
  fdcg_snapshot snapshot;
  if (!fails_with(fdcg_host_keep_snapshots(NULL, 8, &message), &message, "host is NULL")) return 25;
  if (fdcg_host_take_snapshots(NULL, 0, &snapshot, 1) != 0 || fdcg_host_get_dropped_snapshots(NULL, 0) != 0) return 26;
  fdcg_host_arm(NULL, 0);
  fdcg_host_disarm(NULL, 0);
  fdcg_host_request_stop(NULL);
  fdcg_host_close(NULL);
  if (fdcg_device_get_profile_name(fdcg_device_get_profile_count()) != NULL) return 5;
  return strlen(fdcg_fault_text(2)) > 10 && strlen(fdcg_fault_text(99)) > 10 ? 0 : 6;
}

static int run(fdcg_host* host, const char* moved) {
  fdcg_host_message message;
  fdcg_device_status status;
  fdcg_pose pose = fdcg_make_identity_pose();
  int tries;
  status.struct_bytes = (uint32_t)sizeof status;
  if (fdcg_host_get_device_count(host) != 1 || !fdcg_host_get_device_name(host, 0) || fdcg_host_get_device_name(host, 1))
    return 11;
  if (fdcg_host_get_status(host, 1, &status) != FDCG_E_ARGUMENT) return 12;
  if (fdcg_host_start(host, &message) != FDCG_OK) return 13;
  if (fdcg_host_start(host, &message) == FDCG_OK) return 14;
  if (fdcg_host_set_pose(host, moved, &pose, &message) != FDCG_OK) return 15;
  if (fdcg_host_set_pose(host, "nothing", &pose, &message) == FDCG_OK) return 16;
  /* A machine that is busy disarms: try again. */
  for (tries = 0; tries < 200; ++tries) {
    fdcg_host_arm(host, FDCG_ALL_DEVICES);
    if (fdcg_host_wait(host, 200)) return 17;
    if (fdcg_host_get_status(host, 0, &status) != FDCG_OK) return 18;
    if (status.is_open && status.ticks > 20 && status.phase != FDCG_DISARMED) break;
  }
  if (tries == 200) return 19;
  fdcg_host_disarm(host, 0);
  fdcg_host_request_stop(host);
  if (!fdcg_host_wait(host, 20000)) return 20;
  return fdcg_host_stop(host, &message) == FDCG_OK && fdcg_host_stop(host, NULL) == FDCG_OK ? 0 : 21;
}

int runs_from_c(const char* scene, const char* moved) {
  fdcg_host* host;
  fdcg_host_message message;
  int result;
  if (fdcg_host_open_text(scene, strlen(scene), "c11.json", &host, &message) != FDCG_OK) return 10;
  result = run(host, moved);
  fdcg_host_close(host);
  return result;
}
