package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GE;
import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.RolloutAgent;
import skein.lanes.policy.Directions;

/**
 * The vehicles of one role in many worlds, whose commands act at times of their own in each. They fly
 * in pieces, each known from its begin on; the pieces of the near past are kept, so that a vehicle can
 * be read at any moment of it. A piece ends a time after its begin, if no command ends it before; then
 * another begins under the same command. A slot holds the piece that was the newest in each world when
 * it was filled. Times are in grains since the episode's begin, modulo 2³²: no two that are compared lie
 * as far apart.
 */
public abstract class LaneFlights extends LaneVehicles {
  /**
   * Where the numbers of a piece stand: the command's direction, north, then east; what follows, the kind
   * of vehicle says.
   */
  static final int ALONG_X = 0, ALONG_Y = WORLDS;

  /** The longest a piece may last, s: far less than times are told apart by. */
  public static final double MOST_PIECE_S = 1;

  private final int size, keptRows, periodGrains, pieceGrains;

  /** A power of two. */
  private int slots = 16;

  private int[] begins, rowOf;
  float[] pieces;

  /** How many slots were filled; the newest is one less. */
  private int filled;

  /** The times asked for; the pieces in which they lie, and how long after the begin of these, s. */
  private final int[] until = new int[WORLDS];

  final float[] chosen, sinceS = new float[WORLDS];

  // Pieces that end by themselves: where, when, and under which command others follow.
  private final LaneVectors over = new LaneVectors();
  private final int[] ends = new int[WORLDS], next = new int[WORLDS];
  private final Directions along = new Directions(WORLDS);

  private static final LaneVectors ALL = LaneVectors.all();

  /**
   * @param numbers that a piece has
   * @param pieceS how long a piece lasts at most, no longer than {@link #MOST_PIECE_S}
   */
  LaneFlights(RolloutAgent agent, int numbers, double pieceS, LoopLanes loop) {
    super(agent, 0);
    size = numbers * WORLDS;
    keptRows = loop.keptRows();
    periodGrains = LaneViews.grains(loop.periodS());
    pieceGrains = LaneViews.grains(pieceS);
    begins = new int[slots * WORLDS];
    rowOf = new int[slots];
    pieces = new float[slots * size];
    chosen = new float[size];
  }

  @Override
  final void start() {
    super.start();
    Arrays.fill(begins, 0, WORLDS, 0);
    Arrays.fill(pieces, 0, size, 0f);
    rest(pieces);
    rowOf[0] = 0;
    filled = 1;
  }

  /** Fills in a piece at rest where {@link #state} tells, from index 0 on. */
  abstract void rest(float[] pieces);

  /**
   * Flies {@link #chosen} pieces for {@link #sinceS}.
   *
   * @param at where in an array the positions go, north, then east, and behind them the velocities
   */
  abstract void fly(float[] into, int at, boolean withVelocity);

  /** The same to where others {@link #begin}. */
  abstract void flyOn();

  /**
   * New pieces begin where {@link #chosen} ones were {@link #flyOn flown} to, under commands, in worlds where
   * {@code acts} is less than {@link LaneOffers#NONE}; elsewhere the chosen ones go on.
   *
   * @param at where in {@link #pieces} they go
   */
  abstract void begin(LaneVectors vectors, int at, int[] acts, Directions commanded);

  @Override
  final void read(
      int row, LaneVectors vectors, int[] joined, int[] at, int[] fresh, boolean withVelocity) {
    if (fresh != null) remember();
    if (fresh == null) ask(row, vectors, at, joined, Integer.MIN_VALUE);
    else ask(row, vectors, at, fresh, 1);
    goOn(row, vectors);
    choose(vectors);
    fly(state, SEEN_X, withVelocity);
    if (fresh != null) keep(fresh);
  }

  @Override
  final void flyToRow(int row, boolean isLookedAt) {
    Arrays.fill(until, row * periodGrains);
    // No piece lasts longer than times are told apart by.
    goOn(row, ALL);
    if (!isLookedAt) return;
    choose(ALL);
    fly(state, X, false);
  }

  @Override
  final void act(int row, LaneVectors vectors, int[] acts, Directions commanded) {
    ask(row, vectors, acts, acts, Integer.MIN_VALUE);
    goOn(row, vectors);
    chooseNewest(vectors);
    flyOn();
    begin(vectors, fill(row, vectors, until), acts, commanded);
  }

