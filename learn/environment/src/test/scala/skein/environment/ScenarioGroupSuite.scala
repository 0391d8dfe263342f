package skein.environment

import java.nio.ByteBuffer
import skein.forward.{LoopObserver, Rollout}
import skein.policy.*
import skein.scenario.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom
import skein.units.{MetresPerSecond, OwnFailure, Radians, Vector3}

class ScenarioGroupSuite extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  private val surround = EnvironmentSettings(
    scenario = "surround",
    set = Map("vehicles" -> "4"),
    objective = "off-ring",
    episodeS = 6
  )

  private final class Learner(
      settings: EnvironmentSettings,
      count: Int,
      autoreset: Autoreset = Autoreset.NextStep
  ):
    private val block           = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, count))
    val batch: EnvironmentBatch =
      EnvironmentBatch.of(settings, count, autoreset, block).fold(fail(_), identity)
    val buffers: EnvironmentBuffers = EnvironmentBuffers(block, 1, count)

    def act(number: Int, share: Float): Unit = buffers.actions.put(number, share): Unit
    def seen(number: Int, field: Int): Float = buffers.observations.get(field * count + number)
    def reward(number: Int): Float           = buffers.rewards.get(number)
    def ended(number: Int): Boolean          = truncated(number) || buffers.terminations.get(number) != 0
    def truncated(number: Int): Boolean      = buffers.truncations.get(number) != 0

  /** The turn towards the opponent, computed from an observation. */
  private def towards(right: Double): Double = (right / 10).max(-1).min(1)

  private object steered extends HeadingPolicy.Memoryless:
    def heading(seen: PlanarObservation): Double =
      seen.ownHeadingRad + towards(seen.fromOwnHeading(1).toFloat) * seen.elapsedS

  test("the engine is reported: scalar for another scenario, SIMD for the duel"):
    val team = Learner(surround, 2).batch.engine
    assert(team.text.startsWith("scalar: environments of surround"), team)
    val duel = Learner(EnvironmentSettings(), 2).batch.engine
    assert(duel.text.startsWith("SIMD, "), duel)

  for (loop, link) <- Seq("stream" -> "vpn", "predictive" -> "direct", "paused" -> "none") do
    test(s"stepped under $loop over $link, motion and rewards equal the reference's with equal policies"):
      val settings = surround.copy(loop = loop, link = link, startWithinM = (0, 5))
      val side     = ScenarioSide.of(settings).fold(fail(_), identity)
      for number <- 0 until 3 do
        val learner = Learner(settings, 3)
        learner.batch.reset(Array(5L, 6L, 7L))
        var (sum, steps) = (0.0, 0)
        while !learner.truncated(number) do
          for each <- 0 until 3 do learner.act(each, towards(learner.seen(each, 1)).toFloat)
          learner.batch.step()
          sum += learner.reward(number)
          steps += 1
          assert(steps < 300)
        learner.batch.close()
        val seed           = SplitMix64.seedOf(5L + number, 0)
        val engagement     = side.engagement(side.members(number), steered, None, seed)
        val ring           = OffRing(8)
        var (paid, scores) = (0.0, 0)
        val observer       = new LoopObserver:
          private val north, east = Array.ofDim[Double](4)
          override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
            north(vehicle) = x; east(vehicle) = y
            if vehicle == 3 && timeS <= 6 + 1e-6 then
              scores += 1
              paid += ring.of(Positions(IArray.from(north), IArray.from(east), IArray.fill(4)(-5.0)))
        Rollout(engagement, side.timing, side.link, side.response)
          .fly(
            WorldRandom.key(1, 0, ((SplitMix64.seedOf(seed, 1) >>> 1) % (1 << 24)).toInt),
            observer = observer
          ): Unit
        assertEquals(scores, 60)
        assertEqualsDouble(-sum * EnvironmentSettings.RewardM, paid, 1e-3)

  test("equal seeds and actions give equal episodes, to the bit, independent of other environments"):
    def flown(count: Int) =
      val learner = Learner(surround, count)
      learner.batch.reset(Array.tabulate(count)(_ + 3L))
      val all = Vector.tabulate(80): step =>
        for number <- 0 until count do learner.act(number, math.sin(step * 0.2 + number).toFloat)
        learner.batch.step()
        Vector.tabulate(2)(number => (learner.seen(number, 0), learner.reward(number), learner.ended(number)))
      learner.batch.close()
      all
    val first = flown(2)
    assertEquals(flown(7), first)
    assert(first.exists(_.exists(_._3)), "no episode ended")

  test("the next episode's first observation follows an episode's last step, or is returned with it"):
    for mode <- Seq(Autoreset.NextStep, Autoreset.SameStep) do
      val learner = Learner(surround.copy(episodeS = 2), 1, mode)
      learner.batch.reset(Array(1L))
      val begun = learner.seen(0, 0)
      var ends  = 0
      for _ <- 0 until 100 do
        learner.act(0, 0.5f)
        learner.batch.step()
        if learner.ended(0) then
          ends += 1
          if mode == Autoreset.SameStep then assertEqualsFloat(learner.seen(0, 0), begun, 1.5f)
          else
            assert(math.abs(learner.seen(0, 0) - begun) > 1)
            learner.batch.step()
            assertEqualsFloat(learner.seen(0, 0), begun, 1.5f)
            assertEquals(learner.reward(0), 0f)
      assert(ends > 2, s"$mode: $ends episodes")
      learner.batch.close()

  test("the other vehicles of the learner's role use their own policies, or a given one"):
    def paid(policy: Option[PurePursuit]) =
      val learner = Learner(surround, 1)
      policy.foreach(learner.batch.fly)
      learner.batch.reset(Array(9L))
      val sum = Vector.fill(50):
        learner.act(0, 0)
        learner.batch.step()
        learner.reward(0)
      .sum
      learner.batch.close()
      sum
    assertNotEquals(paid(None), paid(Some(PurePursuit(1))))

  test("an evader's reward is a pursuer's cost, and a pursuer that comes near enough captures"):
    val settings = EnvironmentSettings(
      learners = "evader",
      scenario = "duel",
      set = Map("pairs" -> "2"),
      captureRadiusM = 20,
      episodeS = 10
    )
    val learner = Learner(settings, 2, Autoreset.Disabled)
    learner.batch.reset(Array(1L, 2L))
    while !learner.ended(0) do
      learner.act(0, 0)
      learner.act(1, 0)
      learner.batch.step()
    assert(learner.reward(0) < -5, learner.reward(0))
    intercept[IllegalStateException](learner.batch.step()): Unit
    learner.batch.close()

  test("an exception of a user's policy or quantity is reported with its name"):
    given Scenarios                            = Scenarios(ScenarioKind(Own()))
    def told(policy: String, quantity: String) =
      val settings = EnvironmentSettings(
        scenario = "own",
        set = Map("policy" -> policy, "quantity" -> quantity),
        objective = "off",
        episodeS = 6
      )
      val block = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, 1))
      val batch = EnvironmentBatch.of(settings, 1, Autoreset.NextStep, block).fold(fail(_), identity)
      try
        intercept[OwnFailure]:
          batch.reset(Array(1L))
          for _ <- 0 until 20 do batch.step()
        .getMessage
      finally batch.close()
    val thrown = "failed: java.lang.IllegalStateException: no such luck (ScenarioGroupSuite.scala:"
    assert(clue(told("throws", "")).startsWith(s"the policy Away $thrown"))
    assert(clue(told("", "throws")).startsWith(s"the quantity Off $thrown"))
    assertEquals(
      told("NaN", ""),
      "the policy of Evader decided for what no vehicle can do: Along(NaN,4.0,-5.0,Still)"
    )
    assertEquals(told("", "NaN"), "the quantity Off answered NaN, which nobody can be rewarded by")

  test("a scenario unfit for learning is refused with what was expected"):
    def refused(settings: EnvironmentSettings) = ScenarioSide.of(settings).swap.getOrElse("accepted")
    assert(clue(refused(surround.copy(scenario = "surrond"))).contains("the nearest is 'surround'"))
    assert(clue(refused(surround.copy(set = Map("x" -> "1")))).startsWith("set: no setting 'x'"))
    assert(clue(refused(surround.copy(objective = "nearest"))).contains("is told of recorded flights alone"))
    assert(clue(refused(surround.copy(learners = "both"))).startsWith("learners: expected pursuer or evader"))
    assert(clue(refused(surround.copy(opponent = "paper-evader"))).startsWith("opponent: expected none"))
    assert(clue(refused(surround.copy(
      scenario = "formation",
      set = Map.empty
    ))).contains("came formation of leader and follower"))
    for (scenario, why) <- Seq("convoy" -> "which has cars", "forest" -> "which sees by cameras or lidars") do
      assert(clue(refused(surround.copy(scenario = scenario, set = Map.empty))).contains(why))

/** A scenario with an evader's policy and a pursuer's quantity that settings choose. */
final case class Own(policy: String = "", quantity: String = "") extends Scenario:
  def agents: Vector[Agent] = Vector(
    Agent("Evader", Role.Evader, MetresPerSecond(4), Vector3(30, 0, -5), Radians(0), Away(policy)),
    Agent("Pursuer", Role.Pursuer, MetresPerSecond(8), Vector3(0, 0, -5), Radians(0), Surrounding(0, 8, 8))
  )
  override def measures: Vector[Measure] = Vector(Series.of("off", "m", Off(quantity)).mean("off"))

object Own:
  def answer(how: String): Double = how match
    case "throws" => throw IllegalStateException("no such luck")
    case "NaN"    => Double.NaN
    case _        => 1

final case class Away(how: String) extends Policy:
  type Memory = Unit
  def start: Unit                                             = ()
  override def isPlanar: Boolean                              = true
  def choose(seen: Observation, memory: Unit): (Action, Unit) = (seen.along(Own.answer(how), 4), ())

final case class Off(how: String) extends Quantity:
  def of(positions: Positions): Double = Own.answer(how)
