package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.ASHR;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LSHL;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.XOR;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.Delays;
import skein.forward.Steering;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;
import skein.simd.WorldRandom;

/** One vehicle in many worlds, with its controllers, which follow {@code skein.flow.Pace} and {@code
 * skein.flow.Steer}: when each decides on its offer, and when its command takes effect. Subclasses make the
 * decisions. Times are passed in grains of 4 ns from the period's start, and stored from the episode's start,
 * modulo 2³²; a stored time that is long past is moved closer before it could be mistaken for the future.
 */
public abstract class LaneAgents {
  private static final int WORLDS = LanePolicy.WORLDS, NONE = LaneOffers.NONE;

  private static final int LONG = 28;

  private static final float LONG_S = (1 << LONG) * LaneViews.GRAIN_S;

  /** Stands for the time since the last decision of one that never decided. */
  private static final int NEVER = 1 << 20;

  /** A command is answered when the next one replaces it, so the limit of unanswered commands is at least
   * this.
   */
  public static final int LEAST_UNDER_WAY = 2;

  public final int self;

  public final LaneVehicles vehicles;
  private final int line, periodGrains, intervalGrains, leastGrains, handoverGrains, deadGrains;
  private final boolean decidesFirst;

  /** Whether all vehicles receive equal offers at equal times: then all sent commands were sent before. */
  public final boolean together;

  // When it may be commanded again, and when the last command reaches it.
  private final int[] ready = new int[WORLDS], reaches = new int[WORLDS];

  /** When earlier commands are answered, the latest first: as many as may be unanswered besides the last two.
   * The one before the last is answered by then, or awaited.
   */
  private final int[][] answered;

  /** When the last command was sent; not maintained if all offers are {@link #together}. */
  public final int[] sentAt = new int[WORLDS];

  /** When it decides, from the period's start; {@link LaneOffers#NONE} where it does not. */
  public final int[] decides = new int[WORLDS];

  /** 1 where it decides before it considers an offer of the moment in which it may send again: with a {@link
   * #forecast}, offers are scheduled a period before, and the permission was known before that.
   */
  private final int[] goesFirst = new int[WORLDS];

  // When it sends, or NONE, when the command acts, and when it is known to have arrived: the first never is.
  private final int[] sends = new int[WORLDS], acts = new int[WORLDS], answers = new int[WORLDS];

  /** The forecast by which readings are predicted; null where decisions use the readings themselves. */
  public final LaneForecast forecast;

  /** Time from the own last decision to this one, s. */
  public final float[] elapsedS = new float[WORLDS];

  /** When it decided last; and the number of {@link #LONG} spans to add, or {@link #NEVER}. */
  private final int[] decidedAt = new int[WORLDS], decidedLong = new int[WORLDS];

  public int now;

  private final int[] drawn = new int[2 * LANES];

  // Over links whose tables change: places of random numbers, how long commands and their answers are under
  // way, and when commands arrive.
  private final int[] drawnAt = new int[WORLDS],
      there = new int[WORLDS],
      back = new int[WORLDS],
      arrives = new int[WORLDS];

  /** Commanded directions, or velocities over the vehicles' speed: the last and the previous command. */
  public final Directions sent, sentBefore = new Directions(WORLDS);

  /** The last decision, which equals the last command unless a decision waits; and the present decision. */
  public final Directions decided, decidedNow;

  /** @param deadTimeS from a command's arrival until the vehicle follows it */
  public LaneAgents(int self, LoopLanes loop, double deadTimeS, LaneVehicles vehicles) {
    this.self = self;
    this.vehicles = vehicles;
    forecast = loop.forecast();
    decidesFirst = loop.decidesFirst();
    together = loop.offers().together;
    sent = new Directions(WORLDS, vehicles.inSpace);
    decidedNow = new Directions(WORLDS, vehicles.inSpace);
    decided = decidesFirst ? new Directions(WORLDS) : sent;
    line = Delays.command(self);
    Steering steering = loop.steering();
    periodGrains = LaneViews.grains(loop.periodS());
    leastGrains = LaneViews.grains(steering.minIntervalS());
    intervalGrains = Math.max(LaneViews.grains(loop.intervalS()), leastGrains);
    answered = new int[steering.mostOutstanding() - LEAST_UNDER_WAY][WORLDS];
    handoverGrains = LaneViews.grains(steering.handoverS());
    deadGrains = LaneViews.grains(deadTimeS);
  }

