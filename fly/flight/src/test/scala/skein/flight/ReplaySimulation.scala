package skein.flight

import java.nio.file.{Files, Path}
import skein.loop.{Fallback, LoopKind, PlanSettings, Replay}
import skein.record.*
import skein.scenario.{Crossing, PaperDuel, Scenarios}
import skein.settings.{FlightPlan, FlySettings, PredictionModel, TextFile}
import skein.signal.LatencyProfile
import skein.testing.{Optimised, TemporaryFolders}
import skein.units.*
import skein.vehicle.ReducedModel

/** A repeated flight and a replay reproduce the recording, for every loop. */
class ReplaySimulation extends munit.FunSuite, TemporaryFolders, Optimised:
  private given Scenarios = Scenarios.ours

  private val settings = FlySettings(
    LoopKind.values.toList,
    List(LatencyProfile.vpn),
    duration = Span.ofSeconds(3),
    period = Span.ofMillis(100),
    seed = 3,
    planning = PlanSettings(horizonSteps = 10, slices = 2, blocksPerSlice = 1)
  )

  private val predictive =
    settings.plans.find(_.loop == LoopKind.Predictive).getOrElse(fail("there is no such flight"))

  private def fly(settings: FlySettings, plan: FlightPlan): MemoryRecorder =
    VirtualFlights.fly(settings, plan).fold(fail(_), identity).recorder

  private def check(settings: FlySettings, folder: Path)(using Scenarios): Unit =
    for plan <- settings.plans do
      val recorder = fly(settings, plan)
      val file     = plan.file(folder)
      assert(recorder.writeTo(file).isRight)
      val replayed = Replayed.of(file).fold(fail(_), identity)
      assert(replayed.decisions > 10, s"${plan.id}: $replayed")
      assertEquals(replayed.decidedAgain, None, plan.id)
      assertEquals(replayed.flownAgain.map(_.again), Some(recorder.digest), plan.id)
      assert(replayed.isSame, plan.id)

  for loop <- LoopKind.values do
    folder.test(
      s"${loop.label}: a repeated flight and a replay of its recording have equal decisions"
    ): folder =>
      check(settings.copy(loops = List(loop)), folder)

  for scenario <- Seq(PaperDuel(), Crossing(vehicles = 4)) do
    folder.test(
      s"a plan of ${scenario.name} by a user's own plant is repeated, from states that readings lack"
    ): folder =>
      val own = settings.copy(loops = List(LoopKind.Plan), scenario = scenario, predictor = Tilting.predictor)
      val plan = own.plans.head
      check(own, folder)(using Tilting.scenarios)
      val recording = fly(own, plan).recording
      val states    = recording.planned.flatMap(_.states)
      assertEquals(states.size, recording.planned.size)
      assert(states.map(_.own.takeRight(2)).distinct.size > 10, "tilts do not differ")

  test("other states, or a plant with other parameters, give other plans"):
    val own = settings.copy(
      loops = List(LoopKind.Plan),
      scenario = Crossing(vehicles = 4),
      predictor = Tilting.predictor
    )
    val plan      = own.plans.head
    val recording = fly(own, plan).recording
    val untold    = recording.copy(planned = recording.planned.map(_.copy(states = None)))
    assert(Replay(own.fleet, untold, own.loopSettings(plan)).firstDifference.isDefined)
    val other = own.copy(predictor = PredictionModel.Own(Tilting.structure, Vector(1.5, 0.15)))
    assert(Replay(own.fleet, recording, other.loopSettings(plan)).firstDifference.isDefined)

  folder.test("a predictive flight by a reduced model is repeated with the model in its recording"): folder =>
    check(
      settings.copy(
        loops = List(LoopKind.Predictive),
        movesInFlight = 3,
        deadline = Some(Span.ofMillis(20)),
        fallback = Fallback.Hold,
        predictor = PredictionModel.Fitted(ReducedModel.AirSim.copy(gain = 0.987654321))
      ),
      folder
    )

  folder.test(
    "a team of eight as published, over another kind of link, is repeated with equal decisions"
  ): folder =>
    val link =
      LatencyProfile.parse("lognormal:40ms,0.8", Left(_)).fold(error => fail(error.message), identity)
    check(
      settings.copy(
        loops = List(LoopKind.Futures, LoopKind.Stream, LoopKind.Predictive),
        links = List(link),
        scenario = PaperDuel(pairs = 4, asPublished = true)
      ),
      folder
    )

  test("a replay reports the first decision whose heading is not the policy's, with both headings"):
    val recording = fly(settings, predictive).recording
    val forged    = recording.decisions(7)
    val heading   = Radians(forged.heading.value + 1e-12)
    val changed   = recording.copy(decisions = recording.decisions.updated(7, forged.copy(heading = heading)))
    val found     = Replay(PaperDuel().fleet, changed).firstDifference.getOrElse(fail("no difference found"))
    assertEquals(found.where, s"decision ${forged.sequence} of ${forged.vehicle}")
    assertEquals(found.column, "headingRad")
    assertEquals((found.recorded, found.again), (heading.value.toString, forged.heading.value.toString))

  test("a replay notices a reading that was changed after the decision on it"):
    val recording = fly(settings, predictive).recording
    val forged    = recording.readings.map: reading =>
      if reading.sequence != 5 then reading
      else
        val state = reading.state
        reading.copy(state =
          state.map(read => read.copy(velocityNed = read.velocityNed + Vector3(0, 0, 1e-9)))
        )
    val found = Replay(PaperDuel().fleet, recording.copy(readings = forged)).firstDifference
    assert(found.exists(_.column.endsWith("Sequence")), found.toString)

  folder.test("a flight over measured round trips is repeated without their file, by those recorded"):
    folder =>
      val link     = Files.writeString(folder.resolve("link.txt"), "90\n70.25\n81\n")
      val measured = LatencyProfile.parse(s"correlated:1s,loss:1%,file:$link", TextFile.read)
        .fold(error => fail(error.message), identity)
      val plan     = predictive.copy(link = measured)
      val recorder = fly(settings, plan)
      assert(recorder.writeTo(plan.file(folder)).isRight)
      Files.delete(link)
      val replayed = Replayed.of(plan.file(folder)).fold(fail(_), identity)
      assertEquals(replayed.flownAgain.map(_.again), Some(recorder.digest))
      // Older recordings have no round trips: only their decisions are repeated.
      val heading = recorder.recording.heading
      val older   =
        MemoryRecorder(heading.copy(parameters = heading.parameters.filter(_.name != "link.roundTripsMs")))
      recorder.records.foreach(older.offer)
      val file = folder.resolve("older.duckdb")
      assert(older.writeTo(file).isRight)
      val decided = Replayed.of(file).fold(fail(_), identity)
      assertEquals((decided.decidedAgain, decided.flownAgain), (None, None))
      assert(clue(decided.notFlownAgain).exists(_.contains(s"there is no file $link")))

  folder.test("repeating a flight with another seed than the recorded one gives other decisions"): folder =>
    val plan     = predictive
    val recorder = fly(settings, plan)
    val records  = recorder.records
    val relabel  = recorder.recording.heading
    val forged   = MemoryRecorder(relabel.copy(flight = relabel.flight.copy(seed = plan.seed + 1)))
    records.foreach(forged.offer)
    assert(forged.writeTo(plan.file(folder)).isRight)
    val replayed = Replayed.of(plan.file(folder)).fold(fail(_), identity)
    assertEquals(replayed.decidedAgain, None)
    assert(replayed.flownAgain.exists(again => !again.isSame && again.inDecisions.isDefined))
    assert(!replayed.isSame)
