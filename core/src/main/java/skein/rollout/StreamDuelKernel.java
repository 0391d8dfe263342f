package skein.rollout;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.HALF_PI;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;

/**
 * The duel of the paper's pursuer and evader under the full event timing of the {@code stream}
 * loop, many worlds at a time: questions, answers, commands and acknowledgements with sampled
 * delays, order kept, pacing, skipping; vehicles with first-order lag and dead time, exactly
 * integrated between commands. {@link Rollout} with {@code LoopTiming.Stream} and a {@code Reduced}
 * model is its scalar reference; both draw the same delays from a world's key. Of its rules the
 * kernel leaves out what is rare while round trips differ by less than a period: a question and its
 * answer never overtake those before, a picture waits for the answers of all to one question
 * however long, and no question fails or is missed.
 *
 * <p>All worlds go through question m together; when its events happen differs by lane. Times are
 * counted from the question, so that floats resolve them. Positions are those at the questions'
 * times; what a vehicle answers is extrapolated from there through the commands that reach it
 * before. Nothing is allocated after construction; one instance per thread.
 */
public final class StreamDuelKernel {
  /**
   * Worlds flown together: few enough for the first-level cache. A multiple of every lane count.
   */
  public static final int WORLDS = 128;

  private static final int EVADER = 0;
  private static final int PURSUER = 1;

  /**
   * Stands for "never yet" and for "not under way"; not infinite, so that no arithmetic makes a NaN
   * of it.
   */
  private static final float PAST = -1e9f;

  private static final float FUTURE = 1e9f;
  private static final FloatVector NEVER = constant(FUTURE),
      NONE = constant(PAST),
      SOON = constant(1e-7f);

