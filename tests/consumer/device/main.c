/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>
#include <string.h>

#include "fdcg/device.h"

static const char kScene[] =
    "{\"fdcg_scene\": 1, \"objects\": [], \"devices\": [{\"name\": \"toy\", \"source\": \"simulated\"}],"
    " \"loop\": {\"servo_priority\": 0, \"writer_priority\": 0, \"lock_memory\": false}}";

int main(void) {
  fdcg_host* host;
  fdcg_host_message message;
  fdcg_device_status status = {0};
  int tries;
  status.struct_bytes = (uint32_t)sizeof status;
  if (fdcg_host_open_text(kScene, strlen(kScene), "scene", &host, &message) != FDCG_OK ||
      fdcg_host_start(host, &message) != FDCG_OK) {
    fprintf(stderr, "%s\n", message.text);
    return 1;
  }
  for (tries = 0; tries < 100 && status.ticks < 100; ++tries) {
    fdcg_host_wait(host, 100);
    fdcg_host_get_status(host, 0, &status);
  }
  if (fdcg_host_stop(host, &message) != FDCG_OK) return 2;
  printf("%s: %s\n", fdcg_host_get_device_name(host, 0), status.ticks >= 100 ? "ticks" : "stands still");
  fdcg_host_close(host);
  return 0;
}
