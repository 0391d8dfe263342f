package skein.rollout;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import skein.policy.PaperPursuer;
import skein.policy.Policy;

/** {@link PaperPursuer} by lanes. */
final class PaperPursuerLanes extends LanePolicy {
  private static final FloatVector MINUS_ONE = constant(-1f);

  private final float[] turnRate = new float[WORLDS], turnStep = new float[WORLDS];

  @Override
  void take(int world, Policy policy) {
    PaperPursuer pursuer = (PaperPursuer) policy;
    boolean steps = pursuer.stepRad().isDefined();
    turnRate[world] = steps ? 0 : (float) pursuer.turnRateRadPerS();
    turnStep[world] = steps ? ((Double) pursuer.stepRad().get()).floatValue() : 0;
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
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f),
        one = FloatVector.broadcast(SPECIES, 1f),
        minusOne = FloatVector.broadcast(SPECIES, -1f),
        perTurn = FloatVector.broadcast(SPECIES, (float) (0.5 / Math.PI)),
        round = FloatVector.broadcast(SPECIES, 12582912f),
        minusTurn = FloatVector.broadcast(SPECIES, (float) (-2 * Math.PI));
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dx = FloatVector.fromArray(SPECIES, sight.dx, i),
          dy = FloatVector.fromArray(SPECIES, sight.dy, i);
      FloatVector c = FloatVector.fromArray(SPECIES, own.cos, ownAt + i),
          s = FloatVector.fromArray(SPECIES, own.sin, ownAt + i);
      FloatVector x = dx.fma(c, dy.mul(s)), y = dy.fma(c, dx.mul(s).neg());
      FloatVector side = zero.blend(one, x.compare(LT, zero));
      side = side.blend(one, y.compare(GT, zero)).blend(minusOne, y.compare(LT, zero));
      FloatVector change =
          FloatVector.fromArray(SPECIES, turnRate, i)
              .fma(
                  FloatVector.fromArray(SPECIES, sight.elapsed, i),
                  FloatVector.fromArray(SPECIES, turnStep, i))
              .mul(side);
      change.add(FloatVector.fromArray(SPECIES, heading, i)).intoArray(newHeading, i);
      change
          .fma(perTurn, round)
          .sub(round)
          .fma(minusTurn, change)
          .abs()
          .intoArray(turned, i);
    }
    point(into, intoAt);
  }
}
