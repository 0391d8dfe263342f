package skein.environment

import java.nio.{ByteBuffer, ByteOrder}
import skein.forward.{Delays, Engagement, EpisodeOutcome, PlantResponse, ScoredRollout}
import skein.lanes.{LearnerTeams, TeamBatch, TeamCandidate, TeamWorlds}
import skein.lanes.score.Judged
import skein.policy.LearnerSpace
import skein.scenario.{PaperDuel, Reduction, Scenarios, Separation}
import skein.signal.SplitMix64
import skein.vehicle.ReducedModel

class EnvironmentBatchSimulation extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  private val Fields = LearnerSpace.Level.inputs

  /** A batch, with a learner's view of its buffers. */
  private final class Learner(
      settings: EnvironmentSettings,
      count: Int,
      autoreset: Autoreset = Autoreset.NextStep
  ):
    val agents: Int   = if settings.learners == "both" then 2 else 1
    private val block =
      ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(agents, count, settings.space)).order(
        ByteOrder.nativeOrder
      )
    private val fields          = settings.space.inputs
    private val floats          = block.asFloatBuffer
    private val seenAt          = agents * settings.space.outputs * count
    private val finalsAt        = seenAt + agents * fields * count
    private val rewardsAt       = finalsAt + agents * fields * count
    private val endsAt          = 4 * (rewardsAt + 2 * agents * count + count)
    val batch: EnvironmentBatch =
      EnvironmentBatch.of(settings, count, autoreset, block).fold(fail(_), identity)

    def act(number: Int, action: Float, agent: Int = 0): Unit =
      floats.put(agent * count + number, action): Unit
    def seen(number: Int, field: Int, agent: Int = 0): Float =
      floats.get(seenAt + (agent * fields + field) * count + number)
    def last(number: Int, field: Int): Float       = floats.get(finalsAt + field * count + number)
    def reward(number: Int, agent: Int = 0): Float = floats.get(rewardsAt + agent * count + number)
    def distance(number: Int): Float               = floats.get(rewardsAt + agents * count + number)
    def timeS(number: Int): Float                  = floats.get(rewardsAt + 2 * agents * count + number)
    def terminated(number: Int): Boolean           = block.get(endsAt + number) != 0
    def truncated(number: Int): Boolean            = block.get(endsAt + count + number) != 0
    def isDue(agent: Int): Boolean                 = block.get(endsAt + 2 * count + agent * count) != 0
    def reset(seeds: Long*): Unit                  = batch.reset(seeds.toArray)

    /** The paper's pursuer, computed from an observation. */
    def paper(number: Int, agent: Int = 0): Float =
      val (ahead, right) = (seen(number, 0, agent), seen(number, 1, agent))
      if right != 0 then math.signum(right) else if ahead < 0 then 1 else 0

  /** The engine's result for the paper's pursuer over the link of a run. */
  private def engine(settings: EnvironmentSettings, seed: Long): (EpisodeOutcome, Float, Float) =
    val config = LearnerSide.of(settings).fold(fail(_), identity)
    val game   = Engagement.of(PaperDuel(altitudeM = 20).fleet, settings.episodeS)
    val runKey = LearnerTeams.keyOf(SplitMix64.seedOf(seed, 0))
    val judged = Vector(Judged(Separation, Reduction.Least, 0), Judged(Separation, Reduction.Mean, 0))
    val team   = TeamCandidate(game, judged)
    val worlds = new TeamWorlds:
      def size                                 = 1
      override def shareEpisodes               = true
      def key(world: Int): Int                 = runKey
      def link(world: Int): Delays             = config.link
      def candidate(world: Int): TeamCandidate = team
    val flown = TeamBatch(config.timing, PlantResponse(ReducedModel.AirSimLag), 1).fly(worlds)
    (
      ScoredRollout(game, config.timing, config.link, PlantResponse(ReducedModel.AirSimLag)).fly(runKey),
      flown.values(0)(0),
      flown.values(1)(0)
    )

  for (loop, link) <-
      Seq("stream" -> "vpn", "predictive" -> "vpn", "sequential" -> "direct", "paused" -> "none")
  do
    test(s"with the paper's pursuer under $loop over $link a batch equals the engine and the reference"):
      val settings = EnvironmentSettings(loop = loop, link = link, episodeS = 20)
      val learner  = Learner(settings, 2)
      learner.reset(0, 1)
      var (sum, least, steps) = (0.0, Float.PositiveInfinity, 0)
      while !learner.truncated(0) do
        for number <- 0 to 1 do learner.act(number, learner.paper(number))
        learner.batch.step()
        sum += learner.reward(0)
        least = least.min(learner.distance(0))
        steps += 1
        assert(!learner.terminated(0) && steps < 1000)
      val (reference, leastByLanes, meanByLanes) = engine(settings, 0)
      val mean                                   = -sum * EnvironmentSettings.RewardM / 200
      // Sums of 200 floats of up to 25 m, added up in two orders.
      assertEqualsDouble(mean, meanByLanes, 200 * 25 * math.ulp(1f) * 2)
      assertEqualsDouble(mean, reference.meanDistanceM, 0.02)
      assert(least == leastByLanes, s"$least m, by the lanes $leastByLanes m")

  test("rewards do not depend on a start that was discarded before the first step"):
    def paid(discarded: Long) =
      val settings = EnvironmentSettings(startWithinM = (5, 30), link = "constant:300ms", episodeS = 6)
      val learner  = Learner(settings, 2)
      learner.reset(3, discarded)
      learner.batch.reset(Array(-1L, 7L), Array(false, true))
      learner.batch.step()
      (learner.reward(1), learner.distance(1))
    assertEquals(paid(5), paid(6))

  test("a reset shows nothing of the episode before, to learners that are not due either"):
    val settings = EnvironmentSettings(learners = "both", plant = "quadrotor", altitudeM = 3, episodeS = 6)
    val learner  = Learner(settings, 1)
    def begun()  =
      learner.reset(1)
      Vector.tabulate(2, Fields)((agent, field) => learner.seen(0, field, agent))
    val first = begun()
    assert(!learner.isDue(0) || !learner.isDue(1), "all learners are due")
    for _ <- 0 until 20 do learner.batch.step()
    assertEquals(begun(), first)
    learner.batch.close()

  test("equal seeds and actions give equal episodes, to the bit, independent of other groups"):
    def flown(count: Int) =
      val learner =
        Learner(EnvironmentSettings(startWithinM = (3, 9), episodeS = 4, captureRadiusM = 3), count)
      learner.reset((0 until count).map(_ + 7L)*)
      Vector.tabulate(60): step =>
        for number <- 0 until count do learner.act(number, math.sin(step * 0.3 + number).toFloat)
        learner.batch.step()
        Vector.tabulate(8, Fields)((number, field) => learner.seen(number, field)) ->
          Vector.tabulate(8)(number =>
            (learner.reward(number), learner.terminated(number), learner.truncated(number))
          )
    val first = flown(128)
    assertEquals(flown(128), first)
    assertEquals(flown(300), first)
    assert(first.exists(_._2.exists(_._2)), "nobody was captured")

  test("an episode that ends shows the next one's first observation with the next step, or with the same"):
    val settings =
      EnvironmentSettings(startWithinM = (6, 8), episodeS = 10, captureRadiusM = 5, link = "direct")
    for mode <- Seq(Autoreset.NextStep, Autoreset.SameStep) do
      val learner = Learner(settings, 40, mode)
      learner.reset((1 to 40).map(_.toLong)*)
      var (captured, after) = (0, Set.empty[Int])
      for _ <- 0 until 250 do
        for number <- 0 until 40 do learner.act(number, learner.paper(number))
        learner.batch.step()
        for number <- 0 until 40 do
          val begins = math.hypot(learner.seen(number, 0), learner.seen(number, 1))
          val ended  = learner.terminated(number) || learner.truncated(number)
          if after(number) || mode == Autoreset.SameStep && ended then
            assert(begins > 5.5 && begins < 8.1, s"$mode: begins at $begins m")
          if after(number) then assertEqualsFloat(learner.timeS(number), 0, 0.5f)
          if learner.terminated(number) then
            captured += 1
            assert(learner.reward(number) > 5)
            assert(learner.distance(number) < 7, s"$mode: captured at ${learner.distance(number)} m")
            if mode == Autoreset.SameStep then
              assert(math.hypot(learner.last(number, 0), learner.last(number, 1)) < 12)
        after =
          if mode == Autoreset.NextStep then
            (0 until 40).filter(number => learner.terminated(number) || learner.truncated(number)).toSet
          else Set.empty
      assert(captured > 20, s"$mode: $captured captures")

  test(
    "learners climb with the tilt model by SIMD, with the quadrotor one by one, and not with a level model"
  ):
    val settings = EnvironmentSettings(climbMps = 2, link = "none", episodeS = 10)
    for plant <- Seq("tilt", "quadrotor") do
      val learner = Learner(settings.copy(plant = plant), 2)
      assertEquals(learner.batch.engine.fliesByLanes, plant == "tilt", learner.batch.engine.text)
      learner.reset(1, 2)
      for _ <- 0 until 40 do
        for number <- 0 to 1 do learner.act(number, if number == 0 then 1 else -0.5f, agent = 1)
        learner.batch.step()
      for number <- 0 to 1 do
        val upMps = if number == 0 then 2f else -1f
        assertEqualsFloat(learner.seen(number, 12), upMps, 0.1f)
        assertEqualsFloat(learner.seen(number, 9), 20 - learner.seen(number, 11), 0.3f)
      assert(learner.seen(0, 11) > learner.seen(1, 11) + 6)
      learner.batch.close()
    assertEquals(
      LearnerSide.of(settings.copy(plant = "reduced")).left.toOption,
      Some("plant: expected tilt or quadrotor, got reduced: learners climb (climb_mps)")
    )

  test("ages equal the link's delays"):
    def age(link: String) =
      val learner = Learner(EnvironmentSettings(link = link, episodeS = 10), 1)
      learner.reset(3)
      val ages = Vector.fill(80):
        learner.act(0, 0)
        learner.batch.step()
        learner.seen(0, 7)
      ages.sum / ages.size
    assertEqualsFloat(age("none"), 0, 1e-6f)
    assert(age("direct") < 0.06 && age("vpn") > 0.05 && age("constant:400ms") > 0.2)

  test("if both sides learn, at least one learner is due at every step, and both are if nothing takes time"):
    for (loop, link, least) <- Seq(("paused", "none", 40), ("stream", "vpn", 1)) do
      val learner = Learner(EnvironmentSettings(learners = "both", loop = loop, link = link, episodeS = 5), 3)
      learner.reset(1, 2, 3)
      val together = (0 until 40).count(_ => due(learner))
      assert(together >= least, s"$loop: due together $together times of 40")

  private def due(learner: Learner): Boolean =
    val (evader, pursuer) = (learner.isDue(0), learner.isDue(1))
    assert(evader || pursuer)
    for number <- 0 until 3 do
      learner.act(number, 0.1f, agent = 0)
      learner.act(number, learner.paper(number, agent = 1), agent = 1)
    learner.batch.step()
    assertEquals(learner.reward(0, 0), -learner.reward(0, 1))
    evader && pursuer

  test("invalid settings are refused with what was expected, and an action of NaN changes nothing"):
    def refused(settings: EnvironmentSettings) = LearnerSide.of(settings).swap.getOrElse("accepted")
    assert(refused(EnvironmentSettings(learners = "x")).startsWith("learners: expected "))
    assert(refused(EnvironmentSettings(loop = "plan")).contains("which plans"))
    assert(refused(EnvironmentSettings(link = "no")).startsWith("link: "))
    assert(refused(EnvironmentSettings(learners = "both", opponent = "paper-pursuer")).startsWith(
      "opponent: expected none where"
    ))
    assert(refused(EnvironmentSettings(movesInFlight = 33)).startsWith("moves_in_flight: expected 1 to 32"))
    assert(refused(EnvironmentSettings(startWithinM = (5, 2))).startsWith("start_within_m: expected 5.0"))
    val learner = Learner(EnvironmentSettings(), 2, Autoreset.Disabled)
    intercept[IllegalStateException](learner.batch.step())
    learner.reset(1, 2)
    val before = learner.seen(1, 0)
    learner.act(1, Float.NaN)
    assert(intercept[IllegalArgumentException](learner.batch.step()).getMessage.contains("environment 1"))
    assertEquals(learner.seen(1, 0), before)
