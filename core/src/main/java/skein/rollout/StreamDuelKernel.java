package skein.rollout;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.rollout.LaneMath.INTS;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;

/**
 * Duels under the full event timing of the {@code stream} loop, many worlds at a time, each with
 * delays of its own: questions, answers, commands and acknowledgements with sampled delays,
 * overtaking, time-outs, patience, pacing, skipping; vehicles with first-order lag and dead time,
 * exactly integrated between commands. {@link Rollout} with {@code LoopTiming.Stream} and a {@code
 * Reduced} model is its scalar reference: both draw the same delays from a world's key, and every
 * event happens at the same nanosecond in both.
 *
 * <p>All worlds go through row m, from question m to the next, together ({@link LanePictures});
 * when its events happen differs by lane. Positions are those at the row's question; a picture shows
 * them extrapolated through the commands that act before. Nothing is allocated after construction but where
 * links need more room than any before; one instance per thread.
 */
final class StreamDuelKernel extends DuelKernel {
  private static final int EVADER = 0;
  private static final int PURSUER = 1;
  private static final float FUTURE = 1e9f;
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY),
      GRAIN_S = constant(DelayTable.GrainNs() * 1e-9f);
  private static final IntVector NO = IntVector.zero(INTS),
      YES = IntVector.broadcast(INTS, 1),
      PAST = IntVector.broadcast(INTS, -1_000_000_000),
      NEVER = IntVector.broadcast(INTS, LanePictures.NONE);

  private final LoopTiming.Stream timing;
  private final Reduced model;
  private final int steps, lastSteps;
  private final float periodS, lagS;
  private final LanePictures pictures;

  private final IntVector periodGrains, interval, minInterval, handover, dead;
  private final FloatVector period, lag, decayRate, growthRate, periodDecay, periodGain;

  private final Vehicles evader, pursuer;
  private final Vehicles[] both;
  private final LaneSight sight = new LaneSight();
  private final float[] decay = new float[WORLDS], lookAt = new float[WORLDS];
  private final int[] delay = new int[WORLDS], backDelay = new int[WORLDS];
  private final int[] actsFrom = new int[WORLDS], actsUpTo = new int[WORLDS];

  // Commands that some world has yet to feel, by the beat in which they were decided, modulo slots:
  // the first of them, the beat now, and of each the row, and the times between which it acts.
  private int slots = 0;
  private int firstBeat, beat;
  private int[] rowOf;
  private float[] soonest, latest;

  /**
   * Of each such command: its age, its age a row before, s, and what remains of a velocity's error
   * after its age.
   */
  private float[] ageS, youngerS, agedDecay;

  private float captureRadiusM;
  private final float[] least = new float[WORLDS],
      sum = new float[WORLDS],
      lastSum = new float[WORLDS];

  /** All worlds' vehicles of one role, and their controllers. */
  private final class Vehicles {
    final int role;
    final LanePolicy policy;
    final float startX, startY, startHeading;
    final FloatVector speed;

    // At the row's question.
    final float[] x = new float[WORLDS],
        y = new float[WORLDS],
        vx = new float[WORLDS],
        vy = new float[WORLDS],
        wantedX = new float[WORLDS],
        wantedY = new float[WORLDS];

    final float[] seenX = new float[WORLDS],
        seenY = new float[WORLDS],
        seenVx = new float[WORLDS],
        seenVy = new float[WORLDS];

    // By slot: when the command acts, from its own row's question, e to that time over the lag, and
    // by how much it changes the velocity asked for.
    float[] at, growth, changeX, changeY;

    final Directions sent = new Directions(WORLDS), decided = new Directions(WORLDS);

    // From the row's question: when it may decide and when it may be commanded again, when the
    // last command reaches it, when it decides.
    final int[] turnAt = new int[WORLDS],
        freeAt = new int[WORLDS],
        reachesAt = new int[WORLDS],
        decideAt = new int[WORLDS];

    /** 1 where it decides, 1 where it ever has, and how long before the row's question. */
    final int[] decides = new int[WORLDS], hasDecided = new int[WORLDS];

    final float[] decidedBefore = new float[WORLDS];

    /** The sum of the decided headings' changes. */
    final float[] effort = new float[WORLDS];

    Vehicles(int role, Duelist duelist, double gain, LanePolicy policy) {
      this.role = role;
      this.policy = policy;
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

    /** What was seen before the beat. */
    private final float[][] kept = new float[4][WORLDS];

    void keepSeen() {
      float[][] seen = {seenX, seenY, seenVx, seenVy};
      for (int i = 0; i < seen.length; i++) System.arraycopy(seen[i], 0, kept[i], 0, WORLDS);
    }

    void restoreSeen(int[] isFresh) {
      float[][] seen = {seenX, seenY, seenVx, seenVy};
      for (int world = 0; world < WORLDS; world++)
        if (isFresh[world] == 0)
          for (int i = 0; i < seen.length; i++) seen[i][world] = kept[i][world];
    }

    void start() {
      Arrays.fill(x, startX);
      Arrays.fill(y, startY);
      for (float[] zero : new float[][] {vx, vy, wantedX, wantedY, decidedBefore, effort})
        Arrays.fill(zero, 0f);
      for (int[] zero : new int[][] {turnAt, freeAt, reachesAt, hasDecided}) Arrays.fill(zero, 0);
      sent.fill(0, WORLDS, startHeading);
      policy.start(startHeading);
    }
  }

  /** Whether the kernel can fly this model over this link; if not, {@link Rollout} can. */
  static boolean canFly(LoopTiming.Stream timing, DelayTable link, Reduced model) {
    double longest = longestS(timing, link.maxS(), model);
    return model.lagS() > 0
        && !timing.decideThenPace()
        && !timing.asking().inOrder()
        && timing.asking().spreadS() == 0
        && timing.patienceS() > 0
        && timing.steering().mostOutstanding() == LoopTiming.MostOutstanding()
        && longest <= MOST_LAGS * model.lagS()
        && longest + timing.steering().minIntervalS() + link.maxS() <= MOST_S
        && LanePictures.isWhole(timing.periodS())
        && LanePictures.isWhole(timing.toleranceS())
        && LanePictures.isWhole(timing.patienceS())
        && LanePictures.isWhole(timing.asking().timeoutS())
        && LanePictures.isWhole(timing.steering().minIntervalS())
        && LanePictures.isWhole(timing.steering().handoverS())
        && longest <= MOST_ROWS * timing.periodS();
  }

  /** The powers of e that a command's response needs stay within what floats can hold. */
  private static final double MOST_LAGS = 40;

  /** Times stay within what integers can hold. */
  private static final double MOST_S = 7;

  private static final double MOST_ROWS = 64;

  /** From a question to a picture that it is the newest of. */
  private static double pictureS(LoopTiming.Stream timing) {
    return timing.asking().timeoutS() + timing.patienceS() + timing.periodS();
  }

  /**
   * From a question to the time when the command acts that was decided on its picture: a decision
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
    pictures = new LanePictures(timing, duel.durationS(), shortCut);
    periodS = (float) timing.periodS();
    lagS = (float) model.lagS();
    period = constant(periodS);
    periodGrains = grains(timing.periodS());
    interval = grains(timing.periodS() - timing.toleranceS());
    minInterval = grains(timing.steering().minIntervalS());
    handover = grains(timing.steering().handoverS());
    dead = grains(model.deadTimeS());
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    lastSteps = (int) Math.round(10 / timing.periodS());
    lag = constant(lagS);
    decayRate = constant((float) (-1 / model.lagS()));
    growthRate = constant((float) (1 / model.lagS()));
    periodDecay = constant((float) StrictMath.exp(-timing.periodS() / model.lagS()));
    periodGain =
        constant((float) (model.lagS() * (1 - StrictMath.exp(-timing.periodS() / model.lagS()))));
    evader = new Vehicles(EVADER, duel.evader(), model.gain(), evaderPolicy);
    pursuer = new Vehicles(PURSUER, duel.pursuer(), model.gain(), pursuerPolicy);
    both = new Vehicles[] {evader, pursuer};
  }

  private static IntVector grains(double seconds) {
    return IntVector.broadcast(INTS, LanePictures.grains(seconds));
  }

  /**
   * Flies one episode in each of {@link #WORLDS} worlds, by the policies' parameters.
   *
   * @param worldKeys {@link WorldRandom#key} of each world
   * @param links of each world; {@link #canFly} must hold
   * @param captureRadius a distance of at most this is a capture, m
   */
  void fly(int[] worldKeys, DelayTable[] links, float captureRadius) {
    captureRadiusM = captureRadius;
    pictures.start(worldKeys, links);
    makeSlots(pictures.maxS);
    evader.start();
    pursuer.start();
    firstBeat = 0;
    beat = 0;
    Arrays.fill(least, FUTURE);
    Arrays.fill(sum, 0f);
    Arrays.fill(lastSum, 0f);
    Arrays.fill(captureS, Float.POSITIVE_INFINITY);
    for (int step = 0; step < steps; step++) {
      if (step > 0) {
        advance(step);
        score(step);
      }
      pictures.startRow(step);
      do {
        see(evader, step);
        see(pursuer, step);
        decide(step);
      } while (pictures.nextBeat());
    }
    advance(steps);
    score(steps);
    for (int i = 0; i < WORLDS; i++) {
      minDistance[i] = least[i];
      meanDistance[i] = sum[i] / steps;
      meanLast10s[i] = lastSum[i] / Math.min(lastSteps, steps);
      pursuerEffortRad[i] = pursuer.effort[i];
      evaderEffortRad[i] = evader.effort[i];
    }
  }

  /** Makes room for the commands under way, and for those that early readings are without. */
  private void makeSlots(double maxDelayS) {
    double rows = (longestS(timing, maxDelayS, model) + pictureS(timing)) / timing.periodS();
    int needed = 2 * (int) Math.ceil(rows) + 16;
    if (needed > slots) {
      slots = needed;
      rowOf = new int[slots];
      soonest = new float[slots];
      latest = new float[slots];
      ageS = new float[slots];
      youngerS = new float[slots];
      agedDecay = new float[slots];
      evader.makeSlots();
      pursuer.makeSlots();
    }
  }

  /** Both decide, where it is their turn. */
  private void decide(int step) {
    if (beat - firstBeat == slots)
      throw new IllegalStateException("more than " + slots + " commands are under way");
    int slot = beat % slots;
    rowOf[slot] = step;
    ageS[slot] = 0;
    agedDecay[slot] = 1;
    soonest[slot] = FUTURE;
    latest[slot] = -FUTURE;
    due(pursuer);
    relate(pursuer, evader);
    pursuer.policy.decide(sight, pursuer.sent, 0, evader.sent, 0, pursuer.decided, 0);
    due(evader);
    relate(evader, pursuer);
    evader.policy.decide(sight, evader.sent, 0, pursuer.sent, 0, evader.decided, 0);
    command(pursuer, step, slot);
    command(evader, step, slot);
    beat++;
  }

  /** When each controller decides, unless a newer picture comes before, and how long it waited. */
  private void due(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector at =
          IntVector.fromArray(INTS, pictures.joinedAt, i)
              .max(IntVector.fromArray(INTS, each.turnAt, i))
              .max(IntVector.fromArray(INTS, each.freeAt, i));
      VectorMask<Integer> decides = at.compare(LT, IntVector.fromArray(INTS, pictures.nextAt, i));
      NO.blend(YES, decides).intoArray(each.decides, i);
      at.intoArray(each.decideAt, i);
      FloatVector time = (FloatVector) at.convertShape(VectorOperators.I2F, SPECIES, 0);
      VectorMask<Float> first =
          IntVector.fromArray(INTS, each.hasDecided, i).compare(EQ, NO).cast(SPECIES);
      time.fma(GRAIN_S, FloatVector.fromArray(SPECIES, each.decidedBefore, i))
          .blend(ZERO, first)
          .intoArray(sight.elapsed, i);
    }
  }

  /** The opponent as the readings show it. */
  private void relate(Vehicles own, Vehicles opponent) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector.fromArray(SPECIES, opponent.seenX, i)
          .sub(FloatVector.fromArray(SPECIES, own.seenX, i))
          .intoArray(sight.dx, i);
      FloatVector.fromArray(SPECIES, opponent.seenY, i)
          .sub(FloatVector.fromArray(SPECIES, own.seenY, i))
          .intoArray(sight.dy, i);
    }
    if (own.policy.needsVelocity())
      for (int i = 0; i < WORLDS; i += LANES) {
        FloatVector.fromArray(SPECIES, opponent.seenVx, i)
            .sub(FloatVector.fromArray(SPECIES, own.seenVx, i))
            .intoArray(sight.dvx, i);
        FloatVector.fromArray(SPECIES, opponent.seenVy, i)
            .sub(FloatVector.fromArray(SPECIES, own.seenVy, i))
            .intoArray(sight.dvy, i);
      }
  }

  /** Sends what was decided. */
  private void command(Vehicles each, int step, int slot) {
    pictures.draw(
        pictures.place[each.role], Rollout.CommandPlace() + 2 * each.role, delay, backDelay);
    schedule(each, slot);
    bound(slot);
    LaneMath.exp(each.growth, slot * WORLDS, WORLDS);
    change(each, slot * WORLDS);
    remember(each, IntVector.broadcast(INTS, grainsToEnd(step)));
    each.policy.commit(each.decides);
  }

  /** From a row's question to the end of the episode, as far as integers count. */
  private int grainsToEnd(int step) {
    double seconds = (steps - step) * timing.periodS();
    return seconds < MOST_S ? LanePictures.grains(seconds) : Integer.MAX_VALUE;
  }

  /** When the commands act, and when the vehicle may be commanded again. */
  private void schedule(Vehicles each, int slot) {
    int from = slot * WORLDS;
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Integer> decides = IntVector.fromArray(INTS, each.decides, i).compare(NE, NO);
      IntVector at = IntVector.fromArray(INTS, each.decideAt, i);
      IntVector before = IntVector.fromArray(INTS, each.reachesAt, i);
      // Commands to one vehicle keep their order.
      IntVector reaches = at.add(IntVector.fromArray(INTS, delay, i)).max(before);
      before.blend(reaches, decides).intoArray(each.reachesAt, i);
      IntVector actsAt = reaches.add(dead);
      NEVER.blend(actsAt, decides).intoArray(actsFrom, i);
      PAST.blend(actsAt, decides).intoArray(actsUpTo, i);
      FloatVector acts =
          ((FloatVector) actsAt.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(GRAIN_S);
      VectorMask<Float> acting = decides.cast(SPECIES);
      acts = ZERO.blend(acts, acting);
      acts.intoArray(each.at, from + i);
      acts.mul(growthRate).intoArray(each.growth, from + i);
      // The command before is acknowledged when this one has replaced it; the very first replaces
      // none.
      IntVector free = at.add(minInterval);
      VectorMask<Integer> isFirst = IntVector.fromArray(INTS, each.hasDecided, i).compare(EQ, NO);
      IntVector acknowledged =
          reaches.add(IntVector.fromArray(INTS, backDelay, i)).add(handover).max(free);
      IntVector.fromArray(INTS, each.freeAt, i)
          .blend(acknowledged.blend(free, isFirst), decides)
          .intoArray(each.freeAt, i);
      IntVector.fromArray(INTS, each.turnAt, i)
          .blend(at.add(interval), decides)
          .intoArray(each.turnAt, i);
    }
  }

  /** Between which times the commands of a slot act. */
  private void bound(int slot) {
    int first = LanePictures.NONE, last = Integer.MIN_VALUE;
    for (int i = 0; i < WORLDS; i++) first = Math.min(first, actsFrom[i]);
    for (int i = 0; i < WORLDS; i++) last = Math.max(last, actsUpTo[i]);
    // A little wider than floats are exact.
    soonest[slot] = Math.min(soonest[slot], first * (DelayTable.GrainNs() * 1e-9f) * 0.999f);
    latest[slot] = Math.max(latest[slot], last * (DelayTable.GrainNs() * 1e-9f) * 1.001f);
  }

  /** By how much the commands change the velocities asked for. */
  private void change(Vehicles each, int from) {
    for (int i = 0; i < WORLDS; i += LANES) {
      VectorMask<Float> yes =
          IntVector.fromArray(INTS, each.decides, i).compare(NE, NO).cast(SPECIES);
      FloatVector cos = FloatVector.fromArray(SPECIES, each.sent.cos, i),
          sin = FloatVector.fromArray(SPECIES, each.sent.sin, i);
      FloatVector newCos = cos.blend(FloatVector.fromArray(SPECIES, each.decided.cos, i), yes),
          newSin = sin.blend(FloatVector.fromArray(SPECIES, each.decided.sin, i), yes);
      // Before the first command the vehicle rests, whatever its heading.
      VectorMask<Float> rests =
          IntVector.fromArray(INTS, each.hasDecided, i).compare(EQ, NO).cast(SPECIES);
      FloatVector oldX = cos.blend(ZERO, rests.and(yes)), oldY = sin.blend(ZERO, rests.and(yes));
      newCos.sub(oldX).mul(each.speed).blend(ZERO, yes.not()).intoArray(each.changeX, from + i);
      newSin.sub(oldY).mul(each.speed).blend(ZERO, yes.not()).intoArray(each.changeY, from + i);
      newCos.intoArray(each.sent.cos, i);
      newSin.intoArray(each.sent.sin, i);
    }
  }

  /** Keeps what a decision leaves behind; the episode ends at {@code end}. */
  private void remember(Vehicles each, IntVector end) {
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector decides = IntVector.fromArray(INTS, each.decides, i),
          at = IntVector.fromArray(INTS, each.decideAt, i);
      VectorMask<Float> yes = decides.compare(NE, NO).cast(SPECIES);
      FloatVector effort = FloatVector.fromArray(SPECIES, each.effort, i);
      effort
          .add(FloatVector.fromArray(SPECIES, each.policy.turned, i))
          .blend(effort, yes.not())
          .blend(effort, at.compare(LT, end).cast(SPECIES).not())
          .intoArray(each.effort, i);
      FloatVector time =
          ((FloatVector) at.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(GRAIN_S).neg();
      FloatVector.fromArray(SPECIES, each.decidedBefore, i)
          .blend(time, yes)
          .intoArray(each.decidedBefore, i);
      decides.or(IntVector.fromArray(INTS, each.hasDecided, i)).intoArray(each.hasDecided, i);
    }
  }

  // The response to commanded velocities is linear: position and velocity are those without the
  // commands under way, plus each such command's change times its step response, s(t) = t − lag·(1 −
  // r(t)) and 1 − r(t), where r(t) = exp(−t / lag), from the time on at which it acts. With
  // r(end − at) = exp(−end / lag) · growth(at) one exponential serves all commands. What a world
  // computes depends on its own commands alone, to the bit: those of others only decide whether
  // zeros are added.

  /** Flies on to a row's question. */
  private void advance(int step) {
    for (int number = firstBeat; number < beat; number++) {
      int slot = number % slots;
      double age = (step - rowOf[slot]) * timing.periodS();
      youngerS[slot] = rowOf[slot] == step - 1 ? -FUTURE : ageS[slot];
      ageS[slot] = (float) age;
      agedDecay[slot] = (float) StrictMath.exp(-age / model.lagS());
    }
    for (Vehicles each : both) {
      pass(each);
      glide(each);
      for (int number = firstBeat; number < beat; number++)
        if (soonest[number % slots] <= ageS[number % slots]) feel(each, number % slots);
    }
    while (firstBeat < beat && latest[firstBeat % slots] <= ageS[firstBeat % slots]) firstBeat++;
  }

  private void pass(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector.fromArray(SPECIES, each.decidedBefore, i)
          .add(period)
          .intoArray(each.decidedBefore, i);
      IntVector.fromArray(INTS, each.turnAt, i).sub(periodGrains).max(PAST).intoArray(each.turnAt, i);
      IntVector.fromArray(INTS, each.freeAt, i).sub(periodGrains).max(PAST).intoArray(each.freeAt, i);
      IntVector.fromArray(INTS, each.reachesAt, i)
          .sub(periodGrains)
          .max(PAST)
          .intoArray(each.reachesAt, i);
    }
  }

  /** Flies one period, without the commands that begin to act in it. */
  private void glide(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector wantedX = FloatVector.fromArray(SPECIES, each.wantedX, i);
      FloatVector wantedY = FloatVector.fromArray(SPECIES, each.wantedY, i);
      FloatVector offX = FloatVector.fromArray(SPECIES, each.vx, i).sub(wantedX);
      FloatVector offY = FloatVector.fromArray(SPECIES, each.vy, i).sub(wantedY);
      offX.fma(periodGain, wantedX.fma(period, FloatVector.fromArray(SPECIES, each.x, i)))
          .intoArray(each.x, i);
      offY.fma(periodGain, wantedY.fma(period, FloatVector.fromArray(SPECIES, each.y, i)))
          .intoArray(each.y, i);
      offX.fma(periodDecay, wantedX).intoArray(each.vx, i);
      offY.fma(periodDecay, wantedY).intoArray(each.vy, i);
    }
  }

  /** Adds what a command changes where it began to act in the last period. */
  private void feel(Vehicles each, int slot) {
    FloatVector age = constant(ageS[slot]),
        younger = constant(youngerS[slot]),
        aged = constant(agedDecay[slot]);
    int from = slot * WORLDS;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector at = FloatVector.fromArray(SPECIES, each.at, from + i);
      VectorMask<Float> begins = at.compare(LE, age).and(at.compare(GT, younger));
      FloatVector caughtUp =
          ONE.sub(FloatVector.fromArray(SPECIES, each.growth, from + i).mul(aged));
      FloatVector response = age.sub(at).sub(caughtUp.mul(lag));
      FloatVector changeX =
              ZERO.blend(FloatVector.fromArray(SPECIES, each.changeX, from + i), begins),
          changeY = ZERO.blend(FloatVector.fromArray(SPECIES, each.changeY, from + i), begins);
      changeX.fma(response, FloatVector.fromArray(SPECIES, each.x, i)).intoArray(each.x, i);
      changeY.fma(response, FloatVector.fromArray(SPECIES, each.y, i)).intoArray(each.y, i);
      changeX.fma(caughtUp, FloatVector.fromArray(SPECIES, each.vx, i)).intoArray(each.vx, i);
      changeY.fma(caughtUp, FloatVector.fromArray(SPECIES, each.vy, i)).intoArray(each.vy, i);
      changeX.add(FloatVector.fromArray(SPECIES, each.wantedX, i)).intoArray(each.wantedX, i);
      changeY.add(FloatVector.fromArray(SPECIES, each.wantedY, i)).intoArray(each.wantedY, i);
    }
  }

  /** Where the beat's pictures show the vehicles. */
  private void see(Vehicles each, int step) {
    boolean withVelocity = evader.policy.needsVelocity() || pursuer.policy.needsVelocity();
    if (pictures.hasOld) each.keepSeen();
    look(each);
    if (withVelocity) lookAtVelocity(each);
    if (pictures.hasEarly) lookBack(each, step, withVelocity);
    if (pictures.hasOld) each.restoreSeen(pictures.isFresh[each.role]);
  }

  /** Where the vehicles are when the beat's questions reach them. */
  private void look(Vehicles each) {
    time(pictures.sampledAt[each.role]);
    LaneMath.exp(decay, 0, WORLDS);
    place(each);
  }

  private void place(Vehicles each) {
    extrapolate(each);
    for (int number = firstBeat; number < beat; number++)
      if (isInSight(number % slots)) look(each, number % slots);
  }

  private void time(int[] sampledAt) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector end =
          ((FloatVector)
                  IntVector.fromArray(INTS, sampledAt, i)
                      .convertShape(VectorOperators.I2F, SPECIES, 0))
              .mul(GRAIN_S);
      end.intoArray(lookAt, i);
      end.mul(decayRate).intoArray(decay, i);
    }
  }

  /** Without the commands that begin to act before. */
  private void extrapolate(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector end = FloatVector.fromArray(SPECIES, lookAt, i);
      FloatVector r = FloatVector.fromArray(SPECIES, decay, i);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, each.wantedX, i);
      FloatVector wantedY = FloatVector.fromArray(SPECIES, each.wantedY, i);
      FloatVector gain = lag.mul(ONE.sub(r));
      FloatVector offX = FloatVector.fromArray(SPECIES, each.vx, i).sub(wantedX);
      FloatVector offY = FloatVector.fromArray(SPECIES, each.vy, i).sub(wantedY);
      FloatVector x = offX.fma(gain, wantedX.fma(end, FloatVector.fromArray(SPECIES, each.x, i)));
      FloatVector y = offY.fma(gain, wantedY.fma(end, FloatVector.fromArray(SPECIES, each.y, i)));
      x.intoArray(each.seenX, i);
      y.intoArray(each.seenY, i);
    }
  }

  /** Whether a command may act before a reading of the beat is taken. */
  private boolean isInSight(int slot) {
    return soonest[slot] - ageS[slot] < pictures.latestSampleS;
  }

  /** Adds what a command changes until a vehicle is looked at. */
  private void look(Vehicles each, int slot) {
    FloatVector age = constant(ageS[slot]), aged = constant(agedDecay[slot]);
    int from = slot * WORLDS;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector wait = FloatVector.fromArray(SPECIES, each.at, from + i).sub(age);
      FloatVector acted = FloatVector.fromArray(SPECIES, lookAt, i).sub(wait);
      // What acts at the row's question is in the state.
      VectorMask<Float> acts = wait.compare(GT, ZERO).and(acted.compare(GT, ZERO));
      FloatVector remains =
          FloatVector.fromArray(SPECIES, each.growth, from + i)
              .mul(aged)
              .mul(FloatVector.fromArray(SPECIES, decay, i));
      FloatVector response = ZERO.blend(remains.fma(lag, acted.sub(lag)), acts);
      FloatVector.fromArray(SPECIES, each.changeX, from + i)
          .fma(response, FloatVector.fromArray(SPECIES, each.seenX, i))
          .intoArray(each.seenX, i);
      FloatVector.fromArray(SPECIES, each.changeY, from + i)
          .fma(response, FloatVector.fromArray(SPECIES, each.seenY, i))
          .intoArray(each.seenY, i);
    }
  }

  /** How fast the vehicles fly when the beat's questions reach them. */
  private void lookAtVelocity(Vehicles each) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector r = FloatVector.fromArray(SPECIES, decay, i);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, each.wantedX, i);
      FloatVector wantedY = FloatVector.fromArray(SPECIES, each.wantedY, i);
      FloatVector.fromArray(SPECIES, each.vx, i)
          .sub(wantedX)
          .fma(r, wantedX)
          .intoArray(each.seenVx, i);
      FloatVector.fromArray(SPECIES, each.vy, i)
          .sub(wantedY)
          .fma(r, wantedY)
          .intoArray(each.seenVy, i);
    }
    for (int number = firstBeat; number < beat; number++)
      if (isInSight(number % slots)) lookAtVelocity(each, number % slots);
  }

  private void lookAtVelocity(Vehicles each, int slot) {
    FloatVector age = constant(ageS[slot]), aged = constant(agedDecay[slot]);
    int from = slot * WORLDS;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector wait = FloatVector.fromArray(SPECIES, each.at, from + i).sub(age);
      VectorMask<Float> acts =
          wait.compare(GT, ZERO).and(wait.compare(LT, FloatVector.fromArray(SPECIES, lookAt, i)));
      FloatVector remains =
          FloatVector.fromArray(SPECIES, each.growth, from + i)
              .mul(aged)
              .mul(FloatVector.fromArray(SPECIES, decay, i));
      FloatVector caughtUp = ZERO.blend(ONE.sub(remains), acts);
      FloatVector.fromArray(SPECIES, each.changeX, from + i)
          .fma(caughtUp, FloatVector.fromArray(SPECIES, each.seenVx, i))
          .intoArray(each.seenVx, i);
      FloatVector.fromArray(SPECIES, each.changeY, from + i)
          .fma(caughtUp, FloatVector.fromArray(SPECIES, each.seenVy, i))
          .intoArray(each.seenVy, i);
    }
  }

  /** Takes commands back that had not acted when an early reading was taken. */
  private void lookBack(Vehicles each, int step, boolean withVelocity) {
    int[] isFresh = pictures.isFresh[each.role], sampledAt = pictures.sampledAt[each.role];
    for (int world = 0; world < WORLDS; world++)
      if (isFresh[world] != 0 && sampledAt[world] < 0) {
        float end = sampledAt[world] * (DelayTable.GrainNs() * 1e-9f);
        for (int number = beat - 1; number >= 0 && number >= beat - slots; number--) {
          int slot = number % slots, from = slot * WORLDS + world;
          float wait = each.at[from] - (float) ((step - rowOf[slot]) * timing.periodS());
          float acted = end - wait;
          if (wait <= 0 && acted < 0 && rowOf[slot] < step) {
            float caughtUp = (float) -StrictMath.expm1(-acted / lagS), response = acted - lagS * caughtUp;
            each.seenX[world] -= each.changeX[from] * response;
            each.seenY[world] -= each.changeY[from] * response;
            if (withVelocity) {
              each.seenVx[world] -= each.changeX[from] * caughtUp;
              each.seenVy[world] -= each.changeY[from] * caughtUp;
            }
          }
        }
      }
  }

  /** The distance at a row's question. */
  private void score(int step) {
    boolean last = step > steps - lastSteps;
    FloatVector time = constant((float) (step * timing.periodS())),
        captureRadius = constant(captureRadiusM);
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
