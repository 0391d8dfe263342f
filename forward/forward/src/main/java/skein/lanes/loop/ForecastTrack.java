package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.I2F;
import static jdk.incubator.vector.VectorOperators.LE;
import static jdk.incubator.vector.VectorOperators.LT;
import static jdk.incubator.vector.VectorOperators.MAX;
import static jdk.incubator.vector.VectorOperators.MIN;
import static jdk.incubator.vector.VectorOperators.NE;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forecast.VehicleForecast;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LanePolicy;

/** The recent history of one vehicle in many worlds: its last reading, the commands sent since, and which of
 * these are assumed to be in effect. The scalar reference is {@link VehicleForecast} with a {@link
 * skein.vehicle.PlantModel}, in space a {@link skein.vehicle.SpatialModel}. Of the time before the reading, only the commands of the last dead time and the
 * state of {@link ForecastVehicles} matter.
 *
 * <p>{@link #lay} computes the track from the reading to a moment: a list of turns, at each of which the
 * vehicle begins to follow another direction. The first {@link #held} turns were fixed at readings; later
 * turns are estimated anew each time. No time here depends on positions, so seconds in floats are exact
 * enough.
 */
final class ForecastTrack {
  private static final int WORLDS = LanePolicy.WORLDS, NONE = LaneOffers.NONE;

  private static final float GRACE_S = VehicleForecast.Grace() * 1e-9f;

  /** A time before all known events, s. */
  private static final float LONG_AGO_S = -1e9f;

  private static final int FAR = 1 << 30;

  /** Maximum number of fixed turns: those within a dead time before the reading, and the last one before
   * them.
   */
  final int held;

  /** Dead time: from the arrival of a command until the vehicle is assumed to follow it, s. */
  final float deadS;

  private final int periodGrains, farRows;
  private final float periodS;

  /** The period in which the newest reading became known, or -1 before the first reading; and its sampling
   * time, in grains from that period's start.
   */
  final int[] knownRow = new int[WORLDS], readAt = new int[WORLDS];

  /** 1 in worlds whose newest reading became known in this period, else 0. */
  final int[] fresh = new int[WORLDS];

  /** 1 in worlds whose present reading is the first, else 0; and the altitude, m down, that their vehicles
   * are assumed to hold until their first command. Only of readings with errors in space.
   */
  final int[] first = new int[WORLDS];

  final float[] restZ = new float[WORLDS];

  // The period of the oldest stored command, which was in effect at the reading; and the direction before it.
  private final int[] head = new int[WORLDS];
  private final Directions before, prior;

  /** Whether commands have a vertical part. */
  private final boolean inSpace;

  // By period modulo slots: time of the command, NONE without one, and time at which its arrival was known;
  // from the period's start.
  private int slots = 8, oldest;
  private int[] sentAt = new int[slots * WORLDS], answeredAt = new int[slots * WORLDS];
  private Directions sent;

  /** Times of the track's turns, s from the reading, ascending; {@link #turn} has the direction from each on.
   */
  float[] turnS;

  Directions turn;

  /** The arrays of {@link #turnS} and {@link #turn}, for copying. */
  private float[][] ofTurns;

  /** Of each vector: index of the first valid turn (earlier slots of {@link #held} are unused), and end of
   * the valid turns.
   */
  final int[] heldFrom = new int[WORLDS / LANES], turnsOf = new int[WORLDS / LANES];

  int turns;

  /** The period of the first command on the track, of each vector. */
  private final int[] firstOf = new int[WORLDS / LANES];

  /** Whether some command on the track may be presumed lost within the next period. */
  private boolean mayLose;

  /** Length of the track, s; and age of the reading at the time of sending, which is the first part of the
   * track, s.
   */
  final float[] endS = new float[WORLDS], ageS = new float[WORLDS];

  /** 1 where a command contributes a turn; 0 where the entry repeats the turn before. */
  private int[] counts;

  final ArrivedReadings arrived = new ArrivedReadings();

  /** @param deadS time from the arrival of a command until the vehicle is assumed to follow it, s
   * @param inSpace whether commands have a vertical part
   */
  ForecastTrack(double periodS, double deadS, boolean inSpace) {
    this.inSpace = inSpace;
    before = new Directions(WORLDS, inSpace);
    prior = new Directions(WORLDS, inSpace);
    sent = new Directions(slots * WORLDS, inSpace);
    this.periodS = (float) periodS;
    this.deadS = (float) deadS;
    periodGrains = LaneViews.grains(periodS);
    farRows = FAR / periodGrains;
    held = 4 + 4 * (int) Math.ceil(deadS / periodS);
    makeTurns();
  }

