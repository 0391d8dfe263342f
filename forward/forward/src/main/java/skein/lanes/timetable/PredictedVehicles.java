package skein.lanes.timetable;

import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/**
 * Carries readings of the vehicles of one role forward in many worlds, by a {@link Timetable}: to
 * which moment, and through which commands, is the same in all worlds. The scalar reference is a
 * {@code skein.vehicle.VehicleModel} in a {@code skein.forecast.Forecast}.
 */
public abstract class PredictedVehicles {
  static final int WORLDS = LanePolicy.WORLDS;

  /** Back to the start of an episode. */
  void start(int worlds) {}

  /** All readings of one world's vehicle have become those of its start, at rest. */
  void restart(int world, float[] seenX, float[] seenY, float[] seenVx, float[] seenVy) {}

  /**
   * Takes a reading that enters a forecast, where it does not tell all that is known of a vehicle.
   *
   * @param seenX positions and velocities that were read, north and east, by place
   * @param sent the commands, by place
   * @param from the index of the first world of the reading that entered before; negative if none did
   * @param reading the same of this one
   * @param propagation the way to it
   */
  void enter(
      float[] seenX,
      float[] seenY,
      float[] seenVx,
      float[] seenVy,
      Directions sent,
      int from,
      int reading,
      Propagation propagation) {}

  /**
   * Carries a reading forward.
   *
   * @param seenX positions and velocities that were read, north and east, by place; what is predicted
   *     is put beside them
   * @param sent the commands, by place
   * @param reading the index of the reading's first world
   * @param into the same of what is predicted
   * @param propagation the way there
   * @param withVelocity whether velocities are predicted too
   */
  abstract void predict(
      float[] seenX,
      float[] seenY,
      float[] seenVx,
      float[] seenVy,
      Directions sent,
      int reading,
      int into,
      Propagation propagation,
      boolean withVelocity);
}
