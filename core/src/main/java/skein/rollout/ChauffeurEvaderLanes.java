package skein.rollout;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;
import skein.policy.ChauffeurEvader;
import skein.policy.Policy;

/**
 * {@link ChauffeurEvader} by lanes. Directions stand for angles: the tangent through the evader's
 * place is the sum of two angles, so the product of two directions.
 */
final class ChauffeurEvaderLanes extends LanePolicy {
  private static final FloatVector MINUS_ONE = constant(-1f);

  /** The least cosine of an angle that counts as at most a right one: floats are that exact. */
  private static final FloatVector RIGHT_ANGLE = constant(-1e-5f);

  private final float[] radius = new float[WORLDS],
      dodgeSquare = new float[WORLDS],
      // Cosine of the least angle aside, and of half of it.
      leastCos = new float[WORLDS],
      halfCos = new float[WORLDS];

  // Between passes: the place in the pursuer's frame, the direction there, the own one.
  private final float[] ahead = new float[WORLDS],
      signed = new float[WORLDS],
      front = new float[WORLDS],
      aside = new float[WORLDS],
      ownFront = new float[WORLDS],
      ownAside = new float[WORLDS];

  @Override
  void take(int world, Policy policy) {
    ChauffeurEvader evader = (ChauffeurEvader) policy;
    radius[world] = (float) evader.turningRadiusM();
    dodgeSquare[world] = (float) (evader.dodgeM() * evader.dodgeM());
    leastCos[world] = (float) evader.speedRatio();
    halfCos[world] = (float) StrictMath.cos(StrictMath.acos(evader.speedRatio()) / 2);
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
    relate(sight, own, ownAt, known, knownAt);
    run();
    dodge();
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector c = FloatVector.fromArray(SPECIES, known.cos, knownAt + i),
          s = FloatVector.fromArray(SPECIES, known.sin, knownAt + i);
      FloatVector x = FloatVector.fromArray(SPECIES, front, i),
          y = FloatVector.fromArray(SPECIES, aside, i);
      x.fma(c, y.mul(s).neg()).intoArray(into.cos, intoAt + i);
      x.fma(s, y.mul(c)).intoArray(into.sin, intoAt + i);
    }
    measureTurns(own, ownAt, into, intoAt);
  }

  private void relate(LaneSight sight, Directions own, int ownAt, Directions known, int knownAt) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dx = FloatVector.fromArray(SPECIES, sight.dx, i),
          dy = FloatVector.fromArray(SPECIES, sight.dy, i);
      FloatVector c = FloatVector.fromArray(SPECIES, known.cos, knownAt + i),
          s = FloatVector.fromArray(SPECIES, known.sin, knownAt + i);
      dx.fma(c, dy.mul(s)).neg().intoArray(ahead, i);
      dx.fma(s, dy.mul(c).neg()).intoArray(signed, i);
      FloatVector ownCos = FloatVector.fromArray(SPECIES, own.cos, ownAt + i),
          ownSin = FloatVector.fromArray(SPECIES, own.sin, ownAt + i);
      ownCos.fma(c, ownSin.mul(s)).intoArray(ownFront, i);
      ownSin.fma(c, ownCos.mul(s).neg()).intoArray(ownAside, i);
    }
  }

  /** Along the tangent of the turning circle on its side, or inside of that to its centre. */
  private void run() {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, signed, i),
          r = FloatVector.fromArray(SPECIES, radius, i);
      FloatVector side = ONE.blend(MINUS_ONE, y.compare(LT, ZERO));
      FloatVector toCentre = r.sub(side.mul(y));
      FloatVector lengthSquare = x.fma(x, toCentre.mul(toCentre));
      FloatVector square = r.fma(r.neg(), lengthSquare);
      VectorMask<Float> inside = square.compare(LT, ZERO);
      FloatVector tangent = square.max(ZERO).sqrt();
      // (x, −toCentre) turned by the angle of (tangent, r); both together as long as lengthSquare.
      FloatVector alongX = x.fma(tangent, toCentre.mul(r)),
          alongY = x.fma(r, toCentre.mul(tangent).neg());
      FloatVector scale = ONE.div(lengthSquare.blend(ONE, lengthSquare.compare(EQ, ZERO)));
      FloatVector length = lengthSquare.sqrt();
      FloatVector inverse = ONE.div(length.blend(ONE, length.compare(EQ, ZERO)));
      alongX.mul(scale).blend(x.neg().mul(inverse), inside).intoArray(front, i);
      alongY
          .mul(scale)
          .blend(toCentre.mul(inverse), inside)
          .mul(side)
          .intoArray(aside, i);
    }
  }

  /** Ahead and near, at a right angle to the pursuer's heading, and on until it has turned after. */
  private void dodge() {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, signed, i),
          ownX = FloatVector.fromArray(SPECIES, ownFront, i),
          ownY = FloatVector.fromArray(SPECIES, ownAside, i);
      VectorMask<Float> dodges =
          x.compare(GT, ZERO)
              .and(
                  x.fma(x, y.mul(y))
                      .compare(LT, FloatVector.fromArray(SPECIES, dodgeSquare, i)));
      VectorMask<Float> goesOn =
          ownX.compare(LE, FloatVector.fromArray(SPECIES, leastCos, i))
              .and(ownX.compare(GE, RIGHT_ANGLE));
      VectorMask<Float> keepsSide = ownX.compare(LT, FloatVector.fromArray(SPECIES, halfCos, i));
      FloatVector side = ONE.blend(MINUS_ONE, y.blend(ownY, keepsSide).compare(LT, ZERO));
      FloatVector newX = ZERO.blend(ownX, goesOn), newY = side.blend(ownY, goesOn);
      FloatVector.fromArray(SPECIES, front, i).blend(newX, dodges).intoArray(front, i);
      FloatVector.fromArray(SPECIES, aside, i).blend(newY, dodges).intoArray(aside, i);
    }
  }
}
