/* SPDX-License-Identifier: Apache-2.0 */
/* A hidapi, under the hidraw back end's name, for the whole program under test: the firmware core in real time, as the
 * reference profile describes it, with a hand on it. FDCG_FAKE_NODE names its node, a file. FDCG_FAKE_MEMORY names a file of
 * the struct below: who strikes writes there what is to go wrong, and reads there what the device handed out and took, and
 * when.
 *
 * The hand strokes over z = 0; pressing, it goes down to 4 mm below it.
 *
 * A witness on each processor, above the host's threads where the system grants that, notes when the machine itself stood
 * still: nothing that the host does can hold it up. */
#define _GNU_SOURCE /* a thread's own processor */
#include <errno.h>
#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "fdcg_firmware.h"

enum { kMostEvents = 1 << 17, kQueue = 64 };
enum { kHandedOut = 1, kTaken = 2, kLags = 3, kForeign = 4, kGone = 5, kForce = 6, kStood = 7, kRestarted = 8, kLosing = 9 };
enum { kWitnessPriority = 90, kMostWitnesses = 64 };

typedef struct Event {
  int64_t ns; /* CLOCK_MONOTONIC; of kTaken: when hid_write was called; of kStood: when it went on */
  uint32_t kind;
  uint32_t sequence;  /* of the report; of kForeign: the other host's; of kStood: for so many microseconds */
  uint32_t echo;      /* of kHandedOut */
  uint32_t is_enable; /* of kTaken */
  float force_n;      /* its norm: of kTaken what is asked for, of kForce what the motors get from now on */
  uint32_t padding;
} Event;

typedef struct Shared {
  _Atomic uint32_t report_lag_us, output_lag_us; /* under way */
  _Atomic uint32_t foreign; /* so far ahead of the last sequence is another host's report, which the device hears; once */
  _Atomic uint32_t is_unplugged;
  _Atomic uint32_t wrong_byte; /* of the feature report, whose last bit is turned; 0: none */
  _Atomic uint32_t is_pressing;
  _Atomic uint32_t event_count;
  _Atomic uint32_t restarts;   /* it begins anew with its next tick: numbers, clock and echo; once */
  _Atomic uint32_t loses_half; /* every other report is lost under way */
  _Atomic uint32_t rate_hz;    /* from the next start on; 0: 1000 */
  uint32_t padding[6];
  Event events[kMostEvents];
} Shared;

struct hid_device_ {
  int node;
};

typedef struct Queued {
  int64_t due_ns;
  uint8_t bytes[FDCG_FW_INPUT_BYTES];
  uint32_t sequence, echo;
} Queued;

static const int64_t kMs = 1000000;
static const int64_t kWriteNs = 100000; /* a write of USB's takes its time */
static const int64_t kWitnessNs = 250000, kStoodNs = 300000;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static Shared* shared;
static fdcg_fw firmware;
static Queued reports[kQueue], outputs[kQueue];
static uint32_t report_first, report_end, output_first, output_end, was_lagging, was_unplugged = 1;
static uint32_t was_losing;
static int64_t due_ns, begun_ns, period_ns = 1000000;
static double z_m = 0.01;
static float last_force_n;

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

