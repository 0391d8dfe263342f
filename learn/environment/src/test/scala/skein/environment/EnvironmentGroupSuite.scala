package skein.environment

import java.nio.ByteBuffer
import java.nio.file.Files
import skein.policy.*
import skein.scenario.*
import skein.testing.TemporaryFolders
import skein.units.{MetresPerSecond, OwnFailure, Radians, Vector3}

class EnvironmentGroupSuite extends munit.FunSuite, TemporaryFolders:
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
  )(using Scenarios):
    private val block           = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, count))
    val batch: EnvironmentBatch =
      EnvironmentBatch.of(settings, count, autoreset, block).fold(fail(_), identity)
    val buffers: EnvironmentBuffers = EnvironmentBuffers(block, 1, count)

    def act(number: Int, share: Float): Unit = buffers.actions.put(number, share): Unit
    def seen(number: Int, field: Int): Float = buffers.observations.get(field * count + number)
    def reward(number: Int): Float           = buffers.rewards.get(number)
    def ended(number: Int): Boolean          = truncated(number) || buffers.terminations.get(number) != 0
    def truncated(number: Int): Boolean      = buffers.truncations.get(number) != 0

  test("the engine is reported: SIMD, or scalar with the reason"):
    def engine(settings: EnvironmentSettings)(using Scenarios) =
      EnvironmentBatch.engine(settings).fold(fail(_), _.text)
    for settings <- Seq(EnvironmentSettings(), surround, surround.copy(learners = "all")) do
      assert(clue(engine(settings)).startsWith("SIMD, "))
    val quadrotor = EnvironmentSettings(plant = "quadrotor", altitudeM = 3)
    assert(clue(engine(quadrotor)).startsWith("scalar: SIMD simulates no ground"))
    assert(clue(engine(surround.copy(sensors = "position=1,dropout=5%"))).startsWith("SIMD, "))
    val others = Scenarios(ScenarioKind(Own()), ScenarioKind(Short()))
    assert(clue(engine(own("", ""))(using others)).startsWith("scalar: a policy is no formula"))
    assert(clue(engine(EnvironmentSettings(scenario = "short"))(using others)).startsWith("SIMD, "))

  test("learners see the errors of readings; a mistake in them names the setting"):
    def seen(sensors: String) =
      val learner = Learner(surround.copy(sensors = sensors), 1)
      learner.batch.reset(Array(1L))
      learner.act(0, 0)
      learner.batch.step()
      val all = Vector.tabulate(3)(learner.seen(0, _))
      learner.batch.close()
      all
    assertNotEquals(seen("position=1"), seen("position=0"))
    assertEquals(
      EnvironmentBatch.engine(surround.copy(sensors = "position=x")).map(_.text),
      Left("sensors: expected a number from 0.0 to 100.0, got 'position=x'")
    )

  test("a scenario's own end terminates the episode"):
    given Scenarios = Scenarios(ScenarioKind(Short()))
    val learner     = Learner(EnvironmentSettings(scenario = "short", link = "none", episodeS = 9), 2)
    learner.batch.reset(Array(1L, 2L))
    val ends = Vector.fill(80):
      for number <- 0 until 2 do learner.act(number, 0)
      learner.batch.step()
      Vector.tabulate(2)(number => (learner.ended(number), learner.truncated(number)))
    assert(!ends.flatten.exists(_._2), ends)
    // Each of 2 s, the later ones counted from their own beginning, and a step that begins the next.
    for number <- 0 until 2 do
      val at = ends.indices.filter(ends(_)(number)._1)
      assertEquals(at.sliding(2).map(pair => pair(1) - pair(0)).toVector.distinct, Vector(21), at)
    learner.batch.close()

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
    val learner = Learner(settings, 1, Autoreset.Disabled)
    learner.batch.reset(Array(1L))
    while !learner.ended(0) do
      learner.act(0, 0)
      learner.batch.step()
    assert(learner.reward(0) < -5, learner.reward(0))
    intercept[IllegalStateException](learner.batch.step()): Unit
    learner.batch.close()

  private def own(policy: String, quantity: String) = EnvironmentSettings(
    scenario = "own",
    set = Map("policy" -> policy, "quantity" -> quantity),
    objective = "off",
    episodeS = 6
  )

  test("rewards add up to what is optimised: a mean's values, or the squares of a root mean square"):
    given Scenarios             = Scenarios(ScenarioKind(Own()))
    def paid(objective: String) =
      val settings = own("", "3").copy(objective = objective, link = "none", periodMs = 40)
      val learner  = Learner(settings, 1, Autoreset.Disabled)
      learner.batch.reset(Array(1L))
      val sum = Iterator.continually {
        learner.act(0, 0)
        learner.batch.step()
        learner.reward(0)
      }.takeWhile(_ => !learner.ended(0)).sum
      learner.batch.close()
      sum
    assert(paid("off") < -10)
    assertEqualsFloat(paid("off-rms"), paid("off") * 3 / 10, 1e-3f)
    assertEqualsFloat(paid("2*off-rms"), paid("off") * 2 * 3 / 10, 1e-3f)

  test("an exception of a user's policy or quantity is reported with its name"):
    given Scenarios                            = Scenarios(ScenarioKind(Own()))
    def told(policy: String, quantity: String) =
      val block = ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, 1))
      val batch =
        EnvironmentBatch.of(own(policy, quantity), 1, Autoreset.NextStep, block).fold(fail(_), identity)
      try
        intercept[OwnFailure]:
          batch.reset(Array(1L))
          for _ <- 0 until 20 do batch.step()
        .getMessage
      finally batch.close()
    val thrown = "failed: java.lang.IllegalStateException: no such luck (EnvironmentGroupSuite.scala:"
    assert(clue(told("throws", "")).startsWith(s"the policy Away $thrown"))
    assert(clue(told("", "throws")).startsWith(s"the quantity Off $thrown"))
    assertEquals(
      told("NaN", ""),
      "the policy of Evader decided for what no vehicle can do: Along(NaN,4.0,-5.0,Still)"
    )
    assertEquals(told("", "NaN"), "the quantity Off answered NaN, which is no reward")

  test("a scenario unfit for learning is refused with what was expected"):
    def refused(settings: EnvironmentSettings) = LearnerSide.of(settings).swap.getOrElse("accepted")
    assert(clue(refused(surround.copy(scenario = "surrond"))).contains("the nearest is 'surround'"))
    assert(clue(refused(surround.copy(set = Map("x" -> "1")))).startsWith("set: no setting 'x'"))
    assert(clue(refused(surround.copy(
      scenario = "crossing",
      learners = "all",
      objective = "arrived"
    ))).contains("rewards add up to these, got arrived"))
    assertEquals(
      refused(surround.copy(objective = "off-ring + 0.1*gap")),
      "objective: expected means over time, or one root mean square alone: rewards add up to these, " +
        "got off-ring + 0.1*gap"
    )
    assert(clue(refused(surround.copy(opponent =
      "paper-pursuer"
    ))).startsWith("opponent: family paper-pursuer is"))
    assert(clue(refused(EnvironmentSettings(scenario = "formation"))).startsWith(
      "learners: expected one of leader, follower, all of a role (leaders), all, or vehicles of Leader,"
    ))
    def learning(learners: String, scenario: String) =
      refused(EnvironmentSettings(learners = learners, scenario = scenario))
    assert(clue(learning("all", "convoy")).contains("in which a car would learn"))
    assert(clue(learning("all", "forest")).contains("which sees by cameras or lidars"))
    assert(clue(learning(
      "Evader,Evader",
      "surround"
    )).startsWith("learners: expected one of evader, pursuer"))

  test("learners are one of a role in turns, all of a role, all, or those of some names"):
    def named(learners: String) =
      EnvironmentBatch.prepared(surround.copy(learners = learners)).fold(fail(_), _.names).mkString(" ")
    assertEquals(named("pursuer"), "Pursuer1")
    assertEquals(named("pursuers"), "Pursuer1 Pursuer2 Pursuer3")
    assertEquals(named("all"), "Evader Pursuer1 Pursuer2 Pursuer3")
    assertEquals(named("Pursuer3,Evader"), "Evader Pursuer3")

  folder.test("settings are resolved once, for the learners' names and for the batch"): folder =>
    val trips = folder.resolve("trips.csv")
    Files.writeString(trips, "50\n60\n")
    val prepared = EnvironmentBatch.prepare(java.util.Map.of("link", s"file:$trips"))
    assertEquals(prepared.learners, "Pursuer")
    Files.delete(trips)
    prepared.make(1, 0, ByteBuffer.allocateDirect(EnvironmentBuffers.bytes(1, 1))).close()

