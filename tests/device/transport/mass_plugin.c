/* SPDX-License-Identifier: Apache-2.0 */
/* A device of one's own in one file: a mass on a hand's spring, a second above and a second 3 mm below. Its settings may say
 * "absent", "lies" (it echoes what nobody sent) or "loses" (it is gone after half a second). */
#define _POSIX_C_SOURCE 200112L /* clocks, where the compiler is strict */
#include <fdcg/transport.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

typedef struct mass {
  double place_m, speed_m_per_s, since_s, next_s;
  volatile double force_n;
  volatile uint32_t taken, is_enabled;
  uint32_t sequence;
  int is_absent, lies, loses;
} mass;

static mass the_mass;

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int open_mass(void* self, fdcg_host_message* why) {
  mass* const m = self;
  if (m->is_absent) {
    snprintf(why->text, sizeof why->text, "the mass is absent; take \"absent\" out of its settings");
    return FDCG_TRANSPORT_FAILED;
  }
  m->place_m = 0.01;
  m->speed_m_per_s = m->force_n = 0;
  m->since_s = m->next_s = now_s();
  return FDCG_TRANSPORT_OK;
}

static void close_mass(void* self) {
  ((mass*)self)->force_n = 0;
}

static int read_mass(void* self, int32_t timeout_ms, fdcg_transport_sample* sample) {
  mass* const m = self;
  const double until_s = now_s() + 1e-3 * timeout_ms, wake_s = m->next_s < until_s ? m->next_s : until_s;
  const struct timespec wake = {(time_t)wake_s, (long)((wake_s - (double)(time_t)wake_s) * 1e9)};
  if (m->loses && now_s() > m->since_s + 0.5) return FDCG_TRANSPORT_FAILED;
  if (wake_s > now_s()) clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, NULL);
  if (m->next_s > until_s) return FDCG_TRANSPORT_OK;
  {
    const double seconds = m->next_s - m->since_s;
    const double target_m = (long)seconds % 2 == 0 ? 0.01 : -0.003;
    const double force_n = m->force_n + 200 * (target_m - m->place_m) - 6 * m->speed_m_per_s;
    m->speed_m_per_s += force_n / 0.1 * 1e-3;
    m->place_m += m->speed_m_per_s * 1e-3;
  }
  m->next_s += 1e-3;
  sample->position_m[2] = m->place_m;
  sample->time_s = m->next_s - m->since_s;
  sample->sequence = ++m->sequence;
  sample->echo = m->lies && m->sequence > 1500 ? m->taken + 100000 : m->taken;
  sample->flags = m->is_enabled ? FDCG_TRANSPORT_ENABLED : 0;
  return FDCG_TRANSPORT_SAMPLE;
}

static int write_mass(void* self, const fdcg_transport_force* force) {
  mass* const m = self;
  m->force_n = force->force_n[2];
  m->is_enabled = force->is_enabled;
  m->taken = force->sequence;
  return FDCG_TRANSPORT_OK;
}

static void end_mass(void* self) {
  ((mass*)self)->force_n = 0;
}

int fdcg_transport_create(uint32_t abi, const char* settings, fdcg_transport* transport, fdcg_host_message* why);
int fdcg_transport_create(uint32_t abi, const char* settings, fdcg_transport* transport, fdcg_host_message* why) {
  (void)why;
  if (abi != FDCG_TRANSPORT_ABI || transport->struct_bytes < sizeof *transport) return FDCG_TRANSPORT_FAILED;
  the_mass.is_absent = strstr(settings, "absent") != NULL;
  the_mass.lies = strstr(settings, "lies") != NULL;
  the_mass.loses = strstr(settings, "loses") != NULL;
  transport->self = &the_mass;
  transport->open = open_mass;
  transport->close = close_mass;
  transport->read = read_mass;
  transport->write = write_mass;
  transport->emergency = end_mass;
  return FDCG_TRANSPORT_OK;
}
