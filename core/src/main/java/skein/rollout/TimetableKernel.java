package skein.rollout;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.PI;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;

/**
 * Flies many candidates through one episode, by its {@link Timetable}: the duel of the paper's
 * pursuer and evader with vehicles of first-order lag, exactly integrated between commands, under
 * any loop's timing. {@link Rollout} with the same delays and a {@code Reduced} model is its scalar
 * reference.
 *
 * <p>What happens when is the same in all lanes, so that exponentials and everything else about
 * time are numbers of the timetable. A vehicle's state is kept as at the last command that acted:
 * position, the velocity asked for, and the velocity's error, which dies away. Nothing is allocated
 * after construction but where a timetable needs more places than any before; one instance per
 * thread.
 */
public final class TimetableKernel {
  /** Worlds flown together. A multiple of every lane count. */
  public static final int WORLDS = 128;

  private static final FloatVector MINUS_ONE = constant(-1f),
      QUARTER = constant(0.25f);
  private static final FloatVector INFINITE = constant(Float.POSITIVE_INFINITY);
  private static final FloatVector PER_TURN = constant((float) (0.5 / Math.PI)),
      MINUS_TURN = constant((float) (-2 * Math.PI)),
      MINUS_TWO = constant(-2f);

  /** 1.5·2²³: adding it and taking it away leaves a float's nearest integer. */
  private static final FloatVector ROUND = constant(12582912f);

  // arccos h = √(1 − h) · polynomial on 0…1, error below 2e-8: Abramowitz and Stegun, 4.4.46.
  private static final FloatVector ACOS_0 = constant(1.5707963050f),
      ACOS_1 = constant(-0.2145988016f),
      ACOS_2 = constant(0.0889789874f),
      ACOS_3 = constant(-0.0501743046f),
      ACOS_4 = constant(0.0308918810f),
      ACOS_5 = constant(-0.0170881256f),
      ACOS_6 = constant(0.0066700901f),
      ACOS_7 = constant(-0.0012624911f);

  /** Kinds of a timetable's operations. */
  static final int LOOK = 0, DECIDE = 1, ACT = 2, SCORE = 3;

  private static final int EVADER = 0;
  private final int steps, lastSteps;
  private final Vehicles evader, pursuer;

  // Per world: parameters of the policies, and what the episode came to.
  private final float[] turnRate = new float[WORLDS], turnStep = new float[WORLDS];
  private final float[] radius = new float[WORLDS];
  private final float[] heading = new float[WORLDS];
  private final float[] sum = new float[WORLDS], lastSum = new float[WORLDS];

  // Between the passes of one operation.
  private final float[] ahead = new float[WORLDS], right = new float[WORLDS];
  private final float[] newCos = new float[WORLDS], newSin = new float[WORLDS];
  private final float[] chordSquare = new float[WORLDS], distance = new float[WORLDS];

  /** All worlds' vehicles of one role. */
  private static final class Vehicles {
    final float startX, startY, startHeading;
    final FloatVector speed;
    final float[] x = new float[WORLDS],
        y = new float[WORLDS],
        askedX = new float[WORLDS],
        askedY = new float[WORLDS],
        errorX = new float[WORLDS],
        errorY = new float[WORLDS];

    /** Readings and decided directions, by place. */
    float[] seenX = {}, seenY = {}, cos = {}, sin = {};

    Vehicles(Duelist duelist, double gain) {
      startX = (float) duelist.startX();
      startY = (float) duelist.startY();
      startHeading = (float) duelist.startHeadingRad();
      speed = constant((float) (duelist.speed() * gain));
    }

    void start(Timetable timetable) {
      if (seenX.length < timetable.readings() * WORLDS) {
        seenX = new float[timetable.readings() * WORLDS];
        seenY = new float[timetable.readings() * WORLDS];
      }
      if (cos.length < timetable.headings() * WORLDS) {
        cos = new float[timetable.headings() * WORLDS];
        sin = new float[timetable.headings() * WORLDS];
      }
      Arrays.fill(x, startX);
      Arrays.fill(y, startY);
      for (float[] zero : new float[][] {askedX, askedY, errorX, errorY}) Arrays.fill(zero, 0f);
      // The timetable keeps the first heading at place 0.
      Arrays.fill(cos, 0, WORLDS, (float) Math.cos(startHeading));
      Arrays.fill(sin, 0, WORLDS, (float) Math.sin(startHeading));
    }
  }