static uint32_t get32(const uint8_t* at) {
  return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static float norm_of(const float force_n[3]) {
  return sqrtf(force_n[0] * force_n[0] + force_n[1] * force_n[1] + force_n[2] * force_n[2]);
}

/* Under the mutex. */
static Event* note(int64_t ns, uint32_t kind) {
  const uint32_t at = atomic_load(&shared->event_count);
  Event* const event = &shared->events[at % kMostEvents];
  memset(event, 0, sizeof *event);
  event->ns = ns;
  event->kind = kind;
  return event;
}

static void noted(void) {
  atomic_fetch_add(&shared->event_count, 1);
}

static void power_up(int64_t ns) {
  const uint32_t wanted_hz = atomic_load(&shared->rate_hz), rate_hz = wanted_hz == 0 ? 1000 : wanted_hz;
  fdcg_fw_config config = {1000000, {-100, -100, -100}, {100, 100, 100}, 8, 3, (uint16_t)rate_hz, 20, 3, FDCG_FW_CARTESIAN};
  period_ns = 1000000000 / rate_hz;
  begun_ns = ns;
  fdcg_fw_init(&firmware, &config);
  report_first = report_end = output_first = output_end = 0;
}

/* The device's own clock. */
static uint32_t device_us(int64_t ns) {
  return (uint32_t)((ns - begun_ns) / 1000);
}

static void note_force(int64_t ns) {
  float force_n[3];
  fdcg_fw_force(&firmware, device_us(ns), force_n);
  if (norm_of(force_n) == last_force_n) return;
  last_force_n = note(ns, kForce)->force_n = norm_of(force_n);
  noted();
}

static void take(int64_t ns, const uint8_t* bytes, size_t count) {
  fdcg_fw_take_output(&firmware, device_us(ns), bytes, count);
  note_force(ns);
}

/* What another host sends asks for no force. */
static void hear_another(int64_t ns, uint32_t ahead) {
  uint8_t bytes[FDCG_FW_OUTPUT_BYTES] = {FDCG_FW_OUTPUT_ID};
  const uint32_t sequence = firmware.echo + ahead;
  uint16_t crc;
  for (int i = 0; i < 4; ++i)
    bytes[1 + i] = (uint8_t)(sequence >> 8 * i);
  crc = fdcg_fw_crc16(bytes, sizeof bytes - 2);
  bytes[22] = (uint8_t)crc;
  bytes[23] = (uint8_t)(crc >> 8);
  take(ns, bytes, sizeof bytes);
  note(ns, kForeign)->sequence = sequence;
  noted();
}

static void move_hand(int64_t ns, int32_t counts[3]) {
  const double target_m = atomic_load(&shared->is_pressing) ? -0.004 : 0.01,
               step_m = 0.05 * 1e-9 * (double)period_ns; /* 50 mm/s */
  const double turn = 2 * 3.14159265358979 * 3 * (double)(ns % 1000000000) / 1e9;
  z_m += z_m < target_m - step_m ? step_m : z_m > target_m + step_m ? -step_m : target_m - z_m;
  counts[0] = (int32_t)(2000 * sin(turn));
  counts[1] = 0;
  counts[2] = (int32_t)(z_m * 1e6);
}

/* One tick of the device: what is due comes in, a report goes out. */
static void tick(int64_t ns) {
  const uint32_t report_lag_us = atomic_load(&shared->report_lag_us), output_lag_us = atomic_load(&shared->output_lag_us);
  const uint32_t ahead = atomic_exchange(&shared->foreign, 0), is_lagging = (report_lag_us | output_lag_us) != 0;
  const uint32_t is_losing = atomic_load(&shared->loses_half);
  int32_t counts[3];
  if (atomic_exchange(&shared->restarts, 0)) {
    power_up(ns);
    note(ns, kRestarted), noted();
  }
  if (is_losing && !was_losing) note(ns, kLosing), noted();
  was_losing = is_losing;
  if (is_lagging != was_lagging) {
    report_first = report_end = output_first = output_end = 0;
    was_lagging = is_lagging;
    if (is_lagging) note(ns, kLags), noted();
  }
  for (; output_first != output_end && outputs[output_first % kQueue].due_ns <= ns; ++output_first)
    take(ns, outputs[output_first % kQueue].bytes, FDCG_FW_OUTPUT_BYTES);
  if (ahead != 0) hear_another(ns, ahead);
  note_force(ns);
  move_hand(ns, counts);
  if (report_end - report_first == kQueue) ++report_first; /* as hidraw's ring */
  Queued* const made = &reports[report_end++ % kQueue];
  made->due_ns = ns + (int64_t)report_lag_us * 1000;
  fdcg_fw_make_input(&firmware, device_us(ns), counts, 0, made->bytes);
  made->sequence = firmware.sequence;
  made->echo = firmware.echo;
  if (is_losing && made->sequence % 2 != 0) --report_end;
}

/* The device's ticks up to now, whoever comes first: its time never goes back. Under the mutex. */
static void catch_up(int64_t now) {
  if (now - due_ns > kQueue * period_ns) due_ns = now; /* nobody has come for long */
  for (; due_ns <= now; due_ns += period_ns)
    tick(due_ns);
}

/* Under the mutex. False: it is gone. */
static int is_there(void) {
  const uint32_t is_unplugged = atomic_load(&shared->is_unplugged);
  if (is_unplugged != was_unplugged) {
    was_unplugged = is_unplugged;
    if (is_unplugged) note(now_ns(), kGone), noted();
    if (is_unplugged && last_force_n > 0) last_force_n = 0, note(now_ns(), kForce), noted();
    if (!is_unplugged) power_up(now_ns());
    due_ns = now_ns();
  }
  return !is_unplugged;
}

static void* witness(void* cpu) {
  const struct sched_param priority = {.sched_priority = kWitnessPriority};
  cpu_set_t own;
  int64_t next_ns;
  CPU_ZERO(&own);
  CPU_SET((size_t)(intptr_t)cpu, &own);
  if (pthread_setaffinity_np(pthread_self(), sizeof own, &own) != 0) return NULL;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
  for (next_ns = now_ns() + kWitnessNs;; next_ns = now_ns() + kWitnessNs) {
    int64_t now;
    sleep_until(next_ns);
    now = now_ns();
    if (now - next_ns < kStoodNs) continue;
    pthread_mutex_lock(&mutex);
    note(now, kStood)->sequence = (uint32_t)((now - next_ns) / 1000);
    noted();
    pthread_mutex_unlock(&mutex);
  }
}

static void start_witnesses(void) {
  const long cpus = sysconf(_SC_NPROCESSORS_CONF);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before); /* the program's signals are for its own threads */
  for (long cpu = 0; cpu < cpus && cpu < kMostWitnesses; ++cpu) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, witness, (void*)(intptr_t)cpu) == 0) pthread_detach(thread);
  }
  pthread_sigmask(SIG_SETMASK, &before, NULL);
}

