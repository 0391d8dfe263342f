package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import scala.collection.immutable.Set;
import skein.forward.DelayTable;
import skein.forward.Duel;
import skein.forward.LoopTiming;
import skein.forward.Rollout;
import skein.forward.Steering;
import skein.port.Moves;

/**
 * Duels of many worlds at a time, each with delays of its own, under the full event timing of {@code
 * stream}, {@code sequential} or {@code futures}, with vehicles whose flight is known in pieces. A loop tells
 * what is offered when ({@link LaneOffers}), {@link LaneAgents} decide upon it and send, {@link
 * LaneVehicles} fly. {@link Rollout} is the scalar reference: both draw the same delays
 * from a world's key, and every event happens at the same nanosecond in both. Nothing is allocated
 * after construction but where links need more room than any before; one instance per thread.
 */
final class LoopDuelKernel extends DuelKernel {
  private static final int WORLDS = LanePolicy.WORLDS;

  /** Times stay within what integers of grains can hold. */
  private static final double MOST_S = 3.5;

  private final int steps;
  private final double durationS, periodS;
  private final LaneOffers offers;
  private final LaneAgents evader, pursuer;
  private final boolean withVelocity, withAges;
  private final int[][] readAt = new int[2][WORLDS];

  /** In which somebody is offered something in a beat. */
  private final LaneVectors vectors = new LaneVectors();

