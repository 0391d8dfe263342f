package skein.cli

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Future, blocking}
import skein.cluster.BuildId
import skein.flight.{FlightResult, Solvers}
import skein.kafka.{KafkaLink, KafkaTopics}
import skein.link.{Address, TcpTransport, TlsProbe}
import skein.settings.{FlightPlan, FlySettings, SolverChoice}
import skein.solver.TcpLink
import skein.units.Decimals.fixed

/** Interprets `--solver` for the commands that run flights. */
private[cli] object SolverOptions:

  /** Checks that a solver in virtual time is behind a link. */
  def virtual(settings: FlySettings): Either[String, Unit] = settings.solver match
    case None | Some(SolverChoice.Link(_)) => Right(())
    case Some(other)                       =>
      Left(s"--solver ${other.text}: in virtual time expected link:PROFILE, such as link:lognormal:4ms,0.5")

  /** Checks that a solver in real time is another process. */
  def real(settings: FlySettings): Either[String, Unit] = settings.solver match
    case Some(choice: SolverChoice.Link) =>
      Left(
        s"--solver ${choice.text} is for --clock virtual; expected " +
          "tcp://HOST:PORT or kafka://HOST:PORT/PREFIX of ./skein decide"
      )
    case Some(choice: SolverChoice.Kafka) => Extra.Kafka.checked.left.map(s"--solver ${choice.text}: " + _)
    case _                                => Right(())

  /** Connects to any kind of solver of a flight in real time. Only this needs the build's name, which takes a
    * while to compute.
    */
  def reached(settings: FlySettings, secured: SolverSecurity.Checked)(using ActorSystem): Solvers =
    if settings.solver.isEmpty then Solvers.none else reachedBy(BuildId.current, secured)

  private def reachedBy(build: String, secured: SolverSecurity.Checked)(using ActorSystem): Solvers = Solvers(
    build,
    {
      case SolverChoice.Tcp(at) =>
        val transport = TcpTransport(certificates = secured.certificates)
        Right(
          if secured.certificates.isDefined then TcpLink(transport, at, () => lacksTls(at), HasTls)
          else TcpLink(transport, at, () => wantsTls(at))
        )
      case SolverChoice.Kafka(broker, prefix) => Right(KafkaLink(KafkaTopics(broker, prefix)(secured.kafka)))
      case SolverChoice.Link(_)               => Left("a link of a profile is for --clock virtual")
    }
  )

  /** Explains why a solver closes a connection without certificates, if it requires them. */
  private[cli] def wantsTls(at: Address)(using ActorSystem): Future[Option[String]] =
    found(
      TlsProbe.answers(at)
    )(s"the solver at $at asks for certificates; expected --tls FOLDER with this machine's")

  /** Explains why a solver closes a connection with certificates, if it does not use TLS. */
  private[cli] def lacksTls(at: Address)(using ActorSystem): Future[Option[String]] =
    found(
      TlsProbe.isRefused(at)
    )(s"the solver at $at does not speak TLS; expected ./skein decide with --tls there, too")

  private def found(is: => Boolean)(reason: String)(using system: ActorSystem): Future[Option[String]] =
    Future(Option.when(blocking(is))(reason))(using system.dispatcher)

  private[cli] val HasTls = "; has ./skein decide there --tls, too?"

  /** Plans of virtual twins, whose solver is behind a link like that of the flight: its median, and its
    * spread by a lognormal distribution.
    */
  def twins(flown: FlightResult, count: Int): Vector[FlightPlan] =
    flown.plan.twins(count).flatMap: plan =>
      plan.solver match
        case None    => Some(plan)
        case Some(_) =>
          measured(flown.solverTrips.map(_.toMillis)).map(link => plan.copy(solver = Some(link)))

  private[cli] def measured(tripsMs: Vector[Double]): Option[SolverChoice] =
    val logs = tripsMs.filter(_ > 0).map(math.log).sorted
    Option.when(logs.nonEmpty):
      val mean   = logs.sum / logs.size
      val spread = math.sqrt(logs.map(log => (log - mean) * (log - mean)).sum / logs.size).min(3)
      SolverChoice
        .parse(s"link:lognormal:${math.exp(logs(logs.size / 2)).fixed(3)}ms,${spread.fixed(3)}")
        .toOption
    .flatten
