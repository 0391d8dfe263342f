package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.lanes.plant.PlantCorrection;
import skein.lanes.plant.PlantLanes;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.simd.FixedFormula;

/** Predicts with a plant. A step begins at a reading, at the arrival of a command, at each turn, and no later
 * than {@code stepS} after the last. The part of the state that readings lack is simulated from reading to
 * reading. {@code PredictedPlants} is the variant for worlds with equal times. Unlike here, {@code
 * skein.vehicle.PlantModel} also begins a step at a command that repeats the one in effect.
 */
final class ForecastPlants implements ForecastVehicles {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final float speedMps, stepS;
  private final PlantLanes lanes;
  private final FixedFormula.Call correct, step, look;

  /** Number of floats per world in a plant's state. */
  private final int count;

  private final boolean remembers;

  /** The state at the newest reading; used only if a reading lacks a part of the state. */
  private final float[] held;

  /** The state at the start and at the end of a step. */
  private final float[] from, to;

  private final float[] north = new float[WORLDS],
      east = new float[WORLDS],
      third = new float[WORLDS],
      holds = new float[WORLDS],
      forS = new float[WORLDS];

  /** Time simulated so far, end of the command in effect, and latest start of the next step, s from the
   * reading.
   */
  private final float[] flownS = new float[WORLDS], untilS = new float[WORLDS], stopS = new float[WORLDS];

  private final float[] goes = new float[WORLDS];

  ForecastPlants(PlantLanes lanes, PlantCorrection correction, double speedMps) {
    this.lanes = lanes;
    this.speedMps = (float) speedMps;
    stepS = (float) lanes.plant().stepS();
    count = lanes.count();
    from = new float[count * WORLDS];
    to = new float[count * WORLDS];
    remembers = !correction.isTold() || lanes.inSpace();
    held = new float[from.length];
    correct = correction.call();
    correct.inputs(0, count, from, 0);
    step = lanes.step().call();
    step.inputs(0, count, from, 0);
    step.input(count, north, 0);
    step.input(count + 1, east, 0);
    if (lanes.inSpace()) {
      step.input(count + 2, third, 0);
      step.input(count + 3, holds, 0);
    }
    step.input(count + (lanes.inSpace() ? 4 : 2), forS, 0);
    step.outputs(count, to, 0);
    look = lanes.read().call();
    look.inputs(0, count, from, 0);
  }

  @Override
  public boolean remembers() {
    return remembers;
  }

  @Override
  public void start(float[] startZ) {
    if (lanes.inSpace()) lanes.restInSpace(held, 0, startZ);
    else lanes.rest(held, 0);
  }

  @Override
  public void rest(int[] first, float[] downM) {
    lanes.restInSpace(to, 0, downM);
    for (int number = 0; number < held.length; number += WORLDS)
      for (int world = 0; world < WORLDS; world++)
        if (first[world] > 0) held[number + world] = to[number + world];
  }

  @Override
  public void enter(LaneVectors vectors, ForecastTrack way, int[] enters, float[] read) {
    System.arraycopy(held, 0, from, 0, held.length);
    fly(vectors, way);
    correct(read, to);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> does = IntVector.fromArray(INTS, enters, i).compare(GT, 0).cast(SPECIES);
      for (int number = i; number < held.length; number += WORLDS)
        FloatVector.fromArray(SPECIES, to, number).intoArray(held, number, does);
    }
  }

  @Override
  public void predict(LaneVectors vectors, ForecastTrack way, float[] read, float[] into) {
    if (remembers) System.arraycopy(held, 0, from, 0, held.length);
    else correct(read, from);
    fly(vectors, way);
    look.outputs(read(), into, 0);
    look.apply();
  }

  private int read() {
    return LaneObservation.count(true, lanes.inSpace());
  }

  /** Corrects the simulated state with a reading. */
  private void correct(float[] read, float[] into) {
    correct.inputs(count, read(), read, LaneVehicles.SEEN_X);
    correct.outputs(count, into, 0);
    correct.apply();
  }

  /** Simulates the track from its start to its end. */
  private void fly(LaneVectors vectors, ForecastTrack way) {
    Arrays.fill(flownS, 0f);
    Arrays.fill(forS, stepS);
    for (int turn = 0; turn < way.turns; turn++) {
      follow(vectors, way, turn);
      while (goesOn(vectors, way, turn)) {
        step.apply();
        take(vectors);
      }
    }
  }

  /** Makes the command of a turn the one in effect, and computes its end. */
  private void follow(LaneVectors vectors, ForecastTrack way, int turn) {
    float[] turnS = way.turnS, turnX = way.turn.cos, turnY = way.turn.sin;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k], place = turn * WORLDS + i;
      boolean isLast = turn + 1 >= way.turnsOf[i / LANES], counts = turn >= way.heldFrom[i / LANES];
      FloatVector.fromArray(SPECIES, turnX, place).mul(speedMps).intoArray(north, i);
      FloatVector.fromArray(SPECIES, turnY, place).mul(speedMps).intoArray(east, i);
      if (lanes.inSpace()) {
        FloatVector.fromArray(SPECIES, way.turn.third, place).intoArray(third, i);
        FloatVector.fromArray(SPECIES, way.turn.holds, place).intoArray(holds, i);
      }
      FloatVector end = FloatVector.fromArray(SPECIES, way.endS, i);
      if (!counts) end = end.mul(0f);
      else if (!isLast) end = end.min(FloatVector.fromArray(SPECIES, turnS, place + WORLDS));
      end.intoArray(untilS, i);
    }
  }

  /** Whether some world's track has time left under the present command; sets the length of each world's next
   * step.
   */
  private boolean goesOn(LaneVectors vectors, ForecastTrack way, int turn) {
    float[] turnS = way.turnS;
    boolean any = false;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector flown = FloatVector.fromArray(SPECIES, flownS, i),
          until = FloatVector.fromArray(SPECIES, untilS, i);
      // Commands of later turns may arrive now, in their order. Without a dead time they take effect
      // immediately.
      int turns = way.deadS > 0 ? way.turnsOf[i / LANES] : 0;
      for (int later = Math.max(turn + 1, way.held); later < turns; later++) {
        FloatVector told = FloatVector.fromArray(SPECIES, turnS, later * WORLDS + i).sub(way.deadS);
        if (!told.max(flown).compare(LT, until).anyTrue()) break;
        until = until.blend(until.min(told), told.compare(GT, flown));
      }
      until.intoArray(stopS, i);
      FloatVector left = until.sub(flown);
      VectorMask<Float> on = left.compare(GT, 0f);
      any |= on.anyTrue();
      // A plant's step must not be 0 s; the result of this step is not used.
      FloatVector.broadcast(SPECIES, stepS).blend(left.min(stepS), on).intoArray(forS, i);
      left.intoArray(goes, i);
    }
    return any;
  }

  private void take(LaneVectors vectors) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> on = FloatVector.fromArray(SPECIES, goes, i).compare(GT, 0f);
      for (int number = i; number < from.length; number += WORLDS)
        FloatVector.fromArray(SPECIES, to, number).intoArray(from, number, on);
      FloatVector flown = FloatVector.fromArray(SPECIES, flownS, i),
          until = FloatVector.fromArray(SPECIES, stopS, i);
      // Exactly to the end: a remainder left by rounding would be a further step.
      FloatVector then = flown.add(FloatVector.fromArray(SPECIES, forS, i));
      flown.blend(until.blend(then, until.sub(then).compare(GT, 1e-6f)), on).intoArray(flownS, i);
    }
  }
}
