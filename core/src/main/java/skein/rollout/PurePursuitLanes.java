package skein.rollout;

import skein.policy.Policy;
import skein.policy.PurePursuit;

/** {@link PurePursuit} by lanes. */
final class PurePursuitLanes extends TurningLanes {
  @Override
  void take(int world, Policy policy) {
    turnRate[world] = (float) ((PurePursuit) policy).turnRateRadPerS();
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
    turnWithin(sight, into, intoAt);
  }
}
