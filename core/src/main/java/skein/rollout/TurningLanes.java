package skein.rollout;

import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;

import jdk.incubator.vector.FloatVector;

/** Policies that turn from their heading, within a limit on the turn rate. */
abstract class TurningLanes extends LanePolicy {
  /** The most that each turns, rad/s. */
  final float[] turnRate = new float[WORLDS];

  // Between passes: the line of sight in the own frame, and angles.
  final float[] ahead = new float[WORLDS], right = new float[WORLDS], turn = new float[WORLDS];

  /** The opponent's place in the own frame. */
  final void relate(LaneSight sight, Directions own, int ownAt) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector dx = FloatVector.fromArray(SPECIES, sight.dx, i),
          dy = FloatVector.fromArray(SPECIES, sight.dy, i);
      FloatVector c = FloatVector.fromArray(SPECIES, own.cos, ownAt + i),
          s = FloatVector.fromArray(SPECIES, own.sin, ownAt + i);
      dx.fma(c, dy.mul(s)).intoArray(ahead, i);
      dy.fma(c, dx.mul(s).neg()).intoArray(right, i);
    }
  }

  /** Turns by {@link #turn}, but no more than the turn rate allows. */
  final void turnWithin(LaneSight sight, Directions into, int intoAt) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector most =
          FloatVector.fromArray(SPECIES, turnRate, i)
              .mul(FloatVector.fromArray(SPECIES, sight.elapsed, i));
      FloatVector change = FloatVector.fromArray(SPECIES, turn, i).min(most).max(ZERO.sub(most));
      change.add(FloatVector.fromArray(SPECIES, heading, i)).intoArray(newHeading, i);
      change
          .fma(PER_TURN, ROUND)
          .sub(ROUND)
          .fma(MINUS_TURN, change)
          .abs()
          .intoArray(turned, i);
    }
    point(into, intoAt);
  }
}
