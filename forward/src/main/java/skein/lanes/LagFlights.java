package skein.lanes;

import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
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

/** With a first-order lag, or none: of a piece the velocity that is reached, and what it lacks of that at first. */
final class LagFlights extends LaneFlights {
  private static final int WANTED_X = PIECE_OWN, WANTED_Y = PIECE_OWN + 1, EXCESS_X = PIECE_OWN + 2, EXCESS_Y = PIECE_OWN + 3;
  private static final int FIELDS = PIECE_OWN + 4;

  /** Of powers of two that floats hold. */
  private static final float LEAST_EXPONENT = -120f;

  /** In the place of none: no vehicle gets anywhere within. */
  private static final double LEAST_LAG_S = 1e-6;

  private final float speedMps, lagS;

  LagFlights(Duelist duelist, Reduced model, FlightTiming timing) {
    super(duelist, FIELDS, timing);
    speedMps = (float) (duelist.speed() * model.gain());
    lagS = (float) Math.max(model.lagS(), LEAST_LAG_S);
  }

  @Override
  void rest(float[] pieces) {}

  @Override
  void fly(LaneVectors vectors, boolean withVelocity) {
    float[] chosen = this.chosen;
    FloatVector halvings = FloatVector.broadcast(SPECIES, -LOG2_E / lagS),
        lag = FloatVector.broadcast(SPECIES, lagS),
        least = FloatVector.broadcast(SPECIES, LEAST_EXPONENT),
        one = FloatVector.broadcast(SPECIES, 1f),
        round = FloatVector.broadcast(SPECIES, ROUND),
        power1 = FloatVector.broadcast(SPECIES, POWER_1),
        power2 = FloatVector.broadcast(SPECIES, POWER_2),
        power3 = FloatVector.broadcast(SPECIES, POWER_3),
        power4 = FloatVector.broadcast(SPECIES, POWER_4),
        power5 = FloatVector.broadcast(SPECIES, POWER_5);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector dt =
          FloatVector.fromArray(SPECIES, until, i)
              .sub(FloatVector.fromArray(SPECIES, chosen, PIECE_TIME * WORLDS + i));
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
      FloatVector wantedX = FloatVector.fromArray(SPECIES, chosen, WANTED_X * WORLDS + i),
          wantedY = FloatVector.fromArray(SPECIES, chosen, WANTED_Y * WORLDS + i),
          excessX = FloatVector.fromArray(SPECIES, chosen, EXCESS_X * WORLDS + i),
          excessY = FloatVector.fromArray(SPECIES, chosen, EXCESS_Y * WORLDS + i);
      excessX
          .fma(carried, wantedX.fma(dt, FloatVector.fromArray(SPECIES, chosen, PIECE_X * WORLDS + i)))
          .intoArray(x, i);
      excessY
          .fma(carried, wantedY.fma(dt, FloatVector.fromArray(SPECIES, chosen, PIECE_Y * WORLDS + i)))
          .intoArray(y, i);
      if (withVelocity) {
        excessX.fma(left, wantedX).intoArray(vx, i);
        excessY.fma(left, wantedY).intoArray(vy, i);
      }
    }
  }

  @Override
  void begin(LaneVectors vectors, int at, int[] acts, Directions commanded) {
    float[] pieces = this.pieces;
    FloatVector speed = FloatVector.broadcast(SPECIES, speedMps);
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> does =
          IntVector.fromArray(INTS, acts, i).compare(VectorOperators.LT, none).cast(SPECIES);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, commanded.cos, i).mul(speed),
          wantedY = FloatVector.fromArray(SPECIES, commanded.sin, i).mul(speed);
      FloatVector excessX = FloatVector.fromArray(SPECIES, vx, i).sub(wantedX),
          excessY = FloatVector.fromArray(SPECIES, vy, i).sub(wantedY);
      int from = at + i;
      FloatVector.fromArray(SPECIES, until, i).intoArray(pieces, from + PIECE_TIME * WORLDS, does);
      FloatVector.fromArray(SPECIES, x, i).intoArray(pieces, from + PIECE_X * WORLDS, does);
      FloatVector.fromArray(SPECIES, y, i).intoArray(pieces, from + PIECE_Y * WORLDS, does);
      wantedX.intoArray(pieces, from + WANTED_X * WORLDS, does);
      wantedY.intoArray(pieces, from + WANTED_Y * WORLDS, does);
      excessX.intoArray(pieces, from + EXCESS_X * WORLDS, does);
      excessY.intoArray(pieces, from + EXCESS_Y * WORLDS, does);
    }
  }
}