  /** Resets to the start of an episode; the subclass fills in the commands and decisions before it. */
  public void start() {
    now = 0;
    for (int[] zero : new int[][] {ready, reaches, decidedAt}) Arrays.fill(zero, 0);
    Arrays.fill(sentAt, -1);
    for (int[] each : answered) Arrays.fill(each, -1);
    Arrays.fill(decidedLong, NEVER);
    Arrays.fill(goesFirst, 0);
    vehicles.start();
    if (vehicles.inSpace)
      for (Directions each : new Directions[] {sent, decidedNow}) each.level(vehicles.startZ);
  }

  public abstract boolean needsVelocity();

  /** Whether decisions depend on the ages of readings. */
  public boolean needsAges() {
    return false;
  }

  /** Whether it takes images until it decides, which show other vehicles with equal offers: its {@link
   * #choose} must run after they have commanded.
   */
  public boolean sees() {
    return false;
  }

  /** Decides, in all worlds: fills {@link #decidedNow}.
   *
   * @param all by the vehicle's number, with the readings of their vehicles
   * @param readAt by vehicle, when the held readings were sampled; only if {@link #needsAges}
   */
  public abstract void choose(LaneAgents[] all, LaneOffers offers, LaneVectors vectors, int[][] readAt);

  /** Stores the decisions where {@link #decides} is a time.
   *
   * @param endGrains of the episode
   */
  public abstract void remember(LaneVectors vectors, int endGrains);

  public void startRow(int row) {
    now = row * periodGrains;
    if (row % Math.max(1, (1 << LONG) / periodGrains) == 0) drawNear();
  }

  /** Moves times that are long past closer to the present. */
  private void drawNear() {
    IntVector begin = IntVector.broadcast(INTS, now), past = IntVector.broadcast(INTS, -1);
    for (int i = 0; i < WORLDS; i += LANES) {
      for (int[] each : new int[][] {ready, reaches, sentAt}) drawNear(each, i, begin, past);
      for (int[] each : answered) drawNear(each, i, begin, past);
      IntVector at = IntVector.fromArray(INTS, decidedAt, i);
      IntVector passed = begin.sub(at).lanewise(ASHR, LONG);
      at.add(passed.lanewise(LSHL, LONG)).intoArray(decidedAt, i);
      IntVector.fromArray(INTS, decidedLong, i).add(passed).intoArray(decidedLong, i);
    }
  }

  private static void drawNear(int[] times, int i, IntVector begin, IntVector past) {
    IntVector.fromArray(INTS, times, i).sub(begin).max(past).add(begin).intoArray(times, i);
  }

  /** Decides by {@link #choose} wherever it is due; agents that {@link #sees} run last. */
  public final void decide(LaneAgents[] all, LaneOffers offers, LaneVectors vectors, int[][] readAt) {
    look(vectors, offers.joinedAt, offers.nextAt);
    if (forecast != null) forecast.predict(vectors, decides);
    if (!sees()) choose(all, offers, vectors, readAt);
  }

  /** The numbers of this vehicle for decisions: {@code LaneObservation.X} and so on, from {@link #seenFrom}
   * on. A prediction is valid for the deciding agents only.
   */
  public final float[] seen() {
    return forecast == null ? vehicles.state : forecast.predicted(self);
  }

  public final int seenFrom() {
    return forecast == null ? LaneVehicles.SEEN_X : 0;
  }

