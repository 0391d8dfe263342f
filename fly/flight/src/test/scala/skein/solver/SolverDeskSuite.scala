package skein.solver

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.loop.{LoopKind, Memory, TeamView}
import skein.scenario.{PaperDuel, Surround}
import skein.units.*
import skein.vtime.VirtualTime

class SolverDeskSuite extends munit.FunSuite:
  private val fleet = PaperDuel().fleet
  private val hello = Briefing(
    "duel",
    LoopKind.Stream.label,
    1,
    Span.ofMillis(100),
    Span.ofSeconds(1),
    Vector.empty,
    Briefing.agents(fleet)
  )

  /** Work that runs when a test says so. */
  private final class Held extends ExecutionContext:
    private var waits                            = Vector.empty[Runnable]
    def execute(work: Runnable): Unit            = waits :+= work
    def reportFailure(cause: Throwable): Nothing = throw cause
    def run(): Unit                              =
      while waits.nonEmpty do
        val next = waits.head
        waits = waits.tail
        next.run()

  /** A desk's replies, and whether the message was useful. */
  private final class Trial(workers: ExecutionContext)(using ActorSystem):
    private var replies = Vector.empty[SolverMessage]
    val desk            =
      SolverDesk(7, "ours", _ => Right(FlightDeciders(fleet)), () => Instant.Epoch, workers)

    def bytes(all: Array[Byte]*): Either[String, Boolean] =
      desk.received(all, reply => replies :+= SolverMessageCodec.message(reply).fold(fail(_), identity))

    def say(message: SolverMessage): (Either[String, Boolean], Vector[SolverMessage]) =
      val before = replies.size
      (bytes(SolverMessageCodec.bytes(message)), replies.drop(before))

    def greet(flight: Long, build: String = "ours", briefing: Briefing = hello) =
      say(SolverMessage.Hello(flight, build, briefing))

    def ask(flight: Long, number: Long, vehicle: Int = 0, vehicles: Int = 2) =
      val deciders = Vector((vehicle = vehicle, memory = Memory(0, None, 0)))
      val view     = TeamView.empty(vehicles)
      say(SolverMessage.Ask(Question(flight, deciders, number, Instant.Epoch, None, None, view)))

    def saidSince(before: Int): Vector[SolverMessage] = replies.drop(before)
    def said: Int                                     = replies.size

  private def on[A](workers: ExecutionContext = ExecutionContext.parasitic)(body: Trial => A): A =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        Future.successful(body(Trial(workers)))
      .value

  private def welcome(flight: Long) = SolverMessage.Welcome(flight, 7)

  test("a flight is welcomed at each hello, and its requests are answered until its end"):
    on(): trial =>
      for _ <- 1 to 2 do assertEquals(trial.greet(5), (Right(true), Vector(welcome(5))))
      val (isOfUse, replies)                 = trial.ask(5, 0)
      val Vector(SolverMessage.Tell(answer)) = replies: @unchecked
      assertEquals(isOfUse, Right(true))
      assertEquals((answer.flight, answer.number, answer.solver), (5L, 0L, 7L))
      assertEquals(answer.result, Left("not every vehicle was seen"))
      assertEquals(trial.say(SolverMessage.Goodbye(5)), (Right(false), Vector.empty))
      assertEquals(trial.ask(5, 1), (Right(false), Vector(SolverMessage.Unknown(5))))

  test("a flight of another build, or with another fleet, is refused with the difference"):
    on(): trial =>
      assertEquals(
        trial.greet(5, build = "theirs"),
        (
          Right(false),
          Vector(SolverMessage.Refused(
            5,
            "this solver is build ours, the flight's program is build theirs; start both from the same program"
          ))
        )
      )
      val others = hello.copy(agents = Briefing.agents(Surround().fleet))
      val told   = trial.greet(6, briefing = others)._2
      val reason = told.collect { case SolverMessage.Refused(6, reason) => reason }
      assert(clue(reason).exists(_.startsWith("the scenario is another here: the flight has ")))
      assertEquals(trial.desk.stats.flights, 0)

  test("beyond the limit of flights, the one silent for the longest time is removed"):
    on(): trial =>
      val flights = 1L to SolverDesk.MostFlights
      flights.foreach(trial.greet(_))
      for flight <- flights.reverse do trial.ask(flight, 0)
      assertEquals(trial.greet(99)._2, Vector(welcome(99)))
      assertEquals(trial.desk.stats.flights, SolverDesk.MostFlights)
      assertEquals(trial.ask(flights.last, 1)._2, Vector(SolverMessage.Unknown(flights.last)))
      assert(trial.ask(flights.head, 1)._2.head.isInstanceOf[SolverMessage.Tell])

  test(
    "as many flights as may run are prepared simultaneously, each once; a further flight repeats its hello"
  ):
    val workers = Held()
    on(workers): trial =>
      val flights = 1L to SolverDesk.MostFlights
      for flight <- flights do assertEquals(trial.greet(flight), (Right(true), Vector.empty))
      assertEquals(trial.greet(99), (Right(false), Vector.empty))
      assertEquals(trial.greet(1), (Right(true), Vector(SolverMessage.Preparing(1))))
      val before = trial.said
      workers.run()
      assertEquals(trial.saidSince(before), flights.map(welcome).toVector)
      assertEquals(trial.greet(99), (Right(true), Vector.empty))
      workers.run()
      assertEquals(trial.saidSince(before).last, welcome(99))

  test("answers, refusals and invalid messages are counted"):
    on(): trial =>
      trial.greet(1): Unit
      for number <- 0 until 3 do trial.ask(1, number)
      for _ <- 1 to 2 do trial.greet(2, build = "theirs")
      assert(trial.bytes(Array[Byte](1), Array[Byte](2)).isLeft)
      assertEquals(trial.ask(1, 3, vehicles = 3), (Right(false), Vector.empty))
      val stats = trial.desk.stats
      assertEquals((stats.flights, stats.answered, stats.refused, stats.garbled), (1, 3L, 2L, 3L))
