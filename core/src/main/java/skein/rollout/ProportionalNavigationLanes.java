package skein.rollout;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;
import skein.policy.Policy;
import skein.policy.ProportionalNavigation;

/** {@link ProportionalNavigation} by lanes. */
final class ProportionalNavigationLanes extends TurningLanes {
  private final float[] gain = new float[WORLDS];

  @Override
  void take(int world, Policy policy) {
    ProportionalNavigation navigation = (ProportionalNavigation) policy;
    gain[world] = (float) navigation.gain();
    turnRate[world] = (float) navigation.turnRateRadPerS();
  }

  @Override
  boolean needsVelocity() {
    return true;
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
          dy = FloatVector.fromArray(SPECIES, sight.dy, i),
          dvx = FloatVector.fromArray(SPECIES, sight.dvx, i),
          dvy = FloatVector.fromArray(SPECIES, sight.dvy, i);
      VectorMask<Float> closing = dx.fma(dvx, dy.mul(dvy)).compare(LT, ZERO);
      FloatVector sightRate =
          dx.fma(dvy, dy.mul(dvx).neg()).div(dx.fma(dx, dy.mul(dy)));
      FloatVector change =
          sightRate
              .mul(FloatVector.fromArray(SPECIES, gain, i))
              .mul(FloatVector.fromArray(SPECIES, sight.elapsed, i));
      FloatVector.fromArray(SPECIES, turn, i).blend(change, closing).intoArray(turn, i);
    }
    turnWithin(sight, into, intoAt);
  }
}
