package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GT;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.ONE;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.ZERO;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorMask;
import skein.simd.LaneMath;
import skein.vehicle.PlantFlight;
import skein.vehicle.ReducedModel;

/**
 * Flights with lags along and across their commands and with quadratic drag, exactly integrated
 * piece by piece; all worlds' pieces begin and end together. The scalar reference is {@link
 * PlantFlight} of a {@link ReducedModel}; the formulas stand there.
 *
 * <p>{@link ReducedModel#step} compiled as any other {@code Plant} does the same; written out, whatever
 * stands still during a piece is computed once: 182 million agent-steps a second instead of 80.
 */
final class LaneDragFlight {
  static final int WORLDS = LanePolicy.WORLDS;

  /** 1/lag along and across the command, 1/s; drag, 1/m. */
  private final FloatVector perLag, perTurnLag, drag;

  /** Speed reached without drag, over the lag, m/s², of a command of length 1. */
  private final FloatVector pull;

  /** Whether the lags differ; else nothing is kept apart across the command. */
  private final boolean turns;

  // As the piece began: position; goal and lack of velocity along the command; the velocity across
  // it; how fast these die away. And the command, over the speed.
  private final float[] fromX = new float[WORLDS],
      fromY = new float[WORLDS],
      goalX = new float[WORLDS],
      goalY = new float[WORLDS],
      lackX = new float[WORLDS],
      lackY = new float[WORLDS],
      crossX = new float[WORLDS],
      crossY = new float[WORLDS],
      rate = new float[WORLDS],
      crossRate = new float[WORLDS],
      alongX = new float[WORLDS],
      alongY = new float[WORLDS];

  private final float[] left = new float[WORLDS];

  /** At the moment flown to: m and m/s, north and east. */
  final float[] x = new float[WORLDS],
      y = new float[WORLDS],
      vx = new float[WORLDS],
      vy = new float[WORLDS];

  /**
   * @param speedMps of all commands
   */
  LaneDragFlight(ReducedModel model, double speedMps) {
    perLag = constant((float) (1 / model.lagS()));
    perTurnLag = constant((float) (1 / model.turnLagS()));
    drag = constant((float) model.dragPerM());
    pull = constant((float) (model.gain() * speedMps / model.lagS()));
    turns = model.turnLagS() != model.lagS();
  }

  /** Places all at rest, each at its start. */
  void start(float[] startX, float[] startY) {
    System.arraycopy(startX, 0, x, 0, WORLDS);
    System.arraycopy(startY, 0, y, 0, WORLDS);
    Arrays.fill(vx, 0f);
    Arrays.fill(vy, 0f);
  }

  /** Places one world's at rest. */
  void rest(int world, float startX, float startY) {
    x[world] = fromX[world] = startX;
    y[world] = fromY[world] = startY;
    for (float[] zero :
        new float[][] {vx, vy, alongX, alongY, goalX, goalY, lackX, lackY, crossX, crossY})
      zero[world] = 0f;
  }

  /** Commands act from now on. */
  void act(Directions commanded, int from) {
    System.arraycopy(commanded.cos, from, alongX, 0, WORLDS);
    System.arraycopy(commanded.sin, from, alongY, 0, WORLDS);
    begin();
  }

  /** They are to stand still from now on. */
  void rest() {
    Arrays.fill(alongX, 0f);
    Arrays.fill(alongY, 0f);
    begin();
  }

  /**
   * Flies on from where the last piece began.
   *
   * @param pieces that end until then
   * @param dtS after the last of them
   */
  void fly(int pieces, float dtS) {
    for (int piece = 0; piece < pieces; piece++) {
      fly((float) ReducedModel.PieceS());
      begin();
    }
    fly(dtS);
  }

