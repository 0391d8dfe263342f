package skein.flight

import skein.loop.{LoopKind, FlightOutcome}
import skein.loop.learning.{FlownLearner, Learning, Transition}
import skein.policy.*
import skein.record.{EventKind, Recording}
import skein.scenario.{PaperDuel, ScenarioKind, Scenarios}
import skein.settings.{ChosenPolicy, FlySettings, PolicyFile}
import skein.signal.{LatencyProfile, SplitMix64}
import skein.testing.{Optimised, TemporaryFolders}
import skein.units.*

/** Flights in virtual time whose pursuer's policy changes repeatedly. */
class LearningFlightSimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios(ScenarioKind(PaperDuel()))

  private val settings = FlySettings(
    List(LoopKind.Stream),
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(5),
    period = Span.ofMillis(100),
    seed = 7
  )

  private val family = PolicyFamily.learned(LearnedPolicy.shape(Vector(4)))

  private def drawn(seed: Long): Vector[Double] =
    val random = SplitMix64(seed)
    Vector.fill(family.space.dimension - 2)(2 * random.nextDouble() - 1) ++ Vector(2.0, 0.0)

  private val first = PolicyFile(Role.Pursuer, family, drawn(0))

  /** Makes a new version after every ten transitions, drawn from them. */
  private def every10(seen: Transition => Unit): FlownLearner = new FlownLearner:
    private var learned                        = 0
    def learn(transitions: Vector[Transition]) =
      transitions.foreach(seen)
      val before = learned / 10
      learned += transitions.size
      Option.when(learned / 10 > before)(drawn((1e6 * transitions.last.distanceM).toLong))

  private def flown(learner: FlownLearner, explore: Double = 0.1) =
    val chosen = ChosenPolicy("learning", first, Some(Learning.Beside(explore, _ => learner)))
    VirtualFlights.fly(settings, settings.plansWith(chosen).last).fold(fail(_), identity)

  private def learned(recording: Recording) = recording.events.filter(_.kind == EventKind.Learned)

  test("versions change between decisions, are recorded, and are repeated with an equal digest"):
    var seen      = Vector.empty[Transition]
    val landed    = flown(every10(seen :+= _))
    val recording = landed.recorder.recording
    assertEquals(landed.landed.outcome, FlightOutcome.Completed)
    val versions = learned(recording)
    assert(versions.size >= 3, versions)
    assertEquals(
      versions.map(_.detail.takeWhile(_ != ',')),
      versions.indices.map(index => s"version ${index + 1} decides from here").toVector
    )
    // Transitions agree with one another and with the recorded decisions.
    val decisions = recording.decisions.filter(_.vehicle == "Pursuer")
    assert(seen.size >= decisions.size - 3, s"${seen.size} of ${decisions.size}")
    for (one, next) <- seen.zip(seen.drop(1)) do assertEquals(one.reached, next.seen)
    for (one, decision) <- seen.zip(decisions) do
      assertEqualsDouble(
        decision.headingBefore.value + one.shares.head * 2 * decision.elapsed.toSeconds,
        decision.heading.value,
        1e-12
      )
    assertEquals(flown(every10(_ => ())).recorder.digest, landed.recorder.digest)
    val file = temporaryFolder().resolve("flight.duckdb")
    landed.recorder.writeTo(file).fold(error => fail(error.message), _ => ())
    val replayed = Replayed.of(file).fold(fail(_), identity)
    assertEquals(replayed.decidedAgain.map(_.message), None)
    assertEquals(replayed.flownAgain.map(again => again.again), Some(landed.recorder.digest))

  private def headings(recording: Recording) =
    recording.decisions.filter(_.vehicle == "Pursuer").map(_.heading)

  test("exploration is as large as configured: none if it is 0, and never beyond the largest turn"):
    val alone = VirtualFlights.fly(settings, settings.plansWith(ChosenPolicy("alone", first)).last)
    val same  = flown(_ => None, explore = 0)
    assertEquals(headings(same.recorder.recording), headings(alone.fold(fail(_), _.recorder.recording)))
    var shares = Vector.empty[Double]
    val noisy  = flown(transitions => { shares ++= transitions.flatMap(_.shares); None }, explore = 1)
    assertNotEquals(headings(noisy.recorder.recording), headings(same.recorder.recording))
    assertEquals((shares.min, shares.max), (-1.0, 1.0))
    assert(shares.distinct.sizeIs > shares.size / 3, shares)

  test("a version that is not finite is refused, and the previous one continues to decide"):
    val learner: FlownLearner = _ => Some(first.parameters.updated(3, Double.NaN))
    val landed                = flown(learner)
    assertEquals(landed.landed.outcome, FlightOutcome.Completed)
    val texts = learned(landed.recorder.recording).map(_.detail)
    assertEquals(texts.head, s"version 1 refused: 1 of its ${family.space.dimension} numbers are not finite")
    assert(landed.recorder.recording.decisions.forall(_.heading.value.isFinite))

  for
    (what, error) <- Seq(
      "fails"                   -> IllegalStateException("no such luck"),
      "has not all its classes" -> NoClassDefFoundError("no such luck")
    )
  do
    test(s"a learner that $what ends learning, but not the flight"):
      val learner: FlownLearner = _ => throw error
      val landed                = flown(learner)
      assertEquals(landed.landed.outcome, FlightOutcome.Completed)
      val texts = learned(landed.recorder.recording).map(_.detail)
      assert(texts.head.contains("the policy stays as it is: "), texts)
      assert(texts.head.contains("no such luck"), texts)
      assert(landed.recorder.recording.decisions.count(_.vehicle == "Pursuer") > 30)