  /**
   * Asks for times from a row's begin where a number is at least {@code least} and below {@link
   * LaneOffers#NONE}, and elsewhere for the begin of the newest piece.
   */
  private void ask(int row, LaneVectors vectors, int[] times, int[] numbers, int least) {
    int newest = (filled - 1 & slots - 1) * WORLDS;
    IntVector begin = IntVector.broadcast(INTS, row * periodGrains),
        from = IntVector.broadcast(INTS, least),
        none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector number = IntVector.fromArray(INTS, numbers, i);
      VectorMask<Integer> asked = number.compare(GE, from).and(number.compare(LT, none));
      IntVector.fromArray(INTS, begins, newest + i)
          .blend(IntVector.fromArray(INTS, times, i).add(begin), asked)
          .intoArray(until, i);
    }
  }

  /** Lets pieces that end before the times asked for be followed by others. */
  private void goOn(int row, LaneVectors vectors) {
    while (findOver(vectors)) {
      copyNewest(over);
      flyOn();
      System.arraycopy(chosen, ALONG_X, along.cos, 0, WORLDS);
      System.arraycopy(chosen, ALONG_Y, along.sin, 0, WORLDS);
      begin(over, fill(row, over, next), ends, along);
    }
  }

  /** Whether newest pieces end before the times asked for: where, when, and how long they last. */
  private boolean findOver(LaneVectors vectors) {
    int newest = (filled - 1 & slots - 1) * WORLDS;
    float pieceS = pieceGrains * LaneViews.GRAIN_S;
    IntVector piece = IntVector.broadcast(INTS, pieceGrains);
    over.count = 0;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector begin = IntVector.fromArray(INTS, begins, newest + i);
      VectorMask<Integer> isOver = IntVector.fromArray(INTS, until, i).sub(begin).compare(GT, piece);
      if (isOver.anyTrue()) {
        over.first[over.count++] = i;
        begin.add(piece, isOver).intoArray(next, i);
        IntVector.broadcast(INTS, LaneOffers.NONE).blend(0, isOver).intoArray(ends, i);
        FloatVector.broadcast(SPECIES, 0f).blend(pieceS, isOver.cast(SPECIES)).intoArray(sinceS, i);
      }
    }
    return over.count > 0;
  }

  /** Takes a slot for pieces that begin at these times; in other vectors, it holds what the newest does. */
  private int fill(int row, LaneVectors vectors, int[] times) {
    if (filled >= slots && rowOf[filled + 1 & slots - 1] >= row - keptRows) makeRoom();
    int newest = filled - 1 & slots - 1, slot = filled++ & slots - 1;
    rowOf[slot] = row;
    if (vectors.count * LANES < WORLDS) {
      System.arraycopy(begins, newest * WORLDS, begins, slot * WORLDS, WORLDS);
      System.arraycopy(pieces, newest * size, pieces, slot * size, size);
    }
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector.fromArray(INTS, times, i).intoArray(begins, slot * WORLDS + i);
    }
    return slot * size;
  }

  private void makeRoom() {
    int before = slots;
    int[] begun = begins, rows = rowOf;
    float[] held = pieces;
    slots = 2 * before;
    begins = new int[slots * WORLDS];
    rowOf = new int[slots];
    pieces = new float[slots * size];
    for (int number = filled - before; number < filled; number++) {
      int from = number & before - 1, to = number & slots - 1;
      rowOf[to] = rows[from];
      System.arraycopy(begun, from * WORLDS, begins, to * WORLDS, WORLDS);
      System.arraycopy(held, from * size, pieces, to * size, size);
    }
  }

  /** The newest pieces, and how long after their begin the times asked for are. */
  private void chooseNewest(LaneVectors vectors) {
    int newest = (filled - 1 & slots - 1) * WORLDS;
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector since =
          IntVector.fromArray(INTS, until, i).sub(IntVector.fromArray(INTS, begins, newest + i));
      ((FloatVector) since.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(grainS).intoArray(sinceS, i);
    }
    copyNewest(vectors);
  }

  private void copyNewest(LaneVectors vectors) {
    int newest = (filled - 1 & slots - 1) * size;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      for (int number = i; number < size; number += WORLDS)
        FloatVector.fromArray(SPECIES, pieces, newest + number).intoArray(chosen, number);
    }
  }

  /** The pieces in which the times asked for lie, and how long after their begin. */
  private void choose(LaneVectors vectors) {
    copyNewest(vectors);
    int[] begins = this.begins, until = this.until;
    float[] pieces = this.pieces, chosen = this.chosen;
    int size = this.size, mask = slots - 1, newest = filled - 1, oldest = Math.max(0, filled - slots);
    IntVector zero = IntVector.broadcast(INTS, 0);
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k], back = newest;
      IntVector time = IntVector.fromArray(INTS, until, i);
      IntVector since = time.sub(IntVector.fromArray(INTS, begins, (back & mask) * WORLDS + i));
      VectorMask<Integer> late = since.compare(LT, zero);
      while (late.anyTrue()) {
        if (--back < oldest)
          throw new IllegalStateException("a reading is older than " + slots + " pieces of a flight");
        since =
            since.blend(
                time.sub(IntVector.fromArray(INTS, begins, (back & mask) * WORLDS + i)), late);
        VectorMask<Float> isLate = late.cast(SPECIES);
        int from = (back & mask) * size;
        for (int number = i; number < size; number += WORLDS)
          FloatVector.fromArray(SPECIES, pieces, from + number).intoArray(chosen, number, isLate);
        late = since.compare(LT, zero);
      }
      ((FloatVector) since.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(grainS).intoArray(sinceS, i);
    }
  }
}