  /**
   * Distances of the worlds flown last, m: the smallest, the mean, and the mean of the last 10 s.
   */
  public final float[] minDistance = new float[WORLDS],
      meanDistance = new float[WORLDS],
      meanLast10s = new float[WORLDS];

  /** When the distance first was within the capture radius, s; infinite where it never was. */
  public final float[] captureS = new float[WORLDS];

  /** The sums of all changes of the commanded headings, by the shorter way, rad. */
  public final float[] pursuerEffortRad = new float[WORLDS], evaderEffortRad = new float[WORLDS];

  /**
   * @param duel start, speeds and duration; its policies are not used
   * @param model lag above 0; the same as the timetables'
   */
  public TimetableKernel(Duel duel, LoopTiming timing, Reduced model) {
    if (!(model.lagS() > 0))
      throw new IllegalArgumentException("the kernel needs a lag above 0, got " + model.lagS());
    steps = (int) Math.round(duel.durationS() / timing.periodS());
    lastSteps = Math.min(steps, (int) Math.round(10 / timing.periodS()));
    evader = new Vehicles(duel.evader(), model.gain());
    pursuer = new Vehicles(duel.pursuer(), model.gain());
  }

  /**
   * Flies {@link #WORLDS} candidates through one episode.
   *
   * @param turnRates of each pursuer, rad/s ({@code PaperPursuer})
   * @param turnSteps by which each pursuer turns at every decision besides, rad
   * @param radii that each evader assumes, m ({@code PaperEvader})
   * @param captureRadiusM a distance of at most this is a capture
   */
  void fly(
      Timetable timetable,
      float[] turnRates,
      float[] turnSteps,
      float[] radii,
      float captureRadiusM) {
    System.arraycopy(turnRates, 0, turnRate, 0, WORLDS);
    System.arraycopy(turnSteps, 0, turnStep, 0, WORLDS);
    System.arraycopy(radii, 0, radius, 0, WORLDS);
    evader.start(timetable);
    pursuer.start(timetable);
    Arrays.fill(heading, pursuer.startHeading);
    Arrays.fill(minDistance, Float.POSITIVE_INFINITY);
    Arrays.fill(captureS, Float.POSITIVE_INFINITY);
    for (float[] zero : new float[][] {sum, lastSum, pursuerEffortRad, evaderEffortRad})
      Arrays.fill(zero, 0f);
    FloatVector captureRadius = constant(captureRadiusM);
    int[] operations = timetable.operations();
    float[] times = timetable.times();
    for (int i = 0; i < timetable.size(); i++) {
      int field = i * Timetable.Fields(), number = i * Timetable.Numbers();
      Vehicles vehicle = operations[field + 1] == EVADER ? evader : pursuer;
      int place = operations[field + 2] * WORLDS;
      switch (operations[field]) {
        case LOOK -> look(vehicle, place, times[number], times[number + 1]);
        case ACT -> act(vehicle, place, times[number], times[number + 1], times[number + 2]);
        case SCORE -> {
          score(times[number], times[number + 1], times[number + 2], times[number + 3]);
          keep(place != 0, Float.intBitsToFloat(operations[field + 3]), captureRadius);
        }
        default -> {
          relate(
              place,
              operations[field + 3] * WORLDS,
              vehicle == pursuer ? operations[field + 5] * WORLDS : operations[field + 4] * WORLDS);
          if (vehicle == pursuer) turn(times[number], operations[field + 6] * WORLDS);
          else
            evade(
                operations[field + 4] * WORLDS,
                operations[field + 5] * WORLDS,
                operations[field + 6] * WORLDS);
        }
      }
    }
    for (int i = 0; i < WORLDS; i++) {
      meanDistance[i] = sum[i] / steps;
      meanLast10s[i] = lastSum[i] / lastSteps;
    }
  }

  /** Where a vehicle is {@code dtS} after its state, as an answer will tell it. */
  private void look(Vehicles each, int place, float dtS, float gainS) {
    FloatVector dt = constant(dtS), gain = constant(gainS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, each.askedX, i)
              .fma(dt, FloatVector.fromArray(SPECIES, each.x, i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, each.askedY, i)
              .fma(dt, FloatVector.fromArray(SPECIES, each.y, i));
      FloatVector.fromArray(SPECIES, each.errorX, i)
          .fma(gain, x)
          .intoArray(each.seenX, place + i);
      FloatVector.fromArray(SPECIES, each.errorY, i)
          .fma(gain, y)
          .intoArray(each.seenY, place + i);
    }
  }

