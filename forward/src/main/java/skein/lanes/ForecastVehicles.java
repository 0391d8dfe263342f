package skein.lanes;

/**
 * Carries readings of one vehicle forward in many worlds, each on a way of its own ({@link
 * ForecastTrack#lay}). The scalar reference is a {@code skein.vehicle.VehicleModel}.
 */
interface ForecastVehicles {
  /**
   * Flies the way that was laid.
   *
   * @param read the reading, by {@link LaneVehicles#SEEN_X} and what follows it
   * @param into position, m, then velocity, m/s, north and east
   */
  void predict(LaneVectors vectors, ForecastTrack way, float[] read, float[] into);
}
