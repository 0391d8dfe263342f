package skein.lanes;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Optional;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duel;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.lanes.policy.PolicyLanes;
import skein.lanes.score.Scoreboard;
import skein.lanes.timetable.Timetable;
import skein.lanes.timetable.TimetableAgents;
import skein.lanes.timetable.TimetableKernel;
import skein.lanes.timetable.TimetableScores;
import skein.policy.Policy;

/** Simulates duels in {@link #WORLDS} worlds side by side, by one timetable, and stops whenever an external
 * learner must decide: the duels of {@link TeamBatch}, for learners. The evader is vehicle 0. Allocates
 * nothing after construction, unless a timetable needs more places than any before.
 *
 * <p>An external decision is represented by a policy of a single number, which is set before each decision.
 * So a decision passes through the code of any policy, with identical bits.
 */
public final class LearnerDuels implements TimetableScores {
  public static final int WORLDS = LanePolicy.WORLDS;

  /** Length of an observation, in the order of {@link #observe}. */
  public static final int FIELDS = 9;

  private static final int VEHICLES = 2;
  private static final float TOLERANCE_S = 1e-4f;

  private final LanePolicy[] policies;
  private final OpponentAgents[] agents;
  private final LaneObservation observation = new LaneObservation();
  private final float[] north = new float[WORLDS], east = new float[WORLDS];
  private final boolean[] isOutside;
  private final TimetableKernel kernel;
  private Timetable timetable;

  /** Index of the timetable's next operation, and end of the decisions that are due. */
  private int next, dueUntil;

  private float untilS;

  private static final int NEWEST = 0, SUM = 1, LEAST = 2;
  private final Scoreboard scores = Scoreboard.ofLearners();

  /** @param duel start, speeds and duration
   * @param evader a policy of a single number if it decides externally
   * @param isOutside whether the evader, and whether the pursuer, decides externally
   */
  public LearnerDuels(
      Duel duel, LaneDynamics model, Policy evader, Policy pursuer, boolean[] isOutside) {
    this.isOutside = isOutside.clone();
    policies = new LanePolicy[] {LanePolicy.of(evader, false), LanePolicy.of(pursuer, false)};
    for (int world = 0; world < WORLDS; world++) {
      policies[0].take(world, evader);
      policies[1].take(world, pursuer);
    }
    float[] effort = new float[WORLDS];
    agents =
        new OpponentAgents[] {
          new OpponentAgents(0, duel.evader(), model, policies[0], effort, observation, isOutside[0], null),
          new OpponentAgents(1, duel.pursuer(), model, policies[1], effort, observation, isOutside[1], null)
        };
    kernel = new TimetableKernel(agents, this);
  }

  /** Why a policy cannot be simulated here, for a person; empty if it can. */
  public static Optional<String> refusal(Policy policy) {
    return PolicyLanes.of(policy).fold(
        refused -> Optional.of("expected a policy that is a formula: " + refused.getMessage()),
        form -> Optional.empty());
  }

  /** Sets every world to the start of a timetable; {@link #restart} sets the vehicles' positions.
   *
   * @param untilS time of the last distance that counts
   */
  public void start(Timetable timetable, float untilS) {
    this.timetable = timetable;
    this.untilS = untilS;
    next = 0;
    dueUntil = 0;
    kernel.start(timetable, WORLDS);
  }

  /** Restarts one world: its vehicles rest at their starts, in all readings, also those on their way; they
   * were commanded along their headings before. Requests and commands on their way stay unchanged: the loop
   * runs already.
   *
   * @param vehicle 0 the evader, 1 the pursuer
   */
  public void restart(int world, int vehicle, float northM, float eastM, float headingRad) {
    agents[vehicle].vehicles.startX[world] = northM;
    agents[vehicle].vehicles.startY[world] = eastM;
    agents[vehicle].restart(world, headingRad);
  }

  /** Simulates until an external decision is due; false at the end of the timetable. */
  public boolean flyOn() {
    int[] operations = timetable.operations();
    while (next < timetable.size() && !isDue(operations, next)) kernel.perform(next++);
    dueUntil = next;
    // Several decide at once where nothing happens between, and none knows what another is about to.
    while (dueUntil < timetable.size()
        && isDue(operations, dueUntil)
        && !knowsPending(operations, dueUntil)) dueUntil++;
    return next < timetable.size();
  }

