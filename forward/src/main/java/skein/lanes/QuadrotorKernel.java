package skein.lanes;

import static jdk.incubator.vector.VectorOperators.GT;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.ONE;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.ZERO;
import static skein.simd.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import skein.simd.LaneMath;
import skein.units.Quaternion;
import skein.units.Vector3;
import skein.vehicle.Airframe;
import skein.vehicle.Atmosphere;
import skein.vehicle.ControllerGains;
import skein.vehicle.Environment;
import skein.vehicle.FirstOrderLag;
import skein.vehicle.Quadrotor;
import skein.vehicle.QuadrotorState;

/**
 * AirSim's quadrotor with its complete flight controller at 3 ms, many vehicles at a time, in
 * floats, for {@code moveByVelocityZ} with the yaw held, in calm air, off the ground. The scalar
 * {@link Quadrotor} is its reference; formulas and sources stand there. A step is a few passes over
 * the block; nothing is allocated after construction. One instance per thread.
 */
public final class QuadrotorKernel {
  /**
   * Vehicles flown together: few enough for the first-level cache. A multiple of every lane count.
   */
  public static final int VEHICLES = 128;

  private static final Quadrotor REFERENCE = Quadrotor.AirSim();
  private static final Airframe FRAME = REFERENCE.airframe();
  private static final ControllerGains GAINS = REFERENCE.gains();

  private static final FloatVector STEP = constant((float) REFERENCE.stepS());
  private static final FloatVector HALF_STEP = constant((float) (REFERENCE.stepS() / 2));
  private static final FloatVector MINUS_ONE = constant(-1f), HALF = constant(0.5f);

  // cos h and sin h / h of half a step's angle h, in powers of h².
  private static final FloatVector COS_1 = constant(-1f / 2), COS_2 = constant(1f / 24);
  private static final FloatVector SINC_1 = constant(-1f / 6), SINC_2 = constant(1f / 120);

  private static final FloatVector ORIGIN_ALTITUDE =
      constant((float) Environment.Calm().originAltitudeM());
  private static final FloatVector DENSITY_1 = constant((float) Atmosphere.slope()),
      DENSITY_2 = constant((float) Atmosphere.curvature());
  private static final FloatVector LIFT = constant((float) (FRAME.maxThrustN() / FRAME.massKg()));
  private static final FloatVector GRAVITY = constant((float) Airframe.Gravity());
  private static final FloatVector DRAG_FRONT = drag(FRAME.dragFront()),
      DRAG_RIGHT = drag(FRAME.dragRight());
  private static final FloatVector DRAG_DOWN = drag(FRAME.dragDown());
  private static final FloatVector DRAG_MIN_SPEED = constant((float) FRAME.dragMinSpeed());
  private static final FloatVector SPIN_FRONT =
      constant((float) (FRAME.rotorOffsetM() * FRAME.maxThrustN() / FRAME.inertiaFront()));
  private static final FloatVector SPIN_RIGHT =
      constant((float) (FRAME.rotorOffsetM() * FRAME.maxThrustN() / FRAME.inertiaRight()));
  private static final FloatVector SPIN_DOWN =
      constant((float) (FRAME.maxTorqueNm() / FRAME.inertiaDown()));
  private static final FloatVector GYRO_FRONT =
      constant((float) ((FRAME.inertiaRight() - FRAME.inertiaDown()) / FRAME.inertiaFront()));
  private static final FloatVector GYRO_RIGHT =
      constant((float) ((FRAME.inertiaDown() - FRAME.inertiaFront()) / FRAME.inertiaRight()));
  private static final FloatVector GYRO_DOWN =
      constant((float) ((FRAME.inertiaFront() - FRAME.inertiaRight()) / FRAME.inertiaDown()));
  private static final FloatVector ROTOR_KEEP =
      constant((float) new FirstOrderLag(FRAME.rotorTimeConstantS()).remains(REFERENCE.stepS()));

  private static final FloatVector RATE_P = constant((float) GAINS.rateP()),
      MAX_RATE = constant((float) GAINS.maxRate());
  private static final FloatVector ANGLE_P = constant((float) GAINS.angleP());
  private static final FloatVector VELOCITY_P = constant((float) GAINS.velocityP());
  private static final FloatVector MAX_TILT = constant((float) GAINS.maxTilt());
  private static final FloatVector POSITION_P = constant((float) GAINS.positionP());
  private static final FloatVector MAX_VELOCITY = constant((float) GAINS.maxVelocity());
  private static final FloatVector VERTICAL_P = constant((float) GAINS.verticalP());
  private static final FloatVector VERTICAL_I =
      constant((float) (GAINS.verticalI() * REFERENCE.stepS()));
  private static final FloatVector VERTICAL_KEEP = constant((float) GAINS.verticalDiscount());
  private static final FloatVector MIN_THROTTLE = constant((float) GAINS.minThrottle());

