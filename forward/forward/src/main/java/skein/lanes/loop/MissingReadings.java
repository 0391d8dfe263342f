package skein.lanes.loop;

import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import java.util.Objects;
import skein.forward.DelayTable;
import skein.lanes.policy.LanePolicy;
import skein.signal.SplitMix64;
import skein.vehicle.NoisySensor;
import skein.vehicle.SensorNoise;

/** Which requests find no reading of a vehicle, in many worlds: their answers say so. Few are, and they are
 * looked up one by one.
 */
public final class MissingReadings {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final SensorNoise[] noise;
  private final NoisySensor[][] sensors;

  final boolean areSome;

  /** @param noise by vehicle; null where every request finds a reading */
  public MissingReadings(SensorNoise[] noise) {
    this.noise = noise;
    areSome = Arrays.stream(noise).anyMatch(Objects::nonNull);
    sensors = new NoisySensor[noise.length][WORLDS];
  }

  SensorNoise[] noises() {
    return noise;
  }

  void start(int[] worldKeys) {
    for (int v = 0; v < noise.length; v++)
      if (noise[v] != null)
        for (int world = 0; world < WORLDS; world++)
          sensors[v][world] = new NoisySensor(noise[v], SplitMix64.seedOf(worldKeys[world], v));
  }

  /** Whether a vehicle has no reading of this time, in grains since the episode's start. */
  boolean is(int vehicle, int world, long at) {
    return noise[vehicle] != null && sensors[vehicle][world].isMissing(at * DelayTable.GrainNs());
  }

  /** Replaces the times of answers without a reading.
   *
   * @param readAt times at which the requests reach the vehicle, in grains from {@code begin}
   * @param answers times of their answers; {@link Integer#MAX_VALUE} where there is none
   */
  void replace(int vehicle, long begin, int[] readAt, int[] answers, int by) {
    for (int world = 0; world < WORLDS; world++)
      if (answers[world] != Integer.MAX_VALUE && is(vehicle, world, begin + readAt[world])) answers[world] = by;
  }

  /** Finds, for rounds that request all vehicles in turn, the first request without a reading.
   *
   * @param begins begin of each round, in grains from {@code begin}
   * @param drawn for each vehicle, the delay of its request, then of its answer
   * @param into receives the vehicle; the number of vehicles if there is none. A round that fails before it
   *   has any
   */
  void find(LaneVectors vectors, int[] begins, long begin, int[][] drawn, int[] into) {
    for (int k = 0; k < vectors.count; k++)
      for (int i = vectors.first[k], end = i + LANES; i < end; i++) {
        long at = begin + begins[i];
        int v = 0;
        for (; v < noise.length && !is(v, i, at + drawn[2 * v][i]); v++)
          at += drawn[2 * v][i] + drawn[2 * v + 1][i];
        into[i] = v;
      }
  }
}
