package skein.environment

import skein.lanes.{LearnerWorlds, Tower}
import skein.policy.{Agent, Role}
import skein.scenario.{Known, PaperDuel, Scenario, ScenarioKind, Scenarios, Surround}
import skein.signal.SplitMix64
import skein.vehicle.VehicleKind

class LearnerWorldsSuite extends munit.FunSuite:
  private given Scenarios =
    Scenarios(
      Scenarios.ours.kinds :+ ScenarioKind(Tower()) :+ ScenarioKind(Meeting()) :+ ScenarioKind(CarChase())
    )

  private val all = EnvironmentSettings(startWithinM = (2, 8), episodeS = 6)

  /** Each learner's observations at its decisions, and the sums of the scores, until the last score. */
  private def flown(
      side: LearnerSide,
      learning: Vector[Int],
      worlds: LearnerWorlds,
      draw: Long = SplitMix64.seedOf(3, 0)
  ) =
    val space          = side.settings.space
    val (starts, seen) = (Starts(side), Array.ofDim[Float](space.inputs * LearnerWorlds.Most))
    val observed       = Array.fill(learning.size)(Vector.newBuilder[Vector[Float]])
    val judged         = side.team(learning, None).judged.indices
    val decisions      = Array.ofDim[Int](learning.size)
    starts.draw(5)
    worlds.start(draw, 6)
    for vehicle <- side.names.indices do
      import starts.{eastM, headingRad, northM}
      worlds.restart(0, vehicle, northM(vehicle), eastM(vehicle), headingRad(vehicle))
    var goesOn = worlds.flyOn()
    while goesOn && !worlds.hasEnded(0) do
      for learner <- learning.indices if worlds.isDue(learner) do
        worlds.observe(learner, seen)
        observed(learner) += Vector.tabulate(space.inputs)(field => seen(field * LearnerWorlds.Most))
        decisions(learner) += 1
        for component <- 0 until space.outputs do
          val share = math.sin(decisions(learner) * (0.2 + 0.15 * component) + learner)
          worlds.act(learner, component, Array.fill(LearnerWorlds.Most)(share.toFloat))
      worlds.decide()
      goesOn = worlds.flyOn()
    worlds.close()
    (
      observed.map(_.result()).toVector,
      judged.map(number => { worlds.soFar(number, seen); seen(0) }).toVector
    )

  test("each draw has its own errors of readings, also where draws share delays"):
    def seen(sensors: String, draw: Long) =
      val side     = LearnerSide.of(all.copy(sensors = sensors)).fold(fail(_), identity)
      val learning = side.turns.last
      flown(side, learning, LearnerRollout(side, side.team(learning, None), learning), draw)._1
    assertEquals(seen("position=0", 2), seen("position=0", 2 + 256))
    assertEquals(seen("position=1", 2), seen("position=1", 2))
    assertNotEquals(seen("position=1", 2), seen("position=1", 2 + 256))

  test("with SIMD, each world of a run has its own errors of readings"):
    val side     = LearnerSide.of(all.copy(sensors = "position=1", loop = "paused")).fold(fail(_), identity)
    val worlds   = EnvironmentBatch.worlds(side, side.engine(None), side.turns.head, None, 2)
    val observed = Array.ofDim[Float](side.settings.space.inputs * LearnerWorlds.Most)
    worlds.start(7, 6)
    for world <- 0 until 2; vehicle <- side.names.indices do
      worlds.restart(world, vehicle, 9f * vehicle, 0, 0)
    assert(worlds.flyOn())
    worlds.observe(0, observed)
    assertNotEquals(observed(0), observed(1))

  private val noisy = all.copy(sensors = "position=0.3,velocity=0.1,drift=1/20s,dropout=3%,outage=0.3s/4s")

  for
    (settings, toleranceM) <- Seq(
      all                                                                                         -> 2e-3,
      all.copy(learners = "both", loop = "sequential")                                            -> 2e-3,
      all.copy(scenario = "surround", learners = "pursuers")                                      -> 2e-3,
      all.copy(scenario = "surround", learners = "all", loop = "paused")                          -> 2e-3,
      all.copy(scenario = "surround", learners = "evader", loop = "predictive", link = "direct")  -> 2e-3,
      all.copy(scenario = "surround", learners = "Pursuer2", plant = "quadrotor", altitudeM = 20) -> 2e-2,
      all.copy(scenario = "surround", learners = "Pursuer1,Evader", objective = "off-ring")       -> 2e-2,
      all.copy(scenario = "surround", learners = "Pursuer1,Evader", objective = "gap")            -> 2e-2,
      all.copy(scenario = "formation", learners = "follower")                                     -> 2e-3,
      all.copy(scenario = "crossing", learners = "all")                                           -> 2e-3,
      all.copy(scenario = "meeting", learners = "all")                                            -> 2e-3,
      all.copy(scenario = "meeting", learners = "pursuers", loop = "futures")                     -> 2e-3,
      all.copy(scenario = "tower", learners = "keeper", objective = "kept")                       -> 2e-2,
      all.copy(scenario = "tower", learners = "inspectors", objective = "kept", plant = "tilt")   -> 2e-2,
      all.copy(climbMps = 2)                                                                      -> 5e-3,
      noisy                                                                                       -> 2e-3,
      noisy.copy(learners = "both", loop = "sequential")                                          -> 2e-3,
      noisy.copy(learners = "both", loop = "predictive", climbMps = 2)                            -> 5e-3,
      noisy.copy(scenario = "surround", learners = "all", loop = "paused")                        -> 2e-3,
      noisy.copy(scenario = "meeting", learners = "pursuers", loop = "futures")                   -> 2e-3,
      noisy.copy(scenario = "car-chase")                                                          -> 2e-3,
      all.copy(climbMps = 2, learners = "both", loop = "predictive")                              -> 5e-3,
      all.copy(scenario = "surround", learners = "all", climbMps = 3, loop = "paused")            -> 5e-3,
      all.copy(scenario = "tower", learners = "keeper", climbMps = 1, loop = "futures")           -> 5e-3,
      all.copy(scenario = "convoy", learners = "escorts", climbMps = 1)                           -> 5e-3,
      all.copy(scenario = "car-chase")                                                            -> 2e-3,
      all.copy(scenario = "car-chase", loop = "predictive", plant = "tilt")                       -> 2e-3,
      all.copy(scenario = "convoy", learners = "escorts", objective = "between-cars")             -> 2e-3,
      all.copy(scenario = "convoy", learners = "escort", loop = "predictive")                     -> 2e-3,
      all.copy(scenario = "convoy", learners = "Escort2", loop = "futures", plant = "tilt")       -> 2e-3
    )
  do
    test(
      s"${settings.learners} of ${settings.scenario} under ${settings.loop}: SIMD equals the scalar engine"
    ):
      val side   = LearnerSide.of(settings).fold(fail(_), identity)
      val engine = side.engine(None)
      assert(engine.fliesByLanes, engine.text)
      val learning         = side.turns.last
      val (seen, sums)     = flown(side, learning, EnvironmentBatch.worlds(side, engine, learning, None, 3))
      val (truth, scalars) = flown(side, learning, LearnerRollout(side, side.team(learning, None), learning))
      assertEquals(seen.map(_.size), truth.map(_.size))
      assert(seen.forall(_.sizeIs > 15), seen.map(_.size))
      for (ours, theirs) <- seen.zip(truth); (one, other) <- ours.zip(theirs); (x, y) <- one.zip(other) do
        assertEqualsDouble(
          x,
          y,
          toleranceM,
          s"decision ${ours.indexOf(one)} of ${ours.size}: $one, scalar $other"
        )
      for (one, other) <- sums.zip(scalars) do assertEqualsDouble(one, other, toleranceM * 60)

  for settings <- Seq(
      all.copy(scenario = "surround", learners = "all", loop = "paused", link = "none", plant = "tilt"),
      all.copy(learners = "both", loop = "paused", link = "none", climbMps = 2),
      all.copy(scenario = "car-chase", loop = "paused", link = "none")
    )
  do
    test(
      s"${settings.scenario}, climbing by ${settings.climbMps} m/s: a restart alone forgets what was before"
    ):
      val side     = LearnerSide.of(settings).fold(fail(_), identity)
      val space    = settings.space
      val learning = side.turns.head
      val worlds   = EnvironmentBatch.worlds(side, side.engine(None), learning, None, 4)
      val seen     = Array.ofDim[Float](space.inputs * LearnerWorlds.Most)
      def begin(world: Int, headingRad: Float): Unit =
        for vehicle <- side.names.indices do worlds.restart(world, vehicle, 10f * vehicle, 3, headingRad)
      def look(world: Int) = Vector.tabulate(learning.size): learner =>
        worlds.observe(learner, seen)
        // The age of the first decision's time differs.
        (0 until space.inputs).filterNot(6 to 8 contains _).map(at => seen(at * LearnerWorlds.Most + world))
      def fly(decisions: Int)(share: Int => Float): Unit = for _ <- 0 until decisions do
        for learner <- learning.indices; component <- 0 until space.outputs do
          worlds.act(learner, component, Array.tabulate(LearnerWorlds.Most)(share))
        worlds.decide()
        assert(worlds.flyOn())
      // World 2 restarts along one heading, wherever it began.
      val after = Seq(2.5f, 0.5f).map: headingRad =>
        worlds.start(1, 6)
        for world <- 0 until 4 do begin(world, headingRad)
        assert(worlds.flyOn())
        val first = look(2)
        fly(20)(0.3f * _)
        val before = look(1)
        assertNotEquals(look(2), first)
        begin(2, 2.5f)
        val again = look(2)
        assertEquals(again == first, headingRad == 2.5f)
        assertEquals(look(1), before)
        begin(3, 2.5f)
        fly(20)(_ => 0.2f)
        assertEquals(look(2), look(3))
        assertNotEquals(look(2), look(1))
        (again, look(2))
      assertEquals(after(1), after(0))

/** Ends after some three seconds: the older the readings, the earlier. */
final case class Meeting() extends Scenario:
  def agents: Vector[Agent]                  = Surround(vehicles = 3).agents
  override def isOver(known: Known): Boolean =
    known.elapsed.toSeconds + 2 * known.vehicles(
      1
    ).age.toSeconds > 3.2 && known.vehicles.head.age.toSeconds > 0.01

/** A drone chases a car. */
final case class CarChase() extends Scenario:
  def agents: Vector[Agent] = PaperDuel().agents.map: agent =>
    if agent.role == Role.Evader then
      agent.copy(kind = VehicleKind.Car, startPositionNed = agent.startPositionNed.copy(z = 0))
    else agent
