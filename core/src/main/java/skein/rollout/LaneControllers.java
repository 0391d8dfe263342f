package skein.rollout;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.EXP_2;
import static skein.rollout.LaneMath.EXP_3;
import static skein.rollout.LaneMath.EXP_4;
import static skein.rollout.LaneMath.EXP_5;
import static skein.rollout.LaneMath.EXP_6;
import static skein.rollout.LaneMath.EXP_7;
import static skein.rollout.LaneMath.INTS;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.LN_2_1;
import static skein.rollout.LaneMath.LN_2_2;
import static skein.rollout.LaneMath.LOG2_E;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.ROUND;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;

/**
 * The controllers of the vehicles of one role in many worlds, as {@code skein.flow.Pace} and {@code
 * skein.flow.Steer} let them: when each decides, upon which sight, and when its command acts. Times
 * are in {@link DelayTable#GrainNs} from the row's question.
 */
final class LaneControllers {
  private static final int WORLDS = LanePolicy.WORLDS;
  private static final FloatVector GRAIN_S = constant(LanePictures.GRAIN_S);

  /** In the place of the time since the last decision, s: it never decided. */
  private static final float LONG_AGO = 1e9f;

  private static final int LONG_PAST = -1_000_000_000;
  private static final FloatVector UNDECIDED = constant(LONG_AGO / 2);
  private static final IntVector PAST = IntVector.broadcast(INTS, LONG_PAST),
      NEVER = IntVector.broadcast(INTS, LanePictures.NONE);

  final LagVehicles vehicles;
  final LanePolicy policy;
  private final float startHeading, periodS;
  private final int periodGrains;
  private final FloatVector speed, growthRate;
  private final IntVector interval, handover, dead;

  // When it may decide and be commanded again, when the last command reaches it, when it decides.
  private final int[] times = new int[3 * WORLDS];

  private static final int READY = 0, REACHES = WORLDS, DECIDES = 2 * WORLDS;

  /** How long before the row's question it decided, s. */
  private final float[] decidedBefore = new float[WORLDS];

  private final LaneSight sight = new LaneSight();
  final Directions sent = new Directions(WORLDS);
  private final Directions decided = new Directions(WORLDS);

  /** The sum of the decided headings' changes. */
  private final float[] effort;

  /**
   * @param effort where the sums of the decided headings' changes go, rad
   */
  LaneControllers(
      Duelist duelist,
      LoopTiming.Stream timing,
      Reduced model,
      LagVehicles vehicles,
      LanePolicy policy,
      float[] effort) {
    this.vehicles = vehicles;
    this.policy = policy;
    this.effort = effort;
    startHeading = (float) duelist.startHeadingRad();
    speed = constant((float) (duelist.speed() * model.gain()));
    growthRate = constant((float) (1 / model.lagS()));
    periodS = (float) timing.periodS();
    periodGrains = LanePictures.grains(timing.periodS());
    interval =
        grains(
            Math.max(timing.periodS() - timing.toleranceS(), timing.steering().minIntervalS()));
    handover = grains(timing.steering().handoverS());
    dead = grains(model.deadTimeS());
  }

  private static IntVector grains(double seconds) {
    return IntVector.broadcast(INTS, LanePictures.grains(seconds));
  }

  void start() {
    Arrays.fill(times, 0);
    Arrays.fill(decidedBefore, LONG_AGO);
    Arrays.fill(effort, 0f);
    sent.fill(0, WORLDS, startHeading);
    policy.start(startHeading);
  }

  /** Decide where it is their turn. */
  void decide(LaneControllers opponents, LanePictures pictures) {
    look(opponents.vehicles, pictures.joinedAt, pictures.nextAt);
    if (policy.needsVelocity()) lookAtVelocity(opponents.vehicles);
    policy.decide(sight, sent, 0, opponents.sent, 0, decided, 0);
  }

