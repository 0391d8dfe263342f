// Steps a second of MuJoCo's own batch on one thread, called from C: what skein.mujoco.mujocoRates calls from the JVM.
// Build: M=$(python3 -c 'import mujoco; print(mujoco.__path__[0])')
//        gcc -O2 -Wall -I$M/include rollout.c -o rollout $M/libmujoco.so.4.0.0 -Wl,-rpath,$M -lm
// Run:   ./rollout FILE.xml CONTROL VEHICLES STEPS ROUNDS      e.g. quadrotor.xml 0.6 64 100 60; the best round counts
#include <math.h>
#include <mujoco/mjbatch.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + t.tv_nsec * 1e-9;
}

int main(int count, char **given) {
  if (count != 6) return fprintf(stderr, "rollout FILE.xml CONTROL VEHICLES STEPS ROUNDS\n"), 2;
  double control = atof(given[2]), best = 0;
  int vehicles = atoi(given[3]), steps = atoi(given[4]), rounds = atoi(given[5]);
  char error[1000] = "";
  mjModel *model = mj_loadXML(given[1], 0, error, sizeof error);
  if (!model) return fprintf(stderr, "%s\n", error), 1;
  mjBatchConfig config = {.nthread = 1, .persistent = 0};
  mjBatch *batch = mjb_makeBatch(model, vehicles, &config, error, sizeof error);
  if (!batch) return fprintf(stderr, "%s\n", error), 1;
  int row = mjb_nstate(batch), size;
  mjtNum *state = mjb_state(batch), *begin = malloc(row * sizeof *begin);
  mjtNum *place = mjb_stateComponent(batch, mjSTATE_QPOS, &size);
  place[2] = 20; // m above the ground
  memcpy(begin, state, row * sizeof *begin);
  long controls = (long)vehicles * steps * model->nu;
  mjtNum *told = malloc(controls * sizeof *told);
  for (long i = 0; i < controls; i++) told[i] = control * (1 + 0.05 * sin(i * 0.37));
  for (int round = 0; round < rounds; round++) {
    double from = now();
    for (int i = 0; i < vehicles; i++) memcpy(state + (long)i * row, begin, row * sizeof *begin);
    if (mjb_rollout(batch, 0, 0, steps, told, mjSTATE_CTRL, 0, 0)) return fprintf(stderr, "%s\n", mjb_error(batch, 0)), 1;
    double rate = vehicles * steps / (now() - from);
    if (rate > best) best = rate;
  }
  printf("%s, %d vehicles, %d steps, best of %d: %.0f steps/s; witness %.17g\n", given[1], vehicles, steps, rounds, best, place[2]);
  return 0;
}
