package skein.lanes.timetable;

import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/** Predicts the vehicles of one role in many worlds from their readings, by a {@link Timetable}: the
 * predicted moments and the commands in effect are equal in all worlds. The scalar reference is a {@code
 * skein.vehicle.VehicleModel} in a {@code skein.forecast.Forecast}.
 */
public abstract class PredictedVehicles {
  static final int WORLDS = LanePolicy.WORLDS;

  /** Resets to the start of an episode, of which the first worlds count.
   *
   * @param startZ altitudes of the start by world, m down
   */
  void start(int worlds, float[] startZ) {}

  /** Sets all readings of one world's vehicle to its start, at rest.
   *
   * @param seen the readings: by component, slot and world
   */
  void restart(int world, float[][] seen) {}

  /** Adds a reading to the forecast, if the model's state contains more than a reading.
   *
   * @param seen the readings: by component, slot and world
   * @param sent the commands, indexed by slot
   * @param from the index, for the first world, of the previous reading; negative if there is none
   * @param reading the index, for the first world, of this reading
   * @param propagation the steps from the previous reading to this one
   */
  void enter(float[][] seen, Directions sent, int from, int reading, Propagation propagation) {}

  /** Predicts from a reading.
   *
   * @param seen the readings: by component, slot and world, to which the predictions are added
   * @param sent the commands, indexed by slot
   * @param reading the index of the reading, for the first world
   * @param into the index of the prediction, for the first world
   * @param propagation the steps of the prediction
   * @param withVelocity whether velocities are predicted too
   */
  abstract void predict(
      float[][] seen,
      Directions sent,
      int reading,
      int into,
      Propagation propagation,
      boolean withVelocity);
}
