package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.LOG2_E;
import static skein.simd.LaneMath.ONE;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.ZERO;
import static skein.simd.LaneMath.powerOf2;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.RolloutAgent;
import skein.lanes.policy.Directions;
import skein.vehicle.FirstOrderLag;
import skein.vehicle.ReducedModel;

/** The vehicles of one role in many worlds, with first-order lag. Commands take effect, and readings are
 * sampled, at different times in each world. Positions are those at a period's start; a reading includes the
 * commands that are in effect at its time.
 *
 * <p>The response to commanded velocities is linear. Position and velocity are those without pending
 * commands, plus, for each pending command from the time it takes effect, its change times its step response:
 * s(t) = t − lag·(1 − r(t)) for the position and 1 − r(t) for the velocity, where r(t) = exp(−t / lag). Since
 * r(end − at) = exp(−end / lag) · growth(at), one exponential serves all commands. A world's results depend
 * only on its own commands, to the bit: the commands of other worlds only decide whether zeros are added.
 *
 * <p>{@link PlantFlights} simulates an equal vehicle for every loop. This second implementation exists for
 * {@code stream}, where it reaches 100 million agent-steps per second; {@code PlantFlights} reaches 54
 * million.
 */
public final class LagVehicles extends LaneVehicles {
  private static final float FUTURE = 1e9f;

  /** Longest time by which a reading is sampled before its period's start, s. */
  private final float earliestS;

  private final double periodS;
  private final FirstOrderLag lag;
  private final float lagS, speedMps, periodGain, periodDecay;

  // By world, at the period's start: the commanded velocity, and the commanded less the actual velocity.
  private static final int WANTED_X = OWN,
      WANTED_Y = OWN + WORLDS,
      LACK_X = OWN + 2 * WORLDS,
      LACK_Y = OWN + 3 * WORLDS;

  /** Sampling times of the readings, s; and the fraction of a velocity error that remains at them. */
  private static final int END = OWN + 4 * WORLDS, DECAY = OWN + 5 * WORLDS;

  /** The last commanded velocity, whether or not it has taken effect. */
  private static final int SENT_X = OWN + 6 * WORLDS, SENT_Y = OWN + 7 * WORLDS;

  private static final int NUMBERS = 8;

  /** The period to which the state belongs. */
  private int row;

  private static final int[] AT_BEGIN = new int[WORLDS];
  private static final LaneVectors ALL = LaneVectors.all();

  /** Of each pending command: the time at which it takes effect, s from its period's start; e to the power of
   * that time over the lag; and the change of the commanded velocity.
   */
  private float[] commands;

  private static final int AT = 0, GROWTH = WORLDS, CHANGE_X = 2 * WORLDS, CHANGE_Y = 3 * WORLDS;
  private static final int SLOT = 4 * WORLDS;

  // Commands by the round of their decision, modulo slots: the oldest that may act after an early reading,
  // the first that does not act yet in every world, and the next; with the period of each and the range of
  // times at which it takes effect.
  private int slots;
  private int oldest, first, next;
  private int[] rowOf;
  private float[] soonest, latest;

  // Of the commands that act before the readings: slots, ages, ages at the last simulation, and the shares of
  // an error that remain after their age.
  private int near;
  private int[] nearFrom;
  private float[] nearAge, nearYounger, nearAged;

  /** For each number of periods: their duration, s, and the fraction of a velocity error that remains after
   * it.
   */
  private final float[] rowsS, remains;

  /** Whether the powers of e fit into floats if commands are pending for up to {@code longestS}. */
  public static boolean canFly(ReducedModel model, double longestS) {
    return longestS <= MOST_LAGS * model.lagS();
  }

  private static final double MOST_LAGS = 80;

  /** @param longestS longest time from the decision on a command until it takes effect, s
   * @param earliestS longest time by which a reading is sampled before its period's start, s
   */
  public LagVehicles(
      RolloutAgent agent, ReducedModel model, double periodS, double longestS, double earliestS) {
    super(agent, NUMBERS, false);
    this.periodS = periodS;
    this.earliestS = (float) earliestS;
    allocate(8);
    lag = new FirstOrderLag(model.lagS());
    lagS = (float) model.lagS();
    speedMps = (float) (agent.speed() * model.gain());
    periodDecay = (float) lag.remains(periodS);
    periodGain = (float) lag.carriesS(periodS);
    rowsS = new float[4 + (int) Math.ceil((longestS + earliestS) / periodS)];
    remains = new float[rowsS.length];
    for (int i = 0; i < remains.length; i++) {
      rowsS[i] = (float) (i * periodS);
      remains[i] = (float) lag.remains(i * periodS);
    }
  }

