package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.LOG2_E;
import static skein.simd.LaneMath.POWER_1;
import static skein.simd.LaneMath.POWER_2;
import static skein.simd.LaneMath.POWER_3;
import static skein.simd.LaneMath.POWER_4;
import static skein.simd.LaneMath.POWER_5;
import static skein.simd.LaneMath.ROUND;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.Duelist;
import skein.forward.LoopTiming;
import skein.forward.Reduced;
import skein.simd.WorldRandom;

/**
 * The controllers of the vehicles of one role in many worlds, as {@code skein.flow.Pace} and {@code
 * skein.flow.Steer} let them: when each decides, upon which sight, and when its command acts. Times
 * are in {@link DelayTable#GrainNs} from the row's question.
 */
final class LaneControllers {
  private static final int WORLDS = LanePolicy.WORLDS;
  /** In the place of the time since the last decision, s: it never decided. */
  private static final float LONG_AGO = 1e9f;

  /** Times count no longer ago than this. */
  private static final int LONG_PAST = -1_000_000_000;

  final LagVehicles vehicles;
  final LanePolicy policy;
  private final float startHeading, speedMps, lagS, periodS;
  private final int periodGrains, intervalGrains, handoverGrains, deadGrains;

  // When it may decide and be commanded again, when the last command reaches it, when it decides.
  private final int[] times = new int[3 * WORLDS];

  private static final int READY = 0, REACHES = WORLDS, DECIDES = 2 * WORLDS;

  /** How long before the row's question it decided, s. */
  private final float[] decidedBefore = new float[WORLDS];

  private final int[] drawn = new int[2 * LANES];