  /**
   * When each decides, unless a newer picture comes before; how long it waited; and the opponent as
   * the readings show it.
   */
  private void look(LagVehicles opponents, int[] joinedAt, int[] nextAt) {
    float[] ours = vehicles.state, theirs = opponents.state;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector when =
          IntVector.fromArray(INTS, joinedAt, i)
              .max(IntVector.fromArray(INTS, times, READY + i));
      VectorMask<Integer> decides = when.compare(LT, IntVector.fromArray(INTS, nextAt, i));
      NEVER.blend(when, decides).intoArray(times, DECIDES + i);
      FloatVector time = (FloatVector) when.convertShape(VectorOperators.I2F, SPECIES, 0);
      FloatVector before = FloatVector.fromArray(SPECIES, decidedBefore, i);
      ZERO.blend(time.fma(GRAIN_S, before), before.compare(LT, UNDECIDED))
          .intoArray(sight.elapsed, i);
      FloatVector.fromArray(SPECIES, theirs, LagVehicles.SEEN_X + i)
          .sub(FloatVector.fromArray(SPECIES, ours, LagVehicles.SEEN_X + i))
          .intoArray(sight.dx, i);
      FloatVector.fromArray(SPECIES, theirs, LagVehicles.SEEN_Y + i)
          .sub(FloatVector.fromArray(SPECIES, ours, LagVehicles.SEEN_Y + i))
          .intoArray(sight.dy, i);
    }
  }

  private void lookAtVelocity(LagVehicles opponents) {
    float[] ours = vehicles.state, theirs = opponents.state;
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector.fromArray(SPECIES, theirs, LagVehicles.SEEN_VX + i)
          .sub(FloatVector.fromArray(SPECIES, ours, LagVehicles.SEEN_VX + i))
          .intoArray(sight.dvx, i);
      FloatVector.fromArray(SPECIES, theirs, LagVehicles.SEEN_VY + i)
          .sub(FloatVector.fromArray(SPECIES, ours, LagVehicles.SEEN_VY + i))
          .intoArray(sight.dvy, i);
    }
  }

  /**
   * Command what was decided.
   *
   * @param delay of each command
   * @param backDelay of the answer to the command before
   * @param end of the episode
   * @param isLast whether the next beat is of the next row
   */
  void command(int row, int[] delay, int[] backDelay, int end, boolean isLast) {
    int slot = vehicles.slotOf(row);
    send(delay, backDelay, end, isLast ? periodGrains : 0, isLast ? periodS : 0, slot);
  }

  private void send(int[] delay, int[] backDelay, int endGrains, int toNextGrains, float toNextSeconds, int slot) {
    IntVector soonest = IntVector.broadcast(INTS, LanePictures.NONE),
        latest = IntVector.broadcast(INTS, LONG_PAST);
    IntVector end = IntVector.broadcast(INTS, endGrains),
        toNext = IntVector.broadcast(INTS, toNextGrains);
    FloatVector toNextS = constant(toNextSeconds);
    float[] commands = vehicles.commands;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector when = IntVector.fromArray(INTS, times, DECIDES + i);
      VectorMask<Integer> decides = when.compare(LT, NEVER);
      VectorMask<Float> yes = decides.cast(SPECIES);
      FloatVector before = FloatVector.fromArray(SPECIES, decidedBefore, i);
      VectorMask<Float> hasDecided = before.compare(LT, UNDECIDED);
      IntVector reachedBefore = IntVector.fromArray(INTS, times, REACHES + i);
      // Commands to one vehicle keep their order.
      IntVector reaches = when.add(IntVector.fromArray(INTS, delay, i)).max(reachedBefore);
      IntVector actsAt = reaches.add(dead);
      soonest = soonest.min(NEVER.blend(actsAt, decides));
      latest = latest.max(PAST.blend(actsAt, decides));
      FloatVector acts =
          ZERO.blend(
              ((FloatVector) actsAt.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(GRAIN_S),
              yes);
      acts.intoArray(commands, slot + LagVehicles.AT + i);
      FloatVector exponent = acts.mul(growthRate);
      FloatVector rounded = exponent.fma(LOG2_E, ROUND);
      FloatVector power = rounded.sub(ROUND);
      FloatVector rest = power.fma(LN_2_2, power.fma(LN_2_1, exponent));
      FloatVector series =
          rest.fma(EXP_7, EXP_6)
              .fma(rest, EXP_5)
              .fma(rest, EXP_4)
              .fma(rest, EXP_3)
              .fma(rest, EXP_2)
              .fma(rest.mul(rest), rest.add(ONE));
      series
          .reinterpretAsInts()
          .add(rounded.reinterpretAsInts().lanewise(VectorOperators.LSHL, 23))
          .reinterpretAsFloats()
          .intoArray(commands, slot + LagVehicles.GROWTH + i);
      // The command before is acknowledged when this one has replaced it; the very first replaces
      // none.
      IntVector ready = when.add(interval);
      IntVector acknowledged =
          reaches.add(IntVector.fromArray(INTS, backDelay, i)).add(handover).max(ready);
      ready = ready.blend(acknowledged, hasDecided.cast(INTS));
      reachedBefore.blend(reaches, decides).sub(toNext).max(PAST).intoArray(times, REACHES + i);
      IntVector.fromArray(INTS, times, READY + i)
          .blend(ready, decides)
          .sub(toNext)
          .max(PAST)
          .intoArray(times, READY + i);
      FloatVector time = (FloatVector) when.convertShape(VectorOperators.I2F, SPECIES, 0);
      before.blend(time.mul(GRAIN_S).neg(), yes).add(toNextS).intoArray(decidedBefore, i);
      FloatVector spent = FloatVector.fromArray(SPECIES, effort, i);
      spent
          .add(FloatVector.fromArray(SPECIES, policy.turned, i), when.compare(LT, end).cast(SPECIES))
          .intoArray(effort, i);
      FloatVector heading = FloatVector.fromArray(SPECIES, policy.heading, i);
      heading
          .blend(FloatVector.fromArray(SPECIES, policy.newHeading, i), yes)
          .intoArray(policy.heading, i);
      // Before the first command the vehicle rests, whatever its heading.
      FloatVector cos = FloatVector.fromArray(SPECIES, sent.cos, i),
          sin = FloatVector.fromArray(SPECIES, sent.sin, i);
      FloatVector newCos = cos.blend(FloatVector.fromArray(SPECIES, decided.cos, i), yes),
          newSin = sin.blend(FloatVector.fromArray(SPECIES, decided.sin, i), yes);
      ZERO.blend(newCos.sub(ZERO.blend(cos, hasDecided)), yes)
          .mul(speed)
          .intoArray(commands, slot + LagVehicles.CHANGE_X + i);
      ZERO.blend(newSin.sub(ZERO.blend(sin, hasDecided)), yes)
          .mul(speed)
          .intoArray(commands, slot + LagVehicles.CHANGE_Y + i);
      newCos.intoArray(sent.cos, i);
      newSin.intoArray(sent.sin, i);
    }
    vehicles.send(
        soonest.reduceLanes(VectorOperators.MIN) * LanePictures.GRAIN_S,
        latest.reduceLanes(VectorOperators.MAX) * LanePictures.GRAIN_S);
  }
}
