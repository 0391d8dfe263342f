package skein.loop

import skein.policy.{Action, Policy, Observation, Yaw}
import skein.scenario.PaperDuel
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

class DeciderSuite extends munit.FunSuite:

  private val scenario = PaperDuel().fleet
  private val evader   = Decider(scenario, 0)
  private val pursuer  = Decider(scenario, 1)

  private def millis(n: Double) = Instant.Epoch + Span.ofMillis(n)

  private def reading(
      vehicle: Int,
      x: Double,
      y: Double,
      validMs: Double,
      sentMs: Double,
      receivedMs: Double
  ) =
    val state = Kinematics(Vector3(x, y, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    Reading(
      vehicle,
      0,
      Stamped(state, millis(validMs), millis(sentMs), millis(receivedMs))
    )

  private val view = TeamView
    .empty(2)
    .withReading(reading(0, 21, 4, 1010, 100, 120))
    .withReading(reading(1, 1, 2, 1040, 130, 160))

  private def sent(vehicle: Int, heading: Double, at: Instant) =
    SentCommand(vehicle, 0, Radians(heading), at, Action.Hover)

  private def row(decided: (Memory, Decision)) = Rows(scenario).decision(decided._2)

  test("the pursuer integrates its turn over the time since its last decision"):
    val (first, _)  = pursuer.decide(pursuer.start, view, millis(200))
    val (_, second) = pursuer.decide(first, view, millis(350))
    assertEquals(first.headingRad, 0.0)
    assertEqualsDouble(second.heading.value, 0.15, 1e-12)
    assertEquals(second.elapsed, Span.ofMillis(150))
    assertEquals(second.sequence, 1L)

  test(
    "another vehicle's heading is the last commanded one, or its direction of motion if commands are unknown"
  ):
    def seen(knows: Knowledge, velocity: Vector3) =
      val moving = reading(0, 21, 4, 1010, 100, 120)
      val state  = moving.state.copy(value = moving.state.value.copy(velocityNed = velocity))
      val known  =
        view.withReading(moving.copy(sequence = 1, state = state)).withMove(sent(0, 2.5, millis(150)))
      pursuer.observation(pursuer.start, known.copy(knows = knows), millis(200)).headings.map(_.value)
    assertEquals(seen(Knowledge.All, Vector3(0, 3, 0)), Vector(2.5, 0.0))
    assertEquals(seen(Knowledge.Positions, Vector3(0, 3, 0)), Vector(math.Pi / 2, 0.0))
    assertEquals(
      seen(Knowledge.Positions, Vector3(0, 0.05, 5)),
      Vector(scenario.agents(0).startHeading.value, 0.0)
    )

  test("no vehicle receives a heading that is not finite"):
    val lost = Decider(scenario, 1, skein.policy.PaperPursuer(Double.NaN))
    val told = intercept[OwnFailure](lost.decide(lost.start, view, millis(200)))
    assert(
      told.getMessage.contains("the policy of Pursuer decided for what no vehicle can do: Along(NaN")
    )

  test("a heading at the start's altitude is recorded without an action, at another with its velocity"):
    final case class Straight(down: Metres, yaw: Yaw) extends Policy:
      type Memory = Int
      def start: Int                                            = 0
      def choose(seen: Observation, memory: Int): (Action, Int) =
        (Action.Along(Radians(7), MetresPerSecond(3), down, yaw), memory + 1)
    def decided(policy: Policy) =
      val decider          = Decider(scenario, 1, policy)
      val (next, decision) = decider.decide(decider.start, view, millis(200))
      assertEquals((next.headingRad, next.held), (7.0, 1))
      val recorded = Rows(scenario).decision(decision)
      assertEquals((recorded.heading, recorded.speed), (Radians(7), Some(MetresPerSecond(3))))
      assertEquals(Rows(scenario).action(recorded, scenario.agents(1)), decision.action)
      recorded.action
    val start = Metres(scenario.agents(1).startPositionNed.z)
    assertEquals(decided(Straight(start, Yaw.Still)), None)
    for (down, yaw) <- Seq(Metres(-3) -> Yaw.Still, start -> Yaw.Forward) do
      val action = Action.Along(Radians(7), MetresPerSecond(3), down, yaw)
      assertEquals(decided(Straight(down, yaw)), Some(action.byVelocity))

  private def failureOf(action: => Action): String =
    object Broken extends Policy:
      type Memory = Unit
      def start: Unit                                             = ()
      def choose(seen: Observation, memory: Unit): (Action, Unit) = (action, ())
    val decider = Decider(scenario, 1, Broken)
    intercept[OwnFailure](decider.decide(decider.start, view, millis(200))).getMessage

  test("no vehicle receives an action with a component that is not finite"):
    val actions = Seq(
      Action.Velocity(Vector3(Double.PositiveInfinity, 0, 0)),
      Action.VelocityAt(1, 2, Metres(Double.NaN)),
      Action.Position(Vector3(0, Double.NaN, 0), MetresPerSecond(1)),
      Action.Turn(Yaw.Turning(Double.NegativeInfinity))
    )
    for action <- actions do
      assertEquals(failureOf(action), s"the policy of Pursuer decided for what no vehicle can do: $action")
    assertEquals(failureOf(null), "the policy of Pursuer decided for what no vehicle can do: null")

  test("an exception in a policy is reported with its vehicle and line"):
    def endless(n: Int): Int = 1 + endless(n + 1)
    val mistakes             = Seq[(() => Action, String)](
      (() => Vector(Action.Hover)(7), "java.lang.IndexOutOfBoundsException: 7 is out of bounds"),
      (() => if endless(0) > 0 then Action.Hover else Action.Land, "java.lang.StackOverflowError"),
      (() => throw NoClassDefFoundError("other/Thing"), "java.lang.NoClassDefFoundError: other/Thing")
    )
    for (mistake, told) <- mistakes do
      val failure = failureOf(mistake())
      assert(clue(failure).startsWith(s"the policy of Pursuer failed: $told"))
      assert(clue(failure).matches(".* \\(DeciderSuite.scala:\\d+\\)"))

  test("an exception in a policy's initial memory is reported with its vehicle and line, too"):
    object Broken extends Policy:
      type Memory = Unit
      def start: Unit                                             = throw IllegalStateException("no memory")
      def choose(seen: Observation, memory: Unit): (Action, Unit) = (Action.Hover, ())
    val failure = intercept[OwnFailure](Decider(scenario, 1, Broken)).getMessage
    assert(
      clue(failure).startsWith("the policy of Pursuer failed: java.lang.IllegalStateException: no memory")
    )

  test("both deciders see the evader in the pursuer's frame"):
    val heading  = math.Pi / 2
    val ofEvader =
      row(evader.decide(evader.start, view.withMove(sent(1, heading, millis(150))), millis(200)))
    assertEqualsDouble(ofEvader.relativeX.value, 2, 1e-12)
    assertEqualsDouble(ofEvader.relativeY.value, -20, 1e-12)
    val ofPursuer = row(pursuer.decide(pursuer.start.copy(headingRad = heading), view, millis(200)))
    assertEqualsDouble(ofPursuer.relativeX.value, 2, 1e-12)
    assertEqualsDouble(ofPursuer.relativeY.value, -20, 1e-12)

  test("the four observations are times since receipt and since the sent moves"):
    val moved    = view.withMove(sent(0, 1, millis(150))).withMove(sent(1, 1, millis(170)))
    val decision = row(evader.decide(evader.start, moved, millis(200)))
    assertEquals(decision.observations.ownAge, Span.ofMillis(80))
    assertEquals(decision.observations.opponentAge, Span.ofMillis(40))
    assertEquals(decision.observations.sinceOwnMove, Some(Span.ofMillis(50)))
    assertEquals(decision.observations.sinceOpponentMove, Some(Span.ofMillis(30)))

  test("the true age counts from the moment of sampling, within the stated uncertainty"):
    val decision = row(evader.decide(evader.start, view, millis(200)))
    val age      = decision.trueAge.get
    // The offset lies in [-910, -890] by the first reading and in [-910, -880] by the second.
    val driftMs = 40 * ClockAlignment.MaxDrift
    assertEqualsDouble(age.clockOffset.toMillis, -900, driftMs)
    assertEqualsDouble(age.uncertainty.toMillis, 10, driftMs)
    assertEqualsDouble(age.own.toMillis, 90, driftMs)
    assertEqualsDouble(age.opponent.toMillis, 60, driftMs)

  test(
    "a policy observes the last commanded headings, and predicted states if there are any"
  ):
    val moved =
      view.withMove(sent(0, 0.4, millis(150))).withMove(sent(1, 0.6, millis(150)))
    val memory = pursuer.start.copy(headingRad = 0.9, decidedAt = Some(millis(170)), decisions = 3)
    val heard  = pursuer.observation(memory, moved, millis(200))
    assertEquals(heard.headings.map(_.value), Vector(0.4, 0.9))
    assertEquals((heard.elapsed, heard.decisions, heard.actsIn), (Span.ofMillis(30), 3L, Span.Zero))
    assert(heard.vehicles.forall(!_.isPredicted))
    val ahead                      = moved.readings(0).get.state.value.copy(positionNed = Vector3(7, 8, -20))
    def foreseen(actsAtMs: Double) =
      val estimate = skein.forecast.Estimate(ahead, millis(actsAtMs), millis(1040))
      pursuer.observation(memory, moved.copy(estimates = Some(Vector(estimate, estimate))), millis(200))
    assert(foreseen(1150).vehicles.forall(seen => seen.isPredicted && seen.kinematics == ahead))
    // The simulator's clock is 900 ms ahead, to within the drift.
    assertEqualsDouble(foreseen(1150).actsIn.toMillis, 50, 0.01)
    assertEquals(foreseen(1050).actsIn, Span.Zero, "what was to act already acts now")
    // The own reading was sampled 60 ms before, at 1040 ms, and the first one 640 ms before that.
    val later                  = memory.copy(firstReadAt = Some(millis(400)))
    def timeAt(view: TeamView) = pursuer.observation(later, view, millis(200)).time.toMillis
    assertEqualsDouble(timeAt(moved), 700, 0.01)
    assertEqualsDouble(heard.time.toMillis, 60, 0.01)
    val estimate = skein.forecast.Estimate(ahead, millis(1150), millis(1040))
    assertEqualsDouble(timeAt(moved.copy(estimates = Some(Vector(estimate, estimate)))), 750, 0.01)

  test("no decision is made before every vehicle was read"):
    assert(!TeamView.empty(2).withReading(reading(0, 0, 0, 0, 0, 0)).isComplete)
    assert(view.isComplete)