  private final LaneObservation sight = new LaneObservation();
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
    speedMps = (float) (duelist.speed() * model.gain());
    lagS = (float) model.lagS();
    periodS = (float) timing.periodS();
    periodGrains = LaneViews.grains(timing.periodS());
    intervalGrains =
        LaneViews.grains(
            Math.max(timing.periodS() - timing.toleranceS(), timing.steering().minIntervalS()));
    handoverGrains = LaneViews.grains(timing.steering().handoverS());
    deadGrains = LaneViews.grains(model.deadTimeS());
  }

  void start() {
    Arrays.fill(times, 0);
    Arrays.fill(decidedBefore, LONG_AGO);
    Arrays.fill(effort, 0f);
    sent.fill(0, WORLDS, startHeading);
    policy.start(startHeading);
  }

  /** Decide where it is their turn. */
  void decide(LaneControllers opponents, LaneViews views) {
    look(opponents.vehicles, views.joinedAt, views.nextAt);
    if (policy.needsVelocity()) lookAtVelocity(opponents.vehicles);
    policy.decide(sight, sent, 0, opponents.sent, 0, decided, 0);
  }

  /**
   * When each decides, unless a newer view comes before; how long it waited; and the opponent as
   * the readings show it.
   */
  private void look(LagVehicles opponents, int[] joinedAt, int[] nextAt) {
    float[] ours = vehicles.state, theirs = opponents.state;
    IntVector never = IntVector.broadcast(INTS, LaneViews.NONE);
    FloatVector undecided = FloatVector.broadcast(SPECIES, LONG_AGO / 2),
        grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector when =
          IntVector.fromArray(INTS, joinedAt, i)
              .max(IntVector.fromArray(INTS, times, READY + i));
      VectorMask<Integer> decides = when.compare(LT, IntVector.fromArray(INTS, nextAt, i));
      never.blend(when, decides).intoArray(times, DECIDES + i);
      FloatVector time = (FloatVector) when.convertShape(VectorOperators.I2F, SPECIES, 0);
      FloatVector before = FloatVector.fromArray(SPECIES, decidedBefore, i);
      zero.blend(time.fma(grainS, before), before.compare(LT, undecided))
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
   * @param delays of the commands and of the answers to those before
   * @param line of the commands' delays
   * @param places of the steps that the commands belong to, from the row's
   * @param end of the episode
   * @param isLast whether the next beat is of the next row
   */
  void command(
      int row, LaneDelays delays, int line, int[] places, int end, boolean isLast) {
    int slot = vehicles.slotOf(row);
    int place = LaneDelays.placeOf(row) + line * WorldRandom.STRIDE;
    send(delays, place, places, end, isLast ? periodGrains : 0, isLast ? periodS : 0, slot);
  }

  private void send(
      LaneDelays delays, int place, int[] places, int endGrains, int toNextGrains, float toNextSeconds, int slot) {
    int[] keys = delays.keys, tableOf = delays.tableOf, table = delays.delays;
    IntVector here = IntVector.broadcast(INTS, place),
        next = IntVector.broadcast(INTS, place + WorldRandom.STRIDE),
        multiplier1 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
        multiplier2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2),
        never = IntVector.broadcast(INTS, LaneViews.NONE),
        past = IntVector.broadcast(INTS, LONG_PAST),
        interval = IntVector.broadcast(INTS, intervalGrains),
        handover = IntVector.broadcast(INTS, handoverGrains),
        dead = IntVector.broadcast(INTS, deadGrains),
        end = IntVector.broadcast(INTS, endGrains),
        toNext = IntVector.broadcast(INTS, toNextGrains);
    FloatVector toNextS = FloatVector.broadcast(SPECIES, toNextSeconds),
        speed = FloatVector.broadcast(SPECIES, speedMps),
        doublings = FloatVector.broadcast(SPECIES, LOG2_E / lagS),
        undecided = FloatVector.broadcast(SPECIES, LONG_AGO / 2),
        grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f),
        one = FloatVector.broadcast(SPECIES, 1f),
        round = FloatVector.broadcast(SPECIES, ROUND),
        power1 = FloatVector.broadcast(SPECIES, POWER_1),
        power2 = FloatVector.broadcast(SPECIES, POWER_2),
        power3 = FloatVector.broadcast(SPECIES, POWER_3),
        power4 = FloatVector.broadcast(SPECIES, POWER_4),
        power5 = FloatVector.broadcast(SPECIES, POWER_5);
    float[] commands = vehicles.commands;
    IntVector soonest = never, latest = past;
    for (int i = 0; i < WORLDS; i += LANES) {
      IntVector key = IntVector.fromArray(INTS, keys, i).add(IntVector.fromArray(INTS, places, i)),
          begin = IntVector.fromArray(INTS, tableOf, i);
      IntVector a = key.add(here), b = key.add(next);
      a = a.lanewise(XOR, a.lanewise(LSHR, 16)).mul(multiplier1);
      b = b.lanewise(XOR, b.lanewise(LSHR, 16)).mul(multiplier1);
      a = a.lanewise(XOR, a.lanewise(LSHR, 15)).mul(multiplier2);
      b = b.lanewise(XOR, b.lanewise(LSHR, 15)).mul(multiplier2);
      a.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, 0);
      b.lanewise(LSHR, LaneDelays.DROP).add(begin).intoArray(drawn, LANES);
      IntVector delay = IntVector.fromArray(INTS, table, 0, drawn, 0),
          backDelay = IntVector.fromArray(INTS, table, 0, drawn, LANES);
      IntVector when = IntVector.fromArray(INTS, times, DECIDES + i);
      VectorMask<Integer> decides = when.compare(LT, never);
      VectorMask<Float> yes = decides.cast(SPECIES);
      FloatVector before = FloatVector.fromArray(SPECIES, decidedBefore, i);
      VectorMask<Float> hasDecided = before.compare(LT, undecided);
      IntVector reachedBefore = IntVector.fromArray(INTS, times, REACHES + i);
      // Commands to one vehicle keep their order.
      IntVector reaches = when.add(delay).max(reachedBefore);
      IntVector actsAt = reaches.add(dead);
      soonest = soonest.lanewise(VectorOperators.MIN, actsAt, decides);
      latest = latest.lanewise(VectorOperators.MAX, actsAt, decides);
      FloatVector acts =
          zero.blend(
              ((FloatVector) actsAt.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(grainS),
              yes);
      acts.intoArray(commands, slot + LagVehicles.AT + i);
      FloatVector exponent = acts.mul(doublings);
      FloatVector rounded = exponent.add(round);
      FloatVector rest = exponent.sub(rounded.sub(round)), square = rest.mul(rest);
      rest.fma(power5, power4)
          .fma(square, rest.fma(power3, power2))
          .fma(square, rest.fma(power1, one))
          .reinterpretAsInts()
          .add(rounded.reinterpretAsInts().lanewise(VectorOperators.LSHL, 23))
          .reinterpretAsFloats()
          .intoArray(commands, slot + LagVehicles.GROWTH + i);
      // The command before is acknowledged when this one has replaced it; the very first replaces
      // none.
      IntVector ready = when.add(interval);
      IntVector acknowledged =
          reaches.add(backDelay).add(handover).max(ready);
      ready = ready.blend(acknowledged, hasDecided.cast(INTS));
      reachedBefore.blend(reaches, decides).sub(toNext).max(past).intoArray(times, REACHES + i);
      IntVector.fromArray(INTS, times, READY + i)
          .blend(ready, decides)
          .sub(toNext)
          .max(past)
          .intoArray(times, READY + i);
      FloatVector time = (FloatVector) when.convertShape(VectorOperators.I2F, SPECIES, 0);
      before.blend(time.mul(grainS).neg(), yes).add(toNextS).intoArray(decidedBefore, i);
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
      zero.blend(newCos.sub(zero.blend(cos, hasDecided)), yes)
          .mul(speed)
          .intoArray(commands, slot + LagVehicles.CHANGE_X + i);
      zero.blend(newSin.sub(zero.blend(sin, hasDecided)), yes)
          .mul(speed)
          .intoArray(commands, slot + LagVehicles.CHANGE_Y + i);
      newCos.intoArray(sent.cos, i);
      newSin.intoArray(sent.sin, i);
    }
    policy.rememberBefore(times, DECIDES, LaneViews.NONE);
    vehicles.send(
        soonest.reduceLanes(VectorOperators.MIN) * LaneViews.GRAIN_S,
        latest.reduceLanes(VectorOperators.MAX) * LaneViews.GRAIN_S);
  }
}
