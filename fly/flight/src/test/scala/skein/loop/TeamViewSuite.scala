package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.{ExecutionContext, Future}
import skein.forecast.ForecastEvent
import skein.policy.Action
import skein.port.{VehicleError, VehiclePort}
import skein.record.{EventKind, MemoryRecorder, Samples}
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

/** No overtaking: a late answer never replaces newer data. */
class TeamViewSuite extends munit.FunSuite:

  private object Silent extends VehiclePort:
    def read(): Future[Either[VehicleError, Stamped[Kinematics]]]               = Future.never
    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      Future.never
    def hover(): Future[Either[VehicleError, Boolean]] = Future.never

  private def millis(n: Double) = Instant.Epoch + Span.ofMillis(n)

  private def reading(vehicle: Int, sequence: Long, validMs: Double, sentMs: Double, receivedMs: Double) =
    val state =
      Kinematics(Vector3(sequence.toDouble, 0, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    Reading(vehicle, sequence, Stamped(state, millis(validMs), millis(sentMs), millis(receivedMs)))

  private val first = reading(0, 0, 10, 0, 30)
  private val later = reading(0, 1, 110, 100, 130)
  // Requested between the two, sampled before the later one, received after it.
  private val late  = reading(0, 2, 90, 80, 150)
  private val other = reading(1, 0, 10, 0, 20)

  /** The decision requests, and the readings that are recorded as stale. */
  private def seen(events: LoopEvent*): (Vector[DecisionRequest], Vector[String]) = seenBy(_ => ())(events*)

  private def silent(system: ActorSystem): Team =
    Team(
      PaperDuel().fleet,
      Vector(Silent, Silent),
      Clock.ofNanos(VirtualTime.clock(system)),
      MemoryRecorder(Samples.heading),
      LoopSettings()
    )(using system.dispatcher)

  private def seenBy(prepared: Team => Unit)(
      events: LoopEvent*
  ): (Vector[DecisionRequest], Vector[String]) = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val recorder           = MemoryRecorder(Samples.heading)
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val team = Team(PaperDuel().fleet, Vector(Silent, Silent), clock, recorder, LoopSettings())
      prepared(team)
      Source(events).via(team.view).runWith(Sink.seq).map: requests =>
        val stale = recorder.recording.events.filter(_.kind == EventKind.Dropped).map(_.detail)
        (requests.toVector, stale)
    .value

  test("a reading is news if it was sampled later, or requested after the other was received"):
    val view = TeamView.empty(2).withReading(later)
    assert(TeamView.empty(2).isNews(late))
    assert(!view.isNews(late))
    assert(!view.isNews(later))
    assert(view.isNews(reading(0, 3, 111, 90, 160)))
    assert(view.isNews(reading(0, 3, 50, 131, 160)), "a simulator that was started again")

  test(
    "a late answer from before the simulator's restart is not news, and does not move the clocks' estimate"
  ):
    val next = reading(0, 3, 20, 200, 230)
    val view = TeamView.empty(2).withReading(later).withReading(next)
    assert(!view.isNews(reading(0, 2, 170, 160, 240)), "by its clock alone it would be")
    assert(view.isNews(reading(1, 2, 170, 160, 240)), "of another vehicle nothing newer is held")
    assertEquals(view.withReading(reading(1, 2, 170, 160, 240)).alignment, view.alignment)
    val held = reading(0, 3, 20, 200, 230).state.map(_ => Vector(1.0))
    val said = view.withSensorReading(SensorReading(0, "gps", 3, Vector("x"), held))
    val old  =
      SensorReading(0, "gps", 2, Vector("x"), reading(0, 2, 170, 160, 240).state.map(_ => Vector(0.0)))
    assertEquals(said.withSensorReading(old), said)

  test("a vehicle's state is its reading or estimate, and its heading the last commanded one"):
    val fleet = PaperDuel().fleet
    val view  = TeamView.empty(2).withReading(first).withReading(other)
    assertEquals(view.kinematics(0), first.state.value)
    assert(view.isComplete && !TeamView.empty(2).withReading(first).isComplete)
    assertEquals(view.headingRad(1, fleet), fleet.agents(1).startHeading.value)
    val estimate = skein.forecast.Estimate(later.state.value, millis(0), millis(1))
    assertEquals(view.copy(estimates = Some(Vector(estimate, estimate))).kinematics(0), later.state.value)

  test("a sensor's late answer never overrides a newer one of that sensor"):
    def sensed(sensor: String, sequence: Long, validMs: Double) = SensorReading(
      0,
      sensor,
      sequence,
      Vector("x"),
      Stamped(Vector(sequence.toDouble), millis(validMs), millis(validMs - 10), millis(validMs + 10))
    )
    val view = TeamView.empty(2).withSensorReading(sensed("gps", 2, 100))
    val held = view.withSensorReading(sensed("gps", 1, 50)).withSensorReading(sensed("imu", 3, 20))
    assertEquals(
      held.sensed(0).map((name, reading) => name -> reading.sequence),
      Map("gps" -> 2L, "imu" -> 3L)
    )
    assertEquals(held.withSensorReading(sensed("gps", 4, 101)).sensed(0)("gps").sequence, 4L)
    assertEquals(held.sensed(1), Map.empty)

  test("a late reading is dropped and recorded, and the decision uses the newer one"):
    val (requests, stale) = seen(
      LoopEvent.Read(first),
      LoopEvent.Read(other),
      LoopEvent.Read(later),
      LoopEvent.Read(late),
      LoopEvent.Due(Set(0, 1))
    )
    assertEquals(requests.map(_.view.readings), Vector(Vector(Some(later), Some(other))))
    assertEquals(requests.map(_.deciders), Vector(Set(0, 1)))
    assertEquals(stale, Vector("reading 2 is stale"))

  test("no decision is made before every vehicle was read"):
    assertEquals(seen(LoopEvent.Read(first), LoopEvent.Due(Set(0, 1)))._1, Vector.empty)
    assertEquals(seen(LoopEvent.Seen(Vector(first), Set(0)))._1, Vector.empty)
    assertEquals(seen(LoopEvent.Seen(Vector(first, other), Set(1)))._1.map(_.deciders), Vector(Set(1)))

  test("while the team is paused there are no decisions, and readings still update the view"):
    val held = seenBy(_.hold.hold(): Unit)(
      LoopEvent.Read(first),
      LoopEvent.Read(other),
      LoopEvent.Due(Set(0, 1))
    )
    assertEquals(held._1, Vector.empty)

  test("elements that pass a part are counted, with the age of their oldest reading"):
    var meter = Option.empty[StageMeter]
    val _     = seenBy(team => meter = Some(team.meters("view")))(
      LoopEvent.Read(first),
      LoopEvent.Read(other),
      LoopEvent.Due(Set(0, 1)),
      LoopEvent.Due(Set(0, 1))
    )
    assertEquals(meter.map(_.passed), Some(2L))
    val one = StageMeters()("decide(Evader)")
    one.pass()
    assertEquals((one.passed, one.age), (1L, None))
    one.pass(Some(Span.ofMillis(30)))
    one.pass(None)
    assertEquals((one.passed, one.age), (3L, Some(Span.ofMillis(30))))
    one.called()
    one.called()
    one.answered()
    assertEquals((one.unanswered, one.entered), (1L, 0L))

  test(
    "a forecast learns of sent, replaced and failed commands; a move that ran to its end changes nothing"
  ):
    import scala.util.{Failure, Success}
    val pursuer  = Decider(PaperDuel().fleet, 1)
    val view     = TeamView.empty(2).withReading(first).withReading(other)
    val decision = pursuer.decide(pursuer.start, view, millis(200))._2
    def ended(result: scala.util.Try[Either[VehicleError, Boolean]]) =
      SteeringEvent(1, skein.flow.Steered.Ended(decision, millis(400), result))
    val told = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        Source(
          Vector(
            SteeringEvent(1, skein.flow.Steered.Sent(decision, millis(210))),
            ended(Success(Right(true))),
            ended(Success(Right(false))),
            ended(Success(Left(VehicleError.TimedOut("lost")))),
            ended(Failure(IllegalStateException("gone")))
          )
        ).via(silent(system).told).runWith(Sink.seq)
      .value
    assertEquals(
      told,
      Seq(
        LoopEvent.Moved(decision.move(millis(210))),
        LoopEvent.Heard(ForecastEvent.Replaced(1, 0, millis(400))),
        LoopEvent.Heard(ForecastEvent.Failed(1, 0)),
        LoopEvent.Heard(ForecastEvent.Failed(1, 0))
      )
    )

  test("a command that arrives while the team is paused is not sent, and the event states that"):
    val pursuer  = Decider(PaperDuel().fleet, 1)
    val view     = TeamView.empty(2).withReading(first).withReading(other)
    val decision = pursuer.decide(pursuer.start, view, millis(200))._2
    val noted    = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val recorder           = MemoryRecorder(Samples.heading)
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val team = Team(PaperDuel().fleet, Vector(Silent, Silent), clock, recorder, LoopSettings())
        team.hold.hold(): Unit
        val _ = Source.single(decision).concat(Source.maybe).via(team.steer(1)).runWith(Sink.ignore)
        org.apache.pekko.pattern
          .after(Span.ofMillis(10).toDuration)(Future.unit)
          .map(_ => recorder.recording.events.map(event => (event.kind, event.detail)))
      .value
    assertEquals(noted, Vector(EventKind.Dropped -> "command 0 not sent while the flight is paused"))

  test("all vehicles are due to decide once a period, midway between two requests"):
    val due = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val start              = clock.now()
        val recorder           = MemoryRecorder(Samples.heading)
        val team = Team(PaperDuel().fleet, Vector(Silent, Silent), clock, recorder, LoopSettings())
        team.due(
          start
        ).map(event => (event, clock.now().since(start).toMillis.round)).take(3).runWith(Sink.seq)
      .value
    assertEquals(due, Seq(50L, 150L, 250L).map(ms => (LoopEvent.Due(Set(0, 1)), ms)))
