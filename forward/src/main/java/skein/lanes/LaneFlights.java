package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.Duelist;

/**
 * The vehicles of one role in many worlds, whose commands act at times of their own in each. They fly
 * in pieces, each known from its begin on; the pieces of the near past are kept, so that a vehicle can
 * be read at any moment of it. A slot holds the piece that was the newest in each world when it was
 * filled. Times are in seconds from the begin of a period.
 */
abstract class LaneFlights extends LaneVehicles {
  /** Of a piece: when it begins, where the vehicle is then; what follows, the kind of vehicle says. */
  static final int PIECE_TIME = 0, PIECE_X = 1, PIECE_Y = 2, PIECE_OWN = 3;

  private static final float FUTURE = 1e9f;

  /** Where they are flown to, and how fast they fly there. */
  final float[] x = new float[WORLDS],
      y = new float[WORLDS],
      vx = new float[WORLDS],
      vy = new float[WORLDS];

  private final int fields, keptRows;
  private final double periodS;
  float[] pieces;

  /** A power of two. */
  private int slots = 16;

  private int[] rowOf = new int[slots];

  /** How many slots were filled; the newest is one less. */
  private int filled;

  /** Until when, and the pieces that lead there. */
  final float[] until = new float[WORLDS], chosen;

  private final LaneVectors all = LaneVectors.all();

  /** Where in {@link #pieces} those begin that were found; and each world's number. */
  private final int[] place = new int[WORLDS];

  private static final int[] WORLD = new int[WORLDS];

  static {
    for (int i = 0; i < WORLDS; i++) WORLD[i] = i;
  }

  /**
   * @param fields numbers of a piece
   */
  LaneFlights(Duelist duelist, int fields, FlightTiming timing) {
    super(duelist, 0);
    this.fields = fields;
    keptRows = timing.keptRows();
    periodS = timing.loop().periodS();
    pieces = new float[slots * fields * WORLDS];
    chosen = new float[fields * WORLDS];
  }

  @Override
  final void start() {
    super.start();
    Arrays.fill(pieces, 0, fields * WORLDS, 0f);
    System.arraycopy(state, X, pieces, PIECE_X * WORLDS, WORLDS);
    System.arraycopy(state, Y, pieces, PIECE_Y * WORLDS, WORLDS);
    rest(pieces);
    rowOf[0] = 0;
    filled = 1;
  }

  /** Fills in what a piece at rest has of its own, from index 0 on. */
  abstract void rest(float[] pieces);

  /** Flies {@link #chosen} pieces {@link #until} the times there, into {@link #x} and the others. */
  abstract void fly(LaneVectors vectors, boolean withVelocity);

  /**
   * New pieces begin where the vehicles were flown to, under commands; from {@code at} on in {@link
   * #pieces}, in worlds where {@code acts} is less than {@link LaneOffers#NONE}.
   */
  abstract void begin(LaneVectors vectors, int at, int[] acts, Directions commanded);

  /** Pieces that begin by themselves before the times there, if this kind of vehicle has such. */
  void goOn(int row, LaneVectors vectors) {}

  @Override
  final void read(int row, LaneVectors vectors, int[] at, int[] fresh, boolean withVelocity) {
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
    // Elsewhere the newest piece will do.
    if (vectors.count * LANES < WORLDS) Arrays.fill(until, FUTURE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector time =
          ((FloatVector) IntVector.fromArray(INTS, at, i).convertShape(VectorOperators.I2F, SPECIES, 0))
              .mul(grainS);
      if (fresh != null)
        time = zero.blend(time, IntVector.fromArray(INTS, fresh, i).compare(GT, 0).cast(SPECIES));
      time.intoArray(until, i);
    }
    flyTo(row, vectors, withVelocity);
    keep(vectors, x, SEEN_X, fresh);
    keep(vectors, y, SEEN_Y, fresh);
    if (withVelocity) {
      keep(vectors, vx, SEEN_VX, fresh);
      keep(vectors, vy, SEEN_VY, fresh);
    }
  }

