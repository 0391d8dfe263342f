package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.Duelist;

/** Flights whose pieces end by themselves, a time after their begin; then another begins under the same command. */
abstract class PieceFlights extends LaneFlights {
  private final float pieceS;
  private final int command;
  private final float[] wanted = new float[WORLDS];
  private final int[] ends = new int[WORLDS];
  private final LaneVectors over = new LaneVectors();
  private final Directions along = new Directions(WORLDS);

  /**
   * @param pieceS how long one lasts at most
   * @param command the number of a piece at which the command's direction stands, north, then east
   */
  PieceFlights(
      Duelist duelist, int fields, FlightTiming timing, double pieceS, int command) {
    super(duelist, fields, timing);
    this.pieceS = (float) pieceS;
    this.command = command;
  }

  @Override
  final void goOn(int row, LaneVectors vectors) {
    System.arraycopy(until, 0, wanted, 0, WORLDS);
    while (ends(row, vectors)) {
      fly(over, true);
      System.arraycopy(chosen, command * WORLDS, along.cos, 0, WORLDS);
      System.arraycopy(chosen, (command + 1) * WORLDS, along.sin, 0, WORLDS);
      begin(over, fill(row), ends, along);
      System.arraycopy(wanted, 0, until, 0, WORLDS);
    }
  }

  /** Whether a newest piece ends before the time there; then, the times of such vectors are those ends. */
  private boolean ends(int row, LaneVectors vectors) {
    chooseNewest(row);
    over.count = 0;
    FloatVector piece = FloatVector.broadcast(SPECIES, pieceS);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector end = FloatVector.fromArray(SPECIES, chosen, PIECE_TIME * WORLDS + i).add(piece);
      VectorMask<Float> isOver = end.compare(LT, FloatVector.fromArray(SPECIES, until, i));
      if (isOver.anyTrue()) {
        over.first[over.count++] = i;
        end.intoArray(until, i);
        IntVector.broadcast(INTS, LaneOffers.NONE).blend(0, isOver.cast(INTS)).intoArray(ends, i);
      }
    }
    return over.count > 0;
  }
}
