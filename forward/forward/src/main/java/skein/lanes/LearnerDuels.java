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
import skein.policy.HeadingPolicy;

/**
 * Duels in {@link #WORLDS} worlds side by side, by one timetable, that stop whenever somebody outside
 * is to decide: what {@link TimetableDuels} flies, for learners. The evader is vehicle 0. Nothing is
 * allocated after construction but where a timetable needs more places than any before.
 *
 * <p>Who decides from outside is a policy of a single number, which is told before each decision. So
 * a decision takes the same way as any policy's, to the same bits.
 */
public final class LearnerDuels implements TimetableScores {
  /** Worlds flown together. */
  public static final int WORLDS = LanePolicy.WORLDS;

  /** Numbers of an observation, in the order of {@link #observe}. */
  public static final int FIELDS = 9;

  private static final int VEHICLES = 2;
  private static final float TOLERANCE_S = 1e-4f;

  private final LanePolicy[] policies;
  private final DuelAgents[] agents;
  private final LaneObservation observation = new LaneObservation();
  private final float[] north = new float[WORLDS], east = new float[WORLDS];
  private final boolean[] isOutside;
  private final TimetableKernel kernel;
  private Timetable timetable;

  /** The timetable's next operation, and up to which decisions are due. */
  private int next, dueUntil;

  private float untilS;

  private static final int NEWEST = 0, SUM = 1, LEAST = 2;
  private final Scoreboard scores = Scoreboard.ofLearners();

  /**
   * @param duel start, speeds and duration
   * @param evader of a single number where it decides from outside
   * @param isOutside whether the evader, and whether the pursuer does
   */
  public LearnerDuels(
      Duel duel, LaneDynamics model, HeadingPolicy evader, HeadingPolicy pursuer, boolean[] isOutside) {
    this.isOutside = isOutside.clone();
    policies = new LanePolicy[] {LanePolicy.of(evader, false), LanePolicy.of(pursuer, false)};
    for (int world = 0; world < WORLDS; world++) {
      policies[0].take(world, evader);
      policies[1].take(world, pursuer);
    }
    float[] effort = new float[WORLDS];
    agents =
        new DuelAgents[] {
          new DuelAgents(0, duel.evader(), model, policies[0], effort, observation, isOutside[0], null),
          new DuelAgents(1, duel.pursuer(), model, policies[1], effort, observation, isOutside[1], null)
        };
    kernel = new TimetableKernel(agents, this);
  }

  /** Why a policy does not fly so, for a person; nothing where it does. */
  public static Optional<String> refusal(HeadingPolicy policy) {
    return PolicyLanes.of(policy).fold(
        refused -> Optional.of("expected a policy that is a formula: " + refused.getMessage()),
        form -> Optional.empty());
  }

  /**
   * Every world is at the start of a timetable; where its vehicles are, {@link #restart} tells.
   *
   * @param untilS distances count up to this time
   */
  public void start(Timetable timetable, float untilS) {
    this.timetable = timetable;
    this.untilS = untilS;
    next = 0;
    dueUntil = 0;
    kernel.start(timetable, WORLDS);
  }

  /**
   * One world begins anew: its vehicles rest at their starts, so tell all readings, and so will those
   * on their way; they were commanded along their headings all the while. Questions and commands stay
   * under way as they are: the loop runs already.
   *
   * @param vehicle 0 the evader, 1 the pursuer
   */
  public void restart(int world, int vehicle, float northM, float eastM, float headingRad) {
    agents[vehicle].vehicles.startX[world] = northM;
    agents[vehicle].vehicles.startY[world] = eastM;
    agents[vehicle].restart(world, headingRad);
  }

  /** Flies on until somebody outside is to decide; false at the end of the timetable. */
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

  /** Whether a vehicle is among those to decide for now. */
  public boolean isDue(int vehicle) {
    return operationOf(vehicle) >= 0;
  }

  private int operationOf(int vehicle) {
    for (int at = next; at < dueUntil; at++)
      if (timetable.operations()[at * Timetable.Fields() + 1] == vehicle) return at;
    return -1;
  }

  /**
   * What a vehicle that is due sees in all worlds, {@link #FIELDS} rows of {@link #WORLDS} numbers:
   * the opponent's place ahead and to the right, m; how fast it goes away ahead and to the right, m/s;
   * cosine and sine of its heading from the own one; the time since the own last decision, the age of
   * the own reading and of the opponent's, s. Ahead is where the own last command led.
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

  /** North and east, as ahead and to the right of a direction. */
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

  /** Tells the policy that decides for a vehicle from outside its number in one world. */
  public void tell(int vehicle, int world, float number) {
    policies[vehicle].tell(world, number);
  }

  /** Those that are due decide, by what they were told. */
  public void decide() {
    while (next < dueUntil) kernel.perform(next++);
  }

  /** When the distances were scored last, since the timetable's start, s. */
  public float scoredAtS() {
    return scores.scoredAtS();
  }

  /** The distance scored last, m. */
  public float distance(int world) {
    return scores.soFar(NEWEST, world);
  }

  /** Of the distances scored since {@link #forgetScores} the sum, m. */
  public float distanceSum(int world) {
    return scores.soFar(SUM, world);
  }

  /** The same of the least. */
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
