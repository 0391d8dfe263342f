package skein.vehicle

import skein.forward.{PlantResponse, VelocityResponses}
import skein.policy.Action
import skein.signal.{Kinematics, SplitMix64}
import skein.units.*

class ReducedModelSuite extends munit.FunSuite:
  private val model = ReducedModel(gain = 0.95, lagS = 1.7, deadTimeS = 0.12, turnLagS = 2.4, dragPerM = 0.01)

  private def moving(model: ReducedModel): PlantFlight[PlaneReading] =
    val flight = PlantFlight(model)
    flight.start(0, PlaneReading(1, 2, 3, -4), 6, 2)
    flight

  test("the division of a flight into calls does not change it"):
    val (whole, cut) = (moving(model), moving(model))
    val source       = SplitMix64(1)
    whole.advance(0.83)
    var now = 0.0
    while now < 0.83 do
      now = (now + 0.03 * source.nextDouble()).min(0.83)
      cut.advance(now)
    assertEqualsDouble(cut.reading.northM, whole.reading.northM, 1e-12)
    assertEqualsDouble(cut.reading.eastM, whole.reading.eastM, 1e-12)
    assertEqualsDouble(cut.reading.northMps, whole.reading.northMps, 1e-12)
    assertEqualsDouble(cut.reading.eastMps, whole.reading.eastMps, 1e-12)

  test("a piece is the solution of its differential equation"):
    // Euler's method with a millionth of a second, within one piece and so one speed for the drag.
    val flight         = moving(model)
    val (step, span)   = (1e-6, 0.09)
    val (ex, ey)       = (6 / math.hypot(6, 2), 2 / math.hypot(6, 2))
    val goal           = model.gain * math.hypot(6, 2)
    var (x, y, vx, vy) = (1.0, 2.0, 3.0, -4.0)
    for _ <- 1 to math.round(span / step).toInt do
      val along    = vx * ex + vy * ey
      val (cx, cy) = (vx - along * ex, vy - along * ey)
      val pull     = (goal - along) / model.lagS
      val drag     = model.dragPerM * 5
      x += vx * step; y += vy * step
      vx += (pull * ex - cx / model.turnLagS - drag * (along * ex + cx)) * step
      vy += (pull * ey - cy / model.turnLagS - drag * (along * ey + cy)) * step
    flight.advance(span)
    assertEqualsDouble(flight.reading.northM, x, 1e-5)
    assertEqualsDouble(flight.reading.eastM, y, 1e-5)
    assertEqualsDouble(flight.reading.northMps, vx, 1e-5)
    assertEqualsDouble(flight.reading.eastMps, vy, 1e-5)

  test("the final speed balances the drag c v² and the pull of the lag"):
    val flight = moving(model)
    flight.act(0, 10, 0)
    flight.advance(60)
    assertEqualsDouble(
      (0.95 * 10 - flight.reading.northMps) / 1.7,
      0.01 * flight.reading.northMps * flight.reading.northMps,
      1e-6
    )

  test("without drag and with one lag, each axis has a first-order lag"):
    val lag     = FirstOrderLag(0.8)
    val vehicle = VelocityResponses.lag(0.9, lag.lagS, 0.05).create()
    vehicle.start(3, 4, -20)
    var place, velocity, wanted = 0.0
    def glide(spanS: Double)    =
      place += wanted * spanS + (velocity - wanted) * lag.carriesS(spanS)
      velocity = wanted + (velocity - wanted) * lag.remains(spanS)
    for k <- 1 to 40 do
      vehicle.advance(0.07 * k)
      vehicle.act(Action.VelocityAt(9 * math.cos(k), 9 * math.sin(k), Metres(-20)))
      glide(if k == 1 then 0.12 else 0.07)
      wanted = 0.9 * 9 * math.sin(k)
    // Longer than a piece.
    vehicle.advance(0.07 * 40 + 0.05 + 2.5)
    glide(2.5)
    assertEqualsDouble(vehicle.y, 4 + place, 1e-9)
    assertEqualsDouble(vehicle.vy, velocity, 1e-9)

  test("the predictor delays a command by the dead time, whatever the requested spans"):
    val predictor       = PlantModel(model)
    val seen            = Kinematics(Vector3(0, 0, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    val told            = Setpoint.velocityZ(10, 0, -20)
    def after(ms: Int*) = predictor.kinematics(ms.foldLeft(predictor.start(seen))((state, span) =>
      predictor.advanced(state, told, Span.ofMillis(span))
    ))
    assertEquals(after(60, 60).velocityNed, Vector3.Zero)
    assert(after(60, 61).velocityNed.x > 0)
    val expected = PlantResponse(model).create()
    expected.start(0, 0, -20)
    expected.act(Action.VelocityAt(10, 0, Metres(-20)))
    expected.advance(0.15)
    assertEqualsDouble(after(150).positionNed.x, expected.x, 1e-12)
    assertEqualsDouble(after(100, 50).positionNed.x, expected.x, 1e-12)
