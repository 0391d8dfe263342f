package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.LEAST_POWER;
import static skein.simd.LaneMath.LOG2_E;
import static skein.simd.LaneMath.POWER_1;
import static skein.simd.LaneMath.POWER_2;
import static skein.simd.LaneMath.POWER_3;
import static skein.simd.LaneMath.POWER_4;
import static skein.simd.LaneMath.POWER_5;
import static skein.simd.LaneMath.ROUND;
import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.lanes.policy.LanePolicy;

/** Predicts with a first-order lag. The model is linear: each change of the commanded velocity moves the
 * vehicle by itself times t − lag · (1 − e^(−t / lag)), where t is the time left. {@link
 * PredictedLagVehicles} is the variant for worlds with equal times.
 */
final class ForecastLagVehicles implements ForecastVehicles {
  private static final int WORLDS = LanePolicy.WORLDS;

  /** Smallest lag that is computed, s; a shorter one is rounded up, which moves no vehicle noticeably. */
  private static final double LEAST_LAG_S = 1e-9;

  private final float speedMps, lagS;

  /** @param speedMps speed of a vehicle whose command does not change, m/s */
  ForecastLagVehicles(double speedMps, double lagS) {
    this.speedMps = (float) speedMps;
    this.lagS = (float) Math.max(lagS, LEAST_LAG_S);
  }

  @Override
  public void predict(
      LaneVectors vectors, ForecastTrack way, float[] read, float[] into) {
    float[] endS = way.endS, turnS = way.turnS, turnX = way.turn.cos, turnY = way.turn.sin;
    FloatVector halvings = FloatVector.broadcast(SPECIES, -LOG2_E / lagS),
        lag = FloatVector.broadcast(SPECIES, lagS),
        speed = FloatVector.broadcast(SPECIES, speedMps),
        least = FloatVector.broadcast(SPECIES, LEAST_POWER),
        zero = FloatVector.broadcast(SPECIES, 0f),
        one = FloatVector.broadcast(SPECIES, 1f),
        round = FloatVector.broadcast(SPECIES, ROUND),
        power1 = FloatVector.broadcast(SPECIES, POWER_1),
        power2 = FloatVector.broadcast(SPECIES, POWER_2),
        power3 = FloatVector.broadcast(SPECIES, POWER_3),
        power4 = FloatVector.broadcast(SPECIES, POWER_4),
        power5 = FloatVector.broadcast(SPECIES, POWER_5);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector end = FloatVector.fromArray(SPECIES, endS, i);
      // The powers are written out: with LaneMath.powerOf2 the loop has 0.83 times the speed.
      FloatVector exponent = end.mul(halvings).max(least);
      FloatVector rounded = exponent.add(round);
      FloatVector rest = exponent.sub(rounded.sub(round)), square = rest.mul(rest);
      FloatVector left =
          rest.fma(power5, power4)
              .fma(square, rest.fma(power3, power2))
              .fma(square, rest.fma(power1, one))
              .reinterpretAsInts()
              .add(rounded.reinterpretAsInts().lanewise(VectorOperators.LSHL, 23))
              .reinterpretAsFloats();
      FloatVector gone = one.sub(left), carried = gone.mul(lag);
      FloatVector seenVx = FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_VX + i),
          seenVy = FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_VY + i);
      FloatVector north = seenVx.fma(carried, FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_X + i)),
          east = seenVy.fma(carried, FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_Y + i)),
          vx = seenVx.mul(left),
          vy = seenVy.mul(left);
      FloatVector moved = end.sub(carried).mul(speed), reached = gone.mul(speed);
      // The direction at the reading is that of the last turn before it.
      FloatVector firstX = zero.mul(end), firstY = zero.mul(end), x = zero.mul(end), y = zero.mul(end);
      int turns = way.turnsOf[i / LANES];
      for (int turn = way.heldFrom[i / LANES]; turn < turns; turn++) {
        int place = turn * WORLDS + i;
        FloatVector at = FloatVector.fromArray(SPECIES, turnS, place),
            newX = FloatVector.fromArray(SPECIES, turnX, place),
            newY = FloatVector.fromArray(SPECIES, turnY, place);
        VectorMask<Float> follows = at.compare(GT, zero);
        firstX = newX.blend(firstX, follows);
        firstY = newY.blend(firstY, follows);
        VectorMask<Float> changes =
            newX.compare(NE, x).or(newY.compare(NE, y)).and(follows).and(at.compare(LT, end));
        if (changes.anyTrue()) {
          FloatVector time = end.sub(at).max(zero).min(end);
          exponent = time.mul(halvings).max(least);
          rounded = exponent.add(round);
          rest = exponent.sub(rounded.sub(round));
          square = rest.mul(rest);
          gone =
              one.sub(
                  rest.fma(power5, power4)
                      .fma(square, rest.fma(power3, power2))
                      .fma(square, rest.fma(power1, one))
                      .reinterpretAsInts()
                      .add(rounded.reinterpretAsInts().lanewise(VectorOperators.LSHL, 23))
                      .reinterpretAsFloats());
          FloatVector far = zero.blend(time.sub(gone.mul(lag)).mul(speed), changes),
              fast = zero.blend(gone.mul(speed), changes),
              changeX = newX.sub(x),
              changeY = newY.sub(y);
          north = changeX.fma(far, north);
          east = changeY.fma(far, east);
          vx = changeX.fma(fast, vx);
          vy = changeY.fma(fast, vy);
        }
        x = newX;
        y = newY;
      }
      north = firstX.fma(moved, north);
      east = firstY.fma(moved, east);
      vx = firstX.fma(reached, vx);
      vy = firstY.fma(reached, vy);
      north.intoArray(into, i);
      east.intoArray(into, WORLDS + i);
      vx.intoArray(into, 2 * WORLDS + i);
      vy.intoArray(into, 3 * WORLDS + i);
    }
  }
}