  private void makeTurns() {
    turnS = new float[(held + 1 + slots) * WORLDS];
    turn = new Directions(turnS.length, inSpace);
    ofTurns = inSpace
        ? new float[][] {turnS, turn.cos, turn.sin, turn.third, turn.holds}
        : new float[][] {turnS, turn.cos, turn.sin};
    counts = new int[turnS.length];
  }

  /** Resets to the start of an episode.
   *
   * @param startZ altitudes by world, m down, which vehicles in space hold at first
   */
  void start(float[] startZ) {
    Arrays.fill(knownRow, -1);
    Arrays.fill(readAt, -FAR);
    arrived.start();
    Arrays.fill(head, 0);
    Arrays.fill(before.cos, 0);
    Arrays.fill(before.sin, 0);
    Arrays.fill(turnS, LONG_AGO_S);
    Arrays.fill(turn.cos, 0);
    Arrays.fill(turn.sin, 0);
    if (inSpace) for (Directions each : new Directions[] {before, turn}) each.level(startZ);
    Arrays.fill(heldFrom, held - 1);
    oldest = 0;
  }

  void startRow(int row) {
    Arrays.fill(fresh, 0);
    IntVector here = IntVector.broadcast(INTS, row);
    IntVector first = here.add(0);
    for (int i = 0; i < WORLDS; i += LANES) {
      first = first.min(IntVector.fromArray(INTS, head, i));
      here.sub(IntVector.fromArray(INTS, knownRow, i))
          .min(farRows)
          .mul(-periodGrains)
          .add(IntVector.fromArray(INTS, readAt, i))
          .intoArray(arrived.newestAt, i);
    }
    oldest = Math.max(oldest, first.reduceLanes(MIN));
    if (row - oldest >= slots) makeRoom(row);
    int slot = (row & slots - 1) * WORLDS;
    Arrays.fill(sentAt, slot, slot + WORLDS, NONE);
  }

  private void makeRoom(int row) {
    int count = slots;
    int[] sentBefore = sentAt, answeredBefore = answeredAt;
    float[][] standing = ofTurns;
    Directions directions = sent;
    slots = 2 * count;
    sentAt = new int[slots * WORLDS];
    answeredAt = new int[slots * WORLDS];
    sent = new Directions(slots * WORLDS, inSpace);
    for (int r = oldest; r < row; r++) {
      int from = (r & count - 1) * WORLDS, to = (r & slots - 1) * WORLDS;
      System.arraycopy(sentBefore, from, sentAt, to, WORLDS);
      System.arraycopy(answeredBefore, from, answeredAt, to, WORLDS);
      System.arraycopy(directions.cos, from, sent.cos, to, WORLDS);
      System.arraycopy(directions.sin, from, sent.sin, to, WORLDS);
      if (inSpace) {
        System.arraycopy(directions.third, from, sent.third, to, WORLDS);
        System.arraycopy(directions.holds, from, sent.holds, to, WORLDS);
      }
    }
    makeTurns();
    for (int i = 0; i < ofTurns.length; i++)
      System.arraycopy(standing[i], 0, ofTurns[i], 0, held * WORLDS);
  }

