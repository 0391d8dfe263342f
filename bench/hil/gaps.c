// Gaps between HIL_SENSOR as an autopilot sees them, and on each core a witness: a thread before all others that only sleeps
// and wakes every millisecond. Sensors come every 4 ms, so one with a gap above 8 ms was more than 4 ms late. If a witness
// did not wake for more than 4 ms meanwhile, the gap is shared: the machine did not run that core.
// Build: gcc -O2 -Wall gaps.c -o gaps -lpthread
// Run:   ./gaps SECONDS [PORT]         as root, or with `ulimit -r 1`, for real-time priority; without a port, witnesses alone
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#define PERIOD 1000000LL // of a witness
#define LONG_PAUSE 4000000LL
#define LONG_GAP 8000000LL // of the sensors
#define MOST_CORES 64
#define WARM_UP_S 20 // until the simulator's code is compiled and its threads have real-time priority

typedef struct { int64_t *at; long n, most; int core; } Times;
static int64_t begin, end;

static int64_t now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000000LL + t.tv_nsec;
}

static Times times(long most, int core) {
  Times t = {malloc(most * sizeof(int64_t)), 0, most, core};
  memset(t.at, 0, most * sizeof(int64_t));
  return t;
}

static void note(Times *t, int64_t at) {
  if (at >= begin && at <= end && t->n < t->most) t->at[t->n++] = at;
}

static int real_time(int priority) {
  struct sched_param p = {.sched_priority = priority};
  return sched_setscheduler(0, SCHED_RR, &p) == 0;
}

static void *witness(void *given) {
  Times *t = given;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(t->core, &one);
  sched_setaffinity(0, sizeof one, &one);
  real_time(2); // the simulator's threads have 1
  int64_t due = now() / PERIOD * PERIOD;
  while (due < end) {
    due += PERIOD;
    if (due < now()) due = now() / PERIOD * PERIOD + PERIOD; // late: back to the grid
    struct timespec until = {due / 1000000000LL, due % 1000000000LL};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, 0);
    note(t, now());
  }
  return 0;
}

static uint16_t crc_of(const uint8_t *bytes, int n, uint8_t extra) {
  uint16_t crc = 0xffff;
  for (int i = 0; i <= n; i++) {
    uint8_t x = (i < n ? bytes[i] : extra) ^ (uint8_t)crc;
    x ^= x << 4;
    crc = (crc >> 8) ^ ((uint16_t)x << 8) ^ ((uint16_t)x << 3) ^ (x >> 4);
  }
  return crc;
}

static void tell(int socket, int id, uint8_t extra, const uint8_t *payload, int n) {
  static uint8_t sequence;
  uint8_t f[300] = {0xfd, n, 0, 0, sequence++, 1, 1, id, id >> 8, id >> 16};
  memcpy(f + 10, payload, n);
  uint16_t crc = crc_of(f + 1, 9 + n, extra);
  f[10 + n] = crc, f[11 + n] = crc >> 8;
  if (write(socket, f, 12 + n) != 12 + n) perror("write"), exit(1);
}

// HIL_ACTUATOR_CONTROLS, disarmed, in lockstep.
static void answer(int socket, const uint8_t *time_usec) {
  uint8_t payload[81] = {0};
  memcpy(payload, time_usec, 8);
  payload[8] = 1;
  payload[80] = 1;
  tell(socket, 93, 47, payload, 81);
}

