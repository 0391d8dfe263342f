package skein.lanes.loop;

/**
 * Carries readings of one vehicle forward in many worlds, each on a way of its own ({@link
 * ForecastTrack#lay}). The scalar reference is a {@code skein.vehicle.VehicleModel}.
 */
interface ForecastVehicles {
  /** Whether readings do not tell all that is known of a vehicle; then each one {@link #enter enters}. */
  default boolean remembers() {
    return false;
  }

  /** Back to the start of an episode. */
  default void start() {}

  /**
   * Flies the way that was laid from the reading before, and takes what this one tells.
   *
   * @param enters 1 where there is a reading
   * @param read the reading, by {@link LaneVehicles#SEEN_X} and what follows it
   */
  default void enter(LaneVectors vectors, ForecastTrack way, int[] enters, float[] read) {}

  /**
   * Flies the way that was laid from the newest reading.
   *
   * @param read the newest reading, by {@link LaneVehicles#SEEN_X} and what follows it
   * @param into position, m, then velocity, m/s, north and east
   */
  void predict(LaneVectors vectors, ForecastTrack way, float[] read, float[] into);
}
