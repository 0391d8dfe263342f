package skein.loop

import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success, Try}
import skein.policy.*
import skein.port.{Sensor, VehicleError}
import skein.record.*
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** The records of a team's events. */
class TeamLogSuite extends munit.FunSuite:
  private val now = Instant.Epoch + Span.ofSeconds(5)

  private final class Books(fleet: Fleet):
    private val deciders = fleet.agents.indices.map(Decider(fleet, _))
    private val memory   = MemoryRecorder(Samples.heading)
    val log: TeamLog     = TeamLog(fleet, deciders, Clock.ofNanos(() => now.toNanos), memory)
    def recording        = memory.recording

    val view: TeamView = fleet.agents.indices.foldLeft(TeamView.empty(fleet.agents.size)): (view, vehicle) =>
      val at    = Vector3(10.0 * vehicle, 0, -20)
      val state = Kinematics(at, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
      view.withReading(Reading(vehicle, 70L + vehicle, Stamped(state, now, now, now)))

    def decision(vehicle: Int): Decision =
      deciders(vehicle).decide(deciders(vehicle).start, view, now)._2

  test("a command is recorded as done, superseded, or failed with the reason"):
    import CommandOutcome.*
    val ends = Seq[(Try[Either[VehicleError, Boolean]], CommandOutcome)](
      Success(Right(true))                                -> Done,
      Success(Right(false))                               -> Superseded,
      Success(Left(VehicleError.Refused("no such move"))) -> Failed("no such move"),
      Failure(IllegalStateException("gone"))              -> Failed("java.lang.IllegalStateException: gone")
    )
    for (result, told) <- ends do
      val books = Books(PaperDuel().fleet)
      books.log.ended(books.decision(1), now, result)
      assertEquals(books.recording.acknowledgements.map(_.outcome), Vector(told))

  test("every error is an event of its kind, with the failed call"):
    val kinds = Seq(
      VehicleError.TimedOut("x")    -> EventKind.TimedOut,
      VehicleError.Lost("x", true)  -> EventKind.Disconnected,
      VehicleError.Unreachable("x") -> EventKind.Disconnected,
      VehicleError.Overloaded("x")  -> EventKind.Overloaded,
      VehicleError.Cancelled("x")   -> EventKind.Cancelled,
      VehicleError.Refused("x")     -> EventKind.Refused,
      VehicleError.Malformed("x")   -> EventKind.Refused,
      VehicleError.Unsupported("x") -> EventKind.Refused
    )
    for (error, kind) <- kinds do
      val books = Books(PaperDuel().fleet)
      books.log.failed(0, "gps 3", error)
      books.log.unread(1, 4, error)
      assertEquals(
        books.recording.events.map(one => (one.kind, one.detail, one.about)),
        Vector((kind, "gps 3: x", None), (kind, "reading 4: x", Some(EventSubject.Reading)))
      )

  private object Together extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      (seen.along(seen.vehicles.indices.map(seen.northM).sum, 2), ())

  test(
    "decisions are recorded with the other vehicles seen, if the policy regards its team; a duel's are not"
  ):
    val duels = PaperDuel(pairs = 2).fleet
    val team  = Fleet(duels.agents.map(_.copy(policy = Together)))
    val books = Books(team)
    val made  = books.decision(1)
    books.log.decided(made)
    val others = team.agents.indices.filterNot(Set(1, made.opponent))
    assertEquals(
      books.recording.sightings.map(one => (one.decider, one.decision, one.vehicle, one.reading)),
      others.map(other => (team.agents(1).name, 0L, team.agents(other).name, 70L + other)).toVector
    )
    val duel = Books(duels)
    duel.log.decided(duel.decision(1))
    assertEquals((duel.recording.decisions.size, duel.recording.sightings), (1, Vector.empty))

  test("a decision is offered to the recorder before its rows exist; the writer makes them later"):
    val team     = Fleet(PaperDuel(pairs = 2).fleet.agents.map(_.copy(policy = Together)))
    val deciders = team.agents.indices.map(Decider(team, _))
    val taken    = Vector.newBuilder[Recordable]
    val recorder = new Recorder:
      def offer(record: Recordable): Unit               = taken += record
      val failure: Future[RecordError]                  = Future.never
      def close(): Future[Either[RecordError, Written]] = Future.never
    val books = Books(team)
    val made  = books.decision(1)
    TeamLog(team, deciders, Clock.ofNanos(() => now.toNanos), recorder).decided(made)
    books.log.decided(made)
    taken.result() match
      case Vector(decision: LaterDecision, _: LaterRow, _: LaterRow) =>
        assertEquals((decision.vehicle, decision.decidedAt), (team.agents(1).name, made.decidedAt))
        assert(decision.seesOthers)
        assertEquals(decision.readings, made.view.asRead(made.decidedAt))
        assertEquals(decision.readings.size, team.agents.size)
      case other => fail(s"expected a decision and two sightings to be made later, got $other")
    val rows = books.recording
    assertEquals(taken.result().map(_.row), (rows.decisions ++ rows.sightings).toVector)

  test("a sensor's answer with a missing or infinite number is recorded as an error"):
    given ExecutionContext    = ExecutionContext.parasitic
    val names                 = Vector("north", "east")
    def read(values: Double*) =
      val books  = Books(PaperDuel().fleet)
      val sensor = new Sensor:
        def columns: Vector[String]                                       = names
        def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] =
          Future.successful(Right(Stamped(IArray.from(values), now, now, now)))
      val answer = TeamSensor(0, "gps", sensor, books.log).read().value.get.get
      (answer.isRight, books.recording.measurements.size, books.recording.events.map(_.detail))
    assertEquals(read(1, 2), (true, 1, Vector.empty))
    for values <- Seq(Seq(1, Double.NaN), Seq(Double.PositiveInfinity, 2), Seq(1.0), Seq(1.0, 2.0, 3.0)) do
      val told = s"gps 0: expected north, east, got ${values.mkString(", ")}"
      assertEquals(read(values*), (false, 0, Vector(told)))