  /**
   * Why the kernel cannot fly this loop over a link, for a person; null where it can.
   *
   * @param maxDelayS the longest one-way delay of the link
   */
  static String refusal(LoopTiming timing, double maxDelayS, LaneDynamics model) {
    if (!model.fliesAlone()) return "worlds with delays of their own fly vehicle by vehicle with the quadrotor";
    Steering steering = LoopTiming.steeringOf(timing);
    double deadTimeS = model.deadTimeS();
    if (steering.mostOutstanding() != Moves.MostOutstanding())
      return "the lanes know "
          + Moves.MostOutstanding()
          + " moves in flight, and this loop has "
          + steering.mostOutstanding();
    double patienceS = 0, toleranceS = 0;
    if (timing instanceof LoopTiming.Stream stream) {
      if (stream.asking().inOrder())
        return "the lanes take answers as they come, and this loop in order";
      if (stream.asking().spreadS() != 0)
        return "the lanes ask all vehicles at once, and this loop spreads its questions";
      if (!(stream.patienceS() > 0))
        return "the lanes wait for the other vehicle's reading, and this loop does not";
      patienceS = stream.patienceS();
      toleranceS = stream.toleranceS();
    } else if (!(timing instanceof LoopTiming.Sequential || timing instanceof LoopTiming.Futures))
      return "worlds with delays of their own fly by lanes under sequential, futures and stream";
    if (model.stepS() > LaneFlights.MOST_PIECE_S)
      return "the lanes fly steps of " + LaneFlights.MOST_PIECE_S + " s at most, and the vehicle's last " + model.stepS() + " s";
    double timeoutS = LoopTiming.askingOf(timing).timeoutS();
    if (timing.periodS() + patienceS + 2 * timeoutS + 2 * maxDelayS + deadTimeS > MOST_S)
      return "a command may act later than the lanes can count";
    boolean whole =
        LaneViews.isWhole(timing.periodS())
            && LaneViews.isWhole(toleranceS)
            && LaneViews.isWhole(patienceS)
            && LaneViews.isWhole(timeoutS)
            && LaneViews.isWhole(steering.minIntervalS())
            && LaneViews.isWhole(steering.handoverS());
    return whole ? null : "the lanes count time in grains of 4 ns, and this loop's times are none";
  }

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param model none that is {@link #refusal refused}
   * @param maxDelayS the longest one-way delay of any link flown over
   * @param pursuerPolicy takes the parameters of each world's pursuer before it flies
   * @param asked what they are judged by
   */
  LoopDuelKernel(
      Duel duel,
      LoopTiming timing,
      LaneDynamics model,
      double maxDelayS,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy,
      Set<DuelNumber> asked) {
    this(duel, timing, model, maxDelayS, pursuerPolicy, evaderPolicy, asked, true);
  }

  /**
   * @param shortCut whether regular stretches of {@code stream} are told by lanes; without, the same is
   *     told world by world
   */
  LoopDuelKernel(
      Duel duel,
      LoopTiming timing,
      LaneDynamics model,
      double maxDelayS,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy,
      Set<DuelNumber> asked,
      boolean shortCut) {
    super(duel.durationS(), timing.periodS(), asked);
    durationS = duel.durationS();
    periodS = timing.periodS();
    steps = (int) Math.round(durationS / periodS);
    double intervalS = 0;
    boolean decidesFirst = true;
    if (timing instanceof LoopTiming.Stream stream) {
      intervalS = periodS - stream.toleranceS();
      decidesFirst = stream.decideThenPace();
      offers = new StreamOffers(stream, duel.durationS(), shortCut);
    } else if (timing instanceof LoopTiming.Sequential sequential)
      offers = new SequentialOffers(sequential);
    else offers = new FuturesOffers((LoopTiming.Futures) timing, maxDelayS);
    FlightTiming flight = new FlightTiming(timing, offers.rowsAhead + keptRows(timing, maxDelayS), 2 * MOST_S);
    LaneVehicles evaders = model.flights(duel.evader(), flight),
        pursuers = model.flights(duel.pursuer(), flight);
    double deadTimeS = model.deadTimeS();
    Steering steering = LoopTiming.steeringOf(timing);
    evader =
        new LaneAgents(
            0, duel.evader(), periodS, steering, intervalS, decidesFirst, offers.together, deadTimeS, evaders,
            evaderPolicy, evaderEffortRad());
    pursuer =
        new LaneAgents(
            1, duel.pursuer(), periodS, steering, intervalS, decidesFirst, offers.together, deadTimeS, pursuers,
            pursuerPolicy, pursuerEffortRad());
    withVelocity = evaderPolicy.needsVelocity() || pursuerPolicy.needsVelocity();
    withAges = evaderPolicy.needsAges() || pursuerPolicy.needsAges();
    place(0, evaders);
    place(1, pursuers);
  }

  private void place(int vehicle, LaneVehicles vehicles) {
    scores().place(vehicle, vehicles.state, LaneVehicles.X, vehicles.state, LaneVehicles.Y);
  }

  /** From a reading to its decision, and from the decision before that to when its command acts. */
  private static int keptRows(LoopTiming timing, double maxDelayS) {
    double timeoutS = LoopTiming.askingOf(timing).timeoutS(), periodS = timing.periodS();
    double kept = Math.min(2 * timeoutS, 4 * maxDelayS) + 3 * maxDelayS + 2 * periodS + 0.5;
    return 2 + (int) Math.ceil(kept / periodS);
  }

  /**
   * Flies one episode in each of {@link #WORLDS} worlds, by the policies' parameters.
   *
   * @param worldKeys {@link skein.simd.WorldRandom#key} of each world
   * @param links of each world; none may be {@link #refusal refused}
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(int[] worldKeys, DelayTable[] links, float captureRadiusM) {
    offers.start(worldKeys, links);
    evader.start();
    pursuer.start();
    captureWithin(captureRadiusM);
    scores().start();
    for (int row = 0; row < steps; row++) {
      if (row > 0) {
        evader.startRow(row);
        pursuer.startRow(row);
        if (withAges) growOlder();
      }
      offers.startRow(row);
      boolean isScored = row == 0;
      while (offers.nextBeat()) {
        vectors.take(offers.joinedAt, LaneOffers.NONE);
        read(row, 0, evader.vehicles);
        read(row, 1, pursuer.vehicles);
        // Reading them has flown the vehicles to the row's begin, if that is their way.
        if (!isScored) score(row);
        isScored = true;
        boolean forPursuer = offers.whose != LaneOffers.EVADER,
            forEvader = offers.whose != LaneOffers.PURSUER;
        if (forPursuer) pursuer.decide(evader, offers, vectors, readAt);
        if (forEvader) evader.decide(pursuer, offers, vectors, readAt);
        int end = grainsToEnd(row);
        if (forPursuer) pursuer.command(row, offers, vectors, end);
        if (forEvader) evader.command(row, offers, vectors, end);
      }
      if (!isScored) score(row);
    }
    score(steps);
  }

  private void read(int row, int vehicle, LaneVehicles vehicles) {
    int[] at = offers.sampledAt[vehicle], fresh = offers.fresh[vehicle];
    vehicles.read(row, vectors, offers.joinedAt, at, fresh, withVelocity);
    if (withAges)
      for (int i = 0; i < WORLDS; i += LANES) {
        IntVector now = IntVector.fromArray(INTS, at, i), held = IntVector.fromArray(INTS, readAt[vehicle], i);
        if (fresh != null) now = held.blend(now, IntVector.fromArray(INTS, fresh, i).compare(GT, 0));
        now.intoArray(readAt[vehicle], i);
      }
  }

  private void growOlder() {
    int period = LaneViews.grains(periodS);
    for (int[] each : readAt)
      for (int i = 0; i < WORLDS; i++) each[i] = Math.max(each[i] - period, Integer.MIN_VALUE / 2);
  }

  private void score(int row) {
    evader.vehicles.flyToRow(row);
    pursuer.vehicles.flyToRow(row);
    scores().score((float) (row * periodS));
  }

  /** From a row's begin to the end of the episode, as far as integers count. */
  private int grainsToEnd(int row) {
    double seconds = (steps - row) * periodS;
    return seconds < 7 ? LaneViews.grains(seconds) : Integer.MAX_VALUE;
  }
}
