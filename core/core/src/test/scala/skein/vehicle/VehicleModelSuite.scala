package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

class VehicleModelSuite extends munit.FunSuite:
  private val quadrotor = Quadrotor.AirSim
  private val start     = Vector3(3, -4, -20)
  private val step      = Span.ofSeconds(quadrotor.stepS)

  private def seen(positionNed: Vector3, velocityNed: Vector3) =
    Kinematics(positionNed, velocityNed, Quaternion.Identity, Vector3.Zero)

  private def assertClose(actual: Vector3, expected: Vector3, tolerance: Double)(using munit.Location): Unit =
    assert((actual - expected).norm <= tolerance, s"$actual is not $expected")

  test("the quadrotor's model flies as the quadrotor does, whatever the division of time"):
    val state    = quadrotor.hovering(start)
    val model    = QuadrotorModel.AirSim
    val setpoint = Setpoint.velocityZ(10, 2, -20)
    val whole    = model.advanced(model.start(state.kinematics), setpoint, step * 1000)
    val pieces   = (1 to 600).foldLeft(model.start(state.kinematics))((flying, _) =>
      model.advanced(flying, setpoint, step * 5 / 3)
    )
    for _ <- 1 to 1000 do quadrotor.step(state, setpoint)
    assertClose(model.kinematics(whole).positionNed, state.positionNed, 5e-3)
    assertEquals(model.kinematics(pieces).velocityNed, model.kinematics(whole).velocityNed)
    assertClose(model.kinematics(pieces).positionNed, model.kinematics(whole).positionNed, 1e-9)

  test("after a correction, the model stays within 5 mm of the real quadrotor for half a second"):
    val model    = QuadrotorModel.AirSim
    val real     = quadrotor.hovering(start)
    val commands = Seq(Setpoint.velocityZ(10, 0, -20), Setpoint.velocityZ(0, 10, -20))
    // The model receives the first command 50 ms late, so that it deviates when it is corrected.
    var flying = model.advanced(model.start(real.kinematics), Setpoint.hold(start), Span.ofMillis(50))
    flying = model.advanced(flying, commands(0), step * 500 - Span.ofMillis(50))
    for _ <- 1 to 500 do quadrotor.step(real, commands(0))
    assert((model.kinematics(flying).positionNed - real.positionNed).norm > 0.05)
    flying = model.corrected(flying, real.kinematics, step * 500)
    assertEquals(model.kinematics(flying), real.kinematics)
    for _ <- 1 to 166 do quadrotor.step(real, commands(1))
    flying = model.advanced(flying, commands(1), step * 166)
    assertClose(model.kinematics(flying).positionNed, real.positionNed, 5e-3)

  test("a state of the quadrotor's model is immutable: predictions leave it unchanged"):
    val model  = QuadrotorModel.AirSim
    val before = model.start(seen(start, Vector3(1, 2, 0)))
    val was    = model.kinematics(before)
    val _      = model.advanced(before, Setpoint.velocityZ(10, 0, -20), Span.ofSeconds(1))
    val _      = model.corrected(before, seen(Vector3.Zero, Vector3.Zero), Span.ofSeconds(1))
    assertEquals(model.kinematics(before), was)

  test("after its lag, the reduced model has reached 1 − 1/e of its final speed"):
    val model = PlantModel(ReducedModel.lag(gain = 0.9, lagS = 2, deadTimeS = 0))
    val after = model.kinematics(
      model.advanced(
        model.start(seen(start, Vector3.Zero)),
        Setpoint.velocityZ(10, -5, -20),
        Span.ofSeconds(2)
      )
    )
    assertClose(after.velocityNed, Vector3(9, -4.5, 0) * (1 - 1 / math.E), 1e-12)
    assertClose(after.positionNed, start + Vector3(9, -4.5, 0) * (2 / math.E), 1e-12)

  test("constant velocity continues a reading"):
    val after = ConstantVelocity.advanced(seen(start, Vector3(1, 2, -3)), Setpoint.Armed, Span.ofSeconds(0.5))
    assertClose(after.positionNed, start + Vector3(0.5, 1, -1.5), 1e-12)

  test("constant turn continues along the circle through two readings"):
    def onCircle(t: Double) =
      seen(
        Vector3(10 * math.cos(0.8 * t), 10 * math.sin(0.8 * t), -20),
        Vector3(-8 * math.sin(0.8 * t), 8 * math.cos(0.8 * t), 0)
      )
    val first     = ConstantTurn.start(onCircle(0))
    val second    = ConstantTurn.corrected(first, onCircle(0.1), Span.ofSeconds(0.1))
    val predicted =
      ConstantTurn.kinematics(ConstantTurn.advanced(second, Setpoint.Armed, Span.ofSeconds(0.7)))
    assertClose(predicted.positionNed, onCircle(0.8).positionNed, 1e-9)
    assertClose(predicted.velocityNed, onCircle(0.8).velocityNed, 1e-9)
