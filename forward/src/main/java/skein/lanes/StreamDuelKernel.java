package skein.lanes;

import skein.forward.DelayTable;
import skein.forward.Duel;
import skein.forward.LoopTiming;
import skein.forward.Reduced;
import skein.forward.Rollout;

/**
 * Duels under the full event timing of the {@code stream} loop, many worlds at a time, each with
 * delays of its own: questions, answers, commands and acknowledgements with sampled delays,
 * overtaking, time-outs, patience, pacing, skipping; vehicles with first-order lag and dead time,
 * exactly integrated between commands. {@link Rollout} with {@code LoopTiming.Stream} and a {@code
 * Reduced} model is its scalar reference: both draw the same delays from a world's key, and every
 * event happens at the same nanosecond in both.
 *
 * <p>All worlds go through row m, from question m to the next, together; when its events happen
 * differs by lane. What the questions bring is told by {@link LaneViews}, who decides when by
 * {@link LaneControllers}, where the vehicles are by {@link LagVehicles}. Nothing is allocated after
 * construction but where links need more room than any before; one instance per thread.
 */
final class StreamDuelKernel extends DuelKernel {
  private static final int COMMANDS = Rollout.CommandPlace();

  private final LoopTiming.Stream timing;
  private final Reduced model;
  private final int steps, periodGrains;
  private final LaneViews views;
  private final LagVehicles evaders, pursuers;
  private final LaneControllers evading, pursuing;
  private final boolean withVelocity;
  private final LaneScores scores;

  /** Whether the kernel can fly this model over this link; if not, {@link LoopDuelKernel} or {@link Rollout} can. */
  static boolean canFly(LoopTiming.Stream timing, DelayTable link, Reduced model) {
    return refusal(timing, link.maxS(), model) == null;
  }

  /**
   * Why the kernel cannot fly this model over a link, for a person; null where it can.
   *
   * @param maxDelayS the longest one-way delay of the link
   */
  static String refusal(LoopTiming.Stream timing, double maxDelayS, Reduced model) {
    double longest = longestS(timing, maxDelayS, model);
    double rows = longest / timing.periodS();
    if (!(model.lagS() > 0)) return "the lanes need vehicles that lag";
    if (timing.decideThenPace()) return "the lanes pace before they decide, and this loop decides first";
    if (timing.asking().inOrder()) return "the lanes take answers as they come, and this loop in order";
    if (timing.asking().spreadS() != 0)
      return "the lanes ask all vehicles at once, and this loop spreads its questions";
    if (!(timing.patienceS() > 0)) return "the lanes wait for the other vehicle's reading, and this loop does not";
    if (timing.steering().mostOutstanding() != LoopTiming.MostOutstanding())
      return "the lanes know " + LoopTiming.MostOutstanding() + " moves in flight, and this loop has "
          + timing.steering().mostOutstanding();
    if (rows > MOST_ROWS)
      return "a command may act " + (long) Math.ceil(rows) + " periods after its question, and the lanes know "
          + MOST_ROWS;
    if (longest > MOST_LAGS * model.lagS()
        || longest + timing.steering().minIntervalS() + maxDelayS > MOST_S)
      return "a command may act later than the lanes can count";
    boolean whole =
        LaneViews.isWhole(timing.periodS())
            && LaneViews.isWhole(timing.toleranceS())
            && LaneViews.isWhole(timing.patienceS())
            && LaneViews.isWhole(timing.asking().timeoutS())
            && LaneViews.isWhole(timing.steering().minIntervalS())
            && LaneViews.isWhole(timing.steering().handoverS());
    return whole ? null : "the lanes count time in grains of 4 ns, and this loop's times are none";
  }

  /** The powers of e that a command's response needs stay within what floats can hold. */
  private static final double MOST_LAGS = 40;

  /** Times stay within what integers can hold. */
  private static final double MOST_S = 7;

  private static final int MOST_ROWS = 64;

  /** From a question to a view that it is the newest of. */
  private static double pictureS(LoopTiming.Stream timing) {
    return timing.asking().timeoutS() + timing.patienceS() + timing.periodS();
  }