  private void look(LaneVectors vectors, int[] joinedAt, int[] nextAt) {
    IntVector none = IntVector.broadcast(INTS, NONE),
        begin = IntVector.broadcast(INTS, now),
        never = IntVector.broadcast(INTS, NEVER / 2),
        less = IntVector.broadcast(INTS, (1 << LONG) - 1);
    FloatVector longS = FloatVector.broadcast(SPECIES, LONG_S),
        grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector joined = IntVector.fromArray(INTS, joinedAt, i);
      IntVector when = joined.max(IntVector.fromArray(INTS, ready, i).sub(begin));
      VectorMask<Integer> offered = joined.compare(LT, none);
      IntVector next = IntVector.fromArray(INTS, nextAt, i).add(IntVector.fromArray(INTS, goesFirst, i));
      VectorMask<Integer> goes = when.compare(LT, next).and(offered);
      IntVector sending = none.blend(when, goes), deciding = decidesFirst ? joined : sending;
      sending.intoArray(sends, i);
      deciding.intoArray(decides, i);
      // In two parts, of which neither depends on the period in which it is looked at.
      IntVector passed = deciding.add(begin).sub(IntVector.fromArray(INTS, decidedAt, i));
      IntVector many =
          IntVector.fromArray(INTS, decidedLong, i).add(passed.lanewise(ASHR, LONG));
      FloatVector rest =
          ((FloatVector) passed.and(less).convertShape(VectorOperators.I2F, SPECIES, 0)).mul(grainS);
      zero.blend(
              ((FloatVector) many.convertShape(VectorOperators.I2F, SPECIES, 0)).fma(longS, rest),
              many.compare(LT, never).cast(SPECIES))
          .intoArray(elapsedS, i);
    }
  }

  /** Sends the decisions as commands.
   *
   * @param endGrains of the episode
   */
  final void command(int row, LaneOffers offers, LaneVectors vectors, int endGrains) {
    int place = LaneDelays.placeOf(row) + LaneDelays.placeOfLine(line);
    if (!offers.delays.isSteady) draw(row, offers.delays, offers.place[self], vectors);
    send(place, offers.delays, offers.place[self], vectors);
    if (forecast != null) forecast.send(self, vectors, sends, answers, sent);
    if (vectors.count * LANES < WORLDS) forget(vectors);
    remember(vectors, endGrains);
    vehicles.act(row, vectors, acts, sent);
  }

  /** Draws the delays of commands and their answers, over links whose tables change. */
  private void draw(int row, LaneDelays delays, int[] places, LaneVectors vectors) {
    long begin = (long) row * periodGrains;
    IntVector step = IntVector.broadcast(INTS, LaneDelays.placeOf(row)),
        now = IntVector.broadcast(INTS, this.now),
        none = IntVector.broadcast(INTS, NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, places, i).add(step).intoArray(drawnAt, i);
    }
    delays.draw(vectors, drawnAt, line, begin, sends, there);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector when = IntVector.fromArray(INTS, sends, i);
      none.blend(
              when.add(IntVector.fromArray(INTS, there, i)).max(IntVector.fromArray(INTS, reaches, i).sub(now)),
              when.compare(LT, none))
          .intoArray(arrives, i);
    }
    delays.draw(vectors, drawnAt, line + 1, begin, arrives, back);
  }

  /** Sends commands, and draws their delays in that pass: a table look-up takes as long as a dozen other
   * operations.
   */
  private void send(int place, LaneDelays delays, int[] places, LaneVectors vectors) {
    boolean isSteady = delays.isSteady, manyUnderWay = answered.length > 0;
    int[] keys = delays.keysOf(line), tableOf = delays.tableOf, table = delays.delays, drawn = this.drawn;
    IntVector here = IntVector.broadcast(INTS, place),
        next = IntVector.broadcast(INTS, place + WorldRandom.STRIDE),
        multiplier1 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_1),
        multiplier2 = IntVector.broadcast(INTS, WorldRandom.MULTIPLIER_2),
        none = IntVector.broadcast(INTS, NONE),
        interval = IntVector.broadcast(INTS, intervalGrains),
        handover = IntVector.broadcast(INTS, handoverGrains),
        dead = IntVector.broadcast(INTS, deadGrains),
        begin = IntVector.broadcast(INTS, now),
        never = IntVector.broadcast(INTS, NEVER / 2),
        period = IntVector.broadcast(INTS, periodGrains),
        zero = IntVector.broadcast(INTS, 0);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector there, back;
      if (isSteady) {
        IntVector key = IntVector.fromArray(INTS, keys, i).add(IntVector.fromArray(INTS, places, i)),
            from = IntVector.fromArray(INTS, tableOf, i);
        IntVector a = key.add(here), b = key.add(next);
        a = a.lanewise(XOR, a.lanewise(LSHR, 16)).mul(multiplier1);
        b = b.lanewise(XOR, b.lanewise(LSHR, 16)).mul(multiplier1);
        a = a.lanewise(XOR, a.lanewise(LSHR, 15)).mul(multiplier2);
        b = b.lanewise(XOR, b.lanewise(LSHR, 15)).mul(multiplier2);
        a.lanewise(LSHR, LaneDelays.DROP).add(from).intoArray(drawn, 0);
        b.lanewise(LSHR, LaneDelays.DROP).add(from).intoArray(drawn, LANES);
        there = IntVector.fromArray(INTS, table, 0, drawn, 0);
        back = IntVector.fromArray(INTS, table, 0, drawn, LANES);
      } else {
        there = IntVector.fromArray(INTS, this.there, i);
        back = IntVector.fromArray(INTS, this.back, i);
      }
      IntVector when = IntVector.fromArray(INTS, sends, i), time = IntVector.fromArray(INTS, decides, i);
      VectorMask<Integer> goes = when.compare(LT, none);
      VectorMask<Integer> does = time.compare(LT, none);
      VectorMask<Float> sending = goes.cast(SPECIES), deciding = does.cast(SPECIES);
      IntVector before = IntVector.fromArray(INTS, decidedLong, i),
          reachedBefore = IntVector.fromArray(INTS, reaches, i);
      // Commands to one vehicle keep their order.
      IntVector arrives = when.add(there).max(reachedBefore.sub(begin));
      none.blend(arrives.add(dead), goes).intoArray(acts, i);
      // The command before is answered when this one has replaced it; the very first replaces none.
      IntVector again = when.add(interval), answer = arrives.add(back);
      // So do their answers.
      if (manyUnderWay)
        answer = answer.max(IntVector.fromArray(INTS, answered[0], i).sub(begin));
      VectorMask<Integer> replaces = before.compare(LT, never);
      none.blend(answer, replaces).intoArray(answers, i);
      IntVector known = when.blend(answer, replaces);
      if (!manyUnderWay) again = again.blend(answer.add(handover).max(again), replaces);
      else {
        IntVector awaited = keep(i, known, goes, begin);
        again = again.max(whenFree(i, when, awaited, begin));
        known = awaited.max(when);
      }
      if (forecast != null) {
        IntVector.fromArray(INTS, goesFirst, i)
            .blend(zero.blend(1, again.sub(known).compare(GT, period)), goes)
            .intoArray(goesFirst, i);
      }
      reachedBefore.blend(arrives.add(begin), goes).intoArray(reaches, i);
      IntVector.fromArray(INTS, ready, i).blend(again.add(begin), goes).intoArray(ready, i);
      FloatVector newCos = FloatVector.fromArray(SPECIES, decidedNow.cos, i),
          newSin = FloatVector.fromArray(SPECIES, decidedNow.sin, i),
          cos = FloatVector.fromArray(SPECIES, sent.cos, i),
          sin = FloatVector.fromArray(SPECIES, sent.sin, i);
      if (!together) {
        IntVector.fromArray(INTS, sentAt, i).blend(when.add(begin), goes).intoArray(sentAt, i);
        FloatVector.fromArray(SPECIES, sentBefore.cos, i).blend(cos, sending).intoArray(sentBefore.cos, i);
        FloatVector.fromArray(SPECIES, sentBefore.sin, i).blend(sin, sending).intoArray(sentBefore.sin, i);
      }
      cos.blend(newCos, sending).intoArray(sent.cos, i);
      sin.blend(newSin, sending).intoArray(sent.sin, i);
      if (sent.third != null) {
        FloatVector.fromArray(SPECIES, sent.third, i)
            .blend(FloatVector.fromArray(SPECIES, decidedNow.third, i), sending)
            .intoArray(sent.third, i);
        FloatVector.fromArray(SPECIES, sent.holds, i)
            .blend(FloatVector.fromArray(SPECIES, decidedNow.holds, i), sending)
            .intoArray(sent.holds, i);
      }
      if (decidesFirst) {
        FloatVector.fromArray(SPECIES, decided.cos, i).blend(newCos, deciding).intoArray(decided.cos, i);
        FloatVector.fromArray(SPECIES, decided.sin, i).blend(newSin, deciding).intoArray(decided.sin, i);
      }
      before.blend(zero, does).intoArray(decidedLong, i);
      IntVector.fromArray(INTS, decidedAt, i).blend(time.add(begin), does).intoArray(decidedAt, i);
    }
  }

  /** Records when a command is answered, no earlier than those before.
   *
   * @param answer a time that has passed where no command is answered
   * @return when the next command may be sent: the earliest pending answer
   */
  private IntVector keep(int i, IntVector answer, VectorMask<Integer> goes, IntVector begin) {
    IntVector later = answer;
    for (int[] each : answered) {
      IntVector held = IntVector.fromArray(INTS, each, i).sub(begin);
      held.blend(later, goes).add(begin).intoArray(each, i);
      later = held;
    }
    return later;
  }

  /** When the vehicle may be commanded again, without the loop's interval: each earlier answer is followed by
   * the handover time.
   */
  private IntVector whenFree(int i, IntVector sent, IntVector awaited, IntVector begin) {
    IntVector free = sent.add(leastGrains);
    free = free.blend(awaited.add(handoverGrains).max(free), awaited.compare(GT, sent));
    for (int n = answered.length - 1; n >= 0; n--) {
      IntVector answer = IntVector.fromArray(INTS, answered[n], i).sub(begin);
      VectorMask<Integer> comesBefore = answer.compare(GT, sent).and(answer.compare(LE, free));
      free = free.blend(answer.add(handoverGrains).max(free), comesBefore);
    }
    return free;
  }

  /** The last commands as cosine and sine, as far as they were known at a joined view. */
  public final void knownAt(
      LaneVectors vectors, int[] joinedAt, Directions told, Directions toldBefore, Directions into) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> isKnown =
          IntVector.fromArray(INTS, sentAt, i)
              .sub(now)
              .compare(LE, IntVector.fromArray(INTS, joinedAt, i))
              .cast(SPECIES);
      FloatVector.fromArray(SPECIES, toldBefore.cos, i)
          .blend(FloatVector.fromArray(SPECIES, told.cos, i), isKnown)
          .intoArray(into.cos, i);
      FloatVector.fromArray(SPECIES, toldBefore.sin, i)
          .blend(FloatVector.fromArray(SPECIES, told.sin, i), isKnown)
          .intoArray(into.sin, i);
    }
  }

  /** Replaces the last command where a new one is sent. */
  protected final void tell(
      LaneVectors vectors, float[] cos, float[] sin, Directions told, Directions toldBefore) {
    IntVector none = IntVector.broadcast(INTS, NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      VectorMask<Float> goes = IntVector.fromArray(INTS, sends, i).compare(LT, none).cast(SPECIES);
      FloatVector lastCos = FloatVector.fromArray(SPECIES, told.cos, i),
          lastSin = FloatVector.fromArray(SPECIES, told.sin, i);
      FloatVector.fromArray(SPECIES, toldBefore.cos, i).blend(lastCos, goes).intoArray(toldBefore.cos, i);
      FloatVector.fromArray(SPECIES, toldBefore.sin, i).blend(lastSin, goes).intoArray(toldBefore.sin, i);
      lastCos.blend(FloatVector.fromArray(SPECIES, cos, i), goes).intoArray(told.cos, i);
      lastSin.blend(FloatVector.fromArray(SPECIES, sin, i), goes).intoArray(told.sin, i);
    }
  }

  /** Age of a vehicle's reading at the decision, s. */
  protected final void age(int vehicle, int[][] readAt, float[] into) {
    if (forecast != null) System.arraycopy(forecast.age(vehicle), 0, into, 0, WORLDS);
    else
      for (int i = 0; i < WORLDS; i += LANES)
        ((FloatVector)
                IntVector.fromArray(INTS, decides, i)
                    .sub(IntVector.fromArray(INTS, readAt[vehicle], i))
                    .convertShape(VectorOperators.I2F, SPECIES, 0))
            .mul(LaneViews.GRAIN_S)
            .intoArray(into, i);
  }

  /** Clears the decisions in the other vectors. */
  private void forget(LaneVectors vectors) {
    int next = 0;
    for (int i = 0; i < WORLDS; i += LANES)
      if (next < vectors.count && vectors.first[next] == i) next++;
      else Arrays.fill(decides, i, i + LANES, NONE);
  }
}