  // One entry per vehicle; names and frames as in QuadrotorState.
  final float[] x = new float[VEHICLES], y = new float[VEHICLES], z = new float[VEHICLES];
  final float[] vx = new float[VEHICLES], vy = new float[VEHICLES], vz = new float[VEHICLES];
  final float[] ax = new float[VEHICLES], ay = new float[VEHICLES], az = new float[VEHICLES];
  private final float[] qw = new float[VEHICLES],
      qx = new float[VEHICLES],
      qy = new float[VEHICLES],
      qz = new float[VEHICLES];
  private final float[] wx = new float[VEHICLES],
      wy = new float[VEHICLES],
      wz = new float[VEHICLES];
  private final float[] wxDot = new float[VEHICLES],
      wyDot = new float[VEHICLES],
      wzDot = new float[VEHICLES];
  private final float[] control0 = new float[VEHICLES],
      control1 = new float[VEHICLES],
      control2 = new float[VEHICLES],
      control3 = new float[VEHICLES];
  private final float[] lagged0 = new float[VEHICLES],
      lagged1 = new float[VEHICLES],
      lagged2 = new float[VEHICLES],
      lagged3 = new float[VEHICLES];
  private final float[] thrust0 = new float[VEHICLES],
      thrust1 = new float[VEHICLES],
      thrust2 = new float[VEHICLES],
      thrust3 = new float[VEHICLES];
  private final float[] integral = new float[VEHICLES];

  // What is commanded: velocity north and east, altitude.
  final float[] goalX = new float[VEHICLES],
      goalY = new float[VEHICLES],
      goalZ = new float[VEHICLES];

  // From one pass to the next: goals and tangents of roll and pitch, then the angles; throttle.
  private final float[] rollGoal = new float[VEHICLES], pitchGoal = new float[VEHICLES];
  private final float[] rollSin = new float[VEHICLES], rollCos = new float[VEHICLES];
  private final float[] pitchSin = new float[VEHICLES], pitchCos = new float[VEHICLES];
  private final float[] throttle = new float[VEHICLES], density = new float[VEHICLES];

  /** Rotation from body to world, by row and column. */
  private final float[] f00 = new float[VEHICLES],
      f01 = new float[VEHICLES],
      f02 = new float[VEHICLES];

  private final float[] f10 = new float[VEHICLES],
      f11 = new float[VEHICLES],
      f12 = new float[VEHICLES];
  private final float[] f20 = new float[VEHICLES],
      f21 = new float[VEHICLES],
      f22 = new float[VEHICLES];

  /** Vehicles that fly, up to a whole number of lanes. */
  private int used = VEHICLES;

  /** Whether vehicles were placed since the last step, so that their rotations are not known. */
  private boolean isPlaced;

  private static FloatVector drag(double factor) {
    return constant((float) (-factor * Atmosphere.SeaLevelDensity() / FRAME.massKg()));
  }

  /** Flies no more than the first vehicles from now on. What each does is the same, to the bit. */
  void use(int vehicles) {
    used = (vehicles + LANES - 1) / LANES * LANES;
  }

  /** Places a vehicle at hover, settled, told to keep its place. */
  public void hover(int vehicle, Vector3 goalNed) {
    QuadrotorState state = REFERENCE.hovering(goalNed, 0, Environment.Calm());
    for (float[] zero :
        new float[][] {vx, vy, vz, ax, ay, az, qx, qy, qz, wx, wy, wz, wxDot, wyDot, wzDot})
      zero[vehicle] = 0f;
    x[vehicle] = (float) state.x();
    y[vehicle] = (float) state.y();
    z[vehicle] = (float) state.z();
    qw[vehicle] = 1f;
    float control = (float) state.control0();
    for (float[] rotor :
        new float[][] {
          control0, control1, control2, control3, lagged0, lagged1, lagged2, lagged3, thrust0,
          thrust1, thrust2, thrust3
        }) rotor[vehicle] = control;
    integral[vehicle] = (float) state.verticalIntegral();
    isPlaced = true;
    command(vehicle, 0f, 0f, (float) goalNed.z());
  }