  private boolean isDue(int[] operations, int at) {
    int field = at * Timetable.Fields();
    return operations[field] == TimetableKernel.DECIDE && isOutside[operations[field + 1]];
  }

  private boolean knowsPending(int[] operations, int at) {
    int field = at * Timetable.Fields();
    for (int before = next; before < at; before++) {
      int its = before * Timetable.Fields();
      boolean isOwn = operations[its + 1] == operations[field + 1];
      if (isOwn || operations[its + 5] == operations[field + 3]) return true;
    }
    return false;
  }

  /** Whether a vehicle's external decision is due. */
  public boolean isDue(int vehicle) {
    return operationOf(vehicle) >= 0;
  }

  private int operationOf(int vehicle) {
    for (int at = next; at < dueUntil; at++)
      if (timetable.operations()[at * Timetable.Fields() + 1] == vehicle) return at;
    return -1;
  }

  /** The observation of a vehicle whose decision is due, in all worlds: {@link #FIELDS} rows of {@link
   * #WORLDS} numbers: the opponent's position ahead and to the right, m; its relative velocity ahead and to
   * the right, m/s; cosine and sine of its heading from the own one; the time since the own last decision,
   * the age of the own reading and of the opponent's, s. Ahead is the direction of the own last command.
   */
  public void observe(int vehicle, float[] into) {
    int operation = operationOf(vehicle), field = operation * Timetable.Fields();
    int[] operations = timetable.operations();
    agents[vehicle].see(
        agents,
        timetable.views(),
        operations[field + 2] * VEHICLES,
        timetable.times(),
        operation * timetable.numbers());
    Directions own = agents[vehicle].headings, theirs = agents[1 - vehicle].headings;
    int known = operations[field + 3] * WORLDS, before = operations[field + 4] * WORLDS;
    observation.difference(LaneObservation.X, north);
    observation.difference(LaneObservation.Y, east);
    turn(north, east, 0, own, before, into, 0);
    observation.difference(LaneObservation.VX, north);
    observation.difference(LaneObservation.VY, east);
    turn(north, east, 0, own, before, into, 2 * WORLDS);
    turn(theirs.cos, theirs.sin, known, own, before, into, 4 * WORLDS);
    System.arraycopy(observation.elapsed, 0, into, 6 * WORLDS, WORLDS);
    System.arraycopy(observation.ownAge, 0, into, 7 * WORLDS, WORLDS);
    System.arraycopy(observation.opponentAge, 0, into, 8 * WORLDS, WORLDS);
  }

  /** Rotates north and east components to ahead and right of a direction. */
  private static void turn(
      float[] x, float[] y, int from, Directions own, int at, float[] into, int to) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector north = FloatVector.fromArray(SPECIES, x, from + i),
          east = FloatVector.fromArray(SPECIES, y, from + i),
          cos = FloatVector.fromArray(SPECIES, own.cos, at + i),
          sin = FloatVector.fromArray(SPECIES, own.sin, at + i);
      north.mul(cos).add(east.mul(sin)).intoArray(into, to + i);
      east.mul(cos).sub(north.mul(sin)).intoArray(into, to + WORLDS + i);
    }
  }

  /** Sets the number of a vehicle's external decision in one world. */
  public void tell(int vehicle, int world, float number) {
    policies[vehicle].tell(world, number);
  }

  /** Makes the due decisions, by the numbers that were set. */
  public void decide() {
    while (next < dueUntil) kernel.perform(next++);
  }

  /** Time of the last scored distance, since the timetable's start, s. */
  public float scoredAtS() {
    return scores.scoredAtS();
  }

  public float distance(int world) {
    return scores.soFar(NEWEST, world);
  }

  /** Sum of the distances scored since {@link #forgetScores}, m. */
  public float distanceSum(int world) {
    return scores.soFar(SUM, world);
  }

  public float distanceLeast(int world) {
    return scores.soFar(LEAST, world);
  }

  public void forgetScores() {
    scores.forget(SUM);
    scores.forget(LEAST);
  }

  @Override
  public void start(int worlds) {
    scores.start(worlds);
  }

  @Override
  public void score(TimetableAgents[] all, int[] views, int view, float timeS) {
    if (timeS <= untilS + TOLERANCE_S) scores.score(all, views, view, timeS);
  }
}
