package skein.lanes.timetable;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.vehicle.PlantModel;

/** Predicts with a first-order lag. The model is linear: a prediction is the reading's position, plus its
 * velocity times a factor, plus each pending command times its own factor; the timetable has the factors. The
 * scalar reference is {@link PlantModel} without drag.
 */
public final class PredictedLagVehicles extends PredictedVehicles {
  private final float speed;
  private int worlds = WORLDS;

  /** @param speedMps speed of a vehicle whose command does not change, m/s */
  public PredictedLagVehicles(double speedMps) {
    speed = (float) speedMps;
  }

  @Override
  void start(int worlds, float[] startZ) {
    this.worlds = worlds;
  }

  @Override
  void predict(
      float[][] seen,
      Directions sent,
      int reading,
      int into,
      Propagation propagation,
      boolean withVelocity) {
    float[] seenX = seen[LaneObservation.X],
        seenY = seen[LaneObservation.Y],
        seenVx = seen[LaneObservation.VX],
        seenVy = seen[LaneObservation.VY];
    float carried = propagation.first(), kept = propagation.second();
    carry(seenX, seenVx, carried, seenX, reading, into);
    carry(seenY, seenVy, carried, seenY, reading, into);
    if (withVelocity) {
      keep(seenVx, kept, reading, into);
      keep(seenVy, kept, reading, into);
    }
    for (int down = LaneObservation.DOWN; down < LaneObservation.IN_SPACE; down++)
      if (seen[down].length > 0) System.arraycopy(seen[down], reading, seen[down], into, worlds);
    int[] commands = propagation.commands();
    float[] numbers = propagation.numbers();
    for (int part = 0; part < commands.length; part++) {
      int place = commands[part];
      if (place != Propagation.Rest()) {
        float moved = numbers[2 * part] * speed, faster = numbers[2 * part + 1] * speed;
        add(sent.cos, place * WORLDS, moved, seenX, into);
        add(sent.sin, place * WORLDS, moved, seenY, into);
        if (withVelocity) {
          add(sent.cos, place * WORLDS, faster, seenVx, into);
          add(sent.sin, place * WORLDS, faster, seenVy, into);
        }
      }
    }
  }

  private void carry(
      float[] position, float[] velocity, float seconds, float[] predicted, int from, int into) {
    FloatVector factor = constant(seconds);
    for (int i = 0; i < worlds; i += LANES)
      FloatVector.fromArray(SPECIES, velocity, from + i)
          .fma(factor, FloatVector.fromArray(SPECIES, position, from + i))
          .intoArray(predicted, into + i);
  }

  private void keep(float[] velocity, float share, int from, int into) {
    FloatVector factor = constant(share);
    for (int i = 0; i < worlds; i += LANES)
      FloatVector.fromArray(SPECIES, velocity, from + i).mul(factor).intoArray(velocity, into + i);
  }

  private void add(float[] what, int from, float times, float[] to, int at) {
    FloatVector factor = constant(times);
    for (int i = 0; i < worlds; i += LANES)
      FloatVector.fromArray(SPECIES, what, from + i)
          .fma(factor, FloatVector.fromArray(SPECIES, to, at + i))
          .intoArray(to, at + i);
  }
}
