package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.MAX;
import static jdk.incubator.vector.VectorOperators.MIN;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.ArrayList;
import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.lanes.policy.LanePolicy;

/** Readings of one vehicle that arrived within a period, in many worlds, each with the mean delays known at
 * its arrival. A world may have several readings; a reading that is older than an earlier arrival is ignored.
 * {@link #next} visits the first reading of every world, then the second of every world, and so on.
 */
final class ArrivedReadings {
  private static final int WORLDS = LanePolicy.WORLDS;

  private static final class Readings {
    final int[] madeAt = new int[WORLDS], receivedAt = new int[WORLDS];
    final float[] toS = new float[WORLDS], fromS = new float[WORLDS];
  }

  /** Entry n contains the n-th reading of each world in the present period. */
  private final ArrayList<Readings> readings = new ArrayList<>();

  /** Number of readings of each world in this period. */
  private final int[] counts = new int[WORLDS];

  /** Number of entries of {@link #readings} that {@link #next} has visited. */
  private int gone;

  /** Sampling time of the newest reading, in grains from the period's start. */
  final int[] newestAt = new int[WORLDS];

  /** 1 in worlds for which {@link #next} has found a reading, else 0; and the vectors with such a world. */
  final int[] enters = new int[WORLDS];

  final LaneVectors vectors = new LaneVectors();

  void start() {
    Arrays.fill(counts, 0);
    gone = 0;
  }

  /** Adds readings that are newer than the newest, and updates the mean delays by them.
   *
   * @param whose number of the vehicle of each reading
   * @param vehicle number of this vehicle
   * @param asked time of each request; {@code made} of each sample, {@code received} of each answer: in
   *   grains from the period's start
   * @param delays mean delays over the readings of all vehicles
   */
  void take(
      LaneVectors among,
      int[] whose,
      int vehicle,
      int[] asked,
      int[] made,
      int[] received,
      MeanDelays delays) {
    IntVector zero = IntVector.broadcast(INTS, 0), one = IntVector.broadcast(INTS, 1);
    vectors.count = 0;
    for (int k = 0; k < among.count; k++) {
      int i = among.first[k];
      IntVector now = IntVector.fromArray(INTS, made, i), last = IntVector.fromArray(INTS, newestAt, i);
      VectorMask<Integer> newer =
          IntVector.fromArray(INTS, whose, i).compare(EQ, vehicle).and(now.compare(GT, last));
      if (!newer.anyTrue()) continue;
      vectors.first[vectors.count++] = i;
      zero.blend(one, newer).intoArray(enters, i);
      last.blend(now, newer).intoArray(newestAt, i);
    }
    delays.take(vectors, enters, asked, made, received);
    note(made, received, delays);
  }

  private void note(int[] made, int[] received, MeanDelays delays) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector count = IntVector.fromArray(INTS, counts, i);
      VectorMask<Integer> enter = IntVector.fromArray(INTS, enters, i).compare(GT, 0);
      int least = count.reduceLanes(MIN), most = count.reduceLanes(MAX);
      while (readings.size() <= most) readings.add(new Readings());
      for (int n = least; n <= most; n++) {
        Readings nth = readings.get(n);
        VectorMask<Integer> does = count.compare(EQ, n).and(enter);
        VectorMask<Float> means = does.cast(SPECIES);
        IntVector.fromArray(INTS, nth.madeAt, i)
            .blend(IntVector.fromArray(INTS, made, i), does)
            .intoArray(nth.madeAt, i);
        IntVector.fromArray(INTS, nth.receivedAt, i)
            .blend(IntVector.fromArray(INTS, received, i), does)
            .intoArray(nth.receivedAt, i);
        FloatVector.fromArray(SPECIES, nth.toS, i)
            .blend(FloatVector.fromArray(SPECIES, delays.toS, i), means)
            .intoArray(nth.toS, i);
        FloatVector.fromArray(SPECIES, nth.fromS, i)
            .blend(FloatVector.fromArray(SPECIES, delays.fromS, i), means)
            .intoArray(nth.fromS, i);
      }
      count.add(1, enter).intoArray(counts, i);
    }
  }

  /** Moves to the next reading in each world that has another; {@link #enters}, {@link #vectors}, {@link
   * #madeAt} and the other methods then refer to it.
   *
   * @return false if no world has another reading; all readings are then discarded
   */
  boolean next() {
    vectors.count = 0;
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Integer> more = IntVector.fromArray(INTS, counts, i).compare(GT, gone);
      if (more.anyTrue()) vectors.first[vectors.count++] = i;
      IntVector.broadcast(INTS, 0).blend(1, more).intoArray(enters, i);
    }
    if (vectors.count == 0) start();
    else gone++;
    return vectors.count > 0;
  }

  private Readings here() {
    return readings.get(gone - 1);
  }

  /** Sampling times of the current readings, in grains from the period's start. */
  int[] madeAt() {
    return here().madeAt;
  }

  /** Arrival times of the current readings, in grains from the period's start. */
  int[] receivedAt() {
    return here().receivedAt;
  }

  /** Mean delay to a vehicle, known at the current readings, s; {@code fromS} is the mean delay back. */
  float[] toS() {
    return here().toS;
  }

  float[] fromS() {
    return here().fromS;
  }
}