  private void keep(LaneVectors vectors, float[] now, int seen, int[] fresh) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector value = FloatVector.fromArray(SPECIES, now, i);
      if (fresh != null)
        value =
            FloatVector.fromArray(SPECIES, state, seen + i)
                .blend(value, IntVector.fromArray(INTS, fresh, i).compare(GT, 0).cast(SPECIES));
      value.intoArray(state, seen + i);
    }
  }

  @Override
  final void flyToRow(int row) {
    Arrays.fill(until, 0f);
    flyTo(row, all, false);
    System.arraycopy(x, 0, state, X, WORLDS);
    System.arraycopy(y, 0, state, Y, WORLDS);
  }

  private void flyTo(int row, LaneVectors vectors, boolean withVelocity) {
    goOn(row, vectors);
    choose(row, vectors);
    fly(vectors, withVelocity);
  }

  @Override
  final void act(int row, LaneVectors vectors, int[] acts, Directions commanded) {
    FloatVector grainS = FloatVector.broadcast(SPECIES, LaneViews.GRAIN_S),
        zero = FloatVector.broadcast(SPECIES, 0f);
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector grains = IntVector.fromArray(INTS, acts, i);
      VectorMask<Float> does = grains.compare(VectorOperators.LT, none).cast(SPECIES);
      zero.blend(
              ((FloatVector) grains.convertShape(VectorOperators.I2F, SPECIES, 0)).mul(grainS), does)
          .intoArray(until, i);
    }
    goOn(row, vectors);
    chooseNewest(row);
    fly(vectors, true);
    begin(vectors, fill(row), acts, commanded);
  }

  /** Fills a slot with {@link #chosen}, which are the newest. */
  final int fill(int row) {
    if (filled >= slots && rowOf[filled & slots - 1] >= row - keptRows) makeRoom();
    int slot = filled++ & slots - 1, at = slot * fields * WORLDS;
    rowOf[slot] = row;
    System.arraycopy(chosen, 0, pieces, at, fields * WORLDS);
    return at;
  }

  private void makeRoom() {
    int before = slots, size = fields * WORLDS;
    float[] held = pieces;
    int[] rows = rowOf;
    slots = 2 * before;
    pieces = new float[slots * size];
    rowOf = new int[slots];
    for (int number = filled - before; number < filled; number++) {
      int from = number & before - 1, to = number & slots - 1;
      rowOf[to] = rows[from];
      System.arraycopy(held, from * size, pieces, to * size, size);
    }
  }

  private float shift(int slot, int row) {
    return (float) ((rowOf[slot] - row) * periodS);
  }

  /** The newest pieces, in times of a row. */
  final void chooseNewest(int row) {
    int slot = filled - 1 & slots - 1;
    System.arraycopy(pieces, slot * fields * WORLDS, chosen, 0, fields * WORLDS);
    FloatVector shift = FloatVector.broadcast(SPECIES, shift(slot, row));
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, chosen, i).add(shift).intoArray(chosen, i);
  }

  /** The pieces in which the times there lie; elsewhere than in these vectors, any. */
  private void choose(int row, LaneVectors vectors) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      if (find(row, i)) copy(i, filled - 1);
      else gather(i);
    }
  }

  /** Finds the pieces of one vector of worlds; whether they are the newest of all. */
  private boolean find(int row, int i) {
    float[] pieces = this.pieces;
    int[] rowOf = this.rowOf;
    int mask = slots - 1, size = fields * WORLDS, back = filled - 1, oldest = Math.max(0, filled - slots);
    FloatVector time = FloatVector.fromArray(SPECIES, until, i);
    IntVector world = IntVector.fromArray(INTS, WORLD, i), found = world.add((back & mask) * size);
    FloatVector begins =
        FloatVector.fromArray(SPECIES, pieces, (back & mask) * size + i)
            .add((float) ((rowOf[back & mask] - row) * periodS));
    VectorMask<Float> late = begins.compare(GT, time);
    while (late.anyTrue() && --back >= oldest) {
      int from = (back & mask) * size;
      begins =
          begins.blend(
              FloatVector.fromArray(SPECIES, pieces, from + i)
                  .add((float) ((rowOf[back & mask] - row) * periodS)),
              late);
      found = found.blend(world.add(from), late.cast(INTS));
      late = begins.compare(GT, time);
    }
    if (back < oldest)
      throw new IllegalStateException("a reading is older than " + slots + " pieces of a flight");
    begins.intoArray(chosen, i);
    found.intoArray(place, i);
    return back == filled - 1;
  }

  /** The numbers of the pieces of one slot. */
  private void copy(int i, int number) {
    int from = (number & slots - 1) * fields * WORLDS + i;
    for (int field = PIECE_X; field < fields; field++)
      FloatVector.fromArray(SPECIES, pieces, from + field * WORLDS).intoArray(chosen, field * WORLDS + i);
  }

  /** The numbers of the pieces that were found. */
  private void gather(int i) {
    for (int field = PIECE_X; field < fields; field++)
      FloatVector.fromArray(SPECIES, pieces, field * WORLDS, place, i).intoArray(chosen, field * WORLDS + i);
  }
}