/** A scenario with an evader's policy and a pursuer's quantity that settings choose. */
final case class Own(policy: String = "", quantity: String = "") extends Scenario:
  def agents: Vector[Agent] = Vector(
    Agent("Evader", Role.Evader, MetresPerSecond(4), Vector3(30, 0, -5), Radians(0), Away(policy)),
    Agent("Pursuer", Role.Pursuer, MetresPerSecond(8), Vector3(0, 0, -5), Radians(0), Surrounding(0, 8, 8))
  )
  private def off                        = Series.of("off", "m", Off(quantity))
  override def measures: Vector[Measure] = Vector(off.mean("off"), off.rms("off rms"))

object Own:
  // No formula.
  def answer(how: String): Double = if Thread.currentThread.getName.isBlank && how == "" then 0
  else
    how match
      case "throws" => throw IllegalStateException("no such luck")
      case "NaN"    => Double.NaN
      case _        => how.toDoubleOption.getOrElse(1)

final case class Away(how: String) extends Policy:
  type Memory = Unit
  def start: Unit                                             = ()
  override def isPlanar: Boolean                              = true
  def choose(seen: Observation, memory: Unit): (Action, Unit) = (seen.along(Own.answer(how), 4), ())

final case class Off(how: String) extends Quantity:
  def of(positions: Positions): Double = Own.answer(how)

/** Ends after 2 s. */
final case class Short() extends Scenario:
  def agents: Vector[Agent]                  = Surround(vehicles = 3).agents
  override def isOver(known: Known): Boolean = known.elapsed.toSeconds >= 2
