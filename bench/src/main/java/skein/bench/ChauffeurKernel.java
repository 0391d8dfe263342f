package skein.bench;

import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.I2F;
import static jdk.incubator.vector.VectorOperators.LSHL;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.bench.Atan2.atan2;
import static skein.bench.SinCos.sinCos;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.ONE;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.ZERO;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;

/**
 * The work of {@code yardstick/chauffeur.c}: the duel of the homicidal chauffeur with delayed observations and
 * a first-order velocity lag, 300 ticks of 0.1 s, 2 agents, with its random numbers. Structure of arrays; a
 * tick is a few passes over a block of worlds; nothing is allocated after construction. One instance per
 * thread.
 *
 * <p>Where the C program recomputes sine and cosine of the pursuer's heading for the next observation, this
 * kernel keeps them; and of the ring of 8 past positions it keeps the 4 that a tick can need.
 */
public final class ChauffeurKernel {
  /** Worlds of one block in the C program. */
  public static final int BLOCK = 64;

  public static final int TICKS = 300;

  /**
   * Worlds simulated together: few enough for the first-level cache, enough to make the passes' overhead
   * negligible.
   */
  private static final int WORLDS = 4 * BLOCK;

  private static final int HISTORY = 4;
  private static final float TICK_S = 0.1f;
  private static final float LAG_S = 0.5f;
  private static final float RADIUS_M = 8f;

  private static final FloatVector HALF_PI = constant(1.57079633f);
  private static final FloatVector STEP = constant(TICK_S);
  private static final FloatVector KEEP = constant((float) Math.exp(-TICK_S / LAG_S));
  private static final FloatVector GAIN =
      constant((float) (LAG_S * (1 - Math.exp(-TICK_S / LAG_S))));
  private static final FloatVector RADIUS = constant(RADIUS_M);
  private static final FloatVector RADIUS_SQUARE = constant(RADIUS_M * RADIUS_M);
  private static final FloatVector NEAR_SQUARE = constant(4 * RADIUS_M * RADIUS_M);
  private static final FloatVector TURN = constant(10f / RADIUS_M);
  private static final FloatVector EVADER_SPEED = constant(5f);
  private static final FloatVector PURSUER_SPEED = constant(10f);

  /** Age of an observation in ticks: 0.2 plus 1.8 times a random number of 24 bits. */
  private static final FloatVector LEAST_AGE = constant(0.2f);

  private static final FloatVector AGE_PER_BIT = constant(1.8f / 16777216f);

  private final int[] random = new int[WORLDS];
  private final float[] k = new float[WORLDS];
  private final float[] evx = new float[WORLDS], evy = new float[WORLDS];
  private final float[] pvx = new float[WORLDS], pvy = new float[WORLDS];
  private final float[] evaderHeading = new float[WORLDS], pursuerHeading = new float[WORLDS];
  private final float[] least = new float[WORLDS], sum = new float[WORLDS];

  /** The evader's observed position in the pursuer's frame. */
  private final float[] ahead = new float[WORLDS], right = new float[WORLDS];

  /** The evader's aim to the right, and the heading it is relative to. */
  private final float[] aim = new float[WORLDS], aside = new float[WORLDS];

  private final float[] sin = new float[WORLDS], cos = new float[WORLDS];

  /** Direction of the pursuer's heading; the next tick observes in its frame. */
  private final float[] pursuerSin = new float[WORLDS], pursuerCos = new float[WORLDS];

  // Positions now and in the ticks before; row t mod 4 holds those before tick t.
  private final float[] ex = new float[HISTORY * WORLDS], ey = new float[HISTORY * WORLDS];
  private final float[] px = new float[HISTORY * WORLDS], py = new float[HISTORY * WORLDS];

  /**
   * Simulates {@code blocks} blocks as the C program's thread {@code thread} does; returns the sum of all
   * worlds' witnesses, smallest distance plus mean distance.
   *
   * @param blocks a multiple of 4
   */
  public double run(int thread, int blocks) {
    if (blocks * BLOCK % WORLDS != 0)
      throw new IllegalArgumentException("blocks must be a multiple of 4, got " + blocks);
    double total = 0;
    for (int first = 0; first < blocks * BLOCK; first += WORLDS) {
      start(thread * 7919 + first);
      for (int tick = 0; tick < TICKS; tick++) {
        observe(row(tick), row(tick - 1), row(tick - 2));
        decide();
        sinCos(evaderHeading, sin, cos, WORLDS);
        fly(ex, ey, evx, evy, cos, sin, EVADER_SPEED, row(tick), row(tick + 1));
        sinCos(pursuerHeading, pursuerSin, pursuerCos, WORLDS);
        fly(px, py, pvx, pvy, pursuerCos, pursuerSin, PURSUER_SPEED, row(tick), row(tick + 1));
        score(row(tick + 1));
      }
      for (int i = 0; i < WORLDS; i++) total += least[i] + sum[i] / TICKS;
    }
    return total;
  }

  private static int row(int tick) {
    return (tick & HISTORY - 1) * WORLDS;
  }

  private void start(int firstWorld) {
    for (int i = 0; i < WORLDS; i++) {
      random[i] = (1234567 + (i + firstWorld) * (int) 2654435761L) | 1;
      k[i] = 0.04f + 0.001f * (i % BLOCK);
    }
    for (float[] zero :
        new float[][] {evx, evy, pvx, pvy, pursuerHeading, pursuerSin, sum, ey, px, py})
      Arrays.fill(zero, 0f);
    Arrays.fill(pursuerCos, 1f);
    Arrays.fill(ex, 21f);
    Arrays.fill(least, 1e9f);
  }