  /** {@code moveByVelocityZ}, m/s and m, from the next step on. */
  public void command(int vehicle, float northMps, float eastMps, float downM) {
    goalX[vehicle] = northMps;
    goalY[vehicle] = eastMps;
    goalZ[vehicle] = downM;
  }

  /** Metres, world NED. */
  public Vector3 positionNed(int vehicle) {
    return new Vector3(x[vehicle], y[vehicle], z[vehicle]);
  }

  /** m/s, world NED. */
  public Vector3 velocityNed(int vehicle) {
    return new Vector3(vx[vehicle], vy[vehicle], vz[vehicle]);
  }

  /** From the body, FRD, to the world, NED. */
  public Quaternion orientation(int vehicle) {
    return new Quaternion(qw[vehicle], qx[vehicle], qy[vehicle], qz[vehicle]);
  }

  /** rad/s about the axes of the body, FRD. */
  public Vector3 angularVelocityFrd(int vehicle) {
    return new Vector3(wx[vehicle], wy[vehicle], wz[vehicle]);
  }

  /** Flies the vehicles for {@code steps} steps of 3 ms. */
  public void fly(int steps) {
    if (isPlaced) frame();
    isPlaced = false;
    for (int step = 0; step < steps; step++) {
      translate();
      turn();
      spin();
      frame();
      climb();
      aim();
      LaneMath.atan2(rollSin, rollCos, rollSin, used);
      LaneMath.atan2(pitchSin, pitchCos, pitchSin, used);
      mix();
    }
  }

