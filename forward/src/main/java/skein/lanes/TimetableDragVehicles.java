package skein.lanes;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.ONE;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duelist;
import skein.simd.LaneMath;
import skein.vehicle.ReducedFlight;
import skein.vehicle.ReducedModel;

/**
 * Vehicles with lags along and across their commands and with quadratic drag, exactly integrated
 * piece by piece. Their clock tells how many pieces end before a moment, and how long it is after the
 * last of these began. The scalar reference is {@link ReducedFlight}; the formulas stand there.
 */
final class TimetableDragVehicles extends TimetableVehicles {
  /** 1/lag along and across the command, 1/s; drag, 1/m. */
  private final FloatVector perLag, perTurnLag, drag;

  /** Speed reached without drag, over the lag, m/s². */
  private final FloatVector pull;

  /** Whether the lags differ; else nothing is kept apart across the command. */
  private final boolean turns;

  /** Whether a command has acted in this episode. */
  private boolean isCommanded;

  // As the piece began: position; goal and lack of velocity along the command; the velocity across
  // it; how fast these die away. And the command's direction.
  private final float[] x = new float[WORLDS],
      y = new float[WORLDS],
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

  // At the moment flown to.
  private final float[] left = new float[WORLDS],
      newX = new float[WORLDS],
      newY = new float[WORLDS],
      newVx = new float[WORLDS],
      newVy = new float[WORLDS];

  TimetableDragVehicles(Duelist duelist, ReducedModel model) {
    super(duelist);
    perLag = constant((float) (1 / model.lagS()));
    perTurnLag = constant((float) (1 / model.turnLagS()));
    drag = constant((float) model.dragPerM());
    pull = constant((float) (model.gain() * duelist.speed() / model.lagS()));
    turns = model.turnLagS() != model.lagS();
  }

  @Override
  void start(int worlds) {
    for (float[] north : new float[][] {x, newX}) System.arraycopy(startX, 0, north, 0, WORLDS);
    for (float[] east : new float[][] {y, newY}) System.arraycopy(startY, 0, east, 0, WORLDS);
    Arrays.fill(newVx, 0f);
    Arrays.fill(newVy, 0f);
    isCommanded = false;
  }

  @Override
  void look(float[] times, int at, int into, boolean withVelocity) {
    flyTo((int) times[at], times[at + 1]);
    System.arraycopy(newX, 0, seenX, into, WORLDS);
    System.arraycopy(newY, 0, seenY, into, WORLDS);
    if (withVelocity) {
      System.arraycopy(newVx, 0, seenVx, into, WORLDS);
      System.arraycopy(newVy, 0, seenVy, into, WORLDS);
    }
  }

  @Override
  void act(float[] times, int at, Directions commanded, int from) {
    flyTo((int) times[at], times[at + 1]);
    System.arraycopy(commanded.cos, from, alongX, 0, WORLDS);
    System.arraycopy(commanded.sin, from, alongY, 0, WORLDS);
    isCommanded = true;
    begin();
  }

  private void flyTo(int pieces, float dtS) {
    // Until the first command they rest.
    if (isCommanded) {
      for (int piece = 0; piece < pieces; piece++) {
        fly((float) ReducedModel.PieceS());
        begin();
      }
      fly(dtS);
    }
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
      goal.fma(dt, lack.fma(span, FloatVector.fromArray(SPECIES, x, i))).intoArray(newX, i);
      lack.fma(remains, goal).intoArray(newVx, i);
      goal = FloatVector.fromArray(SPECIES, goalY, i);
      lack = FloatVector.fromArray(SPECIES, lackY, i);
      goal.fma(dt, lack.fma(span, FloatVector.fromArray(SPECIES, y, i))).intoArray(newY, i);
      lack.fma(remains, goal).intoArray(newVy, i);
    }
    if (turns) flyAcross(dtS);
  }

  private void flyAcross(float dtS) {
    remains(crossRate, dtS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector remains = FloatVector.fromArray(SPECIES, left, i);
      FloatVector span = ONE.sub(remains).div(FloatVector.fromArray(SPECIES, crossRate, i));
      FloatVector cross = FloatVector.fromArray(SPECIES, crossX, i);
      cross.fma(span, FloatVector.fromArray(SPECIES, newX, i)).intoArray(newX, i);
      cross.fma(remains, FloatVector.fromArray(SPECIES, newVx, i)).intoArray(newVx, i);
      cross = FloatVector.fromArray(SPECIES, crossY, i);
      cross.fma(span, FloatVector.fromArray(SPECIES, newY, i)).intoArray(newY, i);
      cross.fma(remains, FloatVector.fromArray(SPECIES, newVy, i)).intoArray(newVy, i);
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
    System.arraycopy(newX, 0, x, 0, WORLDS);
    System.arraycopy(newY, 0, y, 0, WORLDS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector vx = FloatVector.fromArray(SPECIES, newVx, i),
          vy = FloatVector.fromArray(SPECIES, newVy, i);
      FloatVector slowing = vx.fma(vx, vy.mul(vy)).sqrt().mul(drag);
      FloatVector rateAlong = slowing.add(perLag);
      FloatVector goal = pull.div(rateAlong);
      FloatVector wantedX = FloatVector.fromArray(SPECIES, alongX, i).mul(goal),
          wantedY = FloatVector.fromArray(SPECIES, alongY, i).mul(goal);
      rateAlong.intoArray(rate, i);
      slowing.add(perTurnLag).intoArray(crossRate, i);
      wantedX.intoArray(goalX, i);
      wantedY.intoArray(goalY, i);
      vx.sub(wantedX).intoArray(lackX, i);
      vy.sub(wantedY).intoArray(lackY, i);
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
      FloatVector along = allX.fma(north, allY.mul(east));
      FloatVector ownX = along.mul(north), ownY = along.mul(east);
      ownX.intoArray(lackX, i);
      ownY.intoArray(lackY, i);
      allX.sub(ownX).intoArray(crossX, i);
      allY.sub(ownY).intoArray(crossY, i);
    }
  }
}