  @Override
  void start() {
    super.start();
    oldest = 0;
    first = 0;
    next = 0;
    row = 0;
  }

  @Override
  void act(int row, LaneVectors vectors, int[] acts, Directions commanded) {
    if (next - oldest == slots) makeRoom();
    int number = next & slots - 1, slot = number * SLOT;
    rowOf[number] = row;
    if (vectors.count * LANES < WORLDS) Arrays.fill(commands, slot, slot + SLOT, 0f);
    send(vectors, number, slot, acts, commanded);
    next++;
  }

  private void send(LaneVectors vectors, int number, int slot, int[] acts, Directions commanded) {
    float[] state = this.state, commands = this.commands, cos = commanded.cos, sin = commanded.sin;
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE), soonestOf = none, latestOf = none.not();
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        speed = FloatVector.broadcast(SPECIES, speedMps),
        doublings = FloatVector.broadcast(SPECIES, LOG2_E / lagS),
        zero = FloatVector.broadcast(SPECIES, 0f);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector grains = IntVector.fromArray(INTS, acts, i);
      VectorMask<Integer> does = grains.compare(LT, none);
      VectorMask<Float> yes = does.cast(SPECIES);
      soonestOf = soonestOf.min(grains);
      latestOf = latestOf.lanewise(VectorOperators.MAX, grains, does);
      FloatVector at =
          zero.blend(((FloatVector) grains.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(grainS), yes);
      at.intoArray(commands, slot + AT + i);
      powerOf2(at.mul(doublings)).intoArray(commands, slot + GROWTH + i);
      FloatVector beforeX = FloatVector.fromArray(SPECIES, state, SENT_X + i),
          beforeY = FloatVector.fromArray(SPECIES, state, SENT_Y + i);
      FloatVector nowX = beforeX.blend(FloatVector.fromArray(SPECIES, cos, i).mul(speed), yes),
          nowY = beforeY.blend(FloatVector.fromArray(SPECIES, sin, i).mul(speed), yes);
      nowX.sub(beforeX).intoArray(commands, slot + CHANGE_X + i);
      nowY.sub(beforeY).intoArray(commands, slot + CHANGE_Y + i);
      nowX.intoArray(state, SENT_X + i);
      nowY.intoArray(state, SENT_Y + i);
    }
    // Widened slightly, because of the rounding of floats.
    soonest[number] = soonestOf.reduceLanes(VectorOperators.MIN) * LaneViews.GRAIN_S * 0.999f;
    latest[number] = latestOf.reduceLanes(VectorOperators.MAX) * LaneViews.GRAIN_S * 1.001f;
  }

  private void makeRoom() {
    int[] rows = rowOf;
    float[] from = soonest, upTo = latest, before = commands;
    int mask = slots - 1;
    allocate(2 * slots);
    for (int number = oldest; number < next; number++) {
      int old = number & mask, slot = number & slots - 1;
      rowOf[slot] = rows[old];
      soonest[slot] = from[old];
      latest[slot] = upTo[old];
      System.arraycopy(before, old * SLOT, commands, slot * SLOT, SLOT);
    }
  }

  private void allocate(int count) {
    slots = count;
    commands = new float[count * SLOT];
    rowOf = new int[count];
    soonest = new float[count];
    latest = new float[count];
    nearFrom = new int[count];
    nearAge = new float[count];
    nearYounger = new float[count];
    nearAged = new float[count];
  }

  @Override
  void read(
      int row, LaneVectors vectors, int[] joined, int[] at, int[] fresh, boolean withVelocity) {
    if (fresh != null) remember();
    // A simulation must be of all worlds; without one, only the vectors with readings are needed.
    LaneVectors read = this.row < row ? ALL : vectors;
    flyTo(row, read, at);
    if (withVelocity) readVelocities(read);
    lookBack(at, fresh);
    if (fresh != null) keep(fresh);
  }

  @Override
  void flyToRow(int row, boolean isLookedAt) {
    if (this.row < row) flyTo(row, ALL, AT_BEGIN);
  }

  /** Simulates to a period, unless the state is already there, and reads the vehicles. */
  private void flyTo(int row, LaneVectors vectors, int[] sampledAt) {
    boolean fliesOn = this.row < row;
    findNear(row, latestS(sampledAt), fliesOn);
    if (!fliesOn) fly(vectors, 0, 0, 1, sampledAt);
    else {
      fly(vectors, (float) periodS, periodGain, periodDecay, sampledAt);
      while (first < next && latest[first & slots - 1] <= ageS(first & slots - 1, row)) first++;
      while (oldest < first
          && latest[oldest & slots - 1] <= ageS(oldest & slots - 1, row) - earliestS) oldest++;
    }
    this.row = row;
  }

  private static float latestS(int[] sampledAt) {
    IntVector latest = IntVector.broadcast(INTS, 0);
    for (int i = 0; i < WORLDS; i += LANES)
      latest = latest.max(IntVector.fromArray(INTS, sampledAt, i));
    return latest.reduceLanes(VectorOperators.MAX) * (LaneViews.GRAIN_S * 1.001f);
  }

  private float ageS(int slot, int row) {
    return rowsS[row - rowOf[slot]];
  }

  private void findNear(int row, float latestSampleS, boolean fliesOn) {
    near = 0;
    for (int number = first; number < next; number++) {
      int slot = number & slots - 1, rows = row - rowOf[slot];
      float age = ageS(slot, row);
      if (soonest[slot] - age < Math.max(latestSampleS, 0f) || soonest[slot] <= age) {
        nearFrom[near] = slot * SLOT;
        nearAge[near] = age;
        nearAged[near] = remains[rows];
        nearYounger[near] = !fliesOn ? age : rows == 1 ? -FUTURE : ageS(slot, row - 1);
        near++;
      }
    }
  }

  /** Simulates a time span, with the commands that take effect in it, and reads the vehicles. */
  private void fly(LaneVectors vectors, float dtS, float gainS, float keepShare, int[] sampledAt) {
    float[] state = this.state, commands = this.commands;
    FloatVector dt = FloatVector.broadcast(SPECIES, dtS),
        minusGain = FloatVector.broadcast(SPECIES, -gainS),
        keep = FloatVector.broadcast(SPECIES, keepShare),
        lag = FloatVector.broadcast(SPECIES, lagS),
        minusLag = FloatVector.broadcast(SPECIES, -lagS),
        halvings = FloatVector.broadcast(SPECIES, -LOG2_E / lagS),
        grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
    for (int n = 0; n < vectors.count; n++) {
      int i = vectors.first[n];
      FloatVector end =
          ((FloatVector)
                  IntVector.fromArray(INTS, sampledAt, i)
                      .convertShape(VectorOperators.I2F, SPECIES, 0))
              .mul(grainS);
      FloatVector decay = powerOf2(end.mul(halvings));
      FloatVector wantedX = FloatVector.fromArray(SPECIES, state, WANTED_X + i),
          wantedY = FloatVector.fromArray(SPECIES, state, WANTED_Y + i),
          lackX = FloatVector.fromArray(SPECIES, state, LACK_X + i),
          lackY = FloatVector.fromArray(SPECIES, state, LACK_Y + i);
      FloatVector
          x = lackX.fma(minusGain, wantedX.fma(dt, FloatVector.fromArray(SPECIES, state, X + i))),
          y = lackY.fma(minusGain, wantedY.fma(dt, FloatVector.fromArray(SPECIES, state, Y + i)));
      lackX = lackX.mul(keep);
      lackY = lackY.mul(keep);
      FloatVector lagDecay = lag.mul(decay);
      FloatVector died = lagDecay.sub(lag);
      FloatVector seenX = lackX.fma(died, wantedX.fma(end, x)),
          seenY = lackY.fma(died, wantedY.fma(end, y));
      // At an early reading, commands that take effect after it are included; lookBack removes them.
      FloatVector horizon = end.max(zero);
      for (int k = 0; k < near; k++) {
        int from = nearFrom[k] + i;
        FloatVector age = FloatVector.broadcast(SPECIES, nearAge[k]),
            younger = FloatVector.broadcast(SPECIES, nearYounger[k]),
            aged = FloatVector.broadcast(SPECIES, nearAged[k]);
        FloatVector acts = FloatVector.fromArray(SPECIES, commands, from + AT);
        FloatVector wait = acts.sub(age);
        VectorMask<Float> isNew = acts.compare(GT, younger);
        VectorMask<Float> begins = acts.compare(LE, age, isNew);
        VectorMask<Float> isSeen = wait.compare(LE, horizon, isNew);
        FloatVector left =
            FloatVector.fromArray(SPECIES, commands, from + GROWTH).mul(aged);
        FloatVector late = minusLag.sub(wait);
        FloatVector response = left.fma(lag, late);
        FloatVector seen = left.fma(lagDecay, late.add(end));
        FloatVector allX = FloatVector.fromArray(SPECIES, commands, from + CHANGE_X),
            allY = FloatVector.fromArray(SPECIES, commands, from + CHANGE_Y),
            changeX = zero.blend(allX, begins),
            changeY = zero.blend(allY, begins);
        x = changeX.fma(response, x);
        y = changeY.fma(response, y);
        lackX = changeX.fma(left, lackX);
        lackY = changeY.fma(left, lackY);
        wantedX = wantedX.add(changeX);
        wantedY = wantedY.add(changeY);
        seenX = zero.blend(allX, isSeen).fma(seen, seenX);
        seenY = zero.blend(allY, isSeen).fma(seen, seenY);
      }
      x.intoArray(state, X + i);
      y.intoArray(state, Y + i);
      lackX.intoArray(state, LACK_X + i);
      lackY.intoArray(state, LACK_Y + i);
      wantedX.intoArray(state, WANTED_X + i);
      wantedY.intoArray(state, WANTED_Y + i);
      seenX.intoArray(state, SEEN_X + i);
      seenY.intoArray(state, SEEN_Y + i);
      end.intoArray(state, END + i);
      decay.intoArray(state, DECAY + i);
    }
  }

  /** Computes the vehicles' velocities at the readings. */
  void readVelocities(LaneVectors vectors) {
    for (int n = 0; n < vectors.count; n++) {
      int i = vectors.first[n];
      FloatVector end = FloatVector.fromArray(SPECIES, state, END + i),
          decay = FloatVector.fromArray(SPECIES, state, DECAY + i);
      FloatVector vx =
          FloatVector.fromArray(SPECIES, state, LACK_X + i)
              .neg()
              .fma(decay, FloatVector.fromArray(SPECIES, state, WANTED_X + i));
      FloatVector vy =
          FloatVector.fromArray(SPECIES, state, LACK_Y + i)
              .neg()
              .fma(decay, FloatVector.fromArray(SPECIES, state, WANTED_Y + i));
      for (int k = 0; k < near; k++) {
        int from = nearFrom[k] + i;
        FloatVector wait = FloatVector.fromArray(SPECIES, commands, from + AT).sub(nearAge[k]);
        VectorMask<Float> isSeen = wait.compare(GT, ZERO).and(wait.compare(LT, end));
        FloatVector left =
            FloatVector.fromArray(SPECIES, commands, from + GROWTH).mul(nearAged[k]).mul(decay);
        FloatVector caughtUp = ZERO.blend(ONE.sub(left), isSeen);
        vx = FloatVector.fromArray(SPECIES, commands, from + CHANGE_X).fma(caughtUp, vx);
        vy = FloatVector.fromArray(SPECIES, commands, from + CHANGE_Y).fma(caughtUp, vy);
      }
      vx.intoArray(state, SEEN_VX + i);
      vy.intoArray(state, SEEN_VY + i);
    }
  }

  /** Corrects the readings that were sampled before the period's start. */
  private void lookBack(int[] at, int[] fresh) {
    for (int i = 0; i < WORLDS; i += LANES) {
      long early = IntVector.fromArray(INTS, at, i).compare(LT, 0).toLong();
      for (; early != 0; early &= early - 1) {
        int world = i + Long.numberOfTrailingZeros(early);
        if (fresh == null || fresh[world] > 0) lookBack(world, at[world]);
      }
    }
  }

  /** Removes from a world's reading the commands that took effect after its sampling time. */
  private void lookBack(int world, int sampledAt) {
    float end = sampledAt * LaneViews.GRAIN_S;
    for (int number = next - 1; number >= oldest; number--) {
      int slot = number & slots - 1, from = slot * SLOT + world;
      float wait = commands[from + AT] - ageS(slot, row), acted = end - wait;
      if (wait <= 0 && acted < 0 && rowOf[slot] < row) {
        double remains = lag.remains(acted);
        float caughtUp = (float) (1 - remains), response = (float) (acted - lag.carriedS(remains));
        float changeX = commands[from + CHANGE_X], changeY = commands[from + CHANGE_Y];
        state[SEEN_X + world] -= changeX * response;
        state[SEEN_Y + world] -= changeY * response;
        state[SEEN_VX + world] -= changeX * caughtUp;
        state[SEEN_VY + world] -= changeY * caughtUp;
      }
    }
  }
}
