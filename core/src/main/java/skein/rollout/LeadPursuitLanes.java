package skein.rollout;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.HALF_PI;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;

import jdk.incubator.vector.FloatVector;
import skein.policy.LeadPursuit;
import skein.policy.Policy;

/** {@link LeadPursuit} by lanes. */
final class LeadPursuitLanes extends TurningLanes {
  private final float[] speedRatio = new float[WORLDS], lead = new float[WORLDS];

  @Override
  void take(int world, Policy policy) {
    LeadPursuit pursuit = (LeadPursuit) policy;
    speedRatio[world] = (float) pursuit.speedRatio();
    lead[world] = (float) pursuit.lead();
    turnRate[world] = (float) pursuit.turnRateRadPerS();
  }

  @Override
  void decide(
      LaneSight sight,
      Directions own,
      int ownAt,
      Directions known,
      int knownAt,
      Directions into,
      int intoAt) {
    relate(sight, own, ownAt);
    LaneMath.atan2(right, ahead, turn, WORLDS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dx = FloatVector.fromArray(SPECIES, sight.dx, i),
          dy = FloatVector.fromArray(SPECIES, sight.dy, i);
      FloatVector c = FloatVector.fromArray(SPECIES, known.cos, knownAt + i),
          s = FloatVector.fromArray(SPECIES, known.sin, knownAt + i);
      // The sine of the angle from the line of sight, north where there is none, to the opponent's
      // heading.
      FloatVector distance = dx.fma(dx, dy.mul(dy)).sqrt();
      FloatVector sine =
          s.mul(dx)
              .sub(c.mul(dy))
              .div(distance.blend(ONE, distance.compare(EQ, ZERO)))
              .blend(s, distance.compare(EQ, ZERO))
              .mul(FloatVector.fromArray(SPECIES, speedRatio, i));
      FloatVector size = sine.abs().min(ONE);
      FloatVector series =
          size.fma(ACOS_7, ACOS_6)
              .fma(size, ACOS_5)
              .fma(size, ACOS_4)
              .fma(size, ACOS_3)
              .fma(size, ACOS_2)
              .fma(size, ACOS_1)
              .fma(size, ACOS_0);
      FloatVector arc = HALF_PI.sub(ONE.sub(size).sqrt().mul(series));
      arc = arc.blend(arc.neg(), sine.compare(LT, ZERO));
      arc.fma(
              FloatVector.fromArray(SPECIES, lead, i),
              FloatVector.fromArray(SPECIES, turn, i))
          .intoArray(turn, i);
    }
    // By the shorter way.
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector change = FloatVector.fromArray(SPECIES, turn, i);
      change.fma(PER_TURN, ROUND).sub(ROUND).fma(MINUS_TURN, change).intoArray(turn, i);
    }
    turnWithin(sight, into, intoAt);
  }
}
