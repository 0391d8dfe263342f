package skein.cli

import java.util.concurrent.CountDownLatch
import mainargs.{Flag, ParserForClass, arg}
import org.apache.pekko.stream.scaladsl.BidiFlow
import skein.buffer.{BufferCounts, SimulatorBuffer}
import skein.link.*
import skein.signal.{Bandwidth, Impairment, LatencyProfile}
import skein.units.{Clock, Decimals, Expect, Span}
import skein.units.Decimals.fixed

/** Command-line options of `./skein link`, with their help texts. */
final case class LinkOptions(
    @arg(doc = "where clients connect; 0.0.0.0 opens it to other machines")
    listen: String,
    @arg(doc = "the server behind the link")
    to: String,
    @arg(doc =
      "carries UDP datagrams instead of TCP; each has a delay of its own, " +
        "so a later one may arrive first"
    )
    udp: Flag,
    @arg(doc =
      "keeps a buffer of plans beside the simulator behind the link, for fly --plan-in-packet against AirSim: " +
        "performs each action at its moment by the simulator's own moves"
    )
    buffer: Flag,
    @arg(doc =
      "latency in both directions: none, direct, vpn, vpn-mixed, constant:200ms, uniform:10ms..40ms, " +
        "lognormal:36ms,0.3 or file:PATH; times are round trips; " +
        "before it correlated:250ms, keeps each for 250 ms on average, loss:5%, or loss:5%/4, loses packets, " +
        "in bursts of four, outage:1s/10s, everything for 1 s every 10 s, and reorder:2%/10ms, delays 2 % of " +
        "them by 10 ms more (default: direct)"
    )
    profile: Option[String],
    @arg(name = "to-server", doc = "latency towards the server, where it differs")
    toServer: Option[String],
    @arg(name = "to-client", doc = "latency towards the client, where it differs")
    toClient: Option[String],
    @arg(name = "stall-every", doc = "mean time between stalls, in which nothing arrives, for example 30s")
    stallEvery: Option[String],
    @arg(name = "stall-lasts", doc = "mean length of a stall (default: 1s)")
    stallLasts: Option[String],
    @arg(name = "reset-every", doc = "mean time between resets of all connections, for example 5min")
    resetEvery: Option[String],
    @arg(doc =
      "rate of each direction, shared by all connections, and the size of the queue " +
        "before it: 50mbit or 50mbit/64kB; without it, unlimited"
    )
    rate: Option[String],
    @arg(doc = "share of datagrams that come twice, for example 1%; with --udp")
    duplicate: Option[String],
    @arg(doc = "seed of every random choice")
    seed: Long = 1
)