  private void observe(int row0, int row1, int row2) {
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector bits = IntVector.fromArray(INTS, random, i);
      bits = bits.lanewise(XOR, bits.lanewise(LSHL, 13));
      bits = bits.lanewise(XOR, bits.lanewise(LSHR, 17));
      bits = bits.lanewise(XOR, bits.lanewise(LSHL, 5));
      bits.intoArray(random, i);
      FloatVector age =
          ((FloatVector) bits.lanewise(LSHR, 8).convert(I2F, 0)).fma(AGE_PER_BIT, LEAST_AGE);
      VectorMask<Float> old = age.compare(GE, ONE);
      FloatVector share = age.blend(age.sub(ONE), old);
      FloatVector x =
          seen(ex, i, row0, row1, row2, old, share).sub(seen(px, i, row0, row1, row2, old, share));
      FloatVector y =
          seen(ey, i, row0, row1, row2, old, share).sub(seen(py, i, row0, row1, row2, old, share));
      FloatVector c = FloatVector.fromArray(SPECIES, pursuerCos, i),
          s = FloatVector.fromArray(SPECIES, pursuerSin, i);
      x.fma(c, y.mul(s)).intoArray(ahead, i);
      y.fma(c, x.mul(s).neg()).intoArray(right, i);
    }
  }

  /** Position at the observation's time, interpolated between two ticks. */
  private static FloatVector seen(
      float[] positions,
      int i,
      int row0,
      int row1,
      int row2,
      VectorMask<Float> old,
      FloatVector share) {
    FloatVector before = FloatVector.fromArray(SPECIES, positions, row1 + i);
    FloatVector from = FloatVector.fromArray(SPECIES, positions, row0 + i).blend(before, old);
    FloatVector to = before.blend(FloatVector.fromArray(SPECIES, positions, row2 + i), old);
    return to.sub(from).fma(share, from);
  }

  private void decide() {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, right, i);
      FloatVector xSquare = x.mul(x);
      FloatVector toLeft = y.sub(RADIUS), toRight = y.add(RADIUS);
      VectorMask<Float> inLeft = toLeft.fma(toLeft, xSquare).compare(LT, RADIUS_SQUARE);
      VectorMask<Float> inRight = toRight.fma(toRight, xSquare).compare(LT, RADIUS_SQUARE);
      VectorMask<Float> breakAway =
          y.fma(y, xSquare).compare(LT, NEAR_SQUARE).andNot(inLeft.or(inRight));
      y.blend(toLeft, inRight).blend(toRight, inLeft).intoArray(aim, i);
      FloatVector pursuer = FloatVector.fromArray(SPECIES, pursuerHeading, i);
      pursuer.blend(pursuer.add(HALF_PI), breakAway).intoArray(aside, i);

      FloatVector turn = FloatVector.fromArray(SPECIES, k, i).mul(TURN);
      FloatVector turned = pursuer.blend(pursuer.add(turn), y.compare(GT, ZERO));
      turned.blend(pursuer.sub(turn), y.compare(LT, ZERO)).intoArray(pursuerHeading, i);
    }
    atan2(aim, ahead, evaderHeading, WORLDS);
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, evaderHeading, i)
          .add(FloatVector.fromArray(SPECIES, aside, i))
          .intoArray(evaderHeading, i);
  }

  /** Moves one agent for a tick; its velocity approaches the commanded one, integrated exactly. */
  private static void fly(
      float[] xs,
      float[] ys,
      float[] vxs,
      float[] vys,
      float[] cos,
      float[] sin,
      FloatVector speed,
      int row,
      int next) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector wantedX = FloatVector.fromArray(SPECIES, cos, i).mul(speed),
          wantedY = FloatVector.fromArray(SPECIES, sin, i).mul(speed);
      FloatVector offX = FloatVector.fromArray(SPECIES, vxs, i).sub(wantedX),
          offY = FloatVector.fromArray(SPECIES, vys, i).sub(wantedY);
      offX.fma(KEEP, wantedX).intoArray(vxs, i);
      offY.fma(KEEP, wantedY).intoArray(vys, i);
      offX.fma(GAIN, wantedX.fma(STEP, FloatVector.fromArray(SPECIES, xs, row + i)))
          .intoArray(xs, next + i);
      offY.fma(GAIN, wantedY.fma(STEP, FloatVector.fromArray(SPECIES, ys, row + i)))
          .intoArray(ys, next + i);
    }
  }

  private void score(int row) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector
          gapX =
              FloatVector.fromArray(SPECIES, ex, row + i)
                  .sub(FloatVector.fromArray(SPECIES, px, row + i)),
          gapY =
              FloatVector.fromArray(SPECIES, ey, row + i)
                  .sub(FloatVector.fromArray(SPECIES, py, row + i));
      FloatVector distance = gapX.fma(gapX, gapY.mul(gapY)).sqrt();
      FloatVector leastSoFar = FloatVector.fromArray(SPECIES, least, i);
      leastSoFar.blend(distance, distance.compare(LT, leastSoFar)).intoArray(least, i);
      FloatVector.fromArray(SPECIES, sum, i).add(distance).intoArray(sum, i);
    }
  }
}