static void peer(int port, Times *t) {
  int s = socket(AF_INET, SOCK_STREAM, 0), on = 1;
  struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  if (connect(s, (struct sockaddr *)&to, sizeof to)) perror("connect"), exit(1);
  setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  uint8_t heartbeat[9] = {0, 0, 0, 0, 0, 12, 0, 3, 3};
  tell(s, 0, 50, heartbeat, 9);
  static uint8_t in[65536];
  int have = 0;
  while (now() < end) {
    int got = read(s, in + have, sizeof in - have);
    if (got <= 0) fprintf(stderr, "the simulator has hung up\n"), exit(1);
    int64_t at = now();
    have += got;
    int from = 0;
    while (have - from >= 12 && have - from >= 12 + in[from + 1]) {
      uint8_t *f = in + from;
      if (f[0] != 0xfd || f[2]) fprintf(stderr, "not a frame of MAVLink 2\n"), exit(1);
      if ((f[7] | f[8] << 8 | f[9] << 16) == 107) note(t, at), answer(s, f + 10);
      from += 12 + f[1];
    }
    memmove(in, in + from, have -= from);
  }
  close(s);
}

static int by_size(const void *a, const void *b) {
  int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

static long tell_gaps(const char *name, const Times *t, int64_t limit) {
  long n = t->n - 1, above = 0;
  if (n < 1) return printf("%s: none came\n", name), 0;
  int64_t *gaps = malloc(n * sizeof *gaps);
  for (long i = 0; i < n; i++) above += (gaps[i] = t->at[i + 1] - t->at[i]) > limit;
  qsort(gaps, n, sizeof *gaps, by_size);
  printf("%s: %ld at %.2f Hz; gaps in ms: p50 %.2f, p99 %.2f, p99.9 %.2f, greatest %.2f; above %.0f ms: %ld\n", name, n + 1,
         n * 1e9 / (t->at[n] - t->at[0]), gaps[n / 2] * 1e-6, gaps[(long)(n * .99)] * 1e-6, gaps[(long)(n * .999)] * 1e-6,
         gaps[n - 1] * 1e-6, limit * 1e-6, above);
  free(gaps);
  return above;
}

// Whether the witness slept too long at some time between the two.
static int shares(const Times *w, int64_t from, int64_t to) {
  for (long i = 0; i + 1 < w->n && w->at[i] < to; i++)
    if (w->at[i + 1] > from && w->at[i + 1] - w->at[i] > LONG_PAUSE) return 1;
  return 0;
}

int main(int count, char **given) {
  int seconds = count > 1 ? atoi(given[1]) : 0, port = count > 2 ? atoi(given[2]) : 0;
  if (seconds <= 0) return fprintf(stderr, "gaps SECONDS [PORT]\n"), 2;
  int cores = sysconf(_SC_NPROCESSORS_ONLN), is_real_time = real_time(1);
  if (cores > MOST_CORES) cores = MOST_CORES;
  mlockall(MCL_CURRENT | MCL_FUTURE);
  begin = now() + (port ? WARM_UP_S : 1) * 1000000000LL;
  end = begin + seconds * 1000000000LL;
  Times witnesses[MOST_CORES], sensors = times(seconds * 1000L, -1);
  pthread_t threads[MOST_CORES];
  for (int i = 0; i < cores; i++) {
    witnesses[i] = times(seconds * 1100L, i);
    pthread_create(&threads[i], 0, witness, &witnesses[i]);
  }
  if (port) peer(port, &sensors);
  for (int i = 0; i < cores; i++) pthread_join(threads[i], 0);
  if (!is_real_time) printf("without real-time priority: the system did not allow it\n");
  for (int i = 0; i < cores; i++) {
    char name[32];
    snprintf(name, sizeof name, "witness on core %d", i);
    tell_gaps(name, &witnesses[i], LONG_PAUSE);
  }
  if (port) {
    long above = tell_gaps("HIL_SENSOR", &sensors, LONG_GAP), shared = 0;
    for (long i = 0; i + 1 < sensors.n; i++)
      if (sensors.at[i + 1] - sensors.at[i] > LONG_GAP) {
        int is_shared = 0;
        for (int c = 0; c < cores; c++) is_shared |= shares(&witnesses[c], sensors.at[i], sensors.at[i + 1]);
        shared += is_shared;
      }
    printf("gaps above 8 ms: %ld, of which the witnesses shared %ld\n", above, shared);
  }
  return 0;
}
