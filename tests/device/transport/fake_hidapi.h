/* SPDX-License-Identifier: Apache-2.0 */
/* A hidapi with one device in memory, built under both back ends' names: what the host asks of it is counted. */
#ifndef FDCG_FAKE_HIDAPI_H
#define FDCG_FAKE_HIDAPI_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fake_hidapi {
  int is_absent; /* not in the list */
  int refuses_open;
  int refuses_writes;
  int is_gone; /* reads fail */
  char path[64];
  unsigned short usage_page;
  int interface_number;
  int interfaces; /* the device is listed so often, under paths that end in :1.0, :1.1, ... */
  int opened, closed, lists, freed_lists;
  int writes, features, reads;
  void* last_read_handle;
  void* last_write_handle;
  unsigned char last[256]; /* report written last, as it was given */
  int last_bytes;
  unsigned char feature[256]; /* what feature report 3 is; 0 bytes: it is refused */
  int feature_bytes;
  unsigned char input[256]; /* what a read gives; 0 bytes: a time-out */
  int input_bytes;
} fake_hidapi;

fake_hidapi* fake_hidapi_state(void);

#ifdef __cplusplus
}
#endif

#endif