  /** Flies a vehicle for {@code dtS} and lets a command act from there on. */
  private void act(Vehicles each, int place, float dtS, float gainS, float keepShare) {
    FloatVector dt = constant(dtS), gain = constant(gainS), keep = constant(keepShare);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector askedX = FloatVector.fromArray(SPECIES, each.askedX, i);
      FloatVector errorX = FloatVector.fromArray(SPECIES, each.errorX, i);
      FloatVector newX = FloatVector.fromArray(SPECIES, each.cos, place + i).mul(each.speed);
      errorX
          .fma(gain, askedX.fma(dt, FloatVector.fromArray(SPECIES, each.x, i)))
          .intoArray(each.x, i);
      errorX.fma(keep, askedX.sub(newX)).intoArray(each.errorX, i);
      newX.intoArray(each.askedX, i);
      FloatVector askedY = FloatVector.fromArray(SPECIES, each.askedY, i);
      FloatVector errorY = FloatVector.fromArray(SPECIES, each.errorY, i);
      FloatVector newY = FloatVector.fromArray(SPECIES, each.sin, place + i).mul(each.speed);
      errorY
          .fma(gain, askedY.fma(dt, FloatVector.fromArray(SPECIES, each.y, i)))
          .intoArray(each.y, i);
      errorY.fma(keep, askedY.sub(newY)).intoArray(each.errorY, i);
      newY.intoArray(each.askedY, i);
    }
  }

  /** The evader as the readings show it, in the frame of the pursuer on a heading. */
  private void relate(int evaderSeen, int pursuerSeen, int frame) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, evader.seenX, evaderSeen + i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.seenX, pursuerSeen + i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, evader.seenY, evaderSeen + i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.seenY, pursuerSeen + i));
      FloatVector c = FloatVector.fromArray(SPECIES, pursuer.cos, frame + i),
          s = FloatVector.fromArray(SPECIES, pursuer.sin, frame + i);
      x.fma(c, y.mul(s)).intoArray(ahead, i);
      y.fma(c, x.mul(s).neg()).intoArray(right, i);
    }
  }

  /** {@code PaperPursuer}. */
  private void turn(float elapsedS, int place) {
    FloatVector elapsed = constant(elapsedS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, right, i);
      FloatVector side = ZERO.blend(ONE, x.compare(LT, ZERO));
      side = side.blend(ONE, y.compare(GT, ZERO)).blend(MINUS_ONE, y.compare(LT, ZERO));
      FloatVector change =
          FloatVector.fromArray(SPECIES, turnRate, i)
              .fma(elapsed, FloatVector.fromArray(SPECIES, turnStep, i))
              .mul(side);
      change.add(FloatVector.fromArray(SPECIES, heading, i)).intoArray(heading, i);
      change
          .fma(PER_TURN, ROUND)
          .sub(ROUND)
          .fma(MINUS_TURN, change)
          .abs()
          .add(FloatVector.fromArray(SPECIES, pursuerEffortRad, i))
          .intoArray(pursuerEffortRad, i);
    }
    LaneMath.sinCos(heading, newSin, newCos, WORLDS);
    System.arraycopy(newSin, 0, pursuer.sin, place, WORLDS);
    System.arraycopy(newCos, 0, pursuer.cos, place, WORLDS);
  }

  /**
   * {@code PaperEvader}: no angle is needed, for the heading of atan2(y, x) in a frame is the
   * direction of (x, y) there.
   */
  private void evade(int frame, int before, int place) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, ahead, i),
          y = FloatVector.fromArray(SPECIES, right, i),
          r = FloatVector.fromArray(SPECIES, radius, i);
      FloatVector xSquare = x.mul(x), rSquare = r.mul(r);
      FloatVector toLeft = y.sub(r), toRight = y.add(r);
      VectorMask<Float> inRight = toLeft.fma(toLeft, xSquare).compare(LT, rSquare);
      VectorMask<Float> inLeft = toRight.fma(toRight, xSquare).compare(LT, rSquare);
      VectorMask<Float> breakAway =
          y.fma(y, xSquare).mul(QUARTER).compare(LT, rSquare).andNot(inLeft.or(inRight));
      FloatVector aim = y.blend(toLeft, inLeft).blend(toRight, inRight);
      FloatVector length = aim.fma(aim, xSquare).sqrt();
      // At the very place of the pursuer the angle counts as 0.
      VectorMask<Float> none = length.compare(EQ, ZERO);
      FloatVector scale = ONE.div(length.blend(ONE, none));
      FloatVector front = x.blend(ONE, none).mul(scale), side = aim.mul(scale);
      FloatVector forward = front.blend(side.neg(), breakAway), aside = side.blend(front, breakAway);
      FloatVector c = FloatVector.fromArray(SPECIES, pursuer.cos, frame + i),
          s = FloatVector.fromArray(SPECIES, pursuer.sin, frame + i);
      FloatVector cos = forward.fma(c, aside.mul(s).neg()),
          sin = forward.fma(s, aside.mul(c));
      FloatVector changeX = cos.sub(FloatVector.fromArray(SPECIES, evader.cos, before + i)),
          changeY = sin.sub(FloatVector.fromArray(SPECIES, evader.sin, before + i));
      changeX.fma(changeX, changeY.mul(changeY)).intoArray(chordSquare, i);
      cos.intoArray(evader.cos, place + i);
      sin.intoArray(evader.sin, place + i);
    }
    // Two directions a chord apart are at an angle of 2 arcsin(chord / 2) = π − 2 arccos(chord / 2).
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector half = FloatVector.fromArray(SPECIES, chordSquare, i).mul(QUARTER).sqrt().min(ONE);
      FloatVector series =
          half.fma(ACOS_7, ACOS_6)
              .fma(half, ACOS_5)
              .fma(half, ACOS_4)
              .fma(half, ACOS_3)
              .fma(half, ACOS_2)
              .fma(half, ACOS_1)
              .fma(half, ACOS_0);
      ONE.sub(half)
          .sqrt()
          .mul(series)
          .fma(MINUS_TWO, PI)
          .add(FloatVector.fromArray(SPECIES, evaderEffortRad, i))
          .intoArray(evaderEffortRad, i);
    }
  }

  /** The distance so long after the two vehicles' states. */
  private void score(float evaderS, float evaderGainS, float pursuerS, float pursuerGainS) {
    FloatVector evaderDt = constant(evaderS), evaderGain = constant(evaderGainS);
    FloatVector pursuerDt = constant(-pursuerS), pursuerGain = constant(-pursuerGainS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, evader.x, i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.x, i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, evader.y, i)
              .sub(FloatVector.fromArray(SPECIES, pursuer.y, i));
      x = FloatVector.fromArray(SPECIES, evader.askedX, i).fma(evaderDt, x);
      y = FloatVector.fromArray(SPECIES, evader.askedY, i).fma(evaderDt, y);
      x = FloatVector.fromArray(SPECIES, evader.errorX, i).fma(evaderGain, x);
      y = FloatVector.fromArray(SPECIES, evader.errorY, i).fma(evaderGain, y);
      x = FloatVector.fromArray(SPECIES, pursuer.askedX, i).fma(pursuerDt, x);
      y = FloatVector.fromArray(SPECIES, pursuer.askedY, i).fma(pursuerDt, y);
      x = FloatVector.fromArray(SPECIES, pursuer.errorX, i).fma(pursuerGain, x);
      y = FloatVector.fromArray(SPECIES, pursuer.errorY, i).fma(pursuerGain, y);
      x.fma(x, y.mul(y)).sqrt().intoArray(distance, i);
    }
  }

  private void keep(boolean isLast, float timeS, FloatVector captureRadius) {
    FloatVector time = constant(timeS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector now = FloatVector.fromArray(SPECIES, distance, i);
      FloatVector least = FloatVector.fromArray(SPECIES, minDistance, i);
      least.blend(now, now.compare(LT, least)).intoArray(minDistance, i);
      FloatVector.fromArray(SPECIES, sum, i).add(now).intoArray(sum, i);
      if (isLast) FloatVector.fromArray(SPECIES, lastSum, i).add(now).intoArray(lastSum, i);
      INFINITE
          .blend(time, now.compare(LE, captureRadius))
          .min(FloatVector.fromArray(SPECIES, captureS, i))
          .intoArray(captureS, i);
    }
  }
}