int hid_init(void) {
  const char* const path = getenv("FDCG_FAKE_MEMORY");
  const int file = path != NULL ? open(path, O_RDWR | O_CLOEXEC) : -1;
  if (shared != NULL) return 0;
  if (file < 0) return -1;
  shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (shared == MAP_FAILED) abort();
  start_witnesses();
  return 0;
}

struct hid_device_info* hid_enumerate(unsigned short vendor, unsigned short product) {
  struct hid_device_info* info;
  int is_here;
  if (hid_init() != 0 || (vendor != 0 && vendor != 0x1209) || (product != 0 && product != 0x0001)) return NULL;
  pthread_mutex_lock(&mutex);
  is_here = is_there();
  pthread_mutex_unlock(&mutex);
  if (!is_here) return NULL;
  info = calloc(1, sizeof *info);
  info->path = strdup(getenv("FDCG_FAKE_NODE"));
  info->vendor_id = 0x1209;
  info->product_id = 0x0001;
  info->usage_page = FDCG_FW_USAGE_PAGE;
  info->usage = FDCG_FW_USAGE;
  return info;
}

void hid_free_enumeration(struct hid_device_info* list) {
  if (list == NULL) return;
  free(list->path);
  free(list);
}

hid_device* hid_open_path(const char* path) {
  hid_device* const device = calloc(1, sizeof *device);
  device->node = atomic_load(&shared->is_unplugged) ? -1 : open(path, O_WRONLY | O_CLOEXEC);
  if (device->node >= 0) return device;
  free(device);
  return NULL;
}

