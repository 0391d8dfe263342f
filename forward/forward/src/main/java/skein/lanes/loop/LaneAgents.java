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

/** One vehicle's controller in many worlds. As {@code skein.flow.Pace} and {@code skein.flow.Steer} do, it
 * computes when the vehicle decides on an offer and when the command takes effect. Subclasses make the
 * decisions. Times are passed in grains of 4 ns from the period's start, and stored from the episode's start,
 * modulo 2³²; a stored time that is long past is moved closer before it could be mistaken for the future.
 */
public abstract class LaneAgents {
  private static final int WORLDS = LanePolicy.WORLDS, NONE = LaneOffers.NONE;

  private static final int LONG = 28;

  private static final float LONG_S = (1 << LONG) * LaneViews.GRAIN_S;

  /** Marks a controller that has not decided yet, in {@link #decidedLong}. */
  private static final int NEVER = 1 << 20;

  /** Smallest allowed limit of unanswered commands: a command is answered only when the next one replaces
   * it. */
  public static final int LEAST_UNDER_WAY = 2;

  public final int self;

  public final LaneVehicles vehicles;
  private final int line, periodGrains, intervalGrains, leastGrains, handoverGrains, deadGrains;
  private final boolean decidesFirst;

  /** Whether all vehicles receive their offers at equal times, so that every command was sent before the
   * offer.
   */
  public final boolean together;

  // Time from which the vehicle may be commanded again, and arrival of the last command.
  private final int[] ready = new int[WORLDS], reaches = new int[WORLDS];

  /** Times at which earlier commands are answered, the latest first. There are as many as the limit of
   * unanswered commands, less the last two.
   */
  private final int[][] answered;

  /** Time at which the last command was sent; not maintained if {@link #together}. */
  public final int[] sentAt = new int[WORLDS];

  /** Time of the decision, in grains from the period's start; {@link LaneOffers#NONE} in worlds without a
   * decision.
   */
  public final int[] decides = new int[WORLDS];

  /** 1 in worlds where a permission to send precedes an offer of equal time. With a {@link #forecast}, offers
   * are scheduled one period ahead, and such a permission was known before that.
   */
  private final int[] goesFirst = new int[WORLDS];

  // Time of sending, or NONE; time at which the command takes effect; and time at which its arrival is known,
  // NONE for the first command.
  private final int[] sends = new int[WORLDS], acts = new int[WORLDS], answers = new int[WORLDS];

  /** The forecast that predicts the readings; null if decisions use the readings themselves. */
  public final LaneForecast forecast;

  /** Time since this vehicle's previous decision, s. */
  public final float[] elapsedS = new float[WORLDS];

  /** Time of the last decision; and the number of spans of 2^28 grains to add to the time since, or {@link
   * #NEVER}.
   */
  private final int[] decidedAt = new int[WORLDS], decidedLong = new int[WORLDS];

  /** When the vehicle's reading of its first decision was sampled, s; only where {@link #timeAt} is used. */
  private final float[] firstReadS = new float[WORLDS];

  public int now;

  private double rowS;

  private final int[] drawn = new int[2 * LANES];

  // For links whose tables change or that lose packets: indices in the random sequence, delays of commands
  // and of their answers, and arrivals of commands.
  private final int[] drawnAt = new int[WORLDS],
      there = new int[WORLDS],
      back = new int[WORLDS],
      arrives = new int[WORLDS];

  /** The last and the previous command: directions, or velocities divided by the vehicles' speed. */
  public final Directions sent, sentBefore = new Directions(WORLDS);

  /** The last decision, which differs from the last command only while a decision waits; and the present
   * decision.
   */
  public final Directions decided, decidedNow;

  /** @param deadTimeS time from the arrival of a command until the vehicle follows it, s */
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

