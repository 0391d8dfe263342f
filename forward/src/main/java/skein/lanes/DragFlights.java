package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.ONE;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.ZERO;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.Duelist;
import skein.simd.LaneMath;
import skein.vehicle.ReducedFlight;
import skein.vehicle.ReducedModel;

/**
 * With lags along and across the command and quadratic drag, whose rate holds for a piece; so a piece
 * ends {@link ReducedModel#PieceS} after its begin at the latest. The scalar reference is {@link
 * ReducedFlight}; the formulas stand there.
 */
final class DragFlights extends PieceFlights {
  // The velocity reached along the command, what it lacks of that at first, along and across; how
  // fast these die away; and the command.
  private static final int GOAL_X = PIECE_OWN,
      GOAL_Y = PIECE_OWN + 1,
      LACK_X = PIECE_OWN + 2,
      LACK_Y = PIECE_OWN + 3,
      RATE = PIECE_OWN + 4,
      ALONG_X = PIECE_OWN + 5,
      ALONG_Y = PIECE_OWN + 6,
      CROSS_X = PIECE_OWN + 7,
      CROSS_Y = PIECE_OWN + 8,
      CROSS_RATE = PIECE_OWN + 9;

  private final float perLag, perTurnLag, drag, pull;
  private final boolean turns;
  private final float[] left = new float[WORLDS];

  DragFlights(Duelist duelist, ReducedModel model, double periodS, int keptRows) {
    super(
        duelist,
        model.turnLagS() != model.lagS() ? PIECE_OWN + 10 : PIECE_OWN + 7,
        keptRows,
        periodS,
        ReducedModel.PieceS(),
        ALONG_X);
    perLag = (float) (1 / model.lagS());
    perTurnLag = (float) (1 / model.turnLagS());
    drag = (float) model.dragPerM();
    pull = (float) (model.gain() * duelist.speed() / model.lagS());
    turns = model.turnLagS() != model.lagS();
  }

  @Override
  void rest(float[] pieces) {
    Arrays.fill(pieces, RATE * WORLDS, (RATE + 1) * WORLDS, perLag);
    if (turns) Arrays.fill(pieces, CROSS_RATE * WORLDS, (CROSS_RATE + 1) * WORLDS, perTurnLag);
  }

  @Override
  void fly(LaneVectors vectors, boolean withVelocity) {
    flyAlong(vectors, withVelocity);
    if (turns) flyAcross(vectors, withVelocity);
  }

  private void flyAlong(LaneVectors vectors, boolean withVelocity) {
    remains(vectors, RATE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector dt = time(i), remains = FloatVector.fromArray(SPECIES, left, i);
      FloatVector span = ONE.sub(remains).div(FloatVector.fromArray(SPECIES, chosen, RATE * WORLDS + i));
      FloatVector goalX = FloatVector.fromArray(SPECIES, chosen, GOAL_X * WORLDS + i),
          lackX = FloatVector.fromArray(SPECIES, chosen, LACK_X * WORLDS + i);
      goalX
          .fma(dt, lackX.fma(span, FloatVector.fromArray(SPECIES, chosen, PIECE_X * WORLDS + i)))
          .intoArray(x, i);
      FloatVector goalY = FloatVector.fromArray(SPECIES, chosen, GOAL_Y * WORLDS + i),
          lackY = FloatVector.fromArray(SPECIES, chosen, LACK_Y * WORLDS + i);
      goalY
          .fma(dt, lackY.fma(span, FloatVector.fromArray(SPECIES, chosen, PIECE_Y * WORLDS + i)))
          .intoArray(y, i);
      if (withVelocity) {
        lackX.fma(remains, goalX).intoArray(vx, i);
        lackY.fma(remains, goalY).intoArray(vy, i);
      }
    }
  }

  private FloatVector time(int i) {
    return FloatVector.fromArray(SPECIES, until, i)
        .sub(FloatVector.fromArray(SPECIES, chosen, PIECE_TIME * WORLDS + i));
  }

  private void flyAcross(LaneVectors vectors, boolean withVelocity) {
    remains(vectors, CROSS_RATE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector remains = FloatVector.fromArray(SPECIES, left, i);
      FloatVector span =
          ONE.sub(remains).div(FloatVector.fromArray(SPECIES, chosen, CROSS_RATE * WORLDS + i));
      FloatVector crossX = FloatVector.fromArray(SPECIES, chosen, CROSS_X * WORLDS + i),
          crossY = FloatVector.fromArray(SPECIES, chosen, CROSS_Y * WORLDS + i);
      crossX.fma(span, FloatVector.fromArray(SPECIES, x, i)).intoArray(x, i);
      crossY.fma(span, FloatVector.fromArray(SPECIES, y, i)).intoArray(y, i);
      if (withVelocity) {
        crossX.fma(remains, FloatVector.fromArray(SPECIES, vx, i)).intoArray(vx, i);
        crossY.fma(remains, FloatVector.fromArray(SPECIES, vy, i)).intoArray(vy, i);
      }
    }
  }

