package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import java.util.Comparator;
import jdk.incubator.vector.IntVector;
import skein.forward.TabledDelays;
import skein.lanes.policy.LanePolicy;
import skein.lanes.score.Scoreboard;

/** Simulates many worlds in parallel, each with its own delays, under a loop's full event timing: duels and
 * teams, with vehicles that move in closed-form pieces. {@link LaneOffers} are the views on which {@link
 * LaneAgents} decide and send commands; {@link LaneVehicles} move. {@code Rollout} is the scalar reference:
 * from a world's key both draw equal delays, and every event happens at the same nanosecond. Allocates
 * nothing after construction, unless links need larger tables than before. Use one instance per thread.
 */
public final class LoopKernel {
  public static final int WORLDS = LanePolicy.WORLDS;

  private final int steps;
  private final double periodS;
  private final LaneOffers offers;
  private final LaneAgents[] agents;

  /** The agents in the order of their decisions; agents with cameras are last. */
  private final LaneAgents[] turns;
  private final Scoreboard scores;
  private final boolean withVelocity, withAges;

  /** Whether readings are predicted. Then vehicles are also read in worlds without an offer. */
  private final boolean isForecast;

  /** Time of each world's first decision, s. */
  private final double[] begunS = new double[WORLDS];

  private static final LaneVectors ALL = LaneVectors.all();
  private final int[][] readAt;

  /** Earliest sampling time, in grains from the period's start, 4 to 6 s ago: earlier ones count as this, so
   * that the time from it to a decision fits into an int.
   */
  private final int oldestAt;

  /** Vectors in which some world has an offer in this round. */
  private final LaneVectors vectors = new LaneVectors();

  /** @param agents one per vehicle, in the vehicles' order; created with this loop
   * @param scores receives the vehicles' positions
   */
  public LoopKernel(LoopLanes loop, LaneAgents[] agents, Scoreboard scores) {
    this.agents = agents;
    turns = agents.clone();
    Arrays.sort(turns, Comparator.comparing(LaneAgents::sees));
    this.scores = scores;
    offers = loop.offers();
    periodS = loop.periodS();
    steps = (int) Math.round(loop.durationS() / periodS);
    readAt = new int[agents.length][WORLDS];
    oldestAt = Integer.MIN_VALUE + (int) Math.min(1L << 30, Math.max(1L << 29, 4L * LaneViews.grains(periodS)));
    boolean needsVelocity = scores.needsVelocity(), needsAges = scores.needsAges();
    for (LaneAgents each : agents) {
      float[] state = each.vehicles.state;
      scores.place(each.self, state, LaneVehicles.X, state, LaneVehicles.Y);
      if (each.vehicles.inSpace) scores.placeDown(each.self, state, LaneVehicles.Z);
      scores.placeReadings(each.self, state, LaneVehicles.SEEN_X);
      needsVelocity |= each.needsVelocity();
      needsAges |= each.needsAges();
    }
    isForecast = loop.forecast() != null;
    withVelocity = needsVelocity || isForecast;
    withAges = needsAges;
  }

  /** Simulates one episode in each of {@link #WORLDS} worlds.
   *
   * @param worldKeys {@link skein.simd.WorldRandom#key} of each world
   * @param links the link of each world; their longest delay must not exceed that of the loop
   */
  public void fly(int[] worldKeys, TabledDelays[] links) {
    if (offers.missing.areSome) offers.missing.start(worldKeys);
    offers.start(worldKeys, links);
    for (LaneAgents each : agents) {
      each.start();
      each.vehicles.seed(worldKeys, each.self);
    }
    scores.start(WORLDS);
    Arrays.fill(begunS, Double.POSITIVE_INFINITY);
    for (int row = 0; row < steps; row++) {
      if (row > 0) {
        for (LaneAgents each : agents) each.startRow(row);
        if (withAges) growOlder();
      }
      offers.startRow(row);
      boolean isScored = row == 0;
      while (offers.nextBeat()) {
        offers.beat++;
        vectors.take(offers.joinedAt, LaneOffers.NONE);
        for (LaneAgents each : agents) read(row, each);
        // Some kinds of vehicles are simulated to the period's start by the readings.
        if (!isScored) score(row);
        isScored = true;
        for (LaneAgents each : turns) if (offers.isFor(each.self)) each.decide(agents, offers, vectors, readAt);
        if (scores.hasEnd()) mayEnd(row);
        int end = grainsToEnd(row);
        for (LaneAgents each : turns)
          if (offers.isFor(each.self)) {
            if (each.sees()) each.choose(agents, offers, vectors, readAt);
            each.command(row, offers, vectors, end);
          }
      }
      if (!isScored) score(row);
    }
    score(steps);
  }

  private void read(int row, LaneAgents agent) {
    int[] at = offers.sampledAt[agent.self], fresh = offers.fresh[agent.self], held = readAt[agent.self];
    agent.vehicles.sense(row, isForecast ? ALL : vectors, offers.joinedAt, at, fresh, withVelocity);
    if (withAges)
      for (int i = 0; i < WORLDS; i += LANES) {
        IntVector now = IntVector.fromArray(INTS, at, i), before = IntVector.fromArray(INTS, held, i);
        if (fresh != null) now = before.blend(now, IntVector.fromArray(INTS, fresh, i).compare(GT, 0));
        now.intoArray(held, i);
      }
  }

  /** Ends the worlds that have ended by the readings of the decisions of this round. */
  private void mayEnd(int row) {
    double rowS = row * periodS;
    float[] nowS = scores.nowS(), sinceS = scores.sinceS();
    for (LaneAgents each : agents)
      if (offers.isFor(each.self))
        for (int i = 0; i < WORLDS; i++) begunS[i] = Math.min(begunS[i], each.decidesS(i, rowS));
    for (LaneAgents each : agents)
      if (offers.isFor(each.self)) {
        for (int i = 0; i < WORLDS; i++) {
          double decidesS = each.decidesS(i, rowS);
          nowS[i] = (float) decidesS;
          sinceS[i] = (float) (decidesS - begunS[i]);
        }
        if (scores.needsAges())
          for (int v = 0; v < agents.length; v++) each.sinceRead(v, readAt, scores.agesS()[v]);
        scores.end();
      }
  }

  private void growOlder() {
    int period = LaneViews.grains(periodS);
    for (int[] each : readAt)
      for (int i = 0; i < WORLDS; i++) each[i] = Math.max(each[i] - period, oldestAt);
  }

  private void score(int row) {
    float timeS = (float) (row * periodS);
    boolean counts = scores.counts(timeS);
    for (LaneAgents each : agents) each.vehicles.flyToRow(row, counts);
    if (counts) scores.score(timeS);
  }

  /** Time from a period's start to the end of the episode, in grains; {@link Integer#MAX_VALUE} from seven
   * seconds on.
   */
  private int grainsToEnd(int row) {
    double seconds = (steps - row) * periodS;
    return seconds < 7 ? LaneViews.grains(seconds) : Integer.MAX_VALUE;
  }
}