/** `./skein link`: an emulated network between a client and a server. */
object LinkCommand
    extends Command[LinkOptions](
      "link",
      "puts an emulated network between any client and any server, unless they speak HTTP or TLS",
      ParserForClass[LinkOptions]
    ):

  protected def execute(options: LinkOptions): Either[String, Unit] =
    for
      listenAt <- Address.parse(options.listen).left.map("--listen: " + _)
      to       <- Address.parse(options.to).left.map("--to: " + _)
      _        <- Expect.that(!options.buffer.value || !options.udp.value)(
        "--buffer: expected without --udp, for a simulator that speaks AirSim's protocol over TCP"
      )
      profile <- profileOf(options)
      _       <- serve(listenAt, to, profile, options)
    yield ()

  private def profileOf(options: LinkOptions): Either[String, LinkProfile] =
    for
      _ <- Expect.that(options.profile.isEmpty || options.toServer.isEmpty || options.toClient.isEmpty)(
        "--profile: expected without --to-server or without --to-client, which name both directions already"
      )
      _ <- Expect.that(options.stallLasts.isEmpty || options.stallEvery.isDefined)(
        "--stall-lasts: expected with --stall-every, without which nothing stalls"
      )
      toServer   <- latency("--to-server", options.toServer, options)
      toClient   <- latency("--to-client", options.toClient, options)
      stallEvery <- every(options.stallEvery).left.map("--stall-every: " + _)
      stallLasts <- Span.parse(options.stallLasts.getOrElse("1s")).left.map("--stall-lasts: " + _)
      resetEvery <- every(options.resetEvery).left.map("--reset-every: " + _)
      faults = Faults(stallEvery = stallEvery, stallLasts = stallLasts, resetEvery = resetEvery)
      duplicates <- duplicates(options)
    yield LinkProfile(toServer, toClient, faults, duplicates = duplicates)

  private def duplicates(options: LinkOptions): Either[String, Double] = options.duplicate match
    case None                          => Right(0)
    case Some(_) if !options.udp.value => Left("--duplicate: expected with --udp; TCP discards duplicates")
    case Some(text)                    => Impairment.percent(text)
        .filter(share => share >= 0 && share <= 1)
        .toRight(s"--duplicate: expected a share from 0% to 100% such as 1%, got '$text'")

  private def latency(
      flag: String,
      own: Option[String],
      options: LinkOptions
  ): Either[String, LatencyProfile] =
    val (told, profile) = own.fold(("--profile", options.profile.getOrElse("direct")))((flag, _))
    for
      _       <- Expect.optional(options.rate)(Bandwidth.parse).left.map("--rate: " + _)
      limited <- Arguments
        .latency(options.rate.fold("")(rate => s"rate:$rate,") + profile)
        .left
        .map(s"$told: " + _)
    yield limited

  private def every(text: Option[String]): Either[String, Option[Span]] = Expect.optional(text): text =>
    Span.parse(text).filterOrElse(_ > Span.Zero, s"expected more than 0, got '$text'")

  private def serve(
      listenAt: Address,
      to: Address,
      profile: LinkProfile,
      options: LinkOptions
  ): Either[String, Unit] =
    def warn(reason: Throwable) = Console.err.println(s"skein link: ${reason.getMessage}")
    Edge.withSystem("skein"):
      val link      = EmulatedLink(profile, options.seed, Clock.system)
      val isUdp     = options.udp.value
      val transport = if isUdp then UdpTransport() else TcpTransport()
      val buffer    = Option.when(options.buffer.value)(
        SimulatorBuffer.start(to, transport, Clock.system, lost => Console.err.println(s"skein link: $lost"))
      )
      val proxy = Edge.await(LinkProxy.start(
        listenAt,
        to,
        link,
        transport,
        unreachable = warn,
        isDatagrams = isUdp,
        beside = () => buffer.fold[LinkProxy.Passing](BidiFlow.identity)(_.passing())
      ))
      Console.out.println(
        s"${if isUdp then "UDP " else ""}${proxy.address} leads to $to, ${described(profile)}" +
          s"${if buffer.isDefined then ", with a buffer of plans there" else ""}; Ctrl-C ends it"
      )
      val stopped = CountDownLatch(1)
      Edge.untilInterrupted(() => stopped.countDown(), GraceMillis):
        stopped.await()
        Edge.await(proxy.close()): Unit
        Console.out.println(summary(proxy.counts, isUdp))
        buffer.foreach(beside => Console.out.println(summary(beside.counts)))
      Right(())

  /** Time within which the command ends, even if bytes are still on the link. */
  private val GraceMillis = 2_000L

  private def described(profile: LinkProfile): String =
    if profile.toServer == profile.toClient then s"${profile.toServer.name} in both directions"
    else s"${profile.toServer.name} to the server, ${profile.toClient.name} to the client"

  private def summary(counts: LinkCounts, isUdp: Boolean): String =
    val packets =
      if isUdp then
        s"${Decimals.counted(counts.packetsLost, "datagram")} lost, ${counts.duplicates} duplicated"
      else
        s"${Decimals.counted(counts.packetsLost, "packet")} lost, ${counts.packetsSentAgain} sent again"
    s"${Decimals.counted(counts.connections, "connection")}, ${counts.bytesToServer} bytes to the server, " +
      s"${counts.bytesToClient} bytes to the client, ${counts.bytesLost} bytes lost, " +
      s"${counts.stalls} stalls, ${counts.disconnects} disconnects, ${counts.bytesHeldBack} " +
      s"bytes waited at their sender, at most ${counts.longestWait.toMillis.round} ms to be sent; $packets"

  private def summary(counts: BufferCounts): String =
    import counts.*
    s"${Decimals.counted(plans, "plan")} taken, $stalePlans late or again, $refusedPlans refused; " +
      s"${Decimals.counted(moves, "move")}, $failedMoves failed, at most ${latest.toMillis.fixed(1)} ms after " +
      s"their moments; ${Decimals.counted(heldCalls, "call")} waited for the buffer's moves, " +
      s"${Decimals.counted(lostConnections, "connection")} not understood"
