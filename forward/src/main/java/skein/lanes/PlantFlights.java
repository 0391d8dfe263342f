package skein.lanes;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.Duelist;
import skein.vehicle.Plant;

/**
 * Vehicles that move by a {@link Plant}, whose commands act at times of their own in each world. A
 * piece is a step: of it the state at its begin is kept, and the command, which is no number until
 * there was one; the vehicle rests then. The scalar reference is {@code skein.forward.PlantVehicle}.
 */
final class PlantFlights extends LaneFlights {
  private static final int STATE = PIECE_OWN;

  private final PlantLanes lanes;
  private final float speedMps, stepS;
  private final FixedFormula.Call step, see;

  /** The state flown to. */
  private final float[] reached;

  private final float[] north = new float[WORLDS], east = new float[WORLDS], forS = new float[WORLDS];

  /** Of velocities that nobody asks for. */
  private final float[] unread = new float[2 * WORLDS];

  PlantFlights(Duelist duelist, PlantLanes lanes, LoopLanes loop) {
    super(duelist, lanes.count(), lanes.plant().stepS(), loop);
    this.lanes = lanes;
    speedMps = (float) duelist.speed();
    stepS = (float) lanes.plant().stepS();
    reached = new float[lanes.count() * WORLDS];
    step = lanes.step().call();
    step.inputs(0, lanes.count(), chosen, STATE);
    step.input(lanes.count(), north, 0);
    step.input(lanes.count() + 1, east, 0);
    step.input(lanes.count() + 2, forS, 0);
    step.outputs(lanes.count(), reached, 0);
    see = lanes.read().call();
    see.inputs(0, lanes.count(), reached, 0);
    // Where a piece began is where the vehicle started: its state counts from there.
    see.input(lanes.count(), chosen, PIECE_X);
    see.input(lanes.count() + 1, chosen, PIECE_Y);
  }

  @Override
  void rest(float[] pieces) {
    lanes.rest(pieces, STATE);
    Arrays.fill(pieces, ALONG_X, ALONG_X + WORLDS, Float.NaN);
  }

  @Override
  void fly(LaneVectors vectors, float[] into, int at, boolean withVelocity) {
    reach();
    see.output(0, into, at);
    see.output(1, into, at + WORLDS);
    see.output(2, withVelocity ? into : unread, withVelocity ? at + 2 * WORLDS : 0);
    see.output(3, withVelocity ? into : unread, withVelocity ? at + 3 * WORLDS : WORLDS);
    see.apply();
  }

  @Override
  void flyOn(LaneVectors vectors) {
    reach();
  }

  private void reach() {
    FloatVector speed = FloatVector.broadcast(SPECIES, speedMps), whole = FloatVector.broadcast(SPECIES, stepS);
    boolean allFly = true;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dt = FloatVector.fromArray(SPECIES, sinceS, i);
      FloatVector.fromArray(SPECIES, chosen, ALONG_X + i).mul(speed).intoArray(north, i);
      FloatVector.fromArray(SPECIES, chosen, ALONG_Y + i).mul(speed).intoArray(east, i);
      VectorMask<Float> flies = flies(i, dt);
      allFly &= flies.allTrue();
      // A plant is never stepped by no time; what comes of this step is not taken.
      whole.blend(dt.min(whole), flies).intoArray(forS, i);
    }
    step.apply();
    if (!allFly) keepOthers();
  }

  private VectorMask<Float> flies(int i, FloatVector dt) {
    FloatVector along = FloatVector.fromArray(SPECIES, chosen, ALONG_X + i);
    return dt.compare(GT, 0f).and(along.compare(EQ, along));
  }

  private void keepOthers() {
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Float> flies = flies(i, FloatVector.fromArray(SPECIES, sinceS, i));
      if (!flies.allTrue())
        for (int at = i; at < reached.length; at += WORLDS)
          FloatVector.fromArray(SPECIES, chosen, STATE + at)
              .blend(FloatVector.fromArray(SPECIES, reached, at), flies)
              .intoArray(reached, at);
    }
  }

  @Override
  void begin(LaneVectors vectors, int at, int[] acts, Directions commanded) {
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k], to = at + i;
      VectorMask<Float> does = IntVector.fromArray(INTS, acts, i).compare(LT, none).cast(SPECIES);
      FloatVector.fromArray(SPECIES, chosen, PIECE_X + i).intoArray(pieces, to + PIECE_X);
      FloatVector.fromArray(SPECIES, chosen, PIECE_Y + i).intoArray(pieces, to + PIECE_Y);
      FloatVector.fromArray(SPECIES, chosen, ALONG_X + i)
          .blend(FloatVector.fromArray(SPECIES, commanded.cos, i), does)
          .intoArray(pieces, to + ALONG_X);
      FloatVector.fromArray(SPECIES, chosen, ALONG_Y + i)
          .blend(FloatVector.fromArray(SPECIES, commanded.sin, i), does)
          .intoArray(pieces, to + ALONG_Y);
      for (int number = 0; number < reached.length; number += WORLDS)
        FloatVector.fromArray(SPECIES, chosen, STATE + number + i)
            .blend(FloatVector.fromArray(SPECIES, reached, number + i), does)
            .intoArray(pieces, to + STATE + number);
    }
  }
}
