package skein.rollout;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;
import skein.policy.PaperEvader;
import skein.policy.Policy;

/**
 * {@link PaperEvader} by lanes: no angle is needed, for the heading of atan2(y, x) in a frame is the
 * direction of (x, y) there.
 */
final class PaperEvaderLanes extends LanePolicy {
  private static final FloatVector QUARTER = constant(0.25f);

  private final float[] radius = new float[WORLDS];

  @Override
  void take(int world, Policy policy) {
    radius[world] = (float) ((PaperEvader) policy).turningRadiusM();
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
    FloatVector quarter = FloatVector.broadcast(SPECIES, 0.25f),
        one = FloatVector.broadcast(SPECIES, 1f),
        zero = FloatVector.broadcast(SPECIES, 0f);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dx = FloatVector.fromArray(SPECIES, sight.dx, i),
          dy = FloatVector.fromArray(SPECIES, sight.dy, i);
      FloatVector c = FloatVector.fromArray(SPECIES, known.cos, knownAt + i),
          s = FloatVector.fromArray(SPECIES, known.sin, knownAt + i);
      FloatVector x = dx.fma(c, dy.mul(s)).neg(), y = dx.fma(s, dy.mul(c).neg());
      FloatVector r = FloatVector.fromArray(SPECIES, radius, i);
      FloatVector xSquare = x.mul(x), rSquare = r.mul(r);
      FloatVector toLeft = y.sub(r), toRight = y.add(r);
      VectorMask<Float> inRight = toLeft.fma(toLeft, xSquare).compare(LT, rSquare);
      VectorMask<Float> inLeft = toRight.fma(toRight, xSquare).compare(LT, rSquare);
      VectorMask<Float> breakAway =
          y.fma(y, xSquare).mul(quarter).compare(LT, rSquare).andNot(inLeft.or(inRight));
      FloatVector aim = y.blend(toLeft, inLeft).blend(toRight, inRight);
      FloatVector length = aim.fma(aim, xSquare).sqrt();
      // At the very place of the pursuer the angle counts as 0.
      VectorMask<Float> none = length.compare(EQ, zero);
      FloatVector scale = one.div(length.blend(one, none));
      FloatVector front = x.blend(one, none).mul(scale), side = aim.mul(scale);
      FloatVector forward = front.blend(side.neg(), breakAway),
          aside = side.blend(front, breakAway);
      forward.fma(c, aside.mul(s).neg()).intoArray(into.cos, intoAt + i);
      forward.fma(s, aside.mul(c)).intoArray(into.sin, intoAt + i);
    }
    measureTurns(own, ownAt, into, intoAt);
  }
}