  /**
   * From a question to the time when the command acts that was decided on its view: a decision
   * waits for the acknowledgement of the command before at most.
   */
  private static double longestS(LoopTiming.Stream timing, double maxDelayS, Reduced model) {
    return pictureS(timing)
        + 2 * maxDelayS
        + timing.steering().handoverS()
        + maxDelayS
        + model.deadTimeS();
  }

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param timing period, interval and steering
   * @param model lag above 0
   * @param pursuerPolicy takes the parameters of each world's pursuer before it flies
   * @param shortCut whether regular stretches are told by lanes; without, the same is told world by
   *     world
   */
  StreamDuelKernel(
      Duel duel,
      LoopTiming.Stream timing,
      Reduced model,
      LanePolicy pursuerPolicy,
      LanePolicy evaderPolicy,
      boolean shortCut) {
    if (!(model.lagS() > 0))
      throw new IllegalArgumentException("the kernel needs a lag above 0, got " + model.lagS());
    this.timing = timing;
    this.model = model;
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    periodGrains = LaneViews.grains(timing.periodS());
    views = new LaneViews(timing, duel.durationS(), shortCut);
    evaders = new LagVehicles(duel.evader(), model, timing.periodS(), MOST_ROWS, pictureS(timing));
    pursuers = new LagVehicles(duel.pursuer(), model, timing.periodS(), MOST_ROWS, pictureS(timing));
    evading =
        new LaneControllers(duel.evader(), timing, model, evaders, evaderPolicy, evaderEffortRad);
    pursuing =
        new LaneControllers(
            duel.pursuer(), timing, model, pursuers, pursuerPolicy, pursuerEffortRad);
    withVelocity = evaderPolicy.needsVelocity() || pursuerPolicy.needsVelocity();
    scores = new LaneScores(duel.durationS(), timing.periodS(), this);
  }

  /**
   * Flies one episode in each of {@link #WORLDS} worlds, by the policies' parameters.
   *
   * @param worldKeys {@link WorldRandom#key} of each world
   * @param links of each world; {@link #canFly} must hold
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(int[] worldKeys, DelayTable[] links, float captureRadiusM) {
    views.start(worldKeys, links);
    evaders.start();
    pursuers.start();
    evading.start();
    pursuing.start();
    scores.start(captureRadiusM);
    for (int row = 0; row < steps; row++) {
      views.startRow(row);
      read(evaders, 0, row, true);
      read(pursuers, 1, row, true);
      if (row > 0) score(row);
      decide(row);
      while (views.nextBeat()) {
        read(evaders, 0, row, false);
        read(pursuers, 1, row, false);
        decide(row);
      }
    }
    evaders.flyTo(steps, views.sampledAt[0], 0);
    pursuers.flyTo(steps, views.sampledAt[1], 0);
    score(steps);
    scores.finish();
  }

  private void score(int row) {
    scores.add(
        row, evaders.state, evaders.state, pursuers.state, pursuers.state, LagVehicles.Y);
  }

  /** Flies on to a row's question, and takes the readings of the beat's views. */
  private void read(LagVehicles vehicles, int role, int row, boolean isFirst) {
    int[] sampledAt = views.sampledAt[role];
    if (views.hasOld) vehicles.keepSeen();
    if (isFirst && row > 0) vehicles.flyTo(row, sampledAt, views.latestSampleS);
    else vehicles.lookAgain(row, sampledAt, views.latestSampleS);
    if (withVelocity) vehicles.readVelocities();
    for (int i = 0; i < views.oddCount; i++) {
      int world = views.odd[i];
      if (views.isFresh[role][world] == 0) vehicles.restoreSeen(world);
      else if (sampledAt[world] < 0) vehicles.lookBack(world, row, sampledAt[world]);
    }
  }

  /** Both decide, where it is their turn. */
  private void decide(int row) {
    pursuing.decide(evading, views);
    evading.decide(pursuing, views);
    int end = grainsToEnd(row);
    boolean isLast = views.isLastBeat();
    pursuing.command(row, views.delays, COMMANDS + 2, views.place[1], end, isLast);
    evading.command(row, views.delays, COMMANDS, views.place[0], end, isLast);
  }

  /** From a row's question to the end of the episode, as far as integers count. */
  private int grainsToEnd(int row) {
    double seconds = (steps - row) * timing.periodS();
    return seconds < MOST_S ? LaneViews.grains(seconds) : Integer.MAX_VALUE;
  }
}
