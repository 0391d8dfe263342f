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

/** The vehicles of one role in many worlds, whose commands take effect at different times in each. A vehicle
 * moves in pieces, each with a closed form; recent pieces are stored, so that the vehicle can be read at any
 * recent moment. A piece has a maximum length; if no command ends it before, the next piece continues under
 * its command. A slot stores one piece per world: the newest at the time the slot was filled. Times are in
 * grains since the episode's start, modulo 2³²; two compared times never differ by half of that.
 */
public abstract class LaneFlights extends LaneVehicles {
  /** Offsets in a piece: the command's direction north, then east, and in space its vertical part; further
   * components belong to the subclass.
   */
  static final int ALONG_X = 0, ALONG_Y = WORLDS, THIRD = 2 * WORLDS, HOLDS = 3 * WORLDS;

  /** Maximum duration of a piece, s; far less than the range of times that can be compared. */
  public static final double MOST_PIECE_S = 1;

  private final int size, keptRows, periodGrains, pieceGrains;

  /** Number of slots that are allocated, a power of two. */
  private int slots = 16;

  private int[] begins, rowOf;
  float[] pieces;

  /** Number of slots filled so far; the newest slot is the one before it, modulo the number of slots. */
  private int filled;

  /** Times at which vehicles are to be read; the pieces of these times, and the time since each piece's
   * start, s.
   */
  private final int[] until = new int[WORLDS];

  final float[] chosen, sinceS = new float[WORLDS];

  // Vectors with a piece that ends without a command; the worlds, and the begins of the next pieces.
  private final LaneVectors over = new LaneVectors();
  private final int[] ends = new int[WORLDS], next = new int[WORLDS];

  private static final LaneVectors ALL = LaneVectors.all();