  /** What is left of what dies away at these rates. */
  private void remains(LaneVectors vectors, int rate) {
    FloatVector least = FloatVector.broadcast(SPECIES, -80f);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector.fromArray(SPECIES, chosen, PIECE_TIME * WORLDS + i)
          .sub(FloatVector.fromArray(SPECIES, until, i))
          .mul(FloatVector.fromArray(SPECIES, chosen, rate * WORLDS + i))
          .max(least)
          .min(ZERO)
          .intoArray(left, i);
    }
    if (vectors.count * LANES == WORLDS) LaneMath.exp(left, 0, WORLDS);
    else for (int k = 0; k < vectors.count; k++) LaneMath.exp(left, vectors.first[k], LANES);
  }

  @Override
  void begin(LaneVectors vectors, int at, int[] acts, Directions commanded) {
    FloatVector perLag = FloatVector.broadcast(SPECIES, this.perLag),
        drag = FloatVector.broadcast(SPECIES, this.drag),
        pull = FloatVector.broadcast(SPECIES, this.pull);
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      int from = at + i;
      VectorMask<Float> does = IntVector.fromArray(INTS, acts, i).compare(LT, none).cast(SPECIES);
      FloatVector north = FloatVector.fromArray(SPECIES, vx, i),
          east = FloatVector.fromArray(SPECIES, vy, i);
      FloatVector rate = north.fma(north, east.mul(east)).sqrt().fma(drag, perLag);
      FloatVector goal = pull.div(rate);
      FloatVector alongX = FloatVector.fromArray(SPECIES, commanded.cos, i),
          alongY = FloatVector.fromArray(SPECIES, commanded.sin, i);
      FloatVector goalX = alongX.mul(goal), goalY = alongY.mul(goal);
      FloatVector.fromArray(SPECIES, until, i).intoArray(pieces, from + PIECE_TIME * WORLDS, does);
      FloatVector.fromArray(SPECIES, x, i).intoArray(pieces, from + PIECE_X * WORLDS, does);
      FloatVector.fromArray(SPECIES, y, i).intoArray(pieces, from + PIECE_Y * WORLDS, does);
      goalX.intoArray(pieces, from + GOAL_X * WORLDS, does);
      goalY.intoArray(pieces, from + GOAL_Y * WORLDS, does);
      north.sub(goalX).intoArray(pieces, from + LACK_X * WORLDS, does);
      east.sub(goalY).intoArray(pieces, from + LACK_Y * WORLDS, does);
      rate.intoArray(pieces, from + RATE * WORLDS, does);
      alongX.intoArray(pieces, from + ALONG_X * WORLDS, does);
      alongY.intoArray(pieces, from + ALONG_Y * WORLDS, does);
    }
    if (turns) keepAcross(vectors, at, acts);
  }

  /** Parts what a velocity lacks into that along the command and that across it. */
  private void keepAcross(LaneVectors vectors, int at, int[] acts) {
    FloatVector slower = FloatVector.broadcast(SPECIES, perTurnLag - perLag);
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      int from = at + i;
      VectorMask<Float> does = IntVector.fromArray(INTS, acts, i).compare(LT, none).cast(SPECIES);
      FloatVector north = FloatVector.fromArray(SPECIES, pieces, from + ALONG_X * WORLDS),
          east = FloatVector.fromArray(SPECIES, pieces, from + ALONG_Y * WORLDS);
      FloatVector allX = FloatVector.fromArray(SPECIES, pieces, from + LACK_X * WORLDS),
          allY = FloatVector.fromArray(SPECIES, pieces, from + LACK_Y * WORLDS);
      FloatVector square = north.fma(north, east.mul(east));
      FloatVector along = allX.fma(north, allY.mul(east)).div(square);
      VectorMask<Float> moves = square.compare(GT, ZERO);
      FloatVector ownX = allX.blend(along.mul(north), moves), ownY = allY.blend(along.mul(east), moves);
      ownX.intoArray(pieces, from + LACK_X * WORLDS, does);
      ownY.intoArray(pieces, from + LACK_Y * WORLDS, does);
      allX.sub(ownX).intoArray(pieces, from + CROSS_X * WORLDS, does);
      allY.sub(ownY).intoArray(pieces, from + CROSS_Y * WORLDS, does);
      FloatVector.fromArray(SPECIES, pieces, from + RATE * WORLDS)
          .add(slower)
          .intoArray(pieces, from + CROSS_RATE * WORLDS, does);
    }
  }
}
