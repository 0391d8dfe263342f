package skein.lanes;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duelist;

/** One side of a duel in many worlds: decides by the difference of the two vehicles' readings. */
final class DuelAgents extends TimetableAgents {
  private final LanePolicy policy;
  private final float[] effort;
  private final float startHeading;
  private final int self;
  private final LaneObservation sight;

  /** Whether somebody outside looks at what it sees. */
  private final boolean isTold;

  /**
   * @param self the vehicle's number, 0 or 1
   * @param effort where the changes of the heading are added up
   * @param isTold whether somebody outside looks at all that it sees
   */
  DuelAgents(
      int self,
      Duelist duelist,
      TimetableModel model,
      LanePolicy policy,
      float[] effort,
      LaneObservation sight,
      boolean isTold) {
    super(model.vehicles(duelist));
    this.isTold = isTold;
    this.self = self;
    this.policy = policy;
    this.effort = effort;
    this.sight = sight;
    startHeading = (float) duelist.startHeadingRad();
  }

  @Override
  void start(Timetable timetable, int worlds) {
    super.start(timetable, worlds);
    // The timetable keeps the first heading at place 0.
    headings.fill(0, WORLDS, startHeading);
    policy.start(startHeading);
    Arrays.fill(effort, 0f);
  }

  /** One world begins anew where its vehicle starts, commanded along a heading all the while. */
  void restart(int world, float headingRad) {
    vehicles.restart(world);
    policy.restart(world, headingRad);
    float cos = (float) StrictMath.cos(headingRad), sin = (float) StrictMath.sin(headingRad);
    for (int i = world; i < headings.cos.length; i += WORLDS) {
      headings.cos[i] = cos;
      headings.sin[i] = sin;
    }
  }

  @Override
  boolean needsVelocity() {
    return isTold || policy.needsVelocity();
  }

  private boolean needsAges() {
    return isTold || policy.needsAges();
  }

  @Override
  void decide(
      TimetableAgents[] all,
      int[] views,
      int view,
      int known,
      int before,
      int after,
      float[] times,
      int number) {
    see(all, views, view, times, number);
    TimetableAgents opponent = all[1 - self];
    policy.decide(sight, headings, before, opponent.headings, known, headings, after);
    policy.commit();
    add(policy.turned, effort);
  }

  /** Looks at what a decision is made upon. */
  void see(TimetableAgents[] all, int[] views, int view, float[] times, int number) {
    TimetableVehicles ours = vehicles, theirs = all[1 - self].vehicles;
    int ownSeen = views[view + self] * WORLDS,
        opponentSeen = views[view + 1 - self] * WORLDS;
    difference(theirs.seenX, opponentSeen, ours.seenX, ownSeen, sight.dx);
    difference(theirs.seenY, opponentSeen, ours.seenY, ownSeen, sight.dy);
    if (needsVelocity()) {
      difference(theirs.seenVx, opponentSeen, ours.seenVx, ownSeen, sight.dvx);
      difference(theirs.seenVy, opponentSeen, ours.seenVy, ownSeen, sight.dvy);
    }
    Arrays.fill(sight.elapsed, times[number]);
    if (needsAges()) {
      Arrays.fill(sight.ownAge, times[number + 1]);
      Arrays.fill(sight.opponentAge, times[number + 2]);
    }
  }

  private static void difference(float[] of, int ofAt, float[] and, int andAt, float[] into) {
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, of, ofAt + i)
          .sub(FloatVector.fromArray(SPECIES, and, andAt + i))
          .intoArray(into, i);
  }

  private static void add(float[] what, float[] to) {
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, to, i)
          .add(FloatVector.fromArray(SPECIES, what, i))
          .intoArray(to, i);
  }
}