  // What is earlier, or later, is PAST or FUTURE, shifted by an episode's length at most.
  private static final FloatVector LONG_AGO = constant(-1e8f), LATER = constant(1e8f);
  private static final FloatVector MINUS_ONE = constant(-1f), QUARTER = constant(0.25f);
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY);
  private static final FloatVector PER_TURN = constant((float) (0.5 / Math.PI)),
      MINUS_TURN = constant((float) (-2 * Math.PI));

  /** 1.5·2²³: adding it and taking it away leaves a float's nearest integer. */
  private static final FloatVector ROUND = constant(12582912f);

  private final LoopTiming.Stream timing;
  private final Reduced model;
  private final int steps;
  private final float periodS;

  /** The delays of all links of the episodes flown now, one table after the other. */
  private float[] delaysS = new float[DelayTable.Size()];

  /** Where a world's table begins. */
  private final int[] tableOf = new int[WORLDS];

  private final DelayTable[] tables = new DelayTable[WORLDS];
  private int tableCount = 0;

  /** Commands to one vehicle that may be under way. */
  private int slots = 0;

  /** Where the command of so many questions ago is kept. */
  private int[] slotOf;

  /** What remains of a velocity's error after so many periods. */
  private float[] agedDecay;

  private final FloatVector period, interval, minInterval, handover, lag, dead;
  private final FloatVector decayRate, growthRate, periodDecay, periodGain;

  private int[] keys;
  private final int[] draws = new int[WORLDS];
  private final Vehicles[] vehicles = new Vehicles[2];
  private final float[] pictureAt = new float[WORLDS], nextPictureAt = new float[WORLDS];
  private final float[] ahead = new float[WORLDS], right = new float[WORLDS];

  /** The pursuer's heading that the evader's controller knows, and its direction. */

  private final float[] aside = new float[WORLDS];
  private final float[] decay = new float[WORLDS];
  private final int lastSteps;

  // Per world: parameters of the policies, and what the episode came to.
  private final float[] turnRate = new float[WORLDS], radius = new float[WORLDS];
  private FloatVector captureRadius = ZERO;
  private final float[] least = new float[WORLDS],
      sum = new float[WORLDS],
      lastSum = new float[WORLDS];

  /** All worlds' vehicles of one role, and their controllers. */
  private final class Vehicles {
    final int role;
    final float startX, startY, startHeading;
    final FloatVector speed;
    final float[] x = new float[WORLDS],
        y = new float[WORLDS],
        vx = new float[WORLDS],
        vy = new float[WORLDS];
    final float[] wantedX = new float[WORLDS], wantedY = new float[WORLDS];
    final float[] seenX = new float[WORLDS], seenY = new float[WORLDS];

    // Commands under way, by question modulo slots: when each begins to act, counted from its own
    // question, e to that
    // time over the lag, and by how much it changes the velocity asked for.
    float[] at, growth, changeX, changeY;

    /** The velocity asked for last. */
    final float[] askedX = new float[WORLDS], askedY = new float[WORLDS];

    final float[] askedAt = new float[WORLDS], answeredAt = new float[WORLDS];
    final float[] nextAskedAt = new float[WORLDS], nextAnsweredAt = new float[WORLDS];
    final float[] heading = new float[WORLDS], cos = new float[WORLDS], sin = new float[WORLDS];
    final float[] newHeading = new float[WORLDS],
        newCos = new float[WORLDS],
        newSin = new float[WORLDS];
    final float[] decideAt = new float[WORLDS], decidedAt = new float[WORLDS];
    final float[] turnAt = new float[WORLDS],
        freeAt = new float[WORLDS],
        commandAt = new float[WORLDS];
    final float[] delay = new float[WORLDS], backDelay = new float[WORLDS];

    /** The sum of the decided headings' changes. */
    final float[] effort = new float[WORLDS];

    Vehicles(int role, Duelist duelist, float gain) {
      this.role = role;
      startX = (float) duelist.startX();
      startY = (float) duelist.startY();
      startHeading = (float) duelist.startHeadingRad();
      speed = constant((float) (duelist.speed() * gain));
    }

    void makeSlots() {
      at = new float[slots * WORLDS];
      growth = new float[slots * WORLDS];
      changeX = new float[slots * WORLDS];
      changeY = new float[slots * WORLDS];
    }

    void start() {
      Arrays.fill(x, startX);
      Arrays.fill(y, startY);
      for (float[] zero :
          new float[][] {
            vx, vy, wantedX, wantedY, askedX, askedY, growth, changeX, changeY, effort
          })
        Arrays.fill(zero, 0f);
      Arrays.fill(at, PAST);
      Arrays.fill(heading, startHeading);
      LaneMath.sinCos(heading, sin, cos, WORLDS);
      for (float[] past : new float[][] {askedAt, answeredAt, decidedAt, turnAt, freeAt, commandAt})
        Arrays.fill(past, PAST);
    }
  }

  /**
   * Distances of the worlds flown last, m: the smallest, the mean, and the mean of the last 10 s.
   */
  public final float[] minDistance = new float[WORLDS], meanDistance = new float[WORLDS];

  public final float[] meanLast10s = new float[WORLDS];

  /** When the distance first was within the capture radius, s; infinite where it never was. */
  public final float[] captureS = new float[WORLDS];

  /** The sums of all changes of the commanded headings, by the shorter way, rad. */
  public final float[] pursuerEffortRad = new float[WORLDS], evaderEffortRad = new float[WORLDS];

  /** Whether the kernel can fly this model over this link; if not, {@link Rollout} can. */
  public static boolean canFly(LoopTiming.Stream timing, DelayTable link, Reduced model) {
    return model.lagS() > 0
        && !timing.decideThenPace()
        && timing.asking().spreadS() == 0
        && timing.steering().mostOutstanding() == LoopTiming.MostOutstanding()
        && longestS(timing, link.maxS(), model) <= MOST_LAGS * model.lagS();
  }

  /** The powers of e that a command's response needs stay within what floats can hold. */
  private static final double MOST_LAGS = 80;

  /**
   * From a question to the time when its decision's command acts: a decision comes before the next
   * picture, at most two delays after the next question; its command one later.
   */
  private static double longestS(LoopTiming.Stream timing, double maxDelayS, Reduced model) {
    return 3 * maxDelayS + model.deadTimeS() + timing.periodS();
  }

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param timing period, interval and steering
   * @param model lag above 0
   */
  public StreamDuelKernel(Duel duel, LoopTiming.Stream timing, Reduced model) {
    if (!(model.lagS() > 0))
      throw new IllegalArgumentException("the kernel needs a lag above 0, got " + model.lagS());
    this.timing = timing;
    this.model = model;
    periodS = (float) timing.periodS();
    period = constant(periodS);
    interval = constant((float) (timing.periodS() - timing.toleranceS()));
    minInterval = constant((float) timing.steering().minIntervalS());
    handover = constant((float) timing.steering().handoverS());
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    lastSteps = (int) Math.round(10 / timing.periodS());
    lag = constant((float) model.lagS());
    decayRate = constant((float) (-1 / model.lagS()));
    growthRate = constant((float) (1 / model.lagS()));
    periodDecay = constant((float) Math.exp(-timing.periodS() / model.lagS()));
    periodGain =
        constant((float) (model.lagS() * (1 - Math.exp(-timing.periodS() / model.lagS()))));
    dead = constant((float) model.deadTimeS());
    vehicles[EVADER] = new Vehicles(EVADER, duel.evader(), (float) model.gain());
    vehicles[PURSUER] = new Vehicles(PURSUER, duel.pursuer(), (float) model.gain());
  }

  /**
   * Flies one episode in each of {@link #WORLDS} worlds.
   *
   * @param worldKeys {@link WorldRandom#key} of each world
   * @param links of each world; {@link #canFly} must hold
   * @param turnRates of each pursuer, rad/s ({@code PaperPursuer})
   * @param radii that each evader assumes, m ({@code PaperEvader})
   * @param captureRadiusM a distance of at most this is a capture
   */
  public void fly(
      int[] worldKeys,
      DelayTable[] links,
      float[] turnRates,
      float[] radii,
      float captureRadiusM) {
    keys = worldKeys;
    captureRadius = constant(captureRadiusM);
    takeOver(links);
    System.arraycopy(turnRates, 0, turnRate, 0, WORLDS);
    System.arraycopy(radii, 0, radius, 0, WORLDS);
    for (Vehicles each : vehicles) each.start();
    Arrays.fill(least, FUTURE);
    Arrays.fill(sum, 0f);
    Arrays.fill(lastSum, 0f);
    Arrays.fill(captureS, Float.POSITIVE_INFINITY);
    ask(0, ZERO);
    nextQuestion(0);
    for (int step = 0; step < steps; step++) step(step);
    for (int i = 0; i < WORLDS; i++) {
      minDistance[i] = least[i];
      meanDistance[i] = sum[i] / steps;
      meanLast10s[i] = lastSum[i] / Math.min(lastSteps, steps);
      pursuerEffortRad[i] = vehicles[PURSUER].effort[i];
      evaderEffortRad[i] = vehicles[EVADER].effort[i];
    }
  }

  /** Makes room for these links' delays and for the commands that they keep under way. */
  private void takeOver(DelayTable[] links) {
    int count = 0;
    float maxS = 0;
    for (int i = 0; i < WORLDS; i++) {
      int table = i > 0 && links[i] == links[i - 1] ? tableOf[i - 1] / DelayTable.Size() : count;
      if (table == count) {
        if (count >= tableCount || tables[count] != links[i]) {
          int end = (count + 1) * DelayTable.Size();
          if (delaysS.length < end) delaysS = Arrays.copyOf(delaysS, 2 * end);
          System.arraycopy(
              links[i].delaysS(), 0, delaysS, count * DelayTable.Size(), DelayTable.Size());
          tables[count] = links[i];
        }
        maxS = Math.max(maxS, links[i].maxS());
        count++;
      }
      tableOf[i] = table * DelayTable.Size();
    }
    tableCount = Math.max(tableCount, count);
    double longest = longestS(timing, maxS, model);
    if (longest > MOST_LAGS * model.lagS())
      throw new IllegalArgumentException(
          "the kernel needs a lag of at least "
              + longest / MOST_LAGS
              + " s over this link, got "
              + model.lagS());
    int needed = (int) Math.ceil(longest / timing.periodS()) + 1;
    if (needed > slots) {
      slots = needed;
      slotOf = new int[slots];
      agedDecay = new float[slots + 1];
      for (int age = 0; age <= slots; age++)
        agedDecay[age] = (float) Math.exp(-age * timing.periodS() / model.lagS());
      for (Vehicles each : vehicles) each.makeSlots();
    }
  }

  private void step(int step) {
    Vehicles evader = vehicles[EVADER], pursuer = vehicles[PURSUER];
    ask(step + 1, period);
    for (int age = 0; age < slots; age++) slotOf[age] = (step + slots - age) % slots * WORLDS;
    for (Vehicles each : vehicles) {
      look(each);
      due(each);
      draw(step, Rollout.CommandPlace() + 2 * each.role, each.delay);
      draw(step, Rollout.CommandPlace() + 2 * each.role + 1, each.backDelay);
    }
    relate();
    turn(pursuer);
    LaneMath.sinCos(pursuer.newHeading, pursuer.newSin, pursuer.newCos, WORLDS);
    evade(evader, pursuer);
    LaneMath.sinCos(evader.newHeading, evader.newSin, evader.newCos, WORLDS);
    for (Vehicles each : vehicles) {
      command(each, slotOf[0], constant((float) ((steps - step) * timing.periodS())));
      LaneMath.exp(each.growth, slotOf[0], WORLDS);
      fly(each);
    }
    score(step);
    nextQuestion(step + 1);
  }

  private void draw(int step, int place, float[] into) {
    LaneRandom.upperBits(keys, step * Rollout.Places() + place, DelayTable.Drop(), draws, WORLDS);
    for (int i = 0; i < WORLDS; i++) into[i] = delaysS[tableOf[i] + draws[i]];
  }

  /**
   * When question {@code step}, sent at {@code sentAt}, reaches the vehicles, and when all have
   * answered.
   */
  private void ask(int step, FloatVector sentAt) {
    for (Vehicles each : vehicles) {
      draw(step, 2 * each.role, each.delay);
      draw(step, 2 * each.role + 1, each.backDelay);
      for (int i = 0; i < WORLDS; i += LANES) {
        FloatVector asked =
            FloatVector.fromArray(SPECIES, each.askedAt, i)
                .max(FloatVector.fromArray(SPECIES, each.delay, i).add(sentAt));
        asked.intoArray(each.nextAskedAt, i);
        FloatVector.fromArray(SPECIES, each.answeredAt, i)
            .max(asked.add(FloatVector.fromArray(SPECIES, each.backDelay, i)))
            .intoArray(each.nextAnsweredAt, i);
      }
    }
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, vehicles[EVADER].nextAnsweredAt, i)
          .max(FloatVector.fromArray(SPECIES, vehicles[PURSUER].nextAnsweredAt, i))
          .intoArray(nextPictureAt, i);
  }

  /** Counts all times from the next question. */
  private void nextQuestion(int step) {
    FloatVector back = step == 0 ? ZERO : period;
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, nextPictureAt, i).sub(back).intoArray(pictureAt, i);
    for (Vehicles each : vehicles) {
      for (int i = 0; i < WORLDS; i += LANES) {
        FloatVector.fromArray(SPECIES, each.nextAskedAt, i).sub(back).intoArray(each.askedAt, i);
        FloatVector.fromArray(SPECIES, each.nextAnsweredAt, i)
            .sub(back)
            .intoArray(each.answeredAt, i);
        FloatVector.fromArray(SPECIES, each.decidedAt, i).sub(back).intoArray(each.decidedAt, i);
        FloatVector.fromArray(SPECIES, each.turnAt, i).sub(back).intoArray(each.turnAt, i);
        FloatVector.fromArray(SPECIES, each.freeAt, i).sub(back).intoArray(each.freeAt, i);
        FloatVector.fromArray(SPECIES, each.commandAt, i).sub(back).intoArray(each.commandAt, i);
      }
    }
  }

  /**
   * When each controller decides, unless a newer picture comes before: then its decision is put off
   * for ever.
   */
  private void due(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector at =
          FloatVector.fromArray(SPECIES, pictureAt, i)
              .max(FloatVector.fromArray(SPECIES, each.turnAt, i))
              .max(FloatVector.fromArray(SPECIES, each.freeAt, i));
      at.blend(NEVER, at.compare(GT, FloatVector.fromArray(SPECIES, nextPictureAt, i)))
          .intoArray(each.decideAt, i);
    }
  }

  /** The evader as the answers show it, in a frame at the pursuer. */
  private void relate() {
    Vehicles evader = vehicles[EVADER], pursuer = vehicles[PURSUER];
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, evader.seenX, i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.seenX, i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, evader.seenY, i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.seenY, i));
      FloatVector c = FloatVector.fromArray(SPECIES, pursuer.cos, i),
          s = FloatVector.fromArray(SPECIES, pursuer.sin, i);
      x.fma(c, y.mul(s)).intoArray(ahead, i);
      y.fma(c, x.mul(s).neg()).intoArray(right, i);
    }
  }

  /** {@code PaperPursuer}. */
  private void turn(Vehicles pursuer) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, right, i),
          before = FloatVector.fromArray(SPECIES, pursuer.decidedAt, i);
      FloatVector elapsed =
          FloatVector.fromArray(SPECIES, pursuer.decideAt, i)
              .sub(before)
              .blend(ZERO, before.compare(LT, LONG_AGO));
      FloatVector side = ZERO.blend(ONE, x.compare(LT, ZERO));
      side = side.blend(ONE, y.compare(GT, ZERO)).blend(MINUS_ONE, y.compare(LT, ZERO));
      FloatVector old = FloatVector.fromArray(SPECIES, pursuer.heading, i);
      FloatVector turned = elapsed.mul(FloatVector.fromArray(SPECIES, turnRate, i)).fma(side, old);
      turned
          .blend(old, FloatVector.fromArray(SPECIES, pursuer.decideAt, i).compare(GT, LATER))
          .intoArray(pursuer.newHeading, i);
    }
  }

  /** {@code PaperEvader}. */
  private void evade(Vehicles evader, Vehicles pursuer) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, right, i),
          r = FloatVector.fromArray(SPECIES, radius, i);
      FloatVector xSquare = x.mul(x), rSquare = r.mul(r);
      FloatVector toLeft = y.sub(r), toRight = y.add(r);
      VectorMask<Float> inRight = toLeft.fma(toLeft, xSquare).compare(LT, rSquare);
      VectorMask<Float> inLeft = toRight.fma(toRight, xSquare).compare(LT, rSquare);
      FloatVector distance = y.fma(y, xSquare).mul(QUARTER);
      VectorMask<Float> breakAway = distance.compare(LT, rSquare).andNot(inLeft.or(inRight));
      y.blend(toLeft, inLeft).blend(toRight, inRight).intoArray(right, i);
      ZERO.blend(HALF_PI, breakAway)
          .add(FloatVector.fromArray(SPECIES, pursuer.heading, i))
          .intoArray(aside, i);
    }
    LaneMath.atan2(right, ahead, evader.newHeading, WORLDS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector away =
          FloatVector.fromArray(SPECIES, evader.newHeading, i)
              .add(FloatVector.fromArray(SPECIES, aside, i));
      VectorMask<Float> skip =
          FloatVector.fromArray(SPECIES, evader.decideAt, i).compare(GT, LATER);
      away.blend(FloatVector.fromArray(SPECIES, evader.heading, i), skip)
          .intoArray(evader.newHeading, i);
    }
  }

  /** Sends what was decided, and takes it over as known; the episode ends at {@code end}. */
  private void command(Vehicles each, int slot, FloatVector end) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector at = FloatVector.fromArray(SPECIES, each.decideAt, i),
          before = FloatVector.fromArray(SPECIES, each.commandAt, i);
      VectorMask<Float> skip = at.compare(GT, LATER);
      FloatVector reaches = before.max(at.add(FloatVector.fromArray(SPECIES, each.delay, i)));
      // Even at no delay a command acts after its question, not with it: 0 is the past.
      FloatVector acts = reaches.add(dead).max(SOON);
      acts.blend(NONE, skip).intoArray(each.at, slot + i);
      ZERO.blend(acts, skip.not()).mul(growthRate).intoArray(each.growth, slot + i);
      FloatVector askX = FloatVector.fromArray(SPECIES, each.newCos, i).mul(each.speed);
      FloatVector askY = FloatVector.fromArray(SPECIES, each.newSin, i).mul(each.speed);
      FloatVector askedX = FloatVector.fromArray(SPECIES, each.askedX, i);
      FloatVector askedY = FloatVector.fromArray(SPECIES, each.askedY, i);
      askX.sub(askedX).blend(ZERO, skip).intoArray(each.changeX, slot + i);
      askY.sub(askedY).blend(ZERO, skip).intoArray(each.changeY, slot + i);
      askX.blend(askedX, skip).intoArray(each.askedX, i);
      askY.blend(askedY, skip).intoArray(each.askedY, i);
      // The command before is acknowledged when this one has replaced it; the very first replaces
      // none.
      FloatVector free = FloatVector.fromArray(SPECIES, each.freeAt, i);
      FloatVector soonest = at.add(minInterval);
      reaches
          .add(FloatVector.fromArray(SPECIES, each.backDelay, i))
          .add(handover)
          .max(free)
          .max(soonest)
          .blend(soonest, before.compare(LT, LONG_AGO))
          .blend(free, skip)
          .intoArray(each.freeAt, i);
      reaches.blend(before, skip).intoArray(each.commandAt, i);
      at.add(interval)
          .blend(FloatVector.fromArray(SPECIES, each.turnAt, i), skip)
          .intoArray(each.turnAt, i);
      at.blend(FloatVector.fromArray(SPECIES, each.decidedAt, i), skip)
          .intoArray(each.decidedAt, i);
      FloatVector newHeading = FloatVector.fromArray(SPECIES, each.newHeading, i);
      FloatVector change = newHeading.sub(FloatVector.fromArray(SPECIES, each.heading, i));
      FloatVector turns = change.fma(PER_TURN, ROUND).sub(ROUND);
      ZERO.blend(turns.fma(MINUS_TURN, change).abs(), at.compare(LT, end))
          .add(FloatVector.fromArray(SPECIES, each.effort, i))
          .intoArray(each.effort, i);
      newHeading.intoArray(each.heading, i);
      FloatVector.fromArray(SPECIES, each.newCos, i).intoArray(each.cos, i);
      FloatVector.fromArray(SPECIES, each.newSin, i).intoArray(each.sin, i);
    }
  }

  // The response to commanded velocities is linear: position and velocity are those without the
  // commands under way,
  // plus each such command's change times its step response, s(t) = t − lag·(1 − r(t)) and 1 −
  // r(t), where
  // r(t) = exp(−t / lag). With r(end − at) = exp(−end / lag) · growth(at) one exponential serves
  // all commands.

  /** Where the vehicles are when the questions reach them. */
  private void look(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, each.askedAt, i).mul(decayRate).intoArray(decay, i);
    LaneMath.exp(decay, 0, WORLDS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector end = FloatVector.fromArray(SPECIES, each.askedAt, i);
      FloatVector r = FloatVector.fromArray(SPECIES, decay, i);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, each.wantedX, i);
      FloatVector wantedY = FloatVector.fromArray(SPECIES, each.wantedY, i);
      FloatVector gain = lag.mul(ONE.sub(r));
      FloatVector offX = FloatVector.fromArray(SPECIES, each.vx, i).sub(wantedX);
      FloatVector offY = FloatVector.fromArray(SPECIES, each.vy, i).sub(wantedY);
      FloatVector x = offX.fma(gain, wantedX.fma(end, FloatVector.fromArray(SPECIES, each.x, i)));
      FloatVector y = offY.fma(gain, wantedY.fma(end, FloatVector.fromArray(SPECIES, each.y, i)));
      for (int age = 1; age < slots; age++) {
        int slot = slotOf[age] + i;
        FloatVector at = FloatVector.fromArray(SPECIES, each.at, slot).sub(age * periodS);
        VectorMask<Float> acts = at.compare(GT, ZERO).and(at.compare(LT, end));
        if (acts.anyTrue()) {
          FloatVector grown = FloatVector.fromArray(SPECIES, each.growth, slot).mul(agedDecay[age]);
          FloatVector response = r.mul(grown).fma(lag, end.sub(at).sub(lag));
          x = FloatVector.fromArray(SPECIES, each.changeX, slot).fma(ZERO.blend(response, acts), x);
          y = FloatVector.fromArray(SPECIES, each.changeY, slot).fma(ZERO.blend(response, acts), y);
        }
      }
      x.intoArray(each.seenX, i);
      y.intoArray(each.seenY, i);
    }
  }

  /** Flies one period, through the commands that begin to act in it. */
  private void fly(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector wantedX = FloatVector.fromArray(SPECIES, each.wantedX, i);
      FloatVector wantedY = FloatVector.fromArray(SPECIES, each.wantedY, i);
      FloatVector offX = FloatVector.fromArray(SPECIES, each.vx, i).sub(wantedX);
      FloatVector offY = FloatVector.fromArray(SPECIES, each.vy, i).sub(wantedY);
      FloatVector x =
          offX.fma(periodGain, wantedX.fma(period, FloatVector.fromArray(SPECIES, each.x, i)));
      FloatVector y =
          offY.fma(periodGain, wantedY.fma(period, FloatVector.fromArray(SPECIES, each.y, i)));
      FloatVector vx = offX.fma(periodDecay, wantedX), vy = offY.fma(periodDecay, wantedY);
      for (int age = 0; age < slots; age++) {
        int slot = slotOf[age] + i;
        FloatVector at = FloatVector.fromArray(SPECIES, each.at, slot).sub(age * periodS);
        VectorMask<Float> acts = at.compare(GT, ZERO).and(at.compare(LE, period));
        if (acts.anyTrue()) {
          FloatVector changeX =
              ZERO.blend(FloatVector.fromArray(SPECIES, each.changeX, slot), acts);
          FloatVector changeY =
              ZERO.blend(FloatVector.fromArray(SPECIES, each.changeY, slot), acts);
          FloatVector remains =
              FloatVector.fromArray(SPECIES, each.growth, slot).mul(agedDecay[age + 1]);
          FloatVector response = remains.fma(lag, period.sub(at).sub(lag)),
              caughtUp = ONE.sub(remains);
          x = changeX.fma(response, x);
          y = changeY.fma(response, y);
          vx = changeX.fma(caughtUp, vx);
          vy = changeY.fma(caughtUp, vy);
          wantedX = wantedX.add(changeX);
          wantedY = wantedY.add(changeY);
        }
      }
      x.intoArray(each.x, i);
      y.intoArray(each.y, i);
      vx.intoArray(each.vx, i);
      vy.intoArray(each.vy, i);
      wantedX.intoArray(each.wantedX, i);
      wantedY.intoArray(each.wantedY, i);
    }
  }

  private void score(int step) {
    Vehicles evader = vehicles[EVADER], pursuer = vehicles[PURSUER];
    boolean last = step >= steps - lastSteps;
    FloatVector time = constant((float) ((step + 1) * timing.periodS()));
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector
          x =
              FloatVector.fromArray(SPECIES, evader.x, i)
                  .sub(FloatVector.fromArray(SPECIES, pursuer.x, i)),
          y =
              FloatVector.fromArray(SPECIES, evader.y, i)
                  .sub(FloatVector.fromArray(SPECIES, pursuer.y, i));
      FloatVector distance = x.fma(x, y.mul(y)).sqrt();
      FloatVector leastSoFar = FloatVector.fromArray(SPECIES, least, i);
      leastSoFar.blend(distance, distance.compare(LT, leastSoFar)).intoArray(least, i);
      FloatVector.fromArray(SPECIES, sum, i).add(distance).intoArray(sum, i);
      INFINITE
          .blend(time, distance.compare(LE, captureRadius))
          .min(FloatVector.fromArray(SPECIES, captureS, i))
          .intoArray(captureS, i);
      if (last) FloatVector.fromArray(SPECIES, lastSum, i).add(distance).intoArray(lastSum, i);
    }
  }
}
