/* SPDX-License-Identifier: Apache-2.0 */
/* A hidapi, under the hidraw back end's name, for the whole program under test: one device in real time, whose node is the FIFO
 * that FDCG_FAKE_NODE names. Reports come out there in the order in which the device gets them, whether hid_write or write(2)
 * sent them. The hand on it presses: enabled, it goes down to 5 mm below the device's origin and stays; else back to 5 mm
 * above.
 *
 * Input, 17 bytes: id 1, sequence u32, three axes i32 in micrometres. Output, 18 bytes: id 2, sequence u32, three forces f32,
 * enable u8. What is not 18 bytes long goes to the node and no further. */
#include <errno.h>
#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

struct hid_device_ {
  int node;
};

enum { kOutputBytes = 18, kInputBytes = 17, kEnableAt = 17, kReachUm = 5000, kStepUm = 50 };
static const int64_t kPeriodNs = 1000000;
static const long kWriteNs = 300000; /* a write of USB's takes its time: a signal may come in the middle */

static atomic_int is_enabled;

static const char* node_path(void) {
  const char* const path = getenv("FDCG_FAKE_NODE");
  return path != NULL ? path : "";
}

static int64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void sleep_until(int64_t ns) {
  const struct timespec until = {(time_t)(ns / 1000000000), (long)(ns % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL) == EINTR)
    continue;
}

int hid_init(void) {
  return 0;
}

struct hid_device_info* hid_enumerate(unsigned short vendor, unsigned short product) {
  struct hid_device_info* info;
  if ((vendor != 0 && vendor != 0x1209) || (product != 0 && product != 0xf002)) return NULL;
  info = calloc(1, sizeof *info);
  info->path = strdup(node_path());
  info->vendor_id = 0x1209;
  info->product_id = 0xf002;
  info->usage_page = 0xff00;
  info->usage = 1;
  return info;
}

void hid_free_enumeration(struct hid_device_info* list) {
  if (list == NULL) return;
  free(list->path);
  free(list);
}

hid_device* hid_open_path(const char* path) {
  hid_device* const device = calloc(1, sizeof *device);
  device->node = open(path, O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (device->node >= 0) return device;
  free(device);
  return NULL;
}

void hid_close(hid_device* device) {
  close(device->node);
  free(device);
}

int hid_read_timeout(hid_device* device, unsigned char* data, size_t capacity, int milliseconds) {
  static int64_t due_ns;
  static uint32_t sequence;
  static int32_t tip_um = kReachUm;
  const int64_t until_ns = now_ns() + (int64_t)milliseconds * 1000000;
  (void)device;
  if (capacity < kInputBytes) return -1;
  if (due_ns > until_ns) {
    sleep_until(until_ns);
    return 0;
  }
  sleep_until(due_ns);
  if (now_ns() - due_ns > 5 * kPeriodNs) due_ns = now_ns(); /* never queues: the newest stands for those before */
  due_ns += kPeriodNs;
  ++sequence;
  tip_um += atomic_load(&is_enabled) ? -kStepUm : kStepUm;
  if (tip_um > kReachUm) tip_um = kReachUm;
  if (tip_um < -kReachUm) tip_um = -kReachUm;
  memset(data, 0, kInputBytes);
  data[0] = 1;
  memcpy(data + 1, &sequence, 4);
  memcpy(data + 13, &tip_um, 4);
  return kInputBytes;
}

int hid_write(hid_device* device, const unsigned char* data, size_t bytes) {
  sleep_until(now_ns() + kWriteNs);
  if (bytes == kOutputBytes) atomic_store(&is_enabled, data[kEnableAt]);
  return (int)write(device->node, data, bytes);
}

int hid_send_feature_report(hid_device* device, const unsigned char* data, size_t bytes) {
  return (int)write(device->node, data, bytes);
}

int hid_get_feature_report(hid_device* device, unsigned char* data, size_t capacity) {
  (void)device;
  (void)data;
  (void)capacity;
  return -1;
}

const wchar_t* hid_error(hid_device* device) {
  (void)device;
  return L"";
}
