package skein.link

import java.util.concurrent.atomic.LongAdder
import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Try}
import skein.signal.*
import skein.units.*
import skein.vtime.VirtualTime

/** In virtual time, where every delay is exact. */
class DelayLineSuite extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic
  private val lost               = TransportError.Lost(Address("server", 1), "the link broke")
  private val quarterSecond      = constant(500)

  private def constant(roundTripMs: Double): LatencyProfile =
    LatencyProfile.Steady("constant", LatencyDistribution.Constant(Span.ofMillis(roundTripMs)))

  private final class Line(
      val flow: Flow[ByteString, ByteString, Any],
      val ms: () => Double,
      val counts: LinkCounters
  )

  private def over[A](
      latency: LatencyProfile,
      faults: Faults = Faults.none,
      maxBytes: Int = 1_000_000,
      isDatagrams: Boolean = false,
      duplicates: Double = 0
  )(
      body: ActorSystem ?=> Line => Future[A]
  ): A =
    VirtualTime.run(1): system =>
      given ActorSystem      = system
      val clock              = VirtualClock(system)
      val start              = clock.now()
      def sinceStart         = clock.now().since(start)
      def open(opened: Span) =
        Delivery(
          LatencySampler(latency, 1, 2),
          faults.stalls(3),
          faults.breakOf(opened, 3),
          LongAdder(),
          isInOrder = !isDatagrams
        )
      val counts  = LinkCounters()
      val loss    = PacketLoss(latency, 5, 6)
      val packets =
        if isDatagrams then Packets.Datagrams(loss, duplicates, SplitMix64(7))
        else if loss.isAny then
          Packets.Tcp(loss, Retransmission.timeout(latency), Retransmission.overtaken(latency))
        else Packets.Whole
      val line = Flow.fromGraph(DelayLine(
        open,
        None,
        () => sinceStart,
        maxBytes,
        lost,
        counts,
        LongAdder(),
        packets = packets
      ))
      body(Line(line, () => sinceStart.toMillis, counts))
    .value

  private def text(bytes: String) = ByteString(bytes)

  private def every(ms: Int, count: Int): Source[ByteString, Any] =
    Source.tick(0.millis, ms.millis, ()).zipWithIndex.map((_, i) => text(s"$i;")).take(count)

  private def arrivals(source: Source[ByteString, Any], line: Line)(using
      ActorSystem
  ): Future[Seq[(String, Double)]] =
    source.via(line.flow).map(bytes => bytes.utf8String -> line.ms()).runWith(Sink.seq)

  test("bytes and the end come out after exactly the delay"):
    val (came, ended) = over(quarterSecond): line =>
      for came <- arrivals(every(100, 3), line) yield (came, line.ms())
    assertEquals(came, Seq("0;" -> 250.0, "1;" -> 350.0, "2;" -> 450.0))
    assertEquals(ended, 450.0)

  test("bytes keep their order, and those that are due together come out as one segment"):
    val came = over(LatencyProfile.vpn)(line => arrivals(every(1, 500), line))
    assertEquals(came.map(_._1).mkString, (0 until 500).map(i => s"$i;").mkString)
    assert(came.sizeIs < 250, came.size)
    assert(came.map(_._2).sliding(2).forall(pair => pair(0) < pair(1)))

  test("datagrams are not joined and have independent delays, so later ones overtake"):
    val sent                                = 500
    def delays(came: Seq[(String, Double)]) = came.map((text, ms) => ms - text.stripSuffix(";").toInt)
    val came = over(LatencyProfile.vpn, isDatagrams = true)(line => arrivals(every(1, sent), line))
    assertEquals(came.map(_._1).toSet, (0 until sent).map(i => s"$i;").toSet)
    assertEquals(came.size, sent)
    assertNotEquals(came.map(_._1).toVector, (0 until sent).map(i => s"$i;").toVector)
    assertEquals(came.map(_._2), came.map(_._2).sorted)
    // No message waits for an earlier one: the delays are those drawn from the profile.
    val inOrder = over(LatencyProfile.vpn)(line => arrivals(every(1, sent), line))
      .flatMap((text, ms) => text.split(';').map(_ -> ms))
    assert(delays(came).sum < 0.8 * delays(inOrder).sum, s"${delays(came).sum} ${delays(inOrder).sum}")

  test("a stall delays datagrams, too, except those due before it began"):
    val stalls = Faults(stallEvery = Some(Span.ofSeconds(1)), stallLasts = Span.ofMillis(500))
    val free   = over(LatencyProfile.vpn, isDatagrams = true)(line => arrivals(every(5, 800), line)).toMap
    val came   = over(LatencyProfile.vpn, stalls, isDatagrams = true)(line => arrivals(every(5, 800), line))
    val held   = came.filter((text, ms) => ms > free(text) + 1e-6)
    assert(held.size > 50 && held.size < 790, s"${held.size}")
    val during = stalls.stalls(3).take(50).toVector
    for (text, ms) <- came do
      assert(!during.exists(one => one.from.toMillis <= ms && ms < one.until.toMillis), s"$text at $ms")

  test("equal seeds give equal times, to the nanosecond"):
    def once = over(LatencyProfile.vpn)(line => arrivals(every(7, 300), line))
    assertEquals(once, once)

  test("a sender waits when the line is full"):
    val sentAt = over(quarterSecond, maxBytes = 6): line =>
      Source(1 to 6)
        .map(i => (line.ms(), text(s"$i;;")))
        .alsoTo(Sink.ignore)
        .map(_._2)
        .via(line.flow)
        .map(bytes => bytes.size -> line.ms())
        .runWith(Sink.seq)
    assertEquals(sentAt, Seq(6 -> 250.0, 6 -> 500.0, 6 -> 750.0))

  test("a receiver without demand delays its bytes, and no byte is lost"):
    val came = over(constant(20)): line =>
      every(10, 50)
        .via(line.flow)
        .throttle(1, 200.millis)
        .runFold("")(_ + _.utf8String)
    assertEquals(came, (0 until 50).map(i => s"$i;").mkString)

  test("a stall delays bytes and the end until it is over"):
    val faults = Faults(List(TimedFault(Span.ofMillis(300), Fault.Stall(Span.ofMillis(1000)))))
    val came   = over(quarterSecond, faults)(line => arrivals(every(100, 5), line))
    assertEquals(came, Seq("0;" -> 250.0, "1;2;3;4;" -> 1300.0))

  test("a reset fails both sides at its time, and counts bytes in transit as lost"):
    val faults = Faults(List(TimedFault(Span.ofMillis(420), Fault.Reset)))
    val (sender, senderAt, receiver, receiverAt, bytesLost) = over(quarterSecond, faults): line =>
      val (sending, receiving) = every(100, 100)
        .watchTermination()(Keep.right)
        .viaMat(line.flow)(Keep.left)
        .toMat(Sink.ignore)(Keep.both)
        .run()
      for
        s <- ended(sending, line)
        r <- ended(receiving, line)
      yield (s._1, s._2, r._1, r._2, line.counts.bytesLost.sum)
    assertEquals(sender, Failure(lost))
    assertEquals(receiver, Failure(lost))
    assertEquals((senderAt, receiverAt), (420.0, 420.0))
    assertEquals(bytesLost, 6L)

  private def ended(done: Future[Done], line: Line): Future[(Try[Done], Double)] =
    done.transform(result => util.Success((result, line.ms())))

  test("bytes and the end are lost without a report until a silence is over"):
    val faults              = Faults(List(TimedFault(Span.ofMillis(300), Fault.Silence(Span.ofSeconds(9)))))
    val (came, failure, at) = over(quarterSecond, faults): line =>
      val came = StringBuilder()
      ended(every(100, 5).via(line.flow).runForeach(bytes => came ++= bytes.utf8String: Unit), line)
        .map((result, at) => (came.toString, result, at))
    assertEquals(came, "0;")
    assertEquals(failure, Failure(lost))
    assertEquals(at, 9300.0)

  test("a failure comes out after the delay, behind the bytes before it"):
    val failure            = RuntimeException("crash")
    val (came, result, at) = over(quarterSecond): line =>
      val came   = StringBuilder()
      val source = every(100, 3).map(bytes => if bytes == text("2;") then throw failure else bytes)
      ended(source.via(line.flow).runForeach(bytes => came ++= bytes.utf8String: Unit), line)
        .map((result, at) => (came.toString, result, at))
    assertEquals(came, "0;1;")
    assertEquals(result, Failure(failure))
    assertEquals(at, 450.0)

  test("a sender learns that its receiver failed one delay later"):
    val crash        = RuntimeException("crash")
    val (result, at) = over(quarterSecond): line =>
      val sending = every(100, 100)
        .watchTermination()(Keep.right)
        .via(line.flow)
        .to(Sink.foreach(_ => throw crash))
        .run()
      ended(sending, line)
    assertEquals(result, Failure(crash))
    assertEquals(at, 500.0)

  test("a receiver's cancellation is not reported to the sender, whose bytes are discarded"):
    val (result, at) = over(quarterSecond): line =>
      ended(every(100, 20).watchTermination()(Keep.right).via(line.flow).to(Sink.head).run(), line)
    assertEquals(result, util.Success(Done))
    assertEquals(at, 1900.0)

  /** An image each 400 ms and a byte each 10 ms over lines of 50 Mbit/s: the longest delay of a byte, ms. */
  private def longestDelayMs(image: Int, apart: Boolean): Double =
    VirtualTime.run(1): system =>
      given ActorSystem = system
      val clock         = VirtualClock(system)
      val start         = clock.now()
      def ms            = clock.now().since(start).toMillis
      val bottleneck    = Bottleneck(Bandwidth.ofBitsPerSecond(50_000_000))
      val counts        = LinkCounters()
      def line          = DelayLine(
        _ => Delivery(LatencySampler(constant(20), 1, 2), Iterator.empty, None, LongAdder()),
        Some(bottleneck),
        () => clock.now().since(start),
        4 << 20,
        lost,
        counts,
        LongAdder()
      )
      val images   = Source.tick(5.millis, 400.millis, ByteString(new Array[Byte](image))).take(5)
      val commands = Source.tick(0.millis, 10.millis, ByteString(1)).take(200)
      val arrived  = Flow[ByteString].mapConcat(_.filter(_ == 1)).map(_ => ms).toMat(Sink.seq)(Keep.right)
      val times    =
        if apart then
          val _ = images.via(line).to(Sink.ignore).run()
          commands.via(line).toMat(arrived)(Keep.right).run()
        else images.merge(commands).via(line).toMat(arrived)(Keep.right).run()
      times.map(_.zipWithIndex.map((at, i) => at - 10 * i).max)
    .value

  test("over a line with a rate, a command waits for images on its own connection, and little for others"):
    val image = 1280 * 720 * 3 // 442 ms at 50 Mbit/s
    assertEqualsDouble(longestDelayMs(0, apart = false), 10, 0.01)
    assert(longestDelayMs(image, apart = false) > 400)
    assert(longestDelayMs(image, apart = true) < 10 + 5 + 1)

  test("over a line with a rate no byte is lost or reordered, and the end is last"):
    val text = (0 until 2000).map(i => s"$i;").mkString
    val came = VirtualTime.run(1): system =>
      given ActorSystem = system
      val clock         = VirtualClock(system)
      val start         = clock.now()
      val narrow        = LatencyProfile.Limited("", constant(20), Bandwidth(1_000_000, 100))
      val link          = EmulatedLink(LinkProfile.symmetric(narrow), 1, clock)
      Source
        .single(ByteString(text))
        .via(link.connection(lost).join(Flow[ByteString]))
        .runFold("")(_ + _.utf8String)
        .map(came => (came, clock.now().since(start).toMillis, link.counts))
    .value
    assertEquals(came._1, text)
    // There and back again, each at 125 bytes a ms: the last piece goes back when all has arrived.
    assertEqualsDouble(came._2, 20 + text.length / 125.0 + 1500 / 125.0, 1500 / 125.0)
    assert(
      came._3.bytesHeldBack > 0 && came._3.longestWait >= Span.ofMillis(text.length / 125.0 - 1),
      came._3
    )

  private def profile(text: String) =
    LatencyProfile.parse(text, Left(_)).fold(error => fail(error.message), identity)

  private val lossy = profile("loss:10%,constant:100ms")

  test("TCP sends lost bytes again and keeps their order: nothing is missing"):
    val (came, counts) = over(lossy): line =>
      for came <- arrivals(every(20, 1000), line) yield (came, line.counts)
    assertEquals(came.map(_._1).mkString, (0 until 1000).map(i => s"$i;").mkString)
    assertEquals(counts.packetsLost.sum, counts.packetsSentAgain.sum)
    assert(counts.packetsLost.sum > 70 && counts.packetsLost.sum < 150, s"${counts.packetsLost.sum}")

  test("a lost packet that none follows is sent again after the timeout, and then after twice that"):
    // One packet every 30 s, so that each is alone: 50 ms under way, time-outs of 300 ms.
    val came   = over(profile("loss:15%,constant:100ms"))(line => arrivals(every(30_000, 500), line))
    val delays = came.map((text, ms) => (ms - 30_000 * text.stripSuffix(";").toInt).round)
    assertEquals(delays.distinct.sorted.take(3), Seq(50L, 350L, 950L))
    assertEqualsDouble(delays.count(_ == 50) / 500.0, 0.85, 0.05)

  test(
    "a lost packet that others follow is sent again after 1.25 round trips, or once one is acknowledged"
  ):
    val came  = over(lossy)(line => arrivals(every(20, 1000), line))
    val ms    = came.flatMap((text, at) => text.split(';').map(_.toInt -> at)).toMap
    val waits = (0 until 1000).map(i => (ms(i) - 20 * i).round)
    // Alone it would be 350 ms. Sent again after 125 ms; the next one's acknowledgement comes after 120.
    assert(waits.contains(175L), waits.distinct.sorted.toString)
    // Two in a row: the first is sent again after 140 ms, when the one behind both is acknowledged.
    assert(waits.contains(190L), waits.distinct.sorted.toString)
    // The next one waits behind.
    assert(waits.contains(155L), waits.distinct.sorted.toString)

  test("a large write is cut into packets, and the lost ones are sent again"):
    val bytes          = ByteString.fromArray(Array.tabulate(1_000_000)(_.toByte))
    val (came, counts) = over(lossy, maxBytes = 10_000_000): line =>
      for all <- Source.single(bytes).via(line.flow).runFold(ByteString.empty)(_ ++ _)
      yield (all, line.counts)
    assertEquals(came, bytes)
    assert(counts.packetsLost.sum > 40, s"${counts.packetsLost.sum}")

  test("bytes of TCP that an outage loses arrive with a repetition after its end"):
    val came = over(profile("outage:1s/10s,constant:100ms"))(line => arrivals(every(50, 2000), line))
    val gaps = came.map(_._2).sliding(2).map(pair => pair(1) - pair(0)).toVector
    assertEquals(came.map(_._1).mkString, (0 until 2000).map(i => s"$i;").mkString)
    // Sent at the outage's beginning and lost, again after 0.3, 0.9 and 2.1 s; after 4.5 s if another began.
    assert(gaps.max > 900 && gaps.max < 4600, s"${gaps.max}")
    assert(gaps.count(_ > 800) >= 5, s"${gaps.count(_ > 800)}")

  test("a lost datagram is gone, others are unaffected, and some arrive twice"):
    val (came, counts) = over(profile("loss:10%/3,constant:100ms"), isDatagrams = true, duplicates = 0.05):
      line =>
        for came <- arrivals(every(5, 2000), line) yield (came, line.counts)
    val ids = came.map((text, ms) => text.stripSuffix(";").toInt -> ms)
    assert(ids.forall((id, ms) => (ms - 5 * id - 50).abs < 1e-6))
    assertEquals(2000 - ids.map(_._1).distinct.size, counts.packetsLost.sum.toInt)
    assertEquals(ids.size - ids.map(_._1).distinct.size, counts.duplicates.sum.toInt)
    assertEqualsDouble(counts.packetsLost.sum.toDouble, 200, 80)
    assertEqualsDouble(counts.duplicates.sum.toDouble, 90, 40)
    assertEquals(counts.packetsSentAgain.sum, 0L)
    assert(counts.bytesLost.sum > 0)

  test("a late datagram is overtaken by those sent before its time; over TCP they wait for it"):
    def once(isDatagrams: Boolean) =
      over(profile("reorder:2%/12ms,constant:100ms"), isDatagrams = isDatagrams): line =>
        arrivals(every(5, 5000), line)
    val ids  = once(isDatagrams = true).map((text, ms) => text.stripSuffix(";").toInt -> ms)
    val late = ids.filter((id, ms) => (ms - 5 * id - 62).abs < 1e-6).map(_._1)
    assertEquals(ids.map(_._1).sorted, (0 until 5000).toVector)
    assert(ids.forall((id, ms) => late.contains(id) || (ms - 5 * id - 50).abs < 1e-6))
    assertEqualsDouble(late.size.toDouble, 100, 40)
    // RFC 4737: reordered is what arrives after one that was sent later.
    val reordered =
      ids.map(_._1).scanLeft(-1)(_.max(_)).zip(ids.map(_._1)).collect { case (most, id) if id < most => id }
    assertEquals(reordered, late)

    val stream = once(isDatagrams = false)
    assertEquals(stream.map(_._1).mkString, (0 until 5000).map(i => s"$i;").mkString)
    // Those sent 5 and 10 ms later come out with it.
    assert(stream.exists((text, _) => text.count(_ == ';') == 3), "nothing waited")

  test("also with losses, equal seeds give equal times, to the nanosecond"):
    def once = over(profile("loss:10%/3,outage:200ms/2s,vpn"))(line => arrivals(every(7, 1000), line))
    assertEquals(once, once)