  /** Records the commands that were sent in a period.
   *
   * @param times time of sending, in grains from the period's start; {@link LaneOffers#NONE} in worlds
   *   without a command
   * @param answers time at which the answer arrives, likewise; {@link LaneOffers#NONE} if there is none
   */
  void send(int row, LaneVectors vectors, int[] times, int[] answers, Directions directions) {
    int slot = (row & slots - 1) * WORLDS;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, times, i).intoArray(sentAt, slot + i);
      IntVector.fromArray(INTS, answers, i).intoArray(answeredAt, slot + i);
      FloatVector.fromArray(SPECIES, directions.cos, i).intoArray(sent.cos, slot + i);
      FloatVector.fromArray(SPECIES, directions.sin, i).intoArray(sent.sin, slot + i);
      if (inSpace) {
        FloatVector.fromArray(SPECIES, directions.third, i).intoArray(sent.third, slot + i);
        FloatVector.fromArray(SPECIES, directions.holds, i).intoArray(sent.holds, slot + i);
      }
    }
  }

  /** Computes the track from the previous reading to the next one that arrived in this period, in each world
   * that has one. The caller must call {@link #conclude} after each.
   *
   * @return false if no world has another reading
   */
  boolean layToReading(int row) {
    if (!arrived.next()) return false;
    lay(row, arrived.vectors, arrived.receivedAt(), arrived.receivedAt(), arrived.toS(), arrived.fromS());
    aimAt(row, arrived.madeAt());
    return true;
  }

  /** Holds the altitude of the present readings, in worlds where they are the first.
   *
   * @return whether there is one
   */
  boolean rest(float[] read) {
    if (!inSpace) return false;
    boolean any = false;
    for (int world = 0; world < WORLDS; world++) {
      boolean is = knownRow[world] < 0 && arrived.enters[world] > 0;
      first[world] = is ? 1 : 0;
      any |= is;
      restZ[world] = read[LaneVehicles.SEEN_Z + world];
      if (is) for (Directions each : new Directions[] {before, turn}) each.level(world, WORLDS, restZ[world]);
    }
    return any;
  }

  /** Fixes the turns that took effect before the present readings, from what was known at their arrival. */
  void conclude(int row) {
    settle(row);
    renew(row, arrived.madeAt());
  }

  private void renew(int row, int[] made) {
    IntVector here = IntVector.broadcast(INTS, row);
    for (int k = 0; k < arrived.vectors.count; k++) {
      int i = arrived.vectors.first[k];
      IntVector enter = IntVector.fromArray(INTS, arrived.enters, i);
      VectorMask<Integer> does = enter.compare(GT, 0);
      IntVector.fromArray(INTS, readAt, i)
          .blend(IntVector.fromArray(INTS, made, i), does)
          .intoArray(readAt, i);
      IntVector.fromArray(INTS, knownRow, i).blend(here, does).intoArray(knownRow, i);
      enter.max(IntVector.fromArray(INTS, fresh, i)).intoArray(fresh, i);
    }
  }

  /** Sets the length of the track to the time between the previous and the present reading; 0 at the first
   * reading.
   */
  private void aimAt(int row, int[] made) {
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f);
    for (int k = 0; k < arrived.vectors.count; k++) {
      int i = arrived.vectors.first[k];
      zero.blend(sinceReadingS(row, i, IntVector.fromArray(INTS, made, i)), flies(i)).intoArray(endS, i);
    }
  }

  /** Time from the newest reading to a moment, s; the moment is in grains from the period's start. */
  private FloatVector sinceReadingS(int row, int i, IntVector moment) {
    return ((FloatVector) moment.sub(IntVector.fromArray(INTS, readAt, i)).convertShape(I2F, SPECIES, 0))
        .mul(LaneViews.GRAIN_S)
        .add(
            ((FloatVector)
                    IntVector.broadcast(INTS, row)
                        .sub(IntVector.fromArray(INTS, knownRow, i))
                        .convertShape(I2F, SPECIES, 0))
                .mul(periodS));
  }

  /** The worlds in which a reading is added that is not the first. */
  private VectorMask<Float> flies(int i) {
    return IntVector.fromArray(INTS, knownRow, i)
        .compare(GE, 0)
        .and(IntVector.fromArray(INTS, arrived.enters, i).compare(GT, 0))
        .cast(SPECIES);
  }

  /** Stores the turns whose commands took effect before the present readings. */
  private void settle(int row) {
    float[] turnS = this.turnS, turnX = turn.cos, turnY = turn.sin;
    float[] beforeX = before.cos, beforeY = before.sin, priorX = prior.cos, priorY = prior.sin;
    int mask = slots - 1, last = (held - 1) * WORLDS, first = (held + 1) * WORLDS;
    IntVector none = IntVector.broadcast(INTS, NONE);
    FloatVector longAgo = FloatVector.broadcast(SPECIES, LONG_AGO_S),
        zero = FloatVector.broadcast(SPECIES, 0f),
        dead = FloatVector.broadcast(SPECIES, deadS);
    boolean isFull = false;
    for (int k = 0; k < arrived.vectors.count; k++) {
      int i = arrived.vectors.first[k];
      VectorMask<Float> flies = flies(i);
      if (!flies.anyTrue()) continue;
      FloatVector span = FloatVector.fromArray(SPECIES, endS, i);
      FloatVector until = span.add(dead);
      int laidFrom = firstOf[i / LANES], turns = turnsOf[i / LANES], since = heldFrom[i / LANES];
      for (int from = held * WORLDS + i; from < turns * WORLDS; from += WORLDS) {
        FloatVector at = FloatVector.fromArray(SPECIES, turnS, from),
            x = FloatVector.fromArray(SPECIES, turnX, from),
            y = FloatVector.fromArray(SPECIES, turnY, from);
        VectorMask<Float> changes =
            FloatVector.fromArray(SPECIES, turnX, last + i)
                .compare(NE, x)
                .or(FloatVector.fromArray(SPECIES, turnY, last + i).compare(NE, y));
        if (inSpace)
          changes = changes.or(differ(turn.third, last + i, from)).or(differ(turn.holds, last + i, from));
        VectorMask<Float> stands = changes.and(at.compare(LE, until)).and(flies);
        if (stands.anyTrue()) {
          // The last turn that took effect by then replaces the stored one; later turns follow it.
          VectorMask<Float> follows = stands.and(at.compare(GT, span));
          if (follows.anyTrue()) {
            int oldestAt = since * WORLDS + i;
            FloatVector oldestS = FloatVector.fromArray(SPECIES, turnS, oldestAt);
            // Drop turns that no world needs: otherwise those that follow in one world would take slots in
            // all.
            boolean isNeeded =
                oldestAt >= last
                    || FloatVector.fromArray(SPECIES, turnS, oldestAt + WORLDS)
                        .compare(GT, oldestS.max(span))
                        .and(follows)
                        .anyTrue();
            isFull |= isNeeded && since == 0;
            if (isNeeded && since > 0) {
              since--;
              for (float[] each : ofTurns)
                FloatVector.fromArray(SPECIES, each, oldestAt).intoArray(each, oldestAt - WORLDS);
            }
            for (int to = oldestAt; to < last; to += WORLDS)
              for (float[] each : ofTurns)
                FloatVector.fromArray(SPECIES, each, to)
                    .blend(FloatVector.fromArray(SPECIES, each, to + WORLDS), follows)
                    .intoArray(each, to);
          }
          for (float[] each : ofTurns)
            FloatVector.fromArray(SPECIES, each, last + i)
                .blend(FloatVector.fromArray(SPECIES, each, from), stands)
                .intoArray(each, last + i);
        }
      }
      IntVector earliest = IntVector.fromArray(INTS, head, i);
      FloatVector.fromArray(SPECIES, beforeX, i).intoArray(priorX, i);
      FloatVector.fromArray(SPECIES, beforeY, i).intoArray(priorY, i);
      if (inSpace) {
        FloatVector.fromArray(SPECIES, before.third, i).intoArray(prior.third, i);
        FloatVector.fromArray(SPECIES, before.holds, i).intoArray(prior.holds, i);
      }
      for (int r = laidFrom; r < row; r++) {
        int slot = (r & mask) * WORLDS + i, at = first + (r - laidFrom) * WORLDS + i;
        VectorMask<Float> present =
            IntVector.fromArray(INTS, sentAt, slot)
                .compare(LT, none)
                .and(earliest.compare(LE, r))
                .cast(SPECIES);
        VectorMask<Float> acted =
            IntVector.fromArray(INTS, counts, at)
                .compare(GT, 0)
                .cast(SPECIES)
                .and(FloatVector.fromArray(SPECIES, turnS, at).compare(LE, until))
                .and(flies);
        FloatVector x = FloatVector.fromArray(SPECIES, priorX, i),
            y = FloatVector.fromArray(SPECIES, priorY, i);
        if (acted.anyTrue()) {
          IntVector.fromArray(INTS, head, i).blend(r, acted.cast(INTS)).intoArray(head, i);
          FloatVector.fromArray(SPECIES, beforeX, i).blend(x, acted).intoArray(beforeX, i);
          FloatVector.fromArray(SPECIES, beforeY, i).blend(y, acted).intoArray(beforeY, i);
          if (inSpace) {
            blend(before.third, i, prior.third, i, acted);
            blend(before.holds, i, prior.holds, i, acted);
          }
        }
        x.blend(FloatVector.fromArray(SPECIES, sent.cos, slot), present).intoArray(priorX, i);
        y.blend(FloatVector.fromArray(SPECIES, sent.sin, slot), present).intoArray(priorY, i);
        if (inSpace) {
          blend(prior.third, i, sent.third, slot, present);
          blend(prior.holds, i, sent.holds, slot, present);
        }
      }
      boolean isPast = true;
      for (int number = since; number < held; number++) {
        FloatVector at = FloatVector.fromArray(SPECIES, turnS, number * WORLDS + i);
        at = at.blend(at.sub(span).max(longAgo), flies);
        at.intoArray(turnS, number * WORLDS + i);
        isPast &= !at.compare(GT, zero).anyTrue();
        if (isPast) since = number;
      }
      heldFrom[i / LANES] = since;
    }
    if (isFull)
      throw new IllegalStateException(
          "more than " + held + " commands act within a dead time of " + deadS + " s");
  }

  private static VectorMask<Float> differ(float[] of, int one, int other) {
    return FloatVector.fromArray(SPECIES, of, one).compare(NE, FloatVector.fromArray(SPECIES, of, other));
  }

  private static void blend(float[] into, int at, float[] of, int from, VectorMask<Float> where) {
    FloatVector.fromArray(SPECIES, into, at)
        .blend(FloatVector.fromArray(SPECIES, of, from), where)
        .intoArray(into, at);
  }

  /** Computes the track from the newest reading until a command sent at a given moment takes effect.
   *
   * @param known deadline, by world, of the answers to consider, in grains from the period's start
   * @param when time of sending of the new command, in grains from the period's start; {@link
   *   LaneOffers#NONE} in worlds without a decision
   * @param isFirst whether it is the first track since readings were added
   */
  void lay(int row, LaneVectors vectors, int[] known, int[] when, MeanDelays delays, boolean isFirst) {
    // Except for commands presumed lost meanwhile, the tracks to all moments have equal turns.
    if (isFirst || mayLose) lay(row, vectors, known, when, delays.toS, delays.fromS);
    aim(row, vectors, known, when, delays.toS);
  }

  private void aim(int row, LaneVectors vectors, int[] known, int[] when, float[] toS) {
    IntVector none = IntVector.broadcast(INTS, NONE);
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector now = IntVector.fromArray(INTS, when, i);
      now = now.blend(IntVector.fromArray(INTS, known, i), now.compare(EQ, none));
      FloatVector age = sinceReadingS(row, i, now);
      age.intoArray(ageS, i);
      age.add(FloatVector.fromArray(SPECIES, toS, i)).max(zero).intoArray(endS, i);
    }
  }

  /** Computes the turns from the answers received by {@code known}; a command without an answer by {@code
   * when} may be presumed lost.
   */
  private void lay(int row, LaneVectors vectors, int[] known, int[] when, float[] toS, float[] fromS) {
    float[] turnS = this.turnS, turnX = turn.cos, turnY = turn.sin;
    int mask = slots - 1, standing = (held - 1) * WORLDS;
    turns = 0;
    mayLose = false;
    IntVector none = IntVector.broadcast(INTS, NONE),
        no = IntVector.broadcast(INTS, 0),
        yes = IntVector.broadcast(INTS, 1);
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        rowS = FloatVector.broadcast(SPECIES, periodS),
        zero = FloatVector.broadcast(SPECIES, 0f),
        half = FloatVector.broadcast(SPECIES, 0.5f),
        grace = FloatVector.broadcast(SPECIES, GRACE_S),
        dead = FloatVector.broadcast(SPECIES, deadS),
        longAgo = FloatVector.broadcast(SPECIES, LONG_AGO_S);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector until = IntVector.fromArray(INTS, known, i),
          now = IntVector.fromArray(INTS, when, i),
          rows = IntVector.fromArray(INTS, knownRow, i),
          read = IntVector.fromArray(INTS, readAt, i),
          earliest = IntVector.fromArray(INTS, head, i);
      now = now.blend(until, now.compare(EQ, none));
      FloatVector to = FloatVector.fromArray(SPECIES, toS, i),
          roundTrip = to.add(FloatVector.fromArray(SPECIES, fromS, i)),
          patience = roundTrip.add(roundTrip).add(grace);
      int place = standing + WORLDS + i;
      FloatVector at = FloatVector.fromArray(SPECIES, turnS, standing + i),
          x = FloatVector.fromArray(SPECIES, turnX, standing + i),
          y = FloatVector.fromArray(SPECIES, turnY, standing + i);
      at.intoArray(turnS, place);
      x.intoArray(turnX, place);
      y.intoArray(turnY, place);
      FloatVector third = zero, holds = zero;
      if (inSpace) {
        third = FloatVector.fromArray(SPECIES, turn.third, standing + i);
        holds = FloatVector.fromArray(SPECIES, turn.holds, standing + i);
        third.intoArray(turn.third, place);
        holds.intoArray(turn.holds, place);
      }
      FloatVector latest = to.add(longAgo);
      IntVector seen = earliest.sub(earliest);
      int first = Math.max(oldest, Math.min(earliest.reduceLanes(MIN), row));
      firstOf[i / LANES] = first;
      turnsOf[i / LANES] = held + 1 + row - first;
      turns = Math.max(turns, turnsOf[i / LANES]);
      for (int r = first; r < row; r++) {
        int slot = (r & mask) * WORLDS + i;
        place += WORLDS;
        int begin = (int) Math.max((r - row) * (long) periodGrains, -FAR);
        IntVector sending = IntVector.fromArray(INTS, sentAt, slot),
            answered = IntVector.fromArray(INTS, answeredAt, slot);
        VectorMask<Integer> present = sending.compare(LT, none).and(earliest.compare(LE, r));
        VectorMask<Integer> later = seen.compare(GT, 0);
        VectorMask<Float> isKnown = answered.add(begin).compare(LE, until).cast(SPECIES);
        FloatVector acts =
            ((FloatVector) sending.sub(read).convertShape(I2F, SPECIES, 0))
                .mul(grainS)
                .add(((FloatVector) rows.neg().add(r).convertShape(I2F, SPECIES, 0)).mul(rowS))
                .add(to);
        FloatVector off =
            ((FloatVector) answered.sub(sending).convertShape(I2F, SPECIES, 0))
                .mul(grainS)
                .sub(roundTrip)
                .mul(half);
        acts = acts.add(zero.blend(off, isKnown)).max(latest);
        FloatVector wait =
            ((FloatVector) now.sub(sending).convertShape(I2F, SPECIES, 0))
                .mul(grainS)
                .add((row - r) * periodS);
        VectorMask<Float> unanswered = present.and(later).cast(SPECIES).andNot(isKnown);
        mayLose |= wait.add(rowS).compare(GT, patience).and(unanswered).anyTrue();
        VectorMask<Float> count = present.cast(SPECIES).andNot(wait.compare(GT, patience).and(unanswered));
        VectorMask<Float> late = present.andNot(later).cast(SPECIES).and(acts.compare(GT, zero));
        if (late.anyTrue()) {
          // The command acts later than estimated at the reading. The slot before it has no turn of its own.
          at.blend(dead, late).intoArray(turnS, place - WORLDS);
          x.blend(FloatVector.fromArray(SPECIES, before.cos, i), late).intoArray(turnX, place - WORLDS);
          y.blend(FloatVector.fromArray(SPECIES, before.sin, i), late).intoArray(turnY, place - WORLDS);
          if (inSpace) {
            third
                .blend(FloatVector.fromArray(SPECIES, before.third, i), late)
                .intoArray(turn.third, place - WORLDS);
            holds
                .blend(FloatVector.fromArray(SPECIES, before.holds, i), late)
                .intoArray(turn.holds, place - WORLDS);
          }
        }
        seen = seen.blend(yes, present);
        latest = latest.blend(acts, count);
        at = at.blend(acts.max(zero).add(dead), count);
        x = x.blend(FloatVector.fromArray(SPECIES, sent.cos, slot), count);
        y = y.blend(FloatVector.fromArray(SPECIES, sent.sin, slot), count);
        at.intoArray(turnS, place);
        x.intoArray(turnX, place);
        y.intoArray(turnY, place);
        if (inSpace) {
          third = third.blend(FloatVector.fromArray(SPECIES, sent.third, slot), count);
          holds = holds.blend(FloatVector.fromArray(SPECIES, sent.holds, slot), count);
          third.intoArray(turn.third, place);
          holds.intoArray(turn.holds, place);
        }
        no.blend(yes, count.cast(INTS)).intoArray(counts, place);
      }
    }
  }

  /** Reports the sampling time of the newest reading.
   *
   * @param joined set to {@link LaneOffers#NONE} in worlds that have no reading of the vehicle yet
   * @param into receives the times, in grains from the period's start
   */
  void tell(int[] joined, int[] into) {
    System.arraycopy(arrived.newestAt, 0, into, 0, WORLDS);
    IntVector none = IntVector.broadcast(INTS, NONE);
    for (int i = 0; i < WORLDS; i += LANES)
      IntVector.fromArray(INTS, joined, i)
          .blend(none, IntVector.fromArray(INTS, knownRow, i).compare(LT, 0))
          .intoArray(joined, i);
  }
}
