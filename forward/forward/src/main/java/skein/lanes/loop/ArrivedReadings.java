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

/** Readings of one vehicle that arrived in a period, in many worlds, each with the mean delays known then. A
 * world may have several; one that is not newer than all before is ignored. {@link #next} iterates: over each
 * world's first, then each world's second, and so on.
 */
final class ArrivedReadings {
  private static final int WORLDS = LanePolicy.WORLDS;

  private static final class Readings {
    final int[] madeAt = new int[WORLDS], receivedAt = new int[WORLDS];
    final float[] toS = new float[WORLDS], fromS = new float[WORLDS];
  }

  /** By rank: the first reading of all worlds, the second, and so on. */
  private final ArrayList<Readings> readings = new ArrayList<>();

  /** Number of readings of each world in this period. */
  private final int[] counts = new int[WORLDS];

  /** Number of ranks that {@link #next} has visited. */
  private int gone;

  /** When the newest reading was sampled, from the period's start, in grains. */
  final int[] newestAt = new int[WORLDS];

  /** 1 where a world has a reading of the current rank; and the vectors with one. */
  final int[] enters = new int[WORLDS];

  final LaneVectors vectors = new LaneVectors();

  void start() {
    Arrays.fill(counts, 0);
    gone = 0;
  }

  /** Adds readings that are newer than the newest, and updates the mean delays by them.
   *
   * @param whose the vehicle of each reading
   * @param vehicle this one
   * @param asked when it was requested, sampled and received, from the period's start, in grains
   * @param delays the means over all vehicles' readings
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

  /** Moves to the next reading of each world that has one more; {@link #enters}, {@link #vectors}, {@link
   * #madeAt} and the others then refer to it.
   *
   * @return false if no world has one more; all readings are then discarded
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

  /** When the current readings were sampled, from the period's start, in grains. */
  int[] madeAt() {
    return here().madeAt;
  }

  /** When the current readings were received, likewise. */
  int[] receivedAt() {
    return here().receivedAt;
  }

  /** The mean delays at the current readings, to a vehicle and from it, s. */
  float[] toS() {
    return here().toS;
  }

  float[] fromS() {
    return here().fromS;
  }
}
