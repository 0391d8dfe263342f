package skein.vehicle

import skein.units.*

class AdaptiveQuadrotorSuite extends munit.FunSuite:
  private val Every = Span.ofMillis(51) // 17 steps of physics
  private val Ahead = Span.ofMillis(150)

  /** Simulates a flight with turns and climbs, and predicts it from its own readings.
    *
    * @return for each reading from 10 s on, the errors of the predictions by the nominal and by the adaptive
    *   model, m; and the final state of the adaptive model
    */
  private def flown(deviation: Deviation): (Vector[Double], Vector[Double], AdaptiveQuadrotor.Learning) =
    val vehicle = deviation.kind(seed = 5).make()
    val state   = QuadrotorState()
    vehicle.hover(state, Vector3(0, 0, -20), 0, Environment(windNed = deviation.wind.steadyNed))
    def wanted(s: Double) = Setpoint.velocityZ(
      6 * StrictMath.cos(0.7 * s),
      5 * StrictMath.sin(1.1 * s),
      -20 - 3 * StrictMath.sin(0.4 * s)
    )
    var nominal  = QuadrotorModel.AirSim.start(state.kinematics)
    var adaptive = AdaptiveQuadrotor.start(state.kinematics)
    var offs     = Vector.empty[(Double, Double)]
    val steps    = Every.toNanos / Span.ofSeconds(vehicle.stepS).toNanos
    for reading <- 0 until 500 do
      val goal = wanted(reading * Every.toSeconds)
      for _ <- 1L to steps do vehicle.step(state, goal, Environment.Calm)
      nominal = QuadrotorModel.AirSim
        .corrected(QuadrotorModel.AirSim.advanced(nominal, goal, Every), state.kinematics, Every)
      adaptive = AdaptiveQuadrotor
        .corrected(AdaptiveQuadrotor.advanced(adaptive, goal, Every), state.kinematics, Every)
      if reading * Every.toSeconds > 10 then
        val later = state.copy
        val next  = wanted((reading + 1) * Every.toSeconds)
        for _ <- 1L to Ahead.toNanos / Span.ofSeconds(vehicle.stepS).toNanos do
          deviation.quadrotor
            .step(later, next, Environment(windNed = deviation.wind.steadyNed))
        def off(predicted: skein.signal.Kinematics) = (predicted.positionNed - later.positionNed).norm
        offs = offs :+ (
          off(QuadrotorModel.AirSim.kinematics(QuadrotorModel.AirSim.advanced(nominal, next, Ahead))),
          off(AdaptiveQuadrotor.kinematics(AdaptiveQuadrotor.advanced(adaptive, next, Ahead)))
        )
    (offs.map(_._1).sorted, offs.map(_._2).sorted, adaptive)

  private def p95(sorted: Vector[Double]) = sorted(sorted.size * 95 / 100)

  test("with a correct nominal model, predictions equal the nominal model's predictions, to the bit"):
    val (nominal, adaptive, learned) = flown(Deviation())
    assertEquals(adaptive, nominal)
    assert(!learned.helps)

  test("unknown wind, mass, drag and lag are compensated for after 10 s"):
    val truth                        = Deviation(1.3, 2, 1.5, wind = Wind(Vector3(6, -5, 0)))
    val (nominal, adaptive, learned) = flown(truth)
    assert(p95(nominal) > 0.005, p95(nominal))
    assert(p95(adaptive) < p95(nominal) / 10, (p95(adaptive), p95(nominal)))
    // Mass and the vertical integral, which no reading shows, explain each other.
    val believed = learned.deviation
    assertEqualsDouble(believed.lag, truth.lag, 0.05)
    assert((believed.wind.steadyNed - truth.wind.steadyNed).norm < 1, believed)

  test(
    "with a deviation beyond the bounds, parameters stay within them, and errors are not larger than the " +
      "nominal ones"
  ):
    val (nominal, adaptive, learned) = flown(Deviation(drag = 10, wind = Wind(Vector3(12, 0, 0))))
    assert(p95(adaptive) <= p95(nominal), (p95(adaptive), p95(nominal)))
    assert(learned.deviation.drag <= 5.0001, learned.deviation)

  test("the model does not learn across a gap between readings"):
    val seen    = Quadrotor.AirSim.hovering(Vector3(0, 0, -20)).kinematics
    val before  = AdaptiveQuadrotor.start(seen)
    val jumped  = seen.copy(velocityNed = Vector3(3, 0, 0))
    val learned = AdaptiveQuadrotor.corrected(before, jumped, Span.ofSeconds(2))
    assertEquals(learned.belief, before.belief)