void hid_close(hid_device* device) {
  close(device->node);
  free(device);
}

int hid_read_timeout(hid_device* device, unsigned char* data, size_t capacity, int milliseconds) {
  const int64_t until_ns = now_ns() + milliseconds * kMs;
  (void)device;
  if (capacity < FDCG_FW_INPUT_BYTES) return -1;
  for (;;) {
    int64_t now, next_ns;
    pthread_mutex_lock(&mutex);
    if (!is_there()) {
      pthread_mutex_unlock(&mutex);
      return -1;
    }
    now = now_ns();
    catch_up(now);
    next_ns = due_ns;
    if (report_first != report_end) {
      const Queued* const first = &reports[report_first % kQueue];
      if (first->due_ns <= now) {
        Event* event;
        memcpy(data, first->bytes, FDCG_FW_INPUT_BYTES);
        event = note(now_ns(), kHandedOut);
        event->sequence = first->sequence;
        event->echo = first->echo;
        noted();
        ++report_first;
        pthread_mutex_unlock(&mutex);
        return FDCG_FW_INPUT_BYTES;
      }
      if (first->due_ns < next_ns) next_ns = first->due_ns;
    }
    pthread_mutex_unlock(&mutex);
    if (now >= until_ns) return 0;
    sleep_until(next_ns < until_ns ? next_ns : until_ns);
  }
}

int hid_write(hid_device* device, const unsigned char* data, size_t bytes) {
  const int64_t called_ns = now_ns();
  const uint32_t output_lag_us = atomic_load(&shared->output_lag_us);
  float force_n[3] = {0, 0, 0};
  Event* event;
  int is_here;
  (void)device;
  if (bytes != FDCG_FW_OUTPUT_BYTES) return (int)bytes;
  sleep_until(called_ns + kWriteNs);
  pthread_mutex_lock(&mutex);
  is_here = is_there();
  if (is_here) {
    const int64_t now = now_ns();
    catch_up(now);
    memcpy(force_n, data + 5, sizeof force_n);
    event = note(called_ns, kTaken);
    event->sequence = get32(data + 1);
    event->is_enable = data[21] & FDCG_FW_ENABLE;
    event->force_n = event->is_enable ? norm_of(force_n) : 0;
    noted();
    if (output_lag_us == 0) {
      take(now, data, bytes);
    } else if (output_end - output_first < kQueue) {
      Queued* const sent = &outputs[output_end++ % kQueue];
      sent->due_ns = called_ns + (int64_t)output_lag_us * 1000;
      memcpy(sent->bytes, data, bytes);
    }
  }
  pthread_mutex_unlock(&mutex);
  return is_here ? (int)bytes : -1;
}

int hid_send_feature_report(hid_device* device, const unsigned char* data, size_t bytes) {
  (void)device;
  (void)data;
  return (int)bytes;
}

int hid_get_feature_report(hid_device* device, unsigned char* data, size_t capacity) {
  const uint32_t wrong = atomic_load(&shared->wrong_byte);
  uint16_t crc;
  (void)device;
  if (capacity < FDCG_FW_FEATURE_BYTES || data[0] != FDCG_FW_FEATURE_ID) return -1;
  pthread_mutex_lock(&mutex);
  fdcg_fw_feature(&firmware, data);
  pthread_mutex_unlock(&mutex);
  if (wrong == 0) return FDCG_FW_FEATURE_BYTES;
  data[wrong] ^= 1;
  crc = fdcg_fw_crc16(data, FDCG_FW_FEATURE_BYTES - 2);
  data[FDCG_FW_FEATURE_BYTES - 2] = (uint8_t)crc;
  data[FDCG_FW_FEATURE_BYTES - 1] = (uint8_t)(crc >> 8);
  return FDCG_FW_FEATURE_BYTES;
}

const wchar_t* hid_error(hid_device* device) {
  (void)device;
  return L"";
}
