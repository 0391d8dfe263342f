package skein.cli

import java.security.SecureRandom
import java.time.LocalTime
import java.time.temporal.ChronoUnit
import java.util.concurrent.ConcurrentHashMap
import mainargs.{ParserForClass, arg}
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.dispatch.Dispatchers
import scala.concurrent.{ExecutionContext, Future, Promise}
import skein.cluster.BuildId
import skein.flight.{FlightAssembler, WarmUp}
import skein.kafka.{KafkaSolver, KafkaTopics}
import skein.link.{Address, BackgroundThread, ControlThreads, TcpTransport}
import skein.scenario.{ScenarioText, Scenarios}
import skein.settings.{PredictionModel, RecordedPlan, SolverChoice}
import skein.signal.LatencyProfile
import skein.solver.{Briefing, FlightDeciders, SolverDesk, SolverServer}
import skein.units.{Clock, Decimals, Expect}

/** Command-line options of `./skein decide`, with their help texts. */
final case class DecideOptions(
    @arg(doc =
      "address at which flights ask, which they name with --solver: tcp://HOST:PORT of " +
        "this machine, or kafka://HOST:PORT/PREFIX of a broker"
    )
    at: String = "tcp://127.0.0.1:7400",
    @arg(doc = "decides for flights of this scenario alone; without it, of every one that this program has")
    scenario: Option[String],
    secured: SolverSecurity
)

/** `./skein decide`: the solver, which decides for flights of other processes. */
final class DecideCommand(using scenarios: Scenarios)
    extends Command[DecideOptions](
      "decide",
      "decides for flights of other processes: ./skein fly --solver",
      ParserForClass[DecideOptions]
    ):

  protected def execute(options: DecideOptions): Either[String, Unit] =
    for
      at <-
        SolverChoice.parse(options.at, "tcp://HOST:PORT or kafka://HOST:PORT/PREFIX").left.map("--at: " + _)
      _ <- options.scenario.fold(Right(()))(name =>
        scenarios.kind(name).left.map("--scenario: " + _).map(_ => ())
      )
      secured <- options.secured.checked(Some(at))
      _       <- at match
        case SolverChoice.Kafka(at, prefix) =>
          Extra.Kafka.checked.left.map("--at: " + _)
            .flatMap(_ => served(options)(kafka(KafkaTopics(at, prefix)(secured.kafka))))
        case SolverChoice.Tcp(address) => served(options)(tcp(address, secured))
        case SolverChoice.Link(_)      =>
          Left(
            "--at: expected tcp://HOST:PORT, such as " +
              s"tcp://127.0.0.1:7400, or kafka://HOST:PORT/PREFIX, got ${options.at}"
          )
    yield ()

  /** A solver in service.
    *
    * @param failed fails when flights can no longer reach it
    */
  private final case class Served(close: () => Future[Done], failed: Future[Nothing] = Future.never)

  private type Serving = SolverDesk => ActorSystem ?=> Either[String, Served]

  private given ExecutionContext = ExecutionContext.global

  private def tcp(address: Address, secured: SolverSecurity.Checked): Serving = desk =>
    val transport = TcpTransport(certificates = secured.certificates)
    val server    = Edge.await(SolverServer.start(address, transport, desk, Clock.system))
    Console.out.println(s"decides at tcp://${server.address}; Ctrl-C ends it")
    Right(Served(() => server.close()))

  private def kafka(topics: KafkaTopics): Serving = desk =>
    val solver = KafkaSolver(topics, desk, say)
    say(s"looks for the broker at ${topics.broker}")
    val failed = solver.start().flatMap: _ =>
      Console.out.println(s"decides at kafka://${topics.broker}/${topics.prefix}; Ctrl-C ends it")
      Future.never
    Right(Served(() => solver.close().map(_ => Done), failed))

  private def served(options: DecideOptions)(serving: Serving): Either[String, Unit] =
    Edge.withSystem("skein-decide"): system ?=>
      val warm = ConcurrentHashMap[String, Boolean]()
      val desk = SolverDesk(
        SecureRandom().nextLong(),
        BuildId.current,
        briefing => decidersOf(briefing, options.scenario, warm),
        Clock.system,
        system.dispatchers.lookup(Dispatchers.DefaultBlockingDispatcherId),
        told = say
      )
      serving(desk).flatMap: served =>
        val ended = Promise[Either[String, Unit]]()
        served.failed.failed.foreach(error => ended.trySuccess(Left(error.getMessage)))
        val end =
          Edge.untilInterrupted(() => ended.trySuccess(Right(())): Unit)(Edge.await(ended.future))
        Edge.await(served.close()): Unit
        desk.close()
        val stats = desk.stats
        say(
          s"answered ${stats.answered} questions; refused " +
            s"${stats.refused} flights; ${stats.garbled} messages could not be read"
        )
        end

  private def decidersOf(
      briefing: Briefing,
      only: Option[String],
      warm: ConcurrentHashMap[String, Boolean]
  ): Either[String, FlightDeciders] =
    for
      plan <- Briefing.plan(briefing)
      name = plan.settings.scenario.name
      _ <- Expect.that(only.map(ScenarioText.called).forall(_ == name)):
        s"this solver decides for ${only.map(ScenarioText.called).mkString} alone, the flight flies $name"
      _ = // Flights that connect meanwhile wait for it, too.
        warm.computeIfAbsent(
          s"$name ${briefing.loop} ${PredictionModel.text(plan.settings.predictor)}",
          _ =>
            warmUp(plan)
            true
        )
      deciders <- FlightDeciders.of(plan, FlightAssembler.threads)
    yield deciders

  /** Makes decisions before the first flight, so that the flight's first decisions do not wait for the JIT
    * compiler.
    */
  private def warmUp(plan: RecordedPlan): Unit =
    val alike = plan.settings.copy(
      links = List(LatencyProfile.direct),
      policies = plan.plan.policy.map(_.file).toList,
      solver = Some(SolverChoice.Link(LatencyProfile.direct))
    )
    WarmUp.fly(alike, WarmUp.Flights, Clock.system) match
      case Left(reason)   => say(s"not warmed up: $reason")
      case Right(flights) =>
        say(s"warmed up by ${Decimals.counted(flights, "virtual flight")}")
        BackgroundThread.compilersGiveWay(): Unit
        ControlThreads.lead(): Unit

  private def say(line: String): Unit =
    Console.out.println(s"${LocalTime.now().truncatedTo(ChronoUnit.SECONDS)} $line")
