package skein.lanes;

import skein.simd.LaneFunction;

/** What the policies of many worlds see at a decision: see {@code skein.policy.Policy}. */
final class LaneObservation {
  /** Worlds that decide together: few enough for the first-level cache. A multiple of every lane count. */
  static final int WORLDS = LaneFunction.COUNT;

  /** The opponent's position minus the own one, north and east, m. */
  final float[] dx = new float[WORLDS], dy = new float[WORLDS];

  /** The same of the velocities, m/s; kept only for policies that use them. */
  final float[] dvx = new float[WORLDS], dvy = new float[WORLDS];

  /** Since the own last decision, s. */
  final float[] elapsed = new float[WORLDS];

  /** How old the readings are, s; kept only for policies that ask for it. */
  final float[] ownAge = new float[WORLDS], opponentAge = new float[WORLDS];
}
