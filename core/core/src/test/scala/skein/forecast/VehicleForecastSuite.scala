package skein.forecast

import skein.signal.*
import skein.units.*
import skein.vehicle.*

class VehicleForecastSuite extends munit.FunSuite:

  /** Offset of the simulator's clock from the controller's. */
  private val skew   = Span.ofSeconds(1000)
  private val oneWay = Span.ofMillis(50)

  private def controller(ms: Double) = Instant.Epoch + Span.ofMillis(ms)
  private def simulator(ms: Double)  = controller(ms) + skew

  private def at(x: Double, vx: Double = 0) =
    Kinematics(Vector3(x, 0, -20), Vector3(vx, 0, 0), Quaternion.Identity, Vector3.Zero)

  /** A reading that was sampled at this time, ms, over a link with a delay of 50 ms each way. */
  private def reading(sampledMs: Double, state: Kinematics) =
    Stamped(state, simulator(sampledMs), controller(sampledMs) - oneWay, controller(sampledMs) + oneWay)

  private val delays = OneWayDelays.of(reading(0, at(0)))

  /** Predicts a vehicle that follows commands within a microsecond, so that its position shows the command in
    * effect.
    */
  private val obedient = PlantModel(ReducedModel.lag(gain = 1, lagS = 1e-6, deadTimeS = 0))

  private def command(sequence: Long, north: Double, sentMs: Double) =
    Commanded(sequence, Setpoint.velocityZ(north, 0, -20), controller(sentMs))

  private def northAt(track: VehicleForecast[?], validMs: Double, nowMs: Double): Double =
    track.estimateAt(simulator(validMs), delays, controller(nowMs)).kinematics.positionNed.x

  private val commanded =
    VehicleForecast(obedient, reading(0, at(0))).sent(command(0, 10, 0)).sent(command(1, 20, 100))

  test("each command takes effect at its expected arrival, whatever the offset of the clocks"):
    assertEqualsDouble(northAt(commanded, 50, 60), 0, 1e-4)
    assertEqualsDouble(northAt(commanded, 150, 160), 1, 1e-4)
    assertEqualsDouble(northAt(commanded, 200, 210), 2, 1e-4)

  test("an acknowledgement shifts the command's arrival by half of the excess of its round trip"):
    val late = commanded.replaced(sequence = 0, answeredAt = controller(100 + 140))
    assertEqualsDouble(northAt(late, 170, 250), 1.2, 1e-4)
    assertEqualsDouble(northAt(late, 200, 250), 1.8, 1e-4)

  test("an acknowledgement of a command older than all stored ones changes nothing"):
    val several = commanded.sent(command(2, 30, 110)).sent(command(3, 40, 300))
    val seen    = several.seen(reading(200, at(0)), delays)
    assertEquals(seen.commands.map(_.sequence), Vector(2L, 3L))
    assertEquals(seen.replaced(0, controller(390)).commands, seen.commands)
    assertEquals(
      seen.replaced(1, controller(395)).commands.map(_.answeredAt),
      Vector(Some(controller(395)), None)
    )

  /** A plan that flies north with these speeds, in m/s, each for 100 ms. */
  private def plan(sequence: Long, fromMs: Double, north: Double*) =
    north.zipWithIndex.toVector.map: (speed, number) =>
      command(sequence, speed, fromMs - 60).copy(actsAt = Some(simulator(fromMs + 100 * number)))

  test("the actions of a plan act at their own times, however late the plan is answered"):
    val track = VehicleForecast(obedient, reading(0, at(0))).planned(plan(0, 100, 10, 20, 30))
    assertEqualsDouble(northAt(track, 100, 110), 0, 1e-4)
    assertEqualsDouble(northAt(track, 250, 3000), 2, 1e-4)
    assertEqualsDouble(northAt(track, 400, 3000), 6, 1e-4)

  test("a newer plan replaces an older one from its first time on, and a failed call changes nothing"):
    val track = VehicleForecast(obedient, reading(0, at(0)))
      .planned(plan(0, 100, 10, 20, 30))
      .planned(plan(1, 250, 0, 40))
    assertEqualsDouble(northAt(track, 250, 260), 2, 1e-4)
    assertEqualsDouble(northAt(track, 350, 260), 2, 1e-4)
    assertEqualsDouble(northAt(track, 400, 260), 4, 1e-4)
    assertEquals(track.failed(1).commands, track.commands)

  test("a course continues from an estimate as the model does"):
    val track  = VehicleForecast(obedient, reading(0, at(0))).planned(plan(0, 100, 10))
    val course = track.courseAt(simulator(200), delays, controller(210))
    val flown  = course.flown(Setpoint.velocityZ(-5, 0, -20), Span.ofMillis(100))
    assertEquals(course.estimate, track.estimateAt(simulator(200), delays, controller(210)))
    assertEquals(flown.at, simulator(300))
    assertEqualsDouble(flown.estimate.kinematics.positionNed.x, 0.5, 1e-4)
    assertEquals(flown.estimate.readAt, simulator(0))

  test("no command takes effect before an earlier one"):
    val crossed = commanded
      .sent(command(2, -10, 130))
      .replaced(sequence = 0, answeredAt = controller(100 + 300))
    assertEqualsDouble(northAt(crossed, 249, 400), 2, 0.02)
    assertEqualsDouble(northAt(crossed, 350, 400), 1, 0.02)

  test(
    "a command without acknowledgement is presumed lost after two round trips and the grace time, until " +
      "one arrives"
  ):
    val overdueMs = 100 + 2 * 100 + VehicleForecast.Grace.toMillis + 1
    assertEqualsDouble(northAt(commanded, 300, overdueMs), 2.5, 1e-4)
    assertEqualsDouble(northAt(commanded.replaced(0, controller(200)), 300, overdueMs), 4, 1e-4)

  test("the command of a failed call does not act unless it was acknowledged"):
    assertEqualsDouble(northAt(commanded.failed(1), 300, 310), 2.5, 1e-4)
    assertEqualsDouble(northAt(commanded.replaced(0, controller(200)).failed(1), 300, 310), 4, 1e-4)

  test("a reading that is not newer than the newest changes nothing"):
    val seen = commanded.seen(reading(100, at(0.5, 10)), delays)
    assert(seen.seen(reading(50, at(7)), delays) eq seen)
    assert(seen.seen(reading(100, at(7)), delays) eq seen)

  test(
    "after a restart of the simulator with an earlier clock, a vehicle is at the position of the first " +
      "new reading"
  ):
    def seen(validMs: Double, sentMs: Double, receivedMs: Double, northM: Double) =
      val told = Stamped(at(northM), simulator(validMs), controller(sentMs), controller(receivedMs))
      ForecastEvent.Seen(0, told)
    val before = Forecast(Vector(ConstantVelocity))
      .withEvent(seen(20000, 100, 100, 5))
      .withEvent(seen(20100, 200, 200, 5))
    val again                     = before.withEvent(seen(100, 300, 300, 70))
    def north(forecast: Forecast) =
      forecast.whenActing(controller(310)).map(_.head.kinematics.positionNed.x)
    assertEquals(north(before), Some(5.0))
    assertEquals(north(again), Some(70.0))
    assertEquals(north(again.withEvent(seen(20090, 190, 305, 5))), Some(70.0), "late, of the first run")

  test("a forecast works with missing readings, and forgets past commands except the one in effect"):
    val sparse =
      (2 to 30).foldLeft(commanded)((track, n) => track.sent(command(n, 10.0 * (n % 3), 100.0 * n)))
    val seen = sparse.seen(reading(2500, at(77, 0)), delays)
    assertEquals(seen.commands.map(_.sequence), (24L to 30L).toVector)
    assertEqualsDouble(northAt(seen, 2550, 2560), 77, 1e-4)
    assertEqualsDouble(northAt(seen, 2650, 2660), 78, 1e-4)

  test("the numbers of stored commands and readings are limited"):
    val busy = (2 to 1000).foldLeft(commanded)((track, n) => track.sent(command(n, 1, n)))
    assertEquals(busy.commands.size, VehicleForecast.CommandLimit)
    val readings = (1 to 100).foldLeft(commanded)((track, n) => track.seen(reading(100.0 * n, at(n)), delays))
    assertEquals(readings.readings.size, VehicleForecast.ReadingLimit)

  test("a position between two readings is interpolated within 5 mm, and is absent in a gap"):
    def circling(ms: Double) =
      val angle = ms / 1000
      Kinematics(
        Vector3(10 * math.cos(angle), 10 * math.sin(angle), -20),
        Vector3(-10 * math.sin(angle), 10 * math.cos(angle), 0),
        Quaternion.Identity,
        Vector3.Zero
      )
    val track =
      Seq(300.0, 400.0, 1000.0).foldLeft(VehicleForecast(obedient, reading(0, circling(0))))((track, ms) =>
        track.seen(reading(ms, circling(ms)), delays)
      )
    for ms <- 0 to 400 by 10 do
      val position = track.positionNedAt(simulator(ms)).get
      assert((position - circling(ms).positionNed).norm < 5e-3, s"$ms ms: $position")
    assertEquals(track.positionNedAt(simulator(700)), None)
    assertEquals(track.positionNedAt(simulator(1100)), None)

  test(
    "a quadrotor's state when its command acts is estimated within 5 mm, from readings 50 ms old and " +
      "commands under way"
  ):
    val quadrotor = Quadrotor.AirSim
    val model     = QuadrotorModel.AirSim
    val start     = Vector3(0, 0, -20)
    val real      = quadrotor.hovering(start)
    val heading   = (ms: Int) => 0.7 * math.floor(ms / 100.0)
    val setpoint  =
      (ms: Int) => Setpoint.velocityZ(10 * math.cos(heading(ms)), 10 * math.sin(heading(ms)), -20)
    // The command in effect at 3 n ms was sent 50 ms before; a reading every 99 ms is used 100 ms after it
    // was sampled.
    val truth = Vector.tabulate(2000): n =>
      val before = real.kinematics
      quadrotor.step(real, if 3 * n < 50 then Setpoint.hold(start) else setpoint(3 * n - 50))
      before
    var track: VehicleForecast[?] = VehicleForecast(model, reading(0, truth(0)))
    var worst                     = 0.0
    for n <- 33 until 1900 by 33 do
      val sampledMs = 3 * n
      for sentMs <- 0 to sampledMs + 49 by 100 if sentMs > sampledMs - 50 do
        track = track.sent(Commanded(sentMs / 100, setpoint(sentMs), controller(sentMs)))
      track = track.seen(reading(sampledMs, truth(n)), delays)
      val estimate = track.estimateAt(simulator(sampledMs + 99), delays, controller(sampledMs + 50))
      worst = worst.max((estimate.kinematics.positionNed - truth(n + 33).positionNed).norm)
    assert(worst < 5e-3, s"$worst m")
