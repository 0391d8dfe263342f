package skein.loop

import skein.flow.Sense
import skein.forward.{Asking, LoopTiming, Steering}
import skein.planning.Geofence
import skein.port.Moves
import skein.scenario.Fence
import skein.units.*
import skein.vehicle.{ConstantTurn, ConstantVelocity}

/** Settings of loops: the bounds of every number, and derived values. */
class SettingsSuite extends munit.FunSuite:
  private val ms = Span.ofMillis

  test("a loop needs a period, a window and a move in flight"):
    assertEquals(LoopSettings(period = Span.ofNanos(1), window = 1, movesInFlight = 1).window, 1)
    for
      (make, expected) <- Seq[(() => LoopSettings, String)](
        (() => LoopSettings(period = Span.Zero), "period"),
        (() => LoopSettings(window = 0), "window"),
        (() => LoopSettings(movesInFlight = 0), "moves in flight: expected 1 to 32, got 0"),
        (() => LoopSettings(movesInFlight = 33), "moves in flight: expected 1 to 32, got 33")
      )
    do assert(intercept[IllegalArgumentException](make()).getMessage.contains(expected))

  test("a decision's deadline must leave it some time"):
    assertEquals(Deadline(Span.ofNanos(1), Fallback.Hold).within, Span.ofNanos(1))
    assert(intercept[IllegalArgumentException](Deadline(
      Span.Zero,
      Fallback.Hold
    )).getMessage.contains("deadline"))

  test("settings for the paper's period are the defaults"):
    assertEquals(LoopSettings.every(ms(100)).copy(model = LoopSettings().model), LoopSettings())
    val slow = LoopSettings.every(ms(300))
    assertEquals((slow.period, slow.paceInterval, slow.patience), (ms(300), ms(150), ms(300)))

  test(
    "as published, requests are spread over the period, answers are awaited in order, and each is decided on"
  ):
    val published = LoopSettings(period = ms(80)).asPublished
    assertEquals((published.paceInterval, published.spread, published.patience), (ms(80), ms(80), Span.Zero))
    assertEquals((published.early, published.decideThenPace), (Sense.Early.Waits, true))

  test("forward simulation has the loops' own times, in seconds"):
    val settings = LoopSettings(period = ms(200), paceInterval = ms(60), patience = ms(70), spread = ms(40))
    val asking   = Asking(4, 0.5, 0.04, inOrder = false)
    val steering = Steering(0.02, 2, 0.0005)
    def of(kind: LoopKind, settings: LoopSettings = settings) = LoopTimings.of(kind, settings)
    assertEquals(of(LoopKind.Paused), Some(LoopTiming.Paused(0.2)))
    assertEquals(of(LoopKind.Sequential), Some(LoopTiming.Sequential(0.2, asking, steering)))
    assertEquals(of(LoopKind.Futures), Some(LoopTiming.Futures(0.2, asking, steering)))
    // The view of a decision is at most a pace old when the period's decision is due.
    assertEquals(of(LoopKind.Stream), Some(LoopTiming.Stream(0.2, 0.14, 0.07, false, asking, steering)))
    of(LoopKind.Stream, settings.asPublished) match
      case Some(LoopTiming.Stream(_, wait, patience, decideThenPace, asking, _)) =>
        assertEquals((wait, patience, decideThenPace, asking.inOrder), (0.0, 0.0, true, true))
      case other => fail(s"expected a stream, got $other")
    val models = Vector(ConstantVelocity, ConstantTurn)
    assertEquals(
      of(LoopKind.Predictive, settings.copy(model = models(_))),
      Some(LoopTiming.Predictive(0.2, ConstantVelocity, asking, steering))
    )
    assertEquals(of(LoopKind.Plan), None)
    assertEquals(Moves.HandoverAllowed, ms(0.5))

  private def mistake(settings: PlanSettings): String = settings.mistakes.mkString("; ")

  test("plans: values at their limits are valid"):
    for
      settings <- Seq(
        PlanSettings(),
        PlanSettings(
          deadline = Span.ofNanos(1),
          horizonSteps = 1,
          step = ms(10),
          behaviours = 1,
          searches = 1
        ),
        PlanSettings(ms(2000), horizonSteps = 200, step = ms(500), behaviours = 32, searches = 64),
        PlanSettings(slices = 1, blocksPerSlice = 1, turningRadiusM = 0.001, slowestShare = 0),
        PlanSettings(slowestShare = 1, separationM = 0, geofenceM = 0)
      )
    do assertEquals(mistake(settings), "")

  test("plans: a value beyond its limit is reported, with what was expected"):
    for
      (settings, told) <- Seq(
        PlanSettings(deadline =
          Span.Zero
        ) -> "deadline: expected more than 0 and at most 2000.0 ms, got 0.0 ms",
        PlanSettings(deadline =
          ms(2001)
        ) -> "deadline: expected more than 0 and at most 2000.0 ms, got 2001.0 ms",
        PlanSettings(horizonSteps = 0)     -> "horizonSteps: expected 1 to 200, got 0",
        PlanSettings(horizonSteps = 201)   -> "horizonSteps: expected 1 to 200, got 201",
        PlanSettings(step = ms(9.5))       -> "step: expected 10 to 500 ms, got 9.5 ms",
        PlanSettings(step = ms(500.5))     -> "step: expected 10 to 500 ms, got 500.5 ms",
        PlanSettings(behaviours = 0)       -> "behaviours: expected 1 to 32, got 0",
        PlanSettings(behaviours = 33)      -> "behaviours: expected 1 to 32, got 33",
        PlanSettings(searches = 0)         -> "searches: expected 1 to 64, got 0",
        PlanSettings(searches = 65)        -> "searches: expected 1 to 64, got 65",
        PlanSettings(slices = 0)           -> "slices: expected 1 or more, got 0",
        PlanSettings(blocksPerSlice = 0)   -> "blocksPerSlice: expected 1 or more, got 0",
        PlanSettings(turningRadiusM = 0)   -> "turningRadiusM: expected more than 0, got 0.0",
        PlanSettings(slowestShare = -0.01) -> "slowestShare: expected 0 to 1, got -0.01",
        PlanSettings(slowestShare = 1.01)  -> "slowestShare: expected 0 to 1, got 1.01",
        PlanSettings(separationM = -1)     -> "separationM: expected 0 or more, got -1.0",
        PlanSettings(geofenceM = -1)       -> "geofenceM: expected 0 or more, got -1.0",
        PlanSettings(
          slices = 0,
          geofenceM = -1
        ) -> "slices: expected 1 or more, got 0; geofenceM: expected 0 or more, got -1.0"
      )
    do
      assertEquals(mistake(settings), told)
      assertEquals(PlanSettings.parse(settings.text), None, told)

  test("plans: a text with an unknown or missing value is not a settings text"):
    val text = PlanSettings(slices = 7, separationM = 2.5).text
    assertEquals(PlanSettings.parse(text), Some(PlanSettings(slices = 7, separationM = 2.5)))
    for value <- text.split(' ') do assertEquals(PlanSettings.parse(text.replace(value, "x=1")), None, value)

  test("plans: the horizon is in seconds, and the fence is around the origin"):
    val settings = PlanSettings(horizonSteps = 20, step = ms(50), geofenceM = 30)
    assertEquals((settings.planner.steps, settings.planner.dtS), (20, 0.05))
    assertEquals(settings.geofences, Vector(Geofence(Fence.rectangle(-30, 30, -30, 30))))
    assertEquals(PlanSettings().geofences, Vector.empty)