  /** Resets to the start of an episode; the subclass sets the commands and decisions that precede it. */
  public void start() {
    now = 0;
    rowS = 0;
    for (int[] zero : new int[][] {ready, reaches, decidedAt}) Arrays.fill(zero, 0);
    Arrays.fill(sentAt, -1);
    for (int[] each : answered) Arrays.fill(each, -1);
    Arrays.fill(decidedLong, NEVER);
    Arrays.fill(decides, NONE);
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

  /** Whether the controller takes images up to its decision. Its {@link #choose} must then run after the
   * other vehicles with equal offers have sent their commands.
   */
  public boolean sees() {
    return false;
  }

  /** Decides in all worlds; fills {@link #decidedNow}.
   *
   * @param all the controllers, indexed by vehicle, with their vehicles' readings
   * @param readAt sampling times of the present readings, indexed by vehicle; maintained only if {@link
   *     #needsAges}
   */
  public abstract void choose(LaneAgents[] all, LaneOffers offers, LaneVectors vectors, int[][] readAt);

  /** Stores the decisions in worlds where {@link #decides} is not {@link LaneOffers#NONE}.
   *
   * @param endGrains end of the episode, in grains from the period's start
   */
  public abstract void remember(LaneVectors vectors, int endGrains);

  public void startRow(int row) {
    now = row * periodGrains;
    rowS = (double) row * periodGrains * LaneViews.GRAIN_NS * 1e-9;
    if (row % Math.max(1, (1 << LONG) / periodGrains) == 0) drawNear();
  }

  /** Moves stored times in the distant past closer to the present. */
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

  /** Determines where a decision is due, and decides by {@link #choose}. Controllers that {@link #sees take
   * images} only do the first part.
   */
  public final void decide(LaneAgents[] all, LaneOffers offers, LaneVectors vectors, int[][] readAt) {
    look(vectors, offers.joinedAt, offers.nextAt);
    if (vectors.count * LANES < WORLDS) forget(vectors);
    if (forecast != null) forecast.predict(vectors, decides);
    if (!sees()) choose(all, offers, vectors, readAt);
  }

  /** The vehicle's position and velocity for decisions, from index {@link #seenFrom} on: its reading, or its
   * prediction, which is valid only in worlds where this vehicle decides.
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
      // In two parts, neither of which depends on the present period.
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
   * @param endGrains end of the episode, in grains from the period's start
   */
  final void command(int row, LaneOffers offers, LaneVectors vectors, int endGrains) {
    int place = LaneDelays.placeOf(row) + LaneDelays.placeOfLine(line);
    if (!offers.delays.isSteady) draw(row, offers.delays, offers.place[self], vectors);
    send(place, offers.delays, offers.place[self], vectors);
    if (forecast != null) forecast.send(self, vectors, sends, answers, sent);
    remember(vectors, endGrains);
    vehicles.act(row, vectors, acts, sent);
  }

  /** Draws the delays of commands and their answers, for links whose delay tables change or that lose
   * packets.
   */
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

  /** Sends the commands. On steady links the pass also draws their delays: a table look-up takes as long as a
   * dozen other operations.
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
      // A command is answered when its successor has replaced it; the first command replaces none.
      IntVector again = when.add(interval), answer = arrives.add(back);
      // Answers keep their order too.
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

  /** Records when commands are answered; an answer is never earlier than those before it.
   *
   * @param answer time of the answer; a past time in worlds without an answer
   * @return time of the earliest pending answer, before which no command may be sent
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

  /** Time at which the vehicle may be commanded again, apart from the loop's interval: each earlier answer is
   * followed by the handover time.
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

  /** Writes the last command that was known when the view was joined, as cosine and sine. */
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

  /** Makes the new command the last command, in worlds where one is sent. */
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

  /** Time of a world's decision, s; infinity without one.
   *
   * @param rowS time of the period's start, s
   */
  final double decidesS(int world, double rowS) {
    return decides[world] == NONE
        ? Double.POSITIVE_INFINITY
        : rowS + decides[world] * (LaneViews.GRAIN_NS * 1e-9);
  }

  /** Computes the age of a vehicle's reading at the decision, s. */
  protected final void age(int vehicle, int[][] readAt, float[] into) {
    if (forecast != null) System.arraycopy(forecast.age(vehicle), 0, into, 0, WORLDS);
    else sinceRead(vehicle, readAt, into);
  }

  /** Computes the time at which the command of a decision takes effect, since the vehicle was first read, s.
   *
   * @param ageS age of the vehicle's own reading at the decision, s
   */
  protected final void timeAt(float[] ageS, float[] into) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector at =
          ((FloatVector) IntVector.fromArray(INTS, decides, i).convertShape(VectorOperators.I2F, SPECIES, 0))
              .mul(LaneViews.GRAIN_S)
              .add((float) rowS);
      VectorMask<Float> isFirst =
          IntVector.fromArray(INTS, decidedLong, i).compare(VectorOperators.GE, NEVER / 2).cast(SPECIES);
      FloatVector first =
          FloatVector.fromArray(SPECIES, firstReadS, i)
              .blend(at.sub(FloatVector.fromArray(SPECIES, ageS, i)), isFirst);
      first.intoArray(firstReadS, i);
      FloatVector since = at.sub(first);
      (forecast == null ? since : since.add(FloatVector.fromArray(SPECIES, forecast.actsS(), i)))
          .intoArray(into, i);
    }
  }

  /** Computes the time from a vehicle's present reading to the decision, s. */
  final void sinceRead(int vehicle, int[][] readAt, float[] into) {
    for (int i = 0; i < WORLDS; i += LANES)
      ((FloatVector)
              IntVector.fromArray(INTS, decides, i)
                  .sub(IntVector.fromArray(INTS, readAt[vehicle], i))
                  .convertShape(VectorOperators.I2F, SPECIES, 0))
          .mul(LaneViews.GRAIN_S)
          .intoArray(into, i);
  }

  /** Clears the decisions in all other vectors. */
  private void forget(LaneVectors vectors) {
    int next = 0;
    for (int i = 0; i < WORLDS; i += LANES)
      if (next < vectors.count && vectors.first[next] == i) next++;
      else Arrays.fill(decides, i, i + LANES, NONE);
  }
}
