package skein.cli

import mainargs.{Flag, ParserForClass, arg}
import org.apache.pekko.stream.scaladsl.Sink
import scala.concurrent.Future
import scala.util.{Failure, Success, Try}
import skein.airsim.{AirSimClient, AirSimError}
import skein.figures.{FlightTheme, LatencyFigure}
import skein.link.*
import skein.measure.Distribution
import skein.report.{Section, TextHistogram, TextTable}
import skein.rpc.RpcClient
import skein.signal.LatencyProfile
import skein.units.Decimals.fixed
import skein.units.{Clock, Expect, Span}

/** Command-line options of `./skein latency`, with their help texts. */
final case class LatencyOptions(
    @arg(doc = "the simulator")
    simulator: String = "127.0.0.1:41451",
    @arg(doc = "an emulated link between this command and the simulator: direct, vpn, constant:200ms, …")
    link: String = "none",
    @arg(doc = "pings to send")
    samples: Int = 200,
    @arg(doc = "from one ping to the next, whether or not it was answered")
    period: String = "100ms",
    @arg(doc = "seed of every random choice")
    seed: Long = 1,
    @arg(doc = "folder for latency.svg and latency.png")
    out: String = "latency",
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein latency`: measures round trips to a simulator. */
object LatencyCommand
    extends Command[LatencyOptions](
      "latency",
      "measures round trips to a simulator and draws their histogram, the paper's Figure 3",
      ParserForClass[LatencyOptions]
    ):
  private val probabilities = Vector(0, 1, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 99, 100)

  protected def execute(options: LatencyOptions): Either[String, Unit] =
    for
      simulator <- Address.parse(options.simulator).left.map("--simulator: " + _)
      profile   <- Arguments.latency(options.link).left.map("--link: " + _)
      period    <- Span.parse(options.period).left.map("--period: " + _)
      _         <- Expect.that(period > Span.Zero)(s"--period: expected more than 0, got ${options.period}")
      _      <- Expect.that(options.samples > 0)(s"--samples: expected more than 0, got ${options.samples}")
      folder <- OutFolder.made("--out", options.out)
      link = EmulatedLink(LinkProfile.symmetric(profile), options.seed, Clock.system)
      answers <- measure(simulator, link, period, options.samples)
      failures   = answers.collect { case Failure(reason) => reason.getMessage }
      roundTrips = answers.collect { case Success(roundTrip) => roundTrip.toMillis }
      samples <- Distribution.of(roundTrips).toRight(s"no ping was answered: ${failures.mkString("; ")}")
      isDirect = link.profile == LinkProfile.none
      title    = s"to $simulator" + (if isDirect then "" else s", ${FlightTheme.link(profile.name)}")
      drawing <-
        LatencyFigure(Seq(LatencyFigure.Measured(title, profile.name, samples))).toRight("nothing to draw")
      files <- OutFolder.write(folder, OutFolder.picture("latency", drawing, s"Round trips to $simulator"))
    yield
      val shown = Shown(options.json.value)
      val table = quantileTable(profile, samples)
      shown.tables(Seq(Section("Round trips", table = Some(table))), text(table, samples, failures))
      shown.say(s"\npictures: ${files.mkString(", ")}")

  private def measure(
      simulator: Address,
      link: EmulatedLink,
      period: Span,
      samples: Int
  ): Either[String, Seq[Try[Span]]] =
    Edge.withSystem("skein"): system ?=>
      import system.dispatcher
      val transport           = TcpTransport()
      def client(at: Address) = AirSimClient(RpcClient(transport, at, Clock.system))
      def pings(at: Address)  =
        val pinged = client(at)
        def ping() = pinged.ping().map(_.fold(error => throw NoAnswer(error.message), identity))
        def measured(every: Span, count: Int) =
          LatencyProbe.roundTrips(() => ping(), every, count, Clock.system).runWith(Sink.seq)
        for
          // Connects, and lets the just-in-time compiler do its work: these do not count.
          _ <- measured(Span.ofMillis(5), count = 200)
          _ = Console.err.println(f"$samples pings, one each ${period.toMillis}%.0f ms")
          answers <- measured(period, samples)
        yield Right(answers)
      val first   = AirSimClient(RpcClient(transport, simulator, Clock.system), AirSimError.FirstWithin)
      val answers = first.ping().flatMap:
        case Left(error) => Future.successful(Left(AirSimError.ofFirst(error, simulator)))
        case Right(_) if link.profile == LinkProfile.none => pings(simulator)
        case Right(_)                                     =>
          LinkProxy.start(Address("127.0.0.1", 0), simulator, link, transport).flatMap(proxy =>
            pings(proxy.address)
          )
      Edge.await(answers)

  private final class NoAnswer(reason: String) extends RuntimeException(reason)

  /** Measured quantiles, and those of the link's profile. */
  private def quantileTable(profile: LatencyProfile, samples: Distribution): TextTable =
    val measured = "measured, ms" +: quantiles(samples.quantile)
    val expected = Some(expectedOf(profile)).collect:
      case LatencyProfile.Steady(name, roundTrip) if name != LatencyProfile.none.name =>
        s"$name, ms" +: quantiles(roundTrip.quantile(_).toMillis)
    TextTable("<quantile, %" +: probabilities.map(_.toString), measured +: expected.toVector)

  /** The distribution of round trips without load, loss and correlation. */
  private def expectedOf(profile: LatencyProfile): LatencyProfile = profile.delays match
    case LatencyProfile.Correlated(_, latency, _) => latency
    case other                                    => other

  private def text(table: TextTable, samples: Distribution, failures: Seq[String]): String =
    val lines = Vector(
      s"${samples.count} round trips: mean ${shown(samples.mean)} " +
        s"ms, standard deviation ${shown(samples.sd)} ms",
      "",
      table.render
    ) ++ Option.when(table.rows.size > 1)(
      "Each direction takes half of a round trip of the profile, drawn independently " +
        "unless the profile is correlated: independent halves spread less."
    ) ++ Vector("", TextHistogram(samples, "ms")) ++
      failures.headOption.map(first => s"\n${failures.size} pings failed, the first: $first")
    lines.mkString("\n")

  private def quantiles(at: Double => Double): Vector[String] = probabilities.map(p => shown(at(p / 100.0)))

  private def shown(ms: Double): String = ms.fixed(if ms < 10 then 2 else 1)
