package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Compares the car's model with results derived from its source, and tests its driver. */
class SingleTrackSuite extends munit.FunSuite:
  private val car     = SingleTrack()
  private val gravity = Airframe.Gravity

  private def driven(from: CarState, controls: CarControls, forS: Double, dtS: Double = 0.003): CarState =
    (1 to (forS / dtS).round.toInt).foldLeft(from)((state, _) => car.step(state, controls, dtS))

  private def rolling(frontMps: Double) = CarState(0, 0, 0, frontMps)

  private def keeping(frontMps: Double, steeredRad: Double) =
    CarControls(car.coastMps2(frontMps) / car.driveMps2(frontMps), steeredRad / car.mostSteeredRad, 0)

  test("the car drives off straight ahead, and backwards with a negative throttle"):
    val off = driven(CarState(0, 0, 0), CarControls(1, 0, 0), 2)
    // Half of its weight is on driven wheels.
    assertEqualsDouble(off.frontMps, (1.0489 / 2 - 0.015) * gravity * 2, 0.02)
    assertEquals((off.eastM, off.headingRad), (0.0, 0.0))
    val back = driven(CarState(0, 0, math.Pi / 2), CarControls(-1, 0, 0), 1)
    assert(back.frontMps < -4 && back.eastM < -2, back)

  test("full braking stops the car within v²/(2 μ g), and the car then stays at rest"):
    val stopped = driven(rolling(20), CarControls.Stop, 5)
    assertEquals(stopped.frontMps, 0.0)
    assertEqualsDouble(stopped.northM, 400 / (2 * 1.0489 * gravity), 0.4)
    assertEquals(driven(stopped, CarControls.Stop, 1), stopped)

  test("without any control the car rolls to a stop"):
    assertEquals(driven(rolling(5), CarControls.Neutral, 40).frontMps, 0.0)

  test("stopped in a turn, the car swings on its tyres for a moment and comes to rest"):
    val turning = driven(rolling(8), CarControls(0.1, 0.4, 0), 3)
    assert(turning.yawRadPerS > 0.5, turning)
    val rested = driven(driven(turning, CarControls.Stop, 2), CarControls.Stop, 3)
    assert(rested.rightMps.abs < 1e-6 && rested.yawRadPerS.abs < 1e-6, rested)

  test("with equal tyres at both axles the car's yaw rate is v · angle / wheelbase, at every speed"):
    for frontMps <- Seq(4.0, 8.0, 14.0) do
      val steered = 0.01
      val round   = driven(rolling(frontMps), keeping(frontMps, steered), 4)
      assertEqualsDouble(round.yawRadPerS / (frontMps * steered / car.wheelbaseM), 1, 0.02, s"$frontMps m/s")

  test("the lateral acceleration is at most μ g, however the car is steered"):
    var state = rolling(25)
    for _ <- 1 to 2000 do
      val next   = car.step(state, CarControls(0.2, 1, 0), 0.003)
      val across = (next.rightMps - state.rightMps) / 0.003 + state.frontMps * state.yawRadPerS
      assert(math.abs(across) <= car.brakeMps2 + 1e-9, state)
      state = next
    assert(state.frontSlipRad > 0.1, state)

  test("a car at rest does not turn, however it is steered"):
    val stood = driven(CarState(0, 0, 0), CarControls(0, 1, 0), 3)
    assertEquals((stood.headingRad, stood.northM, stood.yawRadPerS), (0.0, 0.0, 0.0))

  test("a tyre's deflection is 63 % of its slip angle after it has rolled by its relaxation length"):
    // One that hardly pushes leaves the body where it is.
    val soft     = SingleTrack(stiffnessPerRad = 1e-9)
    val frontMps = 8.0
    val state    = (1 to 1000).foldLeft(CarState(0, 0, 0, frontMps, steeredRad = 0.1)): (state, _) =>
      soft.step(state, keeping(frontMps, 0.1), soft.relaxationM / frontMps / 1000)
    assertEqualsDouble(state.frontSlipRad / math.sin(0.1), 1 - math.exp(-1), 1e-3)

  test("the division of time into steps makes no significant difference"):
    def way(dtS: Double) = (1 to 3).foldLeft(rolling(8)): (state, part) =>
      driven(state, CarControls(0.3, if part == 2 then -0.2 else 0.2, 0), 1.2, dtS)
    val (fine, coarse) = (way(0.001), way(0.01))
    assertEqualsDouble(coarse.northM, fine.northM, 0.05)
    assertEqualsDouble(coarse.eastM, fine.eastM, 0.05)

  /** The linear single-track model with two tyres, each with its relaxation length: Rajamani's equations 2.31
    * and 2.32 in kilograms and newtons, with lagging slip angles, in small steps.
    *
    * @return heading, rad, after the steering angle has reached `steerRad` as fast as it can
    */
  private def linearHeadingRad(speedMps: Double, steerRad: Double, forS: Double): Double =
    val (mass, inertia, rear) = (1093.3, 1791.6, 1.4227)
    val front                 = 2.5789 - rear
    val frontN                = 1.0489 * 20.89 * mass * gravity * rear / 2.5789
    val rearN                 = 1.0489 * 20.89 * mass * gravity * front / 2.5789
    var lateral, yawRate, heading, frontSlip, rearSlip, steered = 0.0
    val dt                                                      = 1e-4
    for _ <- 1 to (forS / dt).round.toInt do
      steered += (0.4 * dt).min(steerRad - steered)
      frontSlip += speedMps / 0.5 * dt * (steered - (lateral + front * yawRate) / speedMps - frontSlip)
      rearSlip += speedMps / 0.5 * dt * (-(lateral - rear * yawRate) / speedMps - rearSlip)
      lateral += dt * ((frontN * frontSlip + rearN * rearSlip) / mass - speedMps * yawRate)
      yawRate += dt * (front * frontN * frontSlip - rear * rearN * rearSlip) / inertia
      heading += dt * yawRate
    heading

  for speedMps <- Seq(7.0, 12.0, 20.0) do
    test(
      s"at $speedMps m/s the car turns like the linear single-track model with lagging tyres, to within 5 ms"
    ):
      val steerRad = 0.72 / (speedMps * speedMps)
      for forS <- Seq(0.3, 0.6, 1.2, 2.1) do
        val ours   = driven(rolling(speedMps), keeping(speedMps, steerRad), forS).headingRad
        val linear = linearHeadingRad(speedMps, steerRad, forS)
        // So much earlier or later it has this heading.
        assertEqualsDouble(
          (linear - ours) / (speedMps * steerRad / car.wheelbaseM),
          0,
          0.005,
          s"after $forS s"
        )

  test("the driver reaches a commanded velocity, and turns round if it points backwards"):
    for
      degrees <- Seq(0, 30, -90, 180)
      driven = DrivenCar()
    do
      val (north, east) = (6 * math.cos(math.toRadians(degrees)), 6 * math.sin(math.toRadians(degrees)))
      val there = (1 to 1500).foldLeft(driven.initial)((state, _) => driven.step(state, north, east, 0.01))
      val seen  = driven.read(there)
      assertEqualsDouble(seen.northMps, north, 0.05, s"$degrees°")
      assertEqualsDouble(seen.eastMps, east, 0.05, s"$degrees°")
    val stood = (1 to 400).foldLeft(rolling(6))((state, _) => DrivenCar().step(state, 0, 0, 0.01))
    assertEquals(stood.frontMps, 0.0)

  test("a prediction equals the simulated drive"):
    val driven                = DrivenCar()
    val model                 = CarModel(driven)
    def seen(state: CarState) = Kinematics(
      Vector3(state.northM, state.eastM, 0),
      Vector3(state.northMps, state.eastMps, 0),
      Quaternion.ofYaw(state.headingRad),
      Vector3(0, 0, state.yawRadPerS)
    )
    def drive(from: CarState, steps: Int) =
      (1 to steps).foldLeft(from)((state, _) => driven.step(state, 4, 6, driven.stepS))
    val (now, later) = (drive(driven.initial, 120), drive(driven.initial, 150))
    val told         = Setpoint.velocity(4, 6, 0)
    val between      = Span.ofSeconds(1.2)
    val known        =
      model.corrected(model.advanced(model.start(seen(driven.initial)), told, between), seen(now), between)
    val predicted = model.kinematics(model.advanced(known, told, Span.ofSeconds(0.3)))
    assert((predicted.positionNed - seen(later).positionNed).norm < 1e-6, predicted)
    assert((predicted.velocityNed - seen(later).velocityNed).norm < 1e-6, predicted)
