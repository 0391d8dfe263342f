package skein.lanes;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duelist;
import skein.forward.Reduced;

/**
 * Vehicles of first-order lag, exactly integrated between commands. Their state is kept as at the
 * last command that acted: position, the velocity asked for, and the velocity's error, which dies
 * away. Their clock tells how long after that a moment is, how far an error carries them until then,
 * over the error, and what remains of it. The scalar reference is {@link Reduced}'s vehicle.
 */
final class TimetableLagVehicles extends TimetableVehicles {
  private final FloatVector speed;
  private final float[] x = new float[WORLDS],
      y = new float[WORLDS],
      askedX = new float[WORLDS],
      askedY = new float[WORLDS],
      errorX = new float[WORLDS],
      errorY = new float[WORLDS];

  TimetableLagVehicles(Duelist duelist, Reduced model) {
    super(duelist);
    speed = constant((float) (duelist.speed() * model.gain()));
  }

  @Override
  void start(int worlds) {
    System.arraycopy(startX, 0, x, 0, WORLDS);
    System.arraycopy(startY, 0, y, 0, WORLDS);
    for (float[] zero : new float[][] {askedX, askedY, errorX, errorY}) Arrays.fill(zero, 0f);
  }

  @Override
  void rest(int world) {
    x[world] = startX[world];
    y[world] = startY[world];
    for (float[] zero : new float[][] {askedX, askedY, errorX, errorY}) zero[world] = 0f;
  }

  @Override
  void look(float[] times, int at, int into, boolean withVelocity) {
    lookAtPosition(into, times[at], times[at + 1]);
    if (withVelocity) lookAtVelocity(into, times[at + 2]);
  }

  private void lookAtPosition(int into, float dtS, float gainS) {
    FloatVector dt = constant(dtS), gain = constant(gainS);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector newX =
          FloatVector.fromArray(SPECIES, askedX, i).fma(dt, FloatVector.fromArray(SPECIES, x, i));
      FloatVector newY =
          FloatVector.fromArray(SPECIES, askedY, i).fma(dt, FloatVector.fromArray(SPECIES, y, i));
      FloatVector.fromArray(SPECIES, errorX, i).fma(gain, newX).intoArray(seenX, into + i);
      FloatVector.fromArray(SPECIES, errorY, i).fma(gain, newY).intoArray(seenY, into + i);
    }
  }

  private void lookAtVelocity(int into, float keepShare) {
    FloatVector keep = constant(keepShare);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector.fromArray(SPECIES, errorX, i)
          .fma(keep, FloatVector.fromArray(SPECIES, askedX, i))
          .intoArray(seenVx, into + i);
      FloatVector.fromArray(SPECIES, errorY, i)
          .fma(keep, FloatVector.fromArray(SPECIES, askedY, i))
          .intoArray(seenVy, into + i);
    }
  }

  @Override
  void act(float[] times, int at, Directions commanded, int from) {
    FloatVector dt = constant(times[at]),
        gain = constant(times[at + 1]),
        keep = constant(times[at + 2]);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector oldX = FloatVector.fromArray(SPECIES, askedX, i);
      FloatVector lackX = FloatVector.fromArray(SPECIES, errorX, i);
      FloatVector newX = FloatVector.fromArray(SPECIES, commanded.cos, from + i).mul(speed);
      lackX.fma(gain, oldX.fma(dt, FloatVector.fromArray(SPECIES, x, i))).intoArray(x, i);
      lackX.fma(keep, oldX.sub(newX)).intoArray(errorX, i);
      newX.intoArray(askedX, i);
      FloatVector oldY = FloatVector.fromArray(SPECIES, askedY, i);
      FloatVector lackY = FloatVector.fromArray(SPECIES, errorY, i);
      FloatVector newY = FloatVector.fromArray(SPECIES, commanded.sin, from + i).mul(speed);
      lackY.fma(gain, oldY.fma(dt, FloatVector.fromArray(SPECIES, y, i))).intoArray(y, i);
      lackY.fma(keep, oldY.sub(newY)).intoArray(errorY, i);
      newY.intoArray(askedY, i);
    }
  }
}
