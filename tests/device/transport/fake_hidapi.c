/* SPDX-License-Identifier: Apache-2.0 */
#include "fake_hidapi.h"

#include <hidapi/hidapi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct hid_device_ {
  int unused;
};

static fake_hidapi state;

fake_hidapi* fake_hidapi_state(void) {
  return &state;
}

int hid_init(void) {
  return 0;
}

struct hid_device_info* hid_enumerate(unsigned short vendor, unsigned short product) {
  struct hid_device_info* list = NULL;
  int i;
  ++state.lists;
  if (state.is_absent || (vendor && vendor != 0x1209) || (product && product != 0xf001)) return NULL;
  for (i = state.interfaces - 1; i >= 0; --i) {
    struct hid_device_info* const info = (struct hid_device_info*)calloc(1, sizeof *info);
    info->path = (char*)malloc(sizeof state.path + 16);
    snprintf(info->path, sizeof state.path + 16, state.interfaces > 1 ? "%s:1.%d" : "%s", state.path, i);
    info->vendor_id = 0x1209;
    info->product_id = 0xf001;
    info->serial_number = L"S\u00e41";
    info->product_string = L"Fake\nDevice";
    info->usage_page = state.usage_page;
    info->usage = state.usage_page ? 1 : 0;
    info->interface_number = state.interface_number + i;
    info->next = list;
    list = info;
  }
  return list;
}

void hid_free_enumeration(struct hid_device_info* list) {
  ++state.freed_lists;
  while (list) {
    struct hid_device_info* const next = list->next;
    free(list->path);
    free(list);
    list = next;
  }
}

hid_device* hid_open_path(const char* path) {
  if (state.refuses_open || strncmp(path, state.path, strlen(state.path)) != 0) return NULL;
  ++state.opened;
  return (hid_device*)calloc(1, sizeof(hid_device));
}

void hid_close(hid_device* device) {
  ++state.closed;
  free(device);
}

int hid_read_timeout(hid_device* device, unsigned char* data, size_t capacity, int milliseconds) {
  const size_t bytes = (size_t)state.input_bytes < capacity ? (size_t)state.input_bytes : capacity;
  (void)milliseconds;
  ++state.reads;
  state.last_read_handle = device;
  if (state.is_gone) return -1;
  memcpy(data, state.input, bytes);
  return (int)bytes;
}

static int take(hid_device* device, const unsigned char* data, size_t bytes) {
  state.last_write_handle = device;
  if (state.refuses_writes) return -1;
  state.last_bytes = (int)bytes;
  memcpy(state.last, data, bytes < sizeof state.last ? bytes : sizeof state.last);
  return (int)bytes;
}

int hid_write(hid_device* device, const unsigned char* data, size_t bytes) {
  ++state.writes;
  return take(device, data, bytes);
}

int hid_send_feature_report(hid_device* device, const unsigned char* data, size_t bytes) {
  ++state.features;
  return take(device, data, bytes);
}

int hid_get_feature_report(hid_device* device, unsigned char* data, size_t capacity) {
  (void)device;
  if (state.feature_bytes <= 0 || (size_t)state.feature_bytes > capacity || data[0] != 3) return -1;
  memcpy(data, state.feature, (size_t)state.feature_bytes);
  return state.feature_bytes;
}

const wchar_t* hid_error(hid_device* device) {
  (void)device;
  return L"";
}