  /** @param numbers number of floats per piece and world
   * @param pieceS duration of a piece without a command, s, at most {@link #MOST_PIECE_S}
   * @param deadTimeS time from the arrival of a command until its piece begins, s
   */
  LaneFlights(
      RolloutAgent agent,
      int numbers,
      double pieceS,
      double deadTimeS,
      LoopLanes loop,
      boolean inSpace) {
    super(agent, 0, inSpace);
    size = numbers * WORLDS;
    keptRows = loop.keptRows() + (int) Math.ceil(deadTimeS / loop.periodS());
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

  /** Writes a piece in which each vehicle rests at its position in {@link #state}, from index 0 on. */
  abstract void rest(float[] pieces);

  /** Computes the position, and if required the velocity, {@link #sinceS} after the start of each {@link
   * #chosen} piece.
   *
   * @param at index of the results, {@link #X} or {@link #SEEN_X}: positions north, then east, followed at
   *   {@link #SEEN_X} by the velocities and, in space, by position and velocity down
   */
  abstract void fly(float[] into, int at, boolean withVelocity);

  /** Simulates the {@link #chosen} pieces of the first {@code count} vectors to their ends. */
  abstract void flyOn(int count);

  /** Begins new pieces in all worlds, {@link #sinceS} after the start of their present ones and under the
   * present commands; after 0 s they equal the present ones.
   *
   * @param from offset of the present pieces in {@link #pieces}, {@code to} of the new ones
   */
  abstract void flyOn(int from, int to);

  /** Begins new pieces at the ends computed by {@link #flyOn}, in worlds where {@code acts} is less than
   * {@link LaneOffers#NONE}; in other worlds copies the {@link #chosen} pieces.
   *
   * @param vectors the vectors of the chosen pieces, which are stored without gaps
   * @param at offset of the new pieces in {@link #pieces}
   * @param commanded the new commands by world; null if each vehicle keeps its command
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
    // Times are compared only within a range, so pieces must not become longer.
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
    flyOn(vectors.count);
    begin(vectors, fill(row, vectors, until), acts, commanded);
  }

  /** Sets {@link #until} to {@code times}, from the period's start, in worlds where {@code numbers} is at
   * least {@code least} and below {@link LaneOffers#NONE}; in other worlds to the start of the newest piece.
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

  /** Appends pieces until the newest lasts to {@link #until}. */
  private void goOn(int row, LaneVectors vectors) {
    while (findOver(vectors)) {
      if (over.count == ALL.count) {
        int to = fill(row, over, next);
        flyOn((filled - 2 & slots - 1) * size, to);
      } else {
        copyNewest(over);
        flyOn(over.count);
        begin(over, fill(row, over, next), ends, null);
      }
    }
  }

  /** Finds the newest pieces that end before {@link #until}; sets the time of each end and {@link #sinceS}.
   *
   * @return whether there is one
   */
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
        begin.add(piece, isOver).intoArray(next, i);
        IntVector.broadcast(INTS, LaneOffers.NONE).blend(0, isOver).intoArray(ends, i);
        FloatVector.broadcast(SPECIES, 0f)
            .blend(pieceS, isOver.cast(SPECIES))
            .intoArray(sinceS, over.count * LANES);
        over.first[over.count++] = i;
      }
    }
    return over.count > 0;
  }

  /** Fills the next slot with pieces that begin at these times; other vectors copy the newest pieces.
   *
   * @return the slot's offset in {@link #pieces}
   */
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

  /** Chooses the newest piece of each world, stored without gaps between vectors; sets {@link #sinceS} to the
   * time from its start to {@link #until}.
   */
  private void chooseNewest(LaneVectors vectors) {
    int newest = (filled - 1 & slots - 1) * WORLDS;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector since =
          IntVector.fromArray(INTS, until, i).sub(IntVector.fromArray(INTS, begins, newest + i));
      tellSince(since, k * LANES);
    }
    copyNewest(vectors);
  }

  private void copyNewest(LaneVectors vectors) {
    int newest = (filled - 1 & slots - 1) * size;
    for (int k = 0; k < vectors.count; k++) {
      int to = k * LANES, from = newest + vectors.first[k];
      for (int number = 0; number < size; number += WORLDS)
        FloatVector.fromArray(SPECIES, pieces, from + number).intoArray(chosen, to + number);
    }
  }

  private void tellSince(IntVector grains, int at) {
    ((FloatVector) grains.convertShape(VectorOperators.I2F, SPECIES, 0))
        .mul(LaneViews.GRAIN_S)
        .intoArray(sinceS, at);
  }

  /** Chooses the piece of each world that contains {@link #until}; every world keeps its own index. */
  private void choose(LaneVectors vectors) {
    int[] begins = this.begins, until = this.until;
    float[] pieces = this.pieces, chosen = this.chosen;
    int size = this.size, mask = slots - 1, newest = filled - 1, oldest = Math.max(0, filled - slots);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k], back = newest, from = (back & mask) * size + i;
      IntVector time = IntVector.fromArray(INTS, until, i);
      IntVector since = time.sub(IntVector.fromArray(INTS, begins, (back & mask) * WORLDS + i));
      VectorMask<Integer> late = since.compare(LT, 0);
      if (!late.allTrue())
        for (int number = 0; number < size; number += WORLDS)
          FloatVector.fromArray(SPECIES, pieces, from + number).intoArray(chosen, i + number);
      while (late.anyTrue()) {
        if (--back < oldest)
          throw new IllegalStateException("a reading is older than " + slots + " pieces of a flight");
        IntVector before = time.sub(IntVector.fromArray(INTS, begins, (back & mask) * WORLDS + i));
        VectorMask<Integer> found = before.compare(GE, 0).and(late);
        if (!found.anyTrue()) continue;
        since = since.blend(before, found);
        late = late.andNot(found);
        VectorMask<Float> isFound = found.cast(SPECIES);
        from = (back & mask) * size + i;
        for (int number = 0; number < size; number += WORLDS)
          FloatVector.fromArray(SPECIES, pieces, from + number).intoArray(chosen, i + number, isFound);
      }
      tellSince(since, i);
    }
  }
}
