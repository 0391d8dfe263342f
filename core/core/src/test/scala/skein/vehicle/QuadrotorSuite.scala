package skein.vehicle

import skein.units.Vector3

class QuadrotorSuite extends munit.FunSuite:
  private val quadrotor = Quadrotor.AirSim
  private val goal      = Vector3(3, -4, -20)

  private def fly(
      state: QuadrotorState,
      setpoint: Setpoint,
      seconds: Double,
      environment: Environment = Environment.Calm
  ): Unit =
    for _ <- 1 to (seconds / quadrotor.stepS).round.toInt do quadrotor.step(state, setpoint, environment)

  test("a hovering vehicle holds its position to a millimetre over 30 s"):
    val state = quadrotor.hovering(goal)
    val start = state.positionNed
    for _ <- 1 to 10000 do
      quadrotor.step(state, Setpoint.hold(goal))
      assert((state.positionNed - start).norm < 1e-3, state.positionNed)

  test("a hovering vehicle settles two millimetres below its goal"):
    assertEqualsDouble(quadrotor.hoverSagM(-20), 0.002, 2e-4)

  test("the hover control at 20 m is AirSim's 0.5947"):
    assertEqualsDouble(quadrotor.hoverControl(-20), 0.5947, 5e-5)

  test("the inertia and drag factors are those of AirSim's generic quadrotor"):
    val frame = quadrotor.airframe
    assertEqualsDouble(frame.inertiaFront, 0.006721187, 1e-9)
    assertEqualsDouble(frame.inertiaRight, 0.008040687, 1e-9)
    assertEqualsDouble(frame.inertiaDown, 0.01427888, 1e-8)
    assertEqualsDouble(frame.dragFront, 0.00538309, 1e-8)
    assertEqualsDouble(frame.dragRight, 0.00583809, 1e-8)
    assertEqualsDouble(frame.dragDown, 0.10993, 1e-5)

  test("the air density follows the standard atmosphere"):
    for (altitudeM, density) <- Seq(0.0 -> 1.2250, 142.0 -> 1.2084, 1000.0 -> 1.1117, 2000.0 -> 1.0065) do
      assertEqualsDouble(Atmosphere.SeaLevelDensity * Atmosphere.densityRatio(altitudeM), density, 6e-5)

  test("two runs of equal commands are equal to the bit, also from a copied state"):
    val first = quadrotor.hovering(goal)
    fly(first, Setpoint.velocityZ(5, 1, -20), 1.0)
    val second = QuadrotorState()
    second.copyFrom(first)
    for state <- Seq(first, second) do
      fly(state, Setpoint.velocity(2, -3, 0.5).withYaw(0.4), 2.0)
      fly(state, Setpoint.hold(goal), 2.0)
    assertEquals(first.kinematics, second.kinematics)
    assertEquals(first.accelerationNed, second.accelerationNed)
    assertEquals(first.thrust3, second.thrust3)

  test("flight does not depend on the direction once the vehicle's nose points there"):
    val north = quadrotor.hovering(Vector3(0, 0, -20))
    fly(north, Setpoint.velocityZ(5, 0, -20), 5.0)
    for degrees <- Seq(30.0, 90.0, -135.0) do
      val heading = degrees.toRadians
      val turned  = quadrotor.hovering(Vector3(0, 0, -20), heading)
      fly(turned, Setpoint.velocityZ(5 * math.cos(heading), 5 * math.sin(heading), -20), 5.0)
      assertEqualsDouble(math.hypot(turned.x, turned.y), north.x, 1e-9)
      assertEqualsDouble(math.atan2(turned.y, turned.x), heading, 1e-9)
      assertEqualsDouble(turned.z, north.z, 1e-9)

  test("a vehicle on the ground stays there until its thrust exceeds its weight, then climbs"):
    val state = quadrotor.landed(Vector3(1, 2, 0), yawRad = 0.3)
    fly(state, Setpoint.Disarmed, 1.0)
    fly(state, Setpoint.Armed, 1.0)
    assert(state.grounded)
    assertEquals(state.positionNed, Vector3(1, 2, 0))
    fly(state, Setpoint.anglesZ(0, 0, 0.3, -2), 8.0)
    assert(!state.grounded)
    assertEqualsDouble(state.z, -2, 0.05)
    assertEqualsDouble(state.yawRad, 0.3, 1e-3)

  test("landing leaves the vehicle level on the ground"):
    val state = quadrotor.hovering(Vector3(0, 0, -3), 0.5)
    fly(state, Setpoint.velocity(0, 0, 0.5).withYaw(0.5), 12.0)
    assert(state.grounded)
    fly(state, Setpoint.Disarmed, 1.0)
    assertEquals(state.z, 0.0)
    assertEquals(state.velocityNed, Vector3.Zero)
    assertEqualsDouble(state.tiltRad, 0, 1e-9)
    assertEqualsDouble(state.yawRad, 0.5, 1e-6)

  test("a vehicle that reaches the ground faster sideways than down bounces and slows"):
    val state = quadrotor.hovering(Vector3(0, 0, -1))
    state.vx = 6; state.vz = 3
    fly(state, Setpoint.Disarmed, 0.3)
    assert(!state.grounded)
    assert(state.vz < 0, state.vz)
    assert(state.vx < 4, state.vx)

  test(
    "a bounce keeps the orientation, returns 0.55 of the speed down and halves the speed along the ground"
  ):
    val state = quadrotor.hovering(Vector3(0, 0, -0.005), 0.4)
    state.vx = 6; state.vy = -1; state.vz = 3; state.az = 2; state.wz = 1
    quadrotor.step(state, Setpoint.Disarmed)
    assertEquals(state.contacts, 1)
    assertEquals((state.vx, state.vy), (3.0, -0.5))
    assertEqualsDouble(state.vz, -0.55 * (3 + 2 * 0.003), 1e-12)
    assertEqualsDouble(state.x, 3 * 0.003, 1e-12)
    assertEqualsDouble(state.z, state.vz * 0.003, 1e-12)
    assertEqualsDouble(state.yawRad, 0.4, 1e-12)
    assertEqualsDouble(state.wz, 0.9, 1e-12)
    assertEquals(state.accelerationNed, Vector3.Zero)

  test("wind pushes a hovering vehicle until the controller leans against it"):
    val windy = Environment(windNed = Vector3(0, 8, 0))
    val state = quadrotor.hovering(goal)
    fly(state, Setpoint.hold(goal), 30.0, windy)
    assertEqualsDouble(state.vy, 0, 1e-3)
    assert(state.y - goal.y > 0.2, state.y)
    assert(state.tiltRad > 0.02, state.tiltRad)

  test("a yaw goal is reached by the shorter way, and a yaw rate is held"):
    val state = quadrotor.hovering(goal, 170.0.toRadians)
    fly(state, Setpoint.velocityZ(0, 0, -20).withYaw(-170.0.toRadians), 0.2)
    assert(state.wz > 0, state.wz)
    fly(state, Setpoint.velocityZ(0, 0, -20).withYaw(-170.0.toRadians), 5.0)
    assertEqualsDouble(state.yawRad, -170.0.toRadians, 1e-3)
    fly(state, Setpoint.velocityZ(0, 0, -20).withYawRate(0.5), 3.0)
    assertEqualsDouble(state.wz, 0.5, 5e-3)

  test("angles, rates and throttle are followed"):
    val tilted = quadrotor.hovering(goal)
    fly(tilted, Setpoint.anglesZ(0.1, -0.2, 0.0, -20), 1.5)
    val roll = math.atan2(
      2 * (tilted.qw * tilted.qx + tilted.qy * tilted.qz),
      1 - 2 * (tilted.qx * tilted.qx + tilted.qy * tilted.qy)
    )
    val pitch = math.asin(2 * (tilted.qw * tilted.qy - tilted.qz * tilted.qx))
    assertEqualsDouble(roll, 0.1, 3e-3)
    assertEqualsDouble(pitch, -0.2, 3e-3)
    assert(tilted.vx > 1 && tilted.vy > 0.5, tilted.velocityNed)

    val spinning = quadrotor.hovering(goal)
    fly(spinning, Setpoint.ratesZ(0, 0, 1.0, -20), 2.0)
    assertEqualsDouble(spinning.wz, 1.0, 0.01)

    val climbing = quadrotor.hovering(goal)
    fly(climbing, Setpoint.anglesThrottle(0, 0, 0, 0.7), 1.0)
    assert(climbing.vz < -1, climbing.vz)

  test("a change of the vertical mode resets the integrator; otherwise it is kept"):
    val kept = quadrotor.hovering(goal)
    quadrotor.step(kept, Setpoint.velocityZ(0, 0, -20))
    assert(kept.verticalIntegral < -0.18, kept.verticalIntegral)
    val renewed = quadrotor.hovering(goal)
    quadrotor.step(renewed, Setpoint.velocity(0, 0, 0))
    assertEquals(renewed.verticalIntegral, 0.0)
