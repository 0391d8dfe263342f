package skein.lanes;

/**
 * Carries readings of the vehicles of one role forward in many worlds, by a {@link Timetable}: to
 * which moment, and through which commands, is the same in all worlds. The scalar reference is a
 * {@code skein.vehicle.VehicleModel} in a {@code skein.forecast.Forecast}.
 */
abstract class PredictedVehicles {
  static final int WORLDS = LanePolicy.WORLDS;

  /** Back to the start of an episode. */
  void start(int worlds) {}

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
