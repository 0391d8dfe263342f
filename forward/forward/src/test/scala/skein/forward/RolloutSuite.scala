package skein.forward

import scala.collection.mutable.ArrayBuffer
import skein.policy.{Action, HeadingPolicy, PaperEvader, PaperPursuer, PlanarObservation}
import skein.signal.LatencyDistribution
import skein.simd.WorldRandom
import skein.units.*
import skein.vehicle.{PlaneReading, Plant}

class RolloutSuite extends munit.FunSuite:
  private val loops =
    Seq(LoopTiming.Paused(), LoopTiming.Sequential(), LoopTiming.Futures(), LoopTiming.Stream())
  private val towards: HeadingPolicy.Memoryless  = seen => math.atan2(seen.dyM, seen.dxM)
  private val awayFrom: HeadingPolicy.Memoryless = seen => math.atan2(-seen.dyM, -seen.dxM)
  private val lag: VelocityResponse = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)

  private def trajectory(rollout: Rollout, key: Int): Vector[(Double, Double, Double, Double)] =
    val points = ArrayBuffer.empty[(Double, Double, Double, Double)]
    rollout.fly(key, observer = PaperPath((_, ex, ey, px, py) => points += ((ex, ey, px, py))))
    points.toVector

  private def distances(rollout: Rollout, key: Int): Vector[Double] =
    trajectory(rollout, key).map((ex, ey, px, py) => math.hypot(ex - px, ey - py))

  private def assertClose(actual: Seq[Double], expected: Seq[Double], tolerance: Double): Unit =
    assertEquals(actual.size, expected.size)
    for (a, e) <- actual.zip(expected) do assertEqualsDouble(a, e, tolerance)

  for model <- Seq(VelocityResponses.quadrotor(), lag, VelocityResponses.Ideal); loop <- loops do
    test(s"without delays, $loop flies as paused does, with ${model.getClass.getSimpleName}"):
      val truth =
        distances(Rollout(Pair.paper.engagement, LoopTiming.Paused(), DelayTable.none, model), 1)
      assertClose(
        distances(Rollout(Pair.paper.engagement, loop, DelayTable.none, model), 1),
        truth,
        1e-6
      )

  test("an exception in a policy or a plant is reported with its class and line"):
    final class Lost extends HeadingPolicy.Memoryless:
      def heading(seen: PlanarObservation): Double = throw Exception("no way")
    final class Stuck extends Plant[PlaneReading]:
      def initial: PlaneReading                   = PlaneReading(0, 0, 0, 0)
      def stepS: Double                           = 0.1
      def read(state: PlaneReading): PlaneReading = state
      def step(state: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
        throw Exception("no way")
    def told(duel: Pair, plant: VelocityResponse) =
      intercept[OwnFailure](ScoredRollout(
        duel.engagement,
        LoopTiming.Stream(),
        DelayTable.vpn,
        plant
      ).fly(1)).getMessage
    val ofPolicy = told(Pair.paper.copy(pursuer = Pair.paper.pursuer.copy(policy = Lost())), lag)
    val ofPlant  = told(Pair.paper, PlantResponse(Stuck()))
    for (text, whose) <- Seq(ofPolicy -> "policy Lost", ofPlant -> "plant Stuck") do
      assert(clue(text).startsWith(s"the $whose"))
      assert(clue(text).matches(".* failed: java.lang.Exception: no way \\(RolloutSuite.scala:\\d+\\)"))

  for loop <- loops do
    test(s"under $loop the result of a world depends only on its key"):
      val rollout = ScoredRollout(Pair.paper.engagement, loop, DelayTable.vpn, lag)
      val alone   = rollout.fly(WorldRandom.key(7, 3, 11))
      for episode <- 0 until 5 do rollout.fly(WorldRandom.key(7, 3, episode))
      assertEquals(rollout.fly(WorldRandom.key(7, 3, 11)), alone)

    test(s"under $loop a rotation and a shift of the world change no distance"):
      // Off the axis, since straight ahead the pursuer's turn hangs on the sign of a rounding error.
      val offset                = Pair.paper.copy(evader = Pair.paper.evader.copy(startY = 2))
      val angle                 = 0.7
      val (cos, sin)            = (math.cos(angle), math.sin(angle))
      def turn(d: RolloutAgent) = d.copy(
        startX = 100 + d.startX * cos - d.startY * sin,
        startY = -50 + d.startX * sin + d.startY * cos,
        startHeadingRad = d.startHeadingRad + angle
      )
      val turned = Pair(turn(offset.pursuer), turn(offset.evader))
      val key    = WorldRandom.key(1, 2, 3)
      val plain  = distances(Rollout(offset.engagement, loop, DelayTable.direct, lag), key)
      assertClose(distances(Rollout(turned.engagement, loop, DelayTable.direct, lag), key), plain, 1e-6)

  test("with symmetric policies, the mirrored duel has the mirrored flight"):
    val evader: HeadingPolicy.Memoryless =
      seen => 0.7 * math.atan2(-seen.dyM, -seen.dxM) + 0.3 * math.sin(seen.ownHeadingRad)
    val key               = WorldRandom.key(5, 0, 0)
    def fly(side: Double) =
      val duel = Pair(
        Pair.paper.pursuer.copy(policy = PaperPursuer(), startY = 3 * side),
        Pair.paper.evader.copy(policy = evader, startHeadingRad = 0.4 * side),
        durationS = 20
      )
      trajectory(Rollout(duel.engagement, LoopTiming.Stream(), DelayTable.vpn, lag), key)
    for ((ex, ey, px, py), (mx, my, qx, qy)) <- fly(1).zip(fly(-1)) do
      assertClose(Seq(mx, -my, qx, -qy), Seq(ex, ey, px, py), 1e-6)

  test("a straight chase ends after (d − l) / (vP − vE)"):
    val duel  = Pair(Pair.paper.pursuer.copy(policy = towards), Pair.paper.evader.copy(policy = awayFrom))
    val flown =
      ScoredRollout(duel.engagement, LoopTiming.Paused(0.01), DelayTable.none, VelocityResponses.Ideal).fly(
        0,
        captureRadiusM = 2
      )
    assertEqualsDouble(flown.captureS, (21.0 - 2.0) / (10.0 - 5.0), 0.0101)

  test("the paper's game, paused, settles at the distance of AirSim's own flight code, 8.31 m ± 3 %"):
    val flown =
      ScoredRollout(
        Pair.paper.engagement,
        LoopTiming.Paused(),
        DelayTable.none,
        VelocityResponses.quadrotor()
      ).fly(0)
    assertEqualsDouble(flown.meanLast10sM, 8.31, 0.03 * 8.31)
    assertEqualsDouble(flown.minDistanceM, 3.7, 0.3)
    assertEqualsDouble(flown.minDistanceAtS, 6.0, 0.2)

  for
    (loop, link, name, least, most) <- Seq(
      (LoopTiming.Futures(), DelayTable.direct, "direct", 8.8, 9.7),
      (LoopTiming.Stream(), DelayTable.direct, "direct", 8.9, 9.6),
      (LoopTiming.Futures(), DelayTable.vpn, "vpn", 9.9, 11.0),
      (LoopTiming.Stream(), DelayTable.vpn, "vpn", 9.9, 11.0)
    )
  do
    test(s"$loop over $name settles, like the reference flights, between $least and $most m"):
      val rollout = ScoredRollout(Pair.paper.engagement, loop, link, VelocityResponses.quadrotor())
      for episode <- 0 until 4 do
        val settled = rollout.fly(WorldRandom.key(1, 0, episode)).meanLast10sM
        assert(settled > least && settled < most, s"episode $episode: $settled m")

  test(
    "sequential reads one vehicle after the other and then waits, so a step lasts two round trips and a " +
      "period"
  ):
    val link    = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(50)))
    val rollout = ScoredRollout(Pair.paper.engagement, LoopTiming.Sequential(0.1), link, lag)
    assertEqualsDouble(rollout.fly(0).decisions / 2.0, 60 / 0.2, 1.0)

  test("stream skips views if acknowledgements of commands take longer than two periods"):
    val link  = DelayTable.of(LatencyDistribution.Constant(Span.ofMillis(300)))
    val flown = ScoredRollout(Pair.paper.engagement, LoopTiming.Stream(), link, lag).fly(0)
    assert(flown.skipped > 300, flown)
    assertEqualsDouble(flown.decisions + flown.skipped, 1200, 20)

  test("stream has a view at each reading without patience, and one per pair of readings with it"):
    def flown(patienceS: Double) =
      ScoredRollout(
        Pair.paper.engagement,
        LoopTiming.Stream(patienceS = patienceS),
        DelayTable.none,
        lag
      ).fly(0)
    assertEquals((flown(0.1).decisions, flown(0).decisions), (1200, 2398))

  test("after its patience, stream continues without a vehicle that no longer answers"):
    val link: Delays =
      (_, line, step, _, _) => if line == Delays.answer(0, 1) && step > 0 then 1L << 40 else 0L
    val timing = LoopTiming.Stream(patienceS = 0.05)
    // The first view is of the start; in each of the 599 periods after it one waits in vain.
    assertEquals(ScoredRollout(Pair.paper.engagement, timing, link, lag).fly(0).decisions, 1200)

  test("the last ten seconds of a minute contain a hundred distances, those after its fiftieth second"):
    assertEqualsDouble(Rollout.last10sFromS(60, 0.1), 50.1, 1e-9)
    assertEqualsDouble(Rollout.last10sFromS(12, 0.25), 2.25, 1e-9)
    val score = Score(last10sFromS = 50.1)
    for number <- 1 to 600 do score.add(number * 0.1, number)
    assertEqualsDouble(score.outcome.meanLast10sM, 550.5, 1e-9)

  test("64 readings of a vehicle are stored, or as many as a loop may need"):
    assertEquals(RolloutWorld.ringOf(LoopTiming.Stream(), 2), 64)
    // Twice the periods in a time-out, the window of 4, and 2.
    assertEquals(RolloutWorld.ringOf(LoopTiming.Stream(0.01), 2), 106)
    // Of two vehicles, the periods in two time-outs, the window of 4, and 1.
    assertEquals(RolloutWorld.ringOf(LoopTiming.Futures(0.02), 2), 110)
    assertEquals(RolloutWorld.ringOf(LoopTiming.Sequential(0.001), 2), 64)

  test("the reduced model follows its differential equation, with dead time and changing commands"):
    val vehicle = VelocityResponses.lag(gain = 0.8, lagS = 0.5, deadTimeS = 0.12).create()
    vehicle.start(0, 0, 0)
    vehicle.act(Action.VelocityAt(10, 0, Metres(0)))
    vehicle.advance(0.3)
    vehicle.act(Action.VelocityAt(0, 10, Metres(0)))
    vehicle.advance(1.0)
    var x, y, vx, vy = 0.0
    val dt           = 1e-5
    for i <- 0 until 100000 do
      val t        = i * dt
      val (wx, wy) = if t < 0.12 then (0.0, 0.0) else if t < 0.42 then (8.0, 0.0) else (0.0, 8.0)
      x += vx * dt; y += vy * dt
      vx += (wx - vx) / 0.5 * dt; vy += (wy - vy) / 0.5 * dt
    assertClose(Seq(vehicle.x, vehicle.y, vehicle.vx, vehicle.vy), Seq(x, y, vx, vy), 3e-4)

  test("the default duel is that of the scenario"):
    assertEquals(Pair.paper.evader.policy, PaperEvader())
