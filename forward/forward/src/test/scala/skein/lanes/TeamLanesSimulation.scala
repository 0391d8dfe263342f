package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.*
import skein.identify.Tilting
import skein.lanes.policy.{TeamLanes, VehicleNumbers}
import skein.lanes.score.{Judged, OfMoment}
import skein.lanes.timetable.{Timetable, TimetableAgents, TimetableKernel, TimetableScores}
import skein.optimise.LatencyBudget
import skein.policy.*
import skein.scenario.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom
import skein.testing.{Lengthy, Optimised}
import skein.units.OwnFailure
import skein.vehicle.ReducedModel

class TeamLanesSimulation extends munit.FunSuite, Lengthy, Optimised:
  private val worlds = TimetableKernel.WORLDS
  private val lag    = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val links  = Seq[(String, Delays)]("none" -> DelayTable.none, "vpn" -> DelayTable.vpn)

  private val loops = TestLoops.unpredicted :+ LoopTiming.Predictive(predictor = lag.predictor)

  private def within(random: SplitMix64, least: Double, most: Double) =
    least + (most - least) * random.nextDouble()

  private val scenarios: Seq[(String, SplitMix64 => Scenario)] = Seq(
    "surround" -> (random =>
      Surround(6, ringM = within(random, 5, 12), pursuerMps = within(random, 6, 12))
    ),
    "formation" -> (random =>
      Formation(spacingM = within(random, 3, 6), leaderMps = within(random, 3, 6))
    ),
    "crossing" -> (random =>
      // They meet after 2 s.
      Crossing(4, entryM = 15, laneM = within(random, 1, 4), marginM = within(random, 0.5, 2))
    )
  )

  /** The engagement of a scenario without symmetries, in which rounding would decide which of two equally
    * near pursuers is the nearest.
    */
  private def engagement(scenario: Scenario, durationS: Double) =
    val all = Engagement.of(scenario.fleet, durationS)
    all.copy(agents =
      all.agents.zipWithIndex.map((agent, i) => agent.copy(startY = agent.startY + 0.3 * i * i))
    )

  /** Positions of all vehicles at every score, by world. */
  private final class PlacesByWorld(count: Int) extends TimetableScores:
    val places: ArrayBuffer[Array[(Double, Double)]] = ArrayBuffer.empty
    def start(worlds: Int): Unit                     = places.clear()
    def score(
        all: Array[TimetableAgents],
        views: Array[Int],
        view: Int,
        timeS: Float
    ): Unit =
      for vehicle <- 0 until count do
        val from = views(view + vehicle) * worlds
        places += Array.tabulate(worlds): world =>
          (
            all(vehicle).vehicles.seen(0)(from + world).toDouble,
            all(vehicle).vehicles.seen(1)(from + world).toDouble
          )

  private def scalar(of: Engagement, timing: LoopTiming, link: Delays, model: VelocityResponse, key: Int) =
    val places = ArrayBuffer.empty[(Double, Double)]
    val noting = new LoopObserver:
      override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
        places += ((x, y))
    Rollout(of, timing, link, model).fly(key, observer = noting): Unit
    places

  for
    (name, draw)   <- scenarios
    timing         <- loops
    (linked, link) <- links
  do
    test(s"$name, $timing over $linked: every world agrees with the scalar reference, 6 s to 2 mm"):
      agree(draw, timing, link, lag, 2e-3, 6)

  private val manyMoves = Steering(mostOutstanding = 6)

  private val loopsOfManyMoves = Seq(
    LoopTiming.Futures(steering = manyMoves),
    LoopTiming.Stream(steering = manyMoves),
    LoopTiming.Predictive(predictor = lag.predictor, steering = manyMoves)
  )

  for (name, draw) <- scenarios; timing <- loopsOfManyMoves do
    test(s"$name, $timing over vpn: every world agrees with the scalar reference, 6 s to 2 mm"):
      agree(draw, timing, DelayTable.vpn, lag, 2e-3, 6)

  for
    (name, draw)   <- scenarios
    (model, plant) <- Seq(
      "drag"          -> PlantResponse(ReducedModel.AirSim),
      "drag and turn" -> PlantResponse(ReducedModel(0.95, 0.9, 0.04, 0.5, 0.02)),
      "quadrotor"     -> VelocityResponses.quadrotor()
    )
  do
    test(s"$name, $model, stream over vpn: every world agrees with the scalar reference, 3 s to 4 mm"):
      agree(draw, LoopTiming.Stream(), DelayTable.vpn, plant, 4e-3, 3, 50)

  for (name, draw) <- scenarios do
    test(
      s"$name, predictive by a plant that tilts: every world agrees with the scalar reference, 3 s to 4 mm"
    ):
      val tilting = PlantResponse(Tilting(0.95, 0.9, 0.2))
      agree(draw, LoopTiming.Predictive(predictor = tilting.predictor), DelayTable.vpn, tilting, 4e-3, 3, 50)

  private def agree(
      draw: SplitMix64 => Scenario,
      timing: LoopTiming,
      link: Delays,
      plant: VelocityResponse,
      mostM: Double,
      durationS: Double,
      every: Int = 13
  ): Unit =
    val random = SplitMix64(7)
    val all    = Vector.fill(worlds)(engagement(draw(random), durationS))
    val key    = WorldRandom.key(3, 1, 0)
    val lanes  = TeamLanes
      .of(all.head.agents.map(_.policy), all.head.assignment, isPredicted = false)
      .fold(throw _, identity)
    val count  = lanes.count
    val models = Vector.fill(count)(LaneDynamics.under(timing, plant).fold(fail(_), identity))
    val team   = TeamViews(lanes)
    val agents = TeamAgents.of(all.head.agents, models, team)
    val places = PlacesByWorld(count)
    for (each, world) <- all.zipWithIndex do
      for (agent, self) <- agents.zipWithIndex do
        val own = each.agents(self)
        agent.take(world, VehicleNumbers(own, lanes.numbersOf(self, own.policy)))
    TimetableKernel(agents.map(identity[TimetableAgents]), places)
      .fly(Timetable.of(models, durationS, timing, link, key), worlds)
    for world <- 0 until worlds by every do
      val truth = scalar(all(world), timing, link, plant, key)
      assertEquals(truth.size, places.places.size)
      val off = truth.indices.map: i =>
        val (x, y) = places.places(i)(world)
        math.hypot(x - truth(i)._1, y - truth(i)._2)
      assert(off.max < mostM, s"world $world: ${off.max} m at score ${off.indices.maxBy(off) / count}")

  for
    (name, draw)   <- scenarios
    timing         <- loops
    (linked, link) <-
      links ++ Seq(
        "110 ms and 60 ms of jitter" -> wild(110, 60),
        "150 ms of jitter"           -> wild(150, 150),
        "a link that changes"        -> AlternatingDelays(wild(150, 150), DelayTable.direct, 1.0, 0.5)
      )
  do
    test(
      s"$name, $timing, own delays over $linked: every world agrees with the scalar reference, 6 s to 2 mm"
    ):
      // Vehicles that avoid one another amplify rounding: over links that jitter, up to three flights of 168 end 2 to
      // 14 mm off, other ones with each way to compute a lag.
      agreeAlone(draw, timing, link, lag, 2e-3, 6, farthestM = if name == "crossing" then 2e-2 else 2e-3)

  for (name, draw) <- scenarios; timing <- loopsOfManyMoves do
    test(s"$name, $timing, own delays over vpn: every world agrees with the scalar reference, 6 s to 2 mm"):
      agreeAlone(
        draw,
        timing,
        DelayTable.vpn,
        lag,
        2e-3,
        6,
        farthestM = if name == "crossing" then 2e-2 else 2e-3
      )

  for
    (name, draw)   <- scenarios
    (model, plant) <- Seq(
      "drag"    -> PlantResponse(ReducedModel.AirSim),
      "bicycle" -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4)),
      "skating" -> PlantResponse(Skating(0.4, 1.5))
    )
    timing <-
      Seq(LoopTiming.Stream(), LoopTiming.Futures(), LoopTiming.Predictive(predictor = plant.predictor))
  do
    test(
      s"$name, $model, $timing, own delays over vpn: all worlds agree with the scalar reference, 3 s to 4 mm"
    ):
      agreeAlone(draw, timing, DelayTable.vpn, plant, 4e-3, 3)

  test("the result of a world with separate delays depends on no other world, whatever ran before"):
    val team  = TeamCandidate(engagement(Surround(4), 5), Vector(Judged(OffRing(8), Reduction.Rms, 0)))
    val links = Vector(DelayTable.direct, DelayTable.vpn, wild(110, 60))
    def all(from: Int, count: Int) = new TeamWorlds:
      def size: Int                            = count
      def key(world: Int): Int                 = WorldRandom.key(3, 1, from + world)
      def link(world: Int): Delays             = links((from + world) / 150)
      def candidate(world: Int): TeamCandidate = team
    val batch               = TeamBatch(LoopTiming.Stream(), lag, threads = 2)
    def fly(of: TeamWorlds) = batch.fly(of).values(0).toSeq
    val together            = fly(all(0, 450))
    assertEquals(fly(all(0, 450)), together)
    assertEquals(Seq(0, 150, 300).flatMap(from => fly(all(from, 150))), together)
    assert(together.grouped(150).map(_.sum).toSeq.distinct.size == 3, "links differ")

  for timing <-
      Seq(LoopTiming.Futures(), LoopTiming.Predictive(predictor = VelocityResponses.quadrotor().predictor))
  do
    test(s"quadrotors, $timing, own delays over vpn: all agree with the scalar reference, 2 s to 4 mm"):
      val draw = scenarios(0)._2
      agreeAlone(draw, timing, DelayTable.vpn, VelocityResponses.quadrotor(), 4e-3, 2)

  for timing <- Seq(LoopTiming.Sequential(), LoopTiming.Futures()) do
    test(s"fifteen vehicles, $timing, own delays over vpn: all agree with the scalar reference, 6 s to 2 mm"):
      agreeAlone(random => Surround(15, within(random, 6, 12)), timing, DelayTable.vpn, lag, 2e-3, 6)

  private def wild(meanMs: Double, jitterMs: Double) = DelayTable.of(LatencyBudget.link(meanMs, jitterMs).get)

  private def agreeAlone(
      draw: SplitMix64 => Scenario,
      timing: LoopTiming,
      over: Delays,
      plant: VelocityResponse,
      mostM: Double,
      durationS: Double,
      farthestM: Double = 0
  ): Unit =
    val random = SplitMix64(7)
    val all    = new TeamWorlds:
      // More than are simulated together, but less than twice as many; every fifth has no delays.
      private val teams = Vector.fill(worlds + 40):
        val team   = engagement(draw(random), durationS)
        val judged =
          for
            vehicle   <- team.agents.indices.toVector
            along     <- Seq(North(vehicle), East(vehicle))
            reduction <- Seq(OfMoment.Newest, Reduction.Mean)
          yield Judged(along, reduction, 0)
        TeamCandidate(team, judged)
      def size: Int                            = teams.size
      def key(world: Int): Int                 = WorldRandom.key(3, 1, world)
      def link(world: Int): Delays             = if world % 5 == 4 then DelayTable.none else over
      def candidate(world: Int): TeamCandidate = teams(world)
    val batch  = TeamBatch(timing, plant, threads = 2)
    val engine = batch.engine(all.candidate(0), shareEpisodes = false, Seq(over)).text
    assert(engine.startsWith("SIMD"), engine)
    val flown  = batch.fly(all)
    val scalar = ScalarTeam(timing, plant)
    val offs   =
      for world <- 0 until all.size by 13 yield
        val truth = scalar.fly(all.candidate(world), all.link(world), all.key(world))
        val off   = truth.indices.map(number => (flown.values(number)(world) - truth(number)).abs)
        (off.max, s"world $world: ${off.max} m, judged ${off.indices.maxBy(off)}")
    val (farthest, others) = (offs.max, offs.sorted.init)
    for (off, told) <- others do assert(off < mostM, told)
    assert(farthest._1 < farthestM.max(mostM), farthest._2)

  private val quantities: Seq[(String, SplitMix64 => Scenario, Int => Vector[Quantity])] =
    val circuit = Racetrack(50, 20)
    Seq(
      ("surround", scenarios(0)._2, i => Vector(OffRing(7 + 0.01 * i), WidestGap, Separation, Spread)),
      (
        "formation",
        scenarios(1)._2,
        i =>
          Vector(
            OffSlots(circuit, IArray(-4, -4, -8, -8), IArray(4, -4, 8, -8 + 0.01 * i)),
            Separation
          )
      )
    )

  import Reduction.*
  for
    (name, draw, judging) <- quantities
    reduction             <- Seq(Mean, Rms, Sd, Least, Most, OfMoment.Newest)
  do
    test(s"$name, $reduction: candidates agree with the scalar reference, within a relative 1e-3"):
      val random     = SplitMix64(9)
      val candidates = Vector.tabulate(150): i =>
        TeamCandidate(engagement(draw(random), 10), judging(i).map(Judged(_, reduction, 2)))
      val all = new TeamWorlds:
        def size: Int                            = 2 * candidates.size
        override def shareEpisodes: Boolean      = true
        def key(world: Int): Int                 = WorldRandom.key(5, 0, world % 2)
        def link(world: Int): Delays             = DelayTable.vpn
        def candidate(world: Int): TeamCandidate = candidates(world / 2)
      val batch = TeamBatch(LoopTiming.Stream(), lag, 2)
      assertFliesByLanes(batch, candidates.head)
      val outcomes = batch.fly(all)
      assertEquals(outcomes.flown, all.size)
      val scalar = ScalarTeam(LoopTiming.Stream(), lag)
      for world <- 0 until all.size by 23 do
        val truth = scalar.fly(all.candidate(world), DelayTable.vpn, all.key(world))
        for (value, number) <- truth.zipWithIndex do
          assertEqualsDouble(
            outcomes.values(number)(world),
            value,
            1e-3 * value.abs.max(1),
            s"world $world, $number"
          )

  test(
    "scores from different start times have the results that they have alone and by the scalar engine"
  ):
    val random = SplitMix64(9)
    val judged = Vector(
      Judged(Separation, Reduction.Least, 0),
      Judged(Separation, Reduction.Sd, 4),
      Judged(OffRing(7), OfMoment.FirstWithin(1.5), 2),
      Judged(OffRing(7), OfMoment.FirstWithin(0), 2),
      Judged(WidestGap, OfMoment.Newest, 6),
      Judged(WidestGap, Reduction.Most, 11)
    )
    val teams                                  = Vector.fill(40)(engagement(scenarios(0)._2(random), 10))
    val batch                                  = TeamBatch(LoopTiming.Stream(), lag, 1)
    def fly(by: Vector[Judged]): Seq[Seq[Int]] =
      val candidates = teams.map(TeamCandidate(_, by))
      val all        = new TeamWorlds:
        def size: Int                            = candidates.size
        override def shareEpisodes: Boolean      = true
        def key(world: Int): Int                 = 4
        def link(world: Int): Delays             = DelayTable.vpn
        def candidate(world: Int): TeamCandidate = candidates(world)
      assertFliesByLanes(batch, candidates.head)
      batch.fly(all).values.map(_.toSeq.map(java.lang.Float.floatToIntBits))
    val together = fly(judged)
    assertEquals(together, judged.flatMap(each => fly(Vector(each))))
    val scalar = ScalarTeam(LoopTiming.Stream(), lag)
    for (team, world) <- teams.zipWithIndex do
      val truth = scalar.fly(TeamCandidate(team, judged), DelayTable.vpn, 4)
      for number <- Seq(2, 3, 5) do
        val bits = java.lang.Float.floatToIntBits(truth(number).toFloat)
        assertEquals(together(number)(world), bits, s"world $world, $number")
    val found = together(2).count(java.lang.Float.intBitsToFloat(_).isFinite)
    assert(found > 0 && found < teams.size, s"$found of ${teams.size} are ever within the limit")

  private def avoiding(scenario: Crossing, durationS: Double) =
    TeamCandidate(Engagement.of(scenario.fleet, durationS), Vector(Judged(Separation, Reduction.Least, 0)))

  test("twenty vehicles, more than there are rounds, avoid one another with SIMD as by the scalar reference"):
    val crossing = avoiding(Crossing(20, entryM = 8, spacingM = 4), 1.5)
    val batch    = TeamBatch(LoopTiming.Stream(), lag, 1)
    val engine   = batch.engine(crossing, shareEpisodes = true, Seq(DelayTable.vpn)).text
    assert(engine.startsWith("SIMD"), engine)
    val one = new TeamWorlds:
      def size: Int                            = 1
      override def shareEpisodes: Boolean      = true
      def key(world: Int): Int                 = 4
      def link(world: Int): Delays             = DelayTable.direct
      def candidate(world: Int): TeamCandidate = crossing
    val scalar = ScalarTeam(LoopTiming.Stream(), lag).fly(crossing, DelayTable.direct, 4)(0)
    assertEqualsDouble(batch.fly(one).values(0)(0), scalar, 2e-3)

  test("a team that SIMD does not support uses the scalar reference, and the reason is given"):
    val surround = Engagement.of(Surround(4).fleet, 5)
    val team     = surround.copy(agents = surround.agents.map(_.copy(policy = Zigzag)))
    val crossing = TeamCandidate(team, Vector(Judged(Separation, Reduction.Least, 0)))
    val batch    = TeamBatch(LoopTiming.Stream(), lag, 1)
    val engine   = batch.engine(crossing, shareEpisodes = true, Seq(DelayTable.vpn)).text
    assert(engine.startsWith("scalar: a policy is no formula: skein.lanes.Zigzag"), engine)
    val one = new TeamWorlds:
      def size: Int                            = 1
      override def shareEpisodes: Boolean      = true
      def key(world: Int): Int                 = 4
      def link(world: Int): Delays             = DelayTable.vpn
      def candidate(world: Int): TeamCandidate = crossing
    assertEquals(
      batch.fly(one).values(0)(0),
      ScalarTeam(LoopTiming.Stream(), lag).fly(crossing, DelayTable.vpn, 4)(0).toFloat
    )

  test("an exception in a user's own quantity is reported with the quantity's name"):
    val broken =
      TeamCandidate(Engagement.of(Surround(4).fleet, 5), Vector(Judged(Broken, Reduction.Least, 0)))
    val told = intercept[OwnFailure](ScalarTeam(LoopTiming.Stream(), lag).fly(broken, DelayTable.vpn, 4))
    assert(clue(told.getMessage).startsWith("the quantity Broken failed: java.lang.IllegalStateException"))

  private def assertFliesByLanes(batch: TeamBatch, team: TeamCandidate): Unit =
    val engine = batch.engine(team, shareEpisodes = true, Seq(DelayTable.vpn)).text
    assert(batch.engine(team, shareEpisodes = true, Seq(DelayTable.vpn)).isFast, engine)

/** A policy whose frequency of turns depends on its observation. */
object Zigzag extends Policy:
  type Memory = Unit
  def start: Unit                                             = ()
  override def isPlanar: Boolean                              = true
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    var turns = 0
    var north = seen.northM(seen.self)
    while north > 1 do
      north /= 2
      turns += 1
    (seen.along(turns * 0.5, 3), ())

final case class North(vehicle: Int) extends Quantity:
  def of(places: Positions): Double = places.northM(vehicle)

final case class East(vehicle: Int) extends Quantity:
  def of(places: Positions): Double = places.eastM(vehicle)

// Equal to the code in docs/guides/search.md.
/** Mean distance of the vehicles from their middle, m. */
case object Spread extends Quantity:
  def of(places: Positions): Double =
    val (north, east) = (mean(places.northM), mean(places.eastM))
    var sum           = 0.0
    for vehicle <- 0 until places.count do sum += places.distanceM(vehicle, north, east)
    sum / places.count

  private def mean(numbers: IArray[Double]): Double =
    var sum = 0.0
    for i <- numbers.indices do sum += numbers(i)
    sum / numbers.length

private case object Broken extends Quantity:
  def of(positions: Positions): Double = throw IllegalStateException("no such luck")