  private void frame() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector w = FloatVector.fromArray(SPECIES, qw, i),
          a = FloatVector.fromArray(SPECIES, qx, i),
          b = FloatVector.fromArray(SPECIES, qy, i),
          c = FloatVector.fromArray(SPECIES, qz, i);
      FloatVector a2 = a.add(a), b2 = b.add(b), c2 = c.add(c);
      FloatVector aa = a.mul(a2), bb = b.mul(b2), cc = c.mul(c2);
      ONE.sub(bb.add(cc)).intoArray(f00, i);
      ONE.sub(aa.add(cc)).intoArray(f11, i);
      ONE.sub(aa.add(bb)).intoArray(f22, i);
      FloatVector ab = a.mul(b2),
          wc = w.mul(c2),
          ac = a.mul(c2),
          wb = w.mul(b2),
          bc = b.mul(c2),
          wa = w.mul(a2);
      ab.sub(wc).intoArray(f01, i);
      ab.add(wc).intoArray(f10, i);
      ac.add(wb).intoArray(f02, i);
      ac.sub(wb).intoArray(f20, i);
      bc.sub(wa).intoArray(f12, i);
      bc.add(wa).intoArray(f21, i);
    }
  }

  /** Forces, and the next position and velocity. */
  private void translate() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector altitude = ORIGIN_ALTITUDE.sub(FloatVector.fromArray(SPECIES, z, i));
      FloatVector ratio = altitude.fma(DENSITY_2, DENSITY_1).fma(altitude, ONE);
      ratio.intoArray(density, i);
      FloatVector thrust =
          FloatVector.fromArray(SPECIES, thrust0, i)
              .add(FloatVector.fromArray(SPECIES, thrust1, i))
              .add(FloatVector.fromArray(SPECIES, thrust2, i))
              .add(FloatVector.fromArray(SPECIES, thrust3, i));

      FloatVector oldAx = FloatVector.fromArray(SPECIES, ax, i),
          oldAy = FloatVector.fromArray(SPECIES, ay, i),
          oldAz = FloatVector.fromArray(SPECIES, az, i);
      FloatVector startVx = FloatVector.fromArray(SPECIES, vx, i),
          startVy = FloatVector.fromArray(SPECIES, vy, i),
          startVz = FloatVector.fromArray(SPECIES, vz, i);
      FloatVector meanVx = oldAx.fma(HALF_STEP, startVx), meanVy = oldAy.fma(HALF_STEP, startVy);
      FloatVector meanVz = oldAz.fma(HALF_STEP, startVz);
      FloatVector r00 = FloatVector.fromArray(SPECIES, f00, i),
          r01 = FloatVector.fromArray(SPECIES, f01, i),
          r02 = FloatVector.fromArray(SPECIES, f02, i);
      FloatVector r10 = FloatVector.fromArray(SPECIES, f10, i),
          r11 = FloatVector.fromArray(SPECIES, f11, i),
          r12 = FloatVector.fromArray(SPECIES, f12, i);
      FloatVector r20 = FloatVector.fromArray(SPECIES, f20, i),
          r21 = FloatVector.fromArray(SPECIES, f21, i),
          r22 = FloatVector.fromArray(SPECIES, f22, i);
      FloatVector front = r00.fma(meanVx, r10.fma(meanVy, r20.mul(meanVz)));
      FloatVector right = r01.fma(meanVx, r11.fma(meanVy, r21.mul(meanVz)));
      FloatVector down = r02.fma(meanVx, r12.fma(meanVy, r22.mul(meanVz)));
      FloatVector frontSize = front.abs(), rightSize = right.abs(), downSize = down.abs();
      FloatVector forceFront =
          ZERO.blend(front.mul(frontSize).mul(DRAG_FRONT), frontSize.compare(GT, DRAG_MIN_SPEED));
      FloatVector forceRight =
          ZERO.blend(right.mul(rightSize).mul(DRAG_RIGHT), rightSize.compare(GT, DRAG_MIN_SPEED));
      FloatVector forceDown =
          ZERO.blend(down.mul(downSize).mul(DRAG_DOWN), downSize.compare(GT, DRAG_MIN_SPEED))
              .sub(thrust.mul(LIFT));
      FloatVector newAx = r00.fma(forceFront, r01.fma(forceRight, r02.mul(forceDown))).mul(ratio);
      FloatVector newAy = r10.fma(forceFront, r11.fma(forceRight, r12.mul(forceDown))).mul(ratio);
      FloatVector newAz =
          r20.fma(forceFront, r21.fma(forceRight, r22.mul(forceDown))).fma(ratio, GRAVITY);
      newAx.intoArray(ax, i);
      newAy.intoArray(ay, i);
      newAz.intoArray(az, i);
      oldAx.add(newAx).fma(HALF_STEP, startVx).intoArray(vx, i);
      oldAy.add(newAy).fma(HALF_STEP, startVy).intoArray(vy, i);
      oldAz.add(newAz).fma(HALF_STEP, startVz).intoArray(vz, i);
      meanVx.fma(STEP, FloatVector.fromArray(SPECIES, x, i)).intoArray(x, i);
      meanVy.fma(STEP, FloatVector.fromArray(SPECIES, y, i)).intoArray(y, i);
      meanVz.fma(STEP, FloatVector.fromArray(SPECIES, z, i)).intoArray(z, i);
    }
  }

  /** Torques, and the next orientation and angular velocity. */
  private void turn() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector t0 = FloatVector.fromArray(SPECIES, thrust0, i),
          t1 = FloatVector.fromArray(SPECIES, thrust1, i);
      FloatVector t2 = FloatVector.fromArray(SPECIES, thrust2, i),
          t3 = FloatVector.fromArray(SPECIES, thrust3, i);
      FloatVector ratio = FloatVector.fromArray(SPECIES, density, i);
      FloatVector roll = t1.sub(t0).add(t2.sub(t3)).mul(ratio),
          pitch = t0.sub(t1).add(t2.sub(t3)).mul(ratio);
      FloatVector yaw = t0.add(t1).sub(t2.add(t3)).mul(ratio);
      FloatVector oldFront = FloatVector.fromArray(SPECIES, wxDot, i),
          oldRight = FloatVector.fromArray(SPECIES, wyDot, i),
          oldDown = FloatVector.fromArray(SPECIES, wzDot, i);
      FloatVector startWx = FloatVector.fromArray(SPECIES, wx, i),
          startWy = FloatVector.fromArray(SPECIES, wy, i),
          startWz = FloatVector.fromArray(SPECIES, wz, i);
      FloatVector meanWx = oldFront.fma(HALF_STEP, startWx),
          meanWy = oldRight.fma(HALF_STEP, startWy);
      FloatVector meanWz = oldDown.fma(HALF_STEP, startWz);
      FloatVector newFront = meanWy.mul(meanWz).fma(GYRO_FRONT, roll.mul(SPIN_FRONT));
      FloatVector newRight = meanWz.mul(meanWx).fma(GYRO_RIGHT, pitch.mul(SPIN_RIGHT));
      FloatVector newDown = meanWx.mul(meanWy).fma(GYRO_DOWN, yaw.mul(SPIN_DOWN));
      newFront.intoArray(wxDot, i);
      newRight.intoArray(wyDot, i);
      newDown.intoArray(wzDot, i);
      oldFront.add(newFront).fma(HALF_STEP, startWx).intoArray(wx, i);
      oldRight.add(newRight).fma(HALF_STEP, startWy).intoArray(wy, i);
      oldDown.add(newDown).fma(HALF_STEP, startWz).intoArray(wz, i);

      FloatVector halfX = meanWx.mul(HALF_STEP),
          halfY = meanWy.mul(HALF_STEP),
          halfZ = meanWz.mul(HALF_STEP);
      FloatVector square = halfX.fma(halfX, halfY.fma(halfY, halfZ.mul(halfZ)));
      FloatVector w = FloatVector.fromArray(SPECIES, qw, i),
          a = FloatVector.fromArray(SPECIES, qx, i),
          b = FloatVector.fromArray(SPECIES, qy, i),
          c = FloatVector.fromArray(SPECIES, qz, i);
      FloatVector cos = square.fma(COS_2, COS_1).fma(square, ONE),
          sinc = square.fma(SINC_2, SINC_1).fma(square, ONE);
      FloatVector dx = halfX.mul(sinc), dy = halfY.mul(sinc), dz = halfZ.mul(sinc);
      FloatVector nw = w.mul(cos).sub(a.mul(dx)).sub(b.mul(dy)).sub(c.mul(dz));
      FloatVector nx = w.fma(dx, a.mul(cos)).add(b.mul(dz)).sub(c.mul(dy));
      FloatVector ny = w.fma(dy, b.mul(cos)).add(c.mul(dx)).sub(a.mul(dz));
      FloatVector nz = w.fma(dz, c.mul(cos)).add(a.mul(dy)).sub(b.mul(dx));
      FloatVector norm = ONE.div(nw.fma(nw, nx.fma(nx, ny.fma(ny, nz.mul(nz)))).sqrt());
      nw.mul(norm).intoArray(qw, i);
      nx.mul(norm).intoArray(qx, i);
      ny.mul(norm).intoArray(qy, i);
      nz.mul(norm).intoArray(qz, i);
    }
  }

  /** The rotors' lag. */
  private void spin() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector lag0 = FloatVector.fromArray(SPECIES, lagged0, i),
          set0 = FloatVector.fromArray(SPECIES, control0, i);
      lag0.intoArray(thrust0, i);
      lag0.sub(set0).fma(ROTOR_KEEP, set0).intoArray(lagged0, i);
      FloatVector lag1 = FloatVector.fromArray(SPECIES, lagged1, i),
          set1 = FloatVector.fromArray(SPECIES, control1, i);
      lag1.intoArray(thrust1, i);
      lag1.sub(set1).fma(ROTOR_KEEP, set1).intoArray(lagged1, i);
      FloatVector lag2 = FloatVector.fromArray(SPECIES, lagged2, i),
          set2 = FloatVector.fromArray(SPECIES, control2, i);
      lag2.intoArray(thrust2, i);
      lag2.sub(set2).fma(ROTOR_KEEP, set2).intoArray(lagged2, i);
      FloatVector lag3 = FloatVector.fromArray(SPECIES, lagged3, i),
          set3 = FloatVector.fromArray(SPECIES, control3, i);
      lag3.intoArray(thrust3, i);
      lag3.sub(set3).fma(ROTOR_KEEP, set3).intoArray(lagged3, i);
    }
  }

  /** The controller of the vertical: altitude and velocity down give throttle. */
  private void climb() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector r02 = FloatVector.fromArray(SPECIES, f02, i),
          r12 = FloatVector.fromArray(SPECIES, f12, i);
      FloatVector r22 = FloatVector.fromArray(SPECIES, f22, i),
          velZ = FloatVector.fromArray(SPECIES, vz, i);
      FloatVector away =
          FloatVector.fromArray(SPECIES, goalZ, i).sub(FloatVector.fromArray(SPECIES, z, i));
      FloatVector wanted = away.mul(POSITION_P).min(ONE).max(MINUS_ONE).mul(MAX_VELOCITY);
      FloatVector level =
          r02.fma(
              FloatVector.fromArray(SPECIES, vx, i),
              r12.mul(FloatVector.fromArray(SPECIES, vy, i)));
      FloatVector error = r22.mul(wanted.sub(velZ)).sub(level);
      FloatVector kept = FloatVector.fromArray(SPECIES, integral, i).mul(VERTICAL_KEEP);
      FloatVector sum = error.fma(VERTICAL_I, kept).min(ONE).max(MINUS_ONE);
      sum.intoArray(integral, i);
      FloatVector out = error.fma(VERTICAL_P, sum).min(ONE).max(MINUS_ONE);
      ONE.sub(out).mul(HALF).max(MIN_THROTTLE).intoArray(throttle, i);
    }
  }

  /** The controller of the horizontal, upper half: velocity gives the goals of roll and pitch. */
  private void aim() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector r00 = FloatVector.fromArray(SPECIES, f00, i),
          r01 = FloatVector.fromArray(SPECIES, f01, i),
          r02 = FloatVector.fromArray(SPECIES, f02, i);
      FloatVector r10 = FloatVector.fromArray(SPECIES, f10, i),
          r11 = FloatVector.fromArray(SPECIES, f11, i),
          r12 = FloatVector.fromArray(SPECIES, f12, i);
      FloatVector r20 = FloatVector.fromArray(SPECIES, f20, i),
          r21 = FloatVector.fromArray(SPECIES, f21, i),
          r22 = FloatVector.fromArray(SPECIES, f22, i);
      FloatVector velX = FloatVector.fromArray(SPECIES, vx, i),
          velY = FloatVector.fromArray(SPECIES, vy, i),
          velZ = FloatVector.fromArray(SPECIES, vz, i);
      FloatVector offX = FloatVector.fromArray(SPECIES, goalX, i).sub(velX),
          offY = FloatVector.fromArray(SPECIES, goalY, i).sub(velY);
      FloatVector down = FloatVector.fromArray(SPECIES, goalZ, i);
      // The quirk: roll and pitch rotate the altitude goal as if it were a velocity.
      FloatVector offZ = down.sub(velZ);
      FloatVector frontError = r00.fma(offX, r10.fma(offY, r20.mul(offZ)));
      FloatVector rightError = r01.fma(offX, r11.fma(offY, r21.mul(offZ)));
      rightError.mul(VELOCITY_P).min(ONE).max(MINUS_ONE).mul(MAX_TILT).intoArray(rollGoal, i);
      frontError
          .mul(VELOCITY_P)
          .min(ONE)
          .max(MINUS_ONE)
          .mul(MAX_TILT)
          .neg()
          .intoArray(pitchGoal, i);

      r21.intoArray(rollSin, i);
      r22.intoArray(rollCos, i);
      r20.neg().intoArray(pitchSin, i);
      r21.fma(r21, r22.mul(r22)).sqrt().intoArray(pitchCos, i);
    }
  }

  /**
   * The controller's lower half: angles and rates give torque commands, which the mixer turns into
   * rotor controls.
   */
  private void mix() {
    for (int i = 0; i < used; i += LANES) {
      FloatVector rollOff =
          FloatVector.fromArray(SPECIES, rollGoal, i)
              .sub(FloatVector.fromArray(SPECIES, rollSin, i));
      FloatVector pitchOff =
          FloatVector.fromArray(SPECIES, pitchGoal, i)
              .sub(FloatVector.fromArray(SPECIES, pitchSin, i));
      FloatVector rollRate = rollOff.mul(ANGLE_P).min(ONE).max(MINUS_ONE).mul(MAX_RATE);
      FloatVector pitchRate = pitchOff.mul(ANGLE_P).min(ONE).max(MINUS_ONE).mul(MAX_RATE);
      FloatVector roll =
          rollRate.sub(FloatVector.fromArray(SPECIES, wx, i)).mul(RATE_P).min(ONE).max(MINUS_ONE);
      FloatVector pitch =
          pitchRate.sub(FloatVector.fromArray(SPECIES, wy, i)).mul(RATE_P).min(ONE).max(MINUS_ONE);
      FloatVector yaw =
          ZERO.sub(FloatVector.fromArray(SPECIES, wz, i)).mul(RATE_P).min(ONE).max(MINUS_ONE);
      FloatVector base = FloatVector.fromArray(SPECIES, throttle, i),
          plus = base.add(yaw),
          minus = base.sub(yaw);
      FloatVector c0 = plus.sub(roll).add(pitch), c1 = plus.add(roll).sub(pitch);
      FloatVector c2 = minus.add(roll).add(pitch), c3 = minus.sub(roll).sub(pitch);
      FloatVector raise = c0.min(c1).min(c2.min(c3)).min(ZERO);
      FloatVector scale = ONE.div(c0.max(c1).max(c2.max(c3)).sub(raise).max(ONE));
      c0.sub(raise).mul(scale).intoArray(control0, i);
      c1.sub(raise).mul(scale).intoArray(control1, i);
      c2.sub(raise).mul(scale).intoArray(control2, i);
      c3.sub(raise).mul(scale).intoArray(control3, i);
    }
  }
}
