package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.Duelist;
import skein.vehicle.Plant;

/**
 * Vehicles that move by a {@link Plant}, whose commands act at times of their own in each world. A
 * piece is a step: of it the state at its begin is kept, and the command, which is no direction until
 * there was one; the vehicle rests then. The scalar reference is {@code skein.forward.PlantVehicle}.
 */
final class PlantFlights extends PieceFlights {
  private static final int ALONG_X = PIECE_OWN * WORLDS, ALONG_Y = ALONG_X + WORLDS, STATE = ALONG_Y + WORLDS;

  private final PlantLanes lanes;
  private final float speedMps, stepS;
  private final FixedFormula.Call step, see;
  private final float[] flown, north = new float[WORLDS], east = new float[WORLDS], forS = new float[WORLDS];

  PlantFlights(Duelist duelist, PlantLanes lanes, FlightTiming timing) {
    super(duelist, PIECE_OWN + 2 + lanes.count(), timing, lanes.plant().stepS(), PIECE_OWN);
    this.lanes = lanes;
    speedMps = (float) duelist.speed();
    stepS = (float) lanes.plant().stepS();
    flown = new float[lanes.count() * WORLDS];
    step = lanes.step().call();
    step.inputs(0, lanes.count(), chosen, STATE);
    step.input(lanes.count(), north, 0);
    step.input(lanes.count() + 1, east, 0);
    step.input(lanes.count() + 2, forS, 0);
    step.outputs(lanes.count(), flown, 0);
    see = lanes.read().call();
    see.inputs(0, lanes.count(), flown, 0);
    // Where a piece began is where the vehicle started: its state counts from there.
    see.input(lanes.count(), chosen, PIECE_X * WORLDS);
    see.input(lanes.count() + 1, chosen, PIECE_Y * WORLDS);
    see.output(0, x, 0);
    see.output(1, y, 0);
    see.output(2, vx, 0);
    see.output(3, vy, 0);
  }

  @Override
  void rest(float[] pieces) {
    lanes.rest(pieces, STATE);
  }

  @Override
  void fly(LaneVectors vectors, boolean withVelocity) {
    FloatVector speed = FloatVector.broadcast(SPECIES, speedMps), whole = FloatVector.broadcast(SPECIES, stepS);
    boolean allFly = true;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dt = time(i);
      FloatVector.fromArray(SPECIES, chosen, ALONG_X + i).mul(speed).intoArray(north, i);
      FloatVector.fromArray(SPECIES, chosen, ALONG_Y + i).mul(speed).intoArray(east, i);
      VectorMask<Float> flies = flies(i, dt);
      allFly &= flies.allTrue();
      // A plant is never stepped by no time; what comes of this step is not taken.
      whole.blend(dt.min(whole), flies).intoArray(forS, i);
    }
    step.apply();
    if (!allFly) keepOthers();
    see.apply();
  }

  private FloatVector time(int i) {
    return FloatVector.fromArray(SPECIES, until, i)
        .sub(FloatVector.fromArray(SPECIES, chosen, PIECE_TIME * WORLDS + i));
  }

  private VectorMask<Float> flies(int i, FloatVector dt) {
    FloatVector alongX = FloatVector.fromArray(SPECIES, chosen, ALONG_X + i),
        alongY = FloatVector.fromArray(SPECIES, chosen, ALONG_Y + i);
    return dt.compare(GT, 0f).and(alongX.abs().add(alongY.abs()).compare(GT, 0f));
  }

  private void keepOthers() {
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Float> rests = flies(i, time(i)).not();
      if (rests.anyTrue())
        for (int at = i; at < flown.length; at += WORLDS)
          FloatVector.fromArray(SPECIES, chosen, STATE + at).intoArray(flown, at, rests);
    }
  }

  @Override
  void begin(LaneVectors vectors, int at, int[] acts, Directions commanded) {
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k], from = at + i;
      VectorMask<Float> does = IntVector.fromArray(INTS, acts, i).compare(LT, none).cast(SPECIES);
      FloatVector.fromArray(SPECIES, until, i).intoArray(pieces, from + PIECE_TIME * WORLDS, does);
      FloatVector.fromArray(SPECIES, commanded.cos, i).intoArray(pieces, from + ALONG_X, does);
      FloatVector.fromArray(SPECIES, commanded.sin, i).intoArray(pieces, from + ALONG_Y, does);
      for (int number = 0; number < flown.length; number += WORLDS)
        FloatVector.fromArray(SPECIES, flown, number + i).intoArray(pieces, from + STATE + number, does);
    }
  }
}
