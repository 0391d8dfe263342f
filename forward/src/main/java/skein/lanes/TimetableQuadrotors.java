package skein.lanes;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.forward.Duelist;
import skein.units.Vector3;
import skein.vehicle.Environment;
import skein.vehicle.Quadrotor;

/**
 * AirSim's quadrotors with their flight controllers, by {@link QuadrotorKernel}: they fly in whole
 * steps, a command acts from the first step after it on, and between two steps a vehicle is carried
 * on at constant acceleration. Their clock tells how many steps there are until a moment, and how
 * long it is after the last of them. Positions are kept in frames with their origin at the start,
 * where floats are finest. The scalar reference is {@link VelocityResponse}'s quadrotor.
 */
final class TimetableQuadrotors extends TimetableVehicles {
  private final QuadrotorKernel kernel = new QuadrotorKernel();
  private final FloatVector speed;
  private final float downM;
  private final Vector3 hold;

  TimetableQuadrotors(Duelist duelist) {
    super(duelist);
    speed = constant((float) duelist.speed());
    double down = duelist.altitudeDownM();
    downM = (float) down;
    hold = new Vector3(0, 0, down - Quadrotor.AirSim().hoverSagM(down, Environment.Calm()));
  }

  @Override
  void start(int worlds) {
    kernel.use(worlds);
    for (int i = 0; i < WORLDS; i++) kernel.hover(i, hold);
  }

  @Override
  void rest(int world) {
    kernel.hover(world, hold);
  }

  @Override
  void look(float[] times, int at, int into, boolean withVelocity) {
    kernel.fly((int) times[at]);
    float sinceS = times[at + 1];
    lookAlong(kernel.x, kernel.vx, kernel.ax, startX, sinceS, seenX, into);
    lookAlong(kernel.y, kernel.vy, kernel.ay, startY, sinceS, seenY, into);
    if (withVelocity) {
      lookAtVelocity(kernel.vx, kernel.ax, sinceS, seenVx, into);
      lookAtVelocity(kernel.vy, kernel.ay, sinceS, seenVy, into);
    }
  }

  private static void lookAlong(
      float[] place,
      float[] velocity,
      float[] acceleration,
      float[] start,
      float sinceS,
      float[] seen,
      int into) {
    FloatVector since = constant(sinceS), halfSquare = constant(sinceS * sinceS / 2);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector moved =
          FloatVector.fromArray(SPECIES, acceleration, i)
              .mul(halfSquare)
              .add(FloatVector.fromArray(SPECIES, velocity, i).mul(since));
      FloatVector.fromArray(SPECIES, place, i)
          .add(moved)
          .add(FloatVector.fromArray(SPECIES, start, i))
          .intoArray(seen, into + i);
    }
  }

  private static void lookAtVelocity(
      float[] velocity, float[] acceleration, float sinceS, float[] seen, int into) {
    FloatVector since = constant(sinceS);
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, acceleration, i)
          .fma(since, FloatVector.fromArray(SPECIES, velocity, i))
          .intoArray(seen, into + i);
  }

  @Override
  void act(float[] times, int at, Directions commanded, int from) {
    kernel.fly((int) times[at]);
    Arrays.fill(kernel.goalZ, downM);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector.fromArray(SPECIES, commanded.cos, from + i).mul(speed).intoArray(kernel.goalX, i);
      FloatVector.fromArray(SPECIES, commanded.sin, from + i).mul(speed).intoArray(kernel.goalY, i);
    }
  }
}
