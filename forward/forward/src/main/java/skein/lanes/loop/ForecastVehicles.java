package skein.lanes.loop;

/** Predicts one vehicle in many worlds from its readings, each along its own track ({@link
 * ForecastTrack#lay}). The scalar reference is a {@code skein.vehicle.VehicleModel}.
 */
interface ForecastVehicles {
  /** Whether its state holds more than a reading; then each reading must {@link #enter}. */
  default boolean remembers() {
    return false;
  }

  default void start() {}

  /** Simulates the track from the previous reading, and corrects the state by this one.
   *
   * @param enters 1 where there is a reading
   * @param read the reading, by {@link LaneVehicles#SEEN_X} and the following constants
   */
  default void enter(LaneVectors vectors, ForecastTrack way, int[] enters, float[] read) {}

  /** Simulates the track from the newest reading.
   *
   * @param read the newest reading, by {@link LaneVehicles#SEEN_X} and the following constants
   * @param into position, m, then velocity, m/s, north and east
   */
  void predict(LaneVectors vectors, ForecastTrack way, float[] read, float[] into);
}
