package skein.rollout;

/** What the policies of many worlds see at a decision: see {@code skein.policy.Policy}. */
final class LaneSight {
  /** The opponent's position minus the own one, north and east, m. */
  final float[] dx = new float[LanePolicy.WORLDS], dy = new float[LanePolicy.WORLDS];

  /** The same of the velocities, m/s; kept only for policies that use them. */
  final float[] dvx = new float[LanePolicy.WORLDS], dvy = new float[LanePolicy.WORLDS];

  /** Since the own last decision, s. */
  final float[] elapsed = new float[LanePolicy.WORLDS];
}
