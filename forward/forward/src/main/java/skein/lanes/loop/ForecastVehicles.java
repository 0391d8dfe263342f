package skein.lanes.loop;

/** Predicts one vehicle in many worlds from its readings, along a separate track in each world ({@link
 * ForecastTrack#lay}). The scalar reference is a {@code skein.vehicle.VehicleModel}.
 */
interface ForecastVehicles {
  /** Whether the model's state contains more than a reading; then the caller must {@link #enter} each
   * reading.
   */
  default boolean remembers() {
    return false;
  }

  /** Resets to the start of an episode.
   *
   * @param startZ altitudes of the start by world, m down
   */
  default void start(float[] startZ) {}

  /** Resets worlds before their first reading.
   *
   * @param first 1 in these worlds, else 0
   * @param downM altitudes of all worlds, m down, which vehicles hold until their first command
   */
  default void rest(int[] first, float[] downM) {}

  /** Simulates the track from the previous reading, and corrects the state by this one.
   *
   * @param enters 1 in worlds with a reading, else 0
   * @param read the readings, in the order of {@link LaneVehicles#SEEN_X} and the following constants
   */
  default void enter(LaneVectors vectors, ForecastTrack way, int[] enters, float[] read) {}

  /** Simulates the track from the newest reading.
   *
   * @param read the newest readings, in the order of {@link LaneVehicles#SEEN_X} and the following constants
   * @param into receives position, m, then velocity, m/s, each north, then east; in space, then both down
   */
  void predict(LaneVectors vectors, ForecastTrack way, float[] read, float[] into);
}