  /** Where the vehicles are, and how fast, so long after the piece began. */
  private void fly(float dtS) {
    FloatVector dt = constant(dtS);
    remains(rate, dtS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector remains = FloatVector.fromArray(SPECIES, left, i);
      FloatVector span = ONE.sub(remains).div(FloatVector.fromArray(SPECIES, rate, i));
      FloatVector goal = FloatVector.fromArray(SPECIES, goalX, i),
          lack = FloatVector.fromArray(SPECIES, lackX, i);
      goal.fma(dt, lack.fma(span, FloatVector.fromArray(SPECIES, fromX, i))).intoArray(x, i);
      lack.fma(remains, goal).intoArray(vx, i);
      goal = FloatVector.fromArray(SPECIES, goalY, i);
      lack = FloatVector.fromArray(SPECIES, lackY, i);
      goal.fma(dt, lack.fma(span, FloatVector.fromArray(SPECIES, fromY, i))).intoArray(y, i);
      lack.fma(remains, goal).intoArray(vy, i);
    }
    if (turns) flyAcross(dtS);
  }

  private void flyAcross(float dtS) {
    remains(crossRate, dtS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector remains = FloatVector.fromArray(SPECIES, left, i);
      FloatVector span = ONE.sub(remains).div(FloatVector.fromArray(SPECIES, crossRate, i));
      FloatVector cross = FloatVector.fromArray(SPECIES, crossX, i);
      cross.fma(span, FloatVector.fromArray(SPECIES, x, i)).intoArray(x, i);
      cross.fma(remains, FloatVector.fromArray(SPECIES, vx, i)).intoArray(vx, i);
      cross = FloatVector.fromArray(SPECIES, crossY, i);
      cross.fma(span, FloatVector.fromArray(SPECIES, y, i)).intoArray(y, i);
      cross.fma(remains, FloatVector.fromArray(SPECIES, vy, i)).intoArray(vy, i);
    }
  }

  /** What so long a time leaves of what dies away at these rates. */
  private void remains(float[] rates, float dtS) {
    FloatVector minusDt = constant(-dtS);
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, rates, i).mul(minusDt).intoArray(left, i);
    LaneMath.exp(left, 0, WORLDS);
  }

  /** A piece begins where the vehicles were flown to. */
  private void begin() {
    System.arraycopy(x, 0, fromX, 0, WORLDS);
    System.arraycopy(y, 0, fromY, 0, WORLDS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector north = FloatVector.fromArray(SPECIES, vx, i),
          east = FloatVector.fromArray(SPECIES, vy, i);
      FloatVector slowing = north.fma(north, east.mul(east)).sqrt().mul(drag);
      FloatVector rateAlong = slowing.add(perLag);
      FloatVector goal = pull.div(rateAlong);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, alongX, i).mul(goal),
          wantedY = FloatVector.fromArray(SPECIES, alongY, i).mul(goal);
      rateAlong.intoArray(rate, i);
      slowing.add(perTurnLag).intoArray(crossRate, i);
      wantedX.intoArray(goalX, i);
      wantedY.intoArray(goalY, i);
      north.sub(wantedX).intoArray(lackX, i);
      east.sub(wantedY).intoArray(lackY, i);
    }
    if (turns) keepAcross();
  }

  /** Parts what a velocity lacks into that along the command and that across it. */
  private void keepAcross() {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector north = FloatVector.fromArray(SPECIES, alongX, i),
          east = FloatVector.fromArray(SPECIES, alongY, i);
      FloatVector allX = FloatVector.fromArray(SPECIES, lackX, i),
          allY = FloatVector.fromArray(SPECIES, lackY, i);
      FloatVector square = north.fma(north, east.mul(east));
      FloatVector along = allX.fma(north, allY.mul(east)).div(square);
      // Told to stand still, all velocity dies away with the lag along.
      VectorMask<Float> moves = square.compare(GT, ZERO);
      FloatVector ownX = allX.blend(along.mul(north), moves),
          ownY = allY.blend(along.mul(east), moves);
      ownX.intoArray(lackX, i);
      ownY.intoArray(lackY, i);
      allX.sub(ownX).intoArray(crossX, i);
      allY.sub(ownY).intoArray(crossY, i);
    }
  }
}
