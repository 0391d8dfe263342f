package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
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
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.Duelist;
import skein.forward.Reduced;

/**
 * With a first-order lag, or none: of a piece, by how much the velocity exceeds at first that which
 * is reached. It is {@link skein.vehicle.FirstOrderLag} in floats, with an exponential for each world.
 */
final class LagFlights extends LaneFlights {
  private static final int EXCESS_X = PIECE_OWN, EXCESS_Y = PIECE_OWN + WORLDS;
  private static final int NUMBERS = 2;

  private final float speedMps, lagS;

  LagFlights(Duelist duelist, Reduced model, LoopLanes loop) {
    super(duelist, NUMBERS, MOST_PIECE_S, loop);
    speedMps = (float) (duelist.speed() * model.gain());
    lagS = (float) Math.max(model.lagS(), LEAST_LAG_S);
  }

  @Override
  void rest(float[] pieces) {}

  @Override
  void fly(LaneVectors vectors, float[] into, int at, boolean withVelocity) {
    float[] chosen = this.chosen, sinceS = this.sinceS;
    FloatVector halvings = FloatVector.broadcast(SPECIES, -LOG2_E / lagS),
        lag = FloatVector.broadcast(SPECIES, lagS),
        speed = FloatVector.broadcast(SPECIES, speedMps),
        least = FloatVector.broadcast(SPECIES, LEAST_POWER),
        one = FloatVector.broadcast(SPECIES, 1f),
        round = FloatVector.broadcast(SPECIES, ROUND),
        power1 = FloatVector.broadcast(SPECIES, POWER_1),
        power2 = FloatVector.broadcast(SPECIES, POWER_2),
        power3 = FloatVector.broadcast(SPECIES, POWER_3),
        power4 = FloatVector.broadcast(SPECIES, POWER_4),
        power5 = FloatVector.broadcast(SPECIES, POWER_5);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector dt = FloatVector.fromArray(SPECIES, sinceS, i);
      FloatVector exponent = dt.mul(halvings).max(least);
      FloatVector rounded = exponent.add(round);
      FloatVector rest = exponent.sub(rounded.sub(round)), square = rest.mul(rest);
      FloatVector left =
          rest.fma(power5, power4)
              .fma(square, rest.fma(power3, power2))
              .fma(square, rest.fma(power1, one))
              .reinterpretAsInts()
              .add(rounded.reinterpretAsInts().lanewise(VectorOperators.LSHL, 23))
              .reinterpretAsFloats();
      FloatVector carried = one.sub(left).mul(lag);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, chosen, ALONG_X + i).mul(speed),
          wantedY = FloatVector.fromArray(SPECIES, chosen, ALONG_Y + i).mul(speed),
          excessX = FloatVector.fromArray(SPECIES, chosen, EXCESS_X + i),
          excessY = FloatVector.fromArray(SPECIES, chosen, EXCESS_Y + i);
      excessX
          .fma(carried, wantedX.fma(dt, FloatVector.fromArray(SPECIES, chosen, PIECE_X + i)))
          .intoArray(into, at + i);
      excessY
          .fma(carried, wantedY.fma(dt, FloatVector.fromArray(SPECIES, chosen, PIECE_Y + i)))
          .intoArray(into, at + WORLDS + i);
      if (withVelocity) {
        excessX.fma(left, wantedX).intoArray(into, at + 2 * WORLDS + i);
        excessY.fma(left, wantedY).intoArray(into, at + 3 * WORLDS + i);
      }
    }
  }

  @Override
  void begin(LaneVectors vectors, int at, int[] acts, Directions commanded) {
    float[] pieces = this.pieces, chosen = this.chosen, flown = this.flown;
    FloatVector speed = FloatVector.broadcast(SPECIES, speedMps);
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k], to = at + i;
      VectorMask<Float> does = IntVector.fromArray(INTS, acts, i).compare(LT, none).cast(SPECIES);
      FloatVector alongX = FloatVector.fromArray(SPECIES, commanded.cos, i),
          alongY = FloatVector.fromArray(SPECIES, commanded.sin, i);
      FloatVector
          excessX = FloatVector.fromArray(SPECIES, flown, 2 * WORLDS + i).sub(alongX.mul(speed)),
          excessY = FloatVector.fromArray(SPECIES, flown, 3 * WORLDS + i).sub(alongY.mul(speed));
      FloatVector.fromArray(SPECIES, chosen, PIECE_X + i)
          .blend(FloatVector.fromArray(SPECIES, flown, i), does)
          .intoArray(pieces, to + PIECE_X);
      FloatVector.fromArray(SPECIES, chosen, PIECE_Y + i)
          .blend(FloatVector.fromArray(SPECIES, flown, WORLDS + i), does)
          .intoArray(pieces, to + PIECE_Y);
      FloatVector.fromArray(SPECIES, chosen, ALONG_X + i).blend(alongX, does).intoArray(pieces, to + ALONG_X);
      FloatVector.fromArray(SPECIES, chosen, ALONG_Y + i).blend(alongY, does).intoArray(pieces, to + ALONG_Y);
      FloatVector.fromArray(SPECIES, chosen, EXCESS_X + i)
          .blend(excessX, does)
          .intoArray(pieces, to + EXCESS_X);
      FloatVector.fromArray(SPECIES, chosen, EXCESS_Y + i)
          .blend(excessY, does)
          .intoArray(pieces, to + EXCESS_Y);
    }
  }
}
