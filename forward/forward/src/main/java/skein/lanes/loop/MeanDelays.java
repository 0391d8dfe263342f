package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.I2F;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.lanes.policy.LanePolicy;
import skein.signal.OneWayDelays;

/** The mean delays of each world's readings. The scalar reference is {@link OneWayDelays}. Mutable. */
final class MeanDelays {
  private static final int WORLDS = LanePolicy.WORLDS;

  final float[] toS = new float[WORLDS], fromS = new float[WORLDS];
  private final float[] readings = new float[WORLDS];

  void start() {
    for (float[] each : new float[][] {toS, fromS, readings}) Arrays.fill(each, 0);
  }

  /** Adds readings in worlds where {@code enters} is 1.
   *
   * @param asked time of the request; {@code made} of the sample, {@code received} of the answer: in grains
   */
  void take(LaneVectors vectors, int[] enters, int[] asked, int[] made, int[] received) {
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        memory = FloatVector.broadcast(SPECIES, OneWayDelays.Memory()),
        one = FloatVector.broadcast(SPECIES, 1f);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> does = IntVector.fromArray(INTS, enters, i).compare(GT, 0).cast(SPECIES);
      IntVector at = IntVector.fromArray(INTS, made, i);
      FloatVector count = FloatVector.fromArray(SPECIES, readings, i),
          to = FloatVector.fromArray(SPECIES, toS, i),
          from = FloatVector.fromArray(SPECIES, fromS, i);
      FloatVector counted = count.add(one).min(memory);
      IntVector asking = IntVector.fromArray(INTS, asked, i), came = IntVector.fromArray(INTS, received, i);
      FloatVector there = ((FloatVector) at.sub(asking).convertShape(I2F, SPECIES, 0)).mul(grainS),
          back = ((FloatVector) came.sub(at).convertShape(I2F, SPECIES, 0)).mul(grainS);
      to.blend(to.add(there.sub(to).div(counted)), does).intoArray(toS, i);
      from.blend(from.add(back.sub(from).div(counted)), does).intoArray(fromS, i);
      count.blend(counted, does).intoArray(readings, i);
    }
  }
}
