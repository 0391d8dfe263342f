package skein.link

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.snapshot.MaterializerState
import org.apache.pekko.util.ByteString
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Failure, Success, Try}
import skein.signal.*
import skein.units.*
import skein.vtime.VirtualTime

/** In virtual time, where every delay is exact. */
class MemoryNetworkSuite extends munit.FunSuite:
  private given ExecutionContext = ExecutionContext.parasitic
  private val simulator          = Address("simulator", 41451)
  private val slow               = LinkProfile.symmetric(
    LatencyProfile.Steady("constant:100ms", LatencyDistribution.Constant(Span.ofMillis(100)))
  )

  private def ticks: Source[ByteString, Any] = Source.tick(0.millis, 10.millis, ByteString("x"))

  private final class World(val network: MemoryNetwork, val ms: () => Double)(using ActorSystem):
    val controller: Transport = network.host("controller")
    val server: Transport     = network.host("simulator")

    def serve(handler: Flow[ByteString, ByteString, Any], at: Address = simulator): Future[Listening] =
      server.listen(at).to(Sink.foreach(_.flow.join(handler).run(): Unit)).run()

    def ask(bytes: ByteString, to: Address = simulator): Future[ByteString] =
      Source.single(bytes).via(controller.connect(to)).runFold(ByteString.empty)(_ ++ _)

    def connected(): Future[Done] =
      Source.maybe[ByteString].viaMat(controller.connect(simulator))(Keep.right).to(Sink.ignore).run()

    /** Sends a byte each 10 ms until the connection ends. */
    def talk(): Future[Done] =
      Source.tick(
        0.millis,
        10.millis,
        ByteString("x")
      ).via(controller.connect(simulator)).runWith(Sink.ignore)

    def ended[A](future: Future[A]): Future[(Try[A], Double)] =
      future.transform(result => Success((result, ms())))

  private def in[A](plan: NetworkPlan, seed: Long = 1)(body: ActorSystem ?=> World => Future[A]): A =
    VirtualTime.run(1): system =>
      given ActorSystem = system
      val clock         = VirtualClock(system)
      val start         = clock.now()
      body(World(MemoryNetwork(plan, seed, clock), () => clock.now().since(start).toMillis))
    .value

  private def over(link: LinkProfile)      = NetworkPlan(link)
  private def at(ms: Double, fault: Fault) =
    NetworkFault(Where.Everywhere, TimedFault(Span.ofMillis(ms), fault))

  test("connecting takes a round trip, and so does each exchange"):
    val (connectedAt, answer, answeredAt) = in(over(slow)): world =>
      for
        _ <- world.serve(Flow[ByteString])
        (connected, answer) = Source
          .single(ByteString("geese"))
          .viaMat(world.controller.connect(simulator))(Keep.right)
          .toMat(Sink.fold(ByteString.empty)(_ ++ _))(Keep.both)
          .run()
        (_, connectedAt)     <- world.ended(connected)
        (answer, answeredAt) <- world.ended(answer)
      yield (connectedAt, answer, answeredAt)
    assertEquals(connectedAt, 100.0)
    assertEquals(answer, Success(ByteString("geese")))
    assertEquals(answeredAt, 200.0)

  test("a host reaches itself without delay"):
    val at = in(over(slow)): world =>
      for
        listening <- world.serve(Flow[ByteString], Address("127.0.0.1", 0))
        _ <- Source.single(ByteString("x")).via(world.server.connect(listening.address)).runWith(Sink.ignore)
      yield world.ms()
    assertEquals(at, 0.0)

  test("without a listener the client's attempt fails after a round trip"):
    val outcome = in(over(slow))(world => world.ended(world.ask(ByteString("x"))))
    assertEquals(outcome, (Failure(TransportError.NobodyListens(simulator)), 100.0))

  test("a host that does not exist is unknown"):
    val nowhere = Address("nowhere", 1)
    val outcome = in(over(slow))(world => world.ended(world.ask(ByteString("x"), nowhere)))
    assertEquals(outcome._1, Failure(TransportError.UnknownHost(nowhere)))

  test("a port is taken until its listener closes, and then refuses connections"):
    val (second, third, refused) = in(over(slow)): world =>
      for
        first   <- world.serve(Flow[ByteString])
        second  <- world.ended(world.serve(Flow[ByteString]))
        _       <- first.close()
        third   <- world.serve(Flow[ByteString])
        answer  <- world.ask(ByteString("x"))
        _       <- third.close()
        refused <- world.ended(world.ask(ByteString("x")))
      yield (second._1, answer, refused._1)
    assertEquals(second, Failure(TransportError.PortTaken(simulator)))
    assertEquals(third, ByteString("x"))
    assertEquals(refused, Failure(TransportError.NobodyListens(simulator)))

  test("a listener cannot take another host's address"):
    val foreign = Address("controller", 1)
    val outcome = in(over(slow))(world => world.ended(world.serve(Flow[ByteString], foreign)))
    assert(outcome._1.failed.get.isInstanceOf[TransportError.CannotListen], outcome)

  test("listeners on port 0 get free ports"):
    val ports = in(over(slow)): world =>
      for
        first  <- world.serve(Flow[ByteString], Address("simulator", 49153))
        second <- world.serve(Flow[ByteString], Address("simulator", 0))
        third  <- world.serve(Flow[ByteString], Address("simulator", 0))
      yield List(first, second, third).map(_.address.port)
    assertEquals(ports, List(49153, 49152, 49154))

  test("with a full backlog, a further attempt gets no answer"):
    val outcome = in(over(slow)): world =>
      val deaf =
        world.server.listen(simulator).to(Sink.fromGraph(Flow[Incoming].initialDelay(1.hour).to(Sink.ignore)))
      for
        _       <- deaf.run()
        _       <- Future.traverse(1 to 300)(_ => world.connected().recover(_ => Done))
        outcome <- world.ended(world.connected())
      yield outcome
    assertEquals(outcome._1, Failure(TransportError.NoAnswer(simulator, Span.ofSeconds(5))))
    assertEquals(outcome._2, 10_000.0) // 5 s after the crowd, which waited as long

  test("each direction closes separately"):
    val (heard, received) = in(over(slow)): world =>
      val received = Promise[ByteString]()
      val greets   = Flow.fromSinkAndSource(
        Sink.fold[
          ByteString,
          ByteString
        ](ByteString.empty)(_ ++ _).mapMaterializedValue(received.completeWith),
        Source.single(ByteString("hello"))
      )
      val toSend = Promise[ByteString]()
      for
        _     <- world.serve(greets)
        heard <- Source
          .future(toSend.future)
          .via(world.controller.connect(simulator))
          .runFold(ByteString.empty)(_ ++ _)
        _ = toSend.success(ByteString("after your end"))
        got <- received.future
      yield (heard, got)
    assertEquals(heard, ByteString("hello"))
    assertEquals(received, ByteString("after your end"))

  test("a failing side resets the connection, and the other learns it one delay later, in both directions"):
    val (client, clientAt, unsent) = in(over(slow)): world =>
      val failing = Flow.fromSinkAndSource(
        Sink.ignore,
        Source.tick(1.second, 1.second, ByteString("x")).map(_ => throw RuntimeException("crash"))
      )
      for
        _ <- world.serve(failing)
        (unsent, received) = Source
          .maybe[ByteString]
          .watchTermination()(Keep.right)
          .viaMat(world.controller.connect(simulator))(Keep.left)
          .toMat(Sink.ignore)(Keep.both)
          .run()
        (client, clientAt) <- world.ended(received)
        (unsent, _)        <- world.ended(unsent)
      yield (client, clientAt, unsent)
    val reset = TransportError.Lost(simulator, "reset by the other side")
    assertEquals(client, Failure(reset))
    assertEquals(clientAt, 1100.0) // accepted at 50 ms, failed at 1050 ms
    assertEquals(unsent, Failure(reset))

  test("a reset breaks open connections at its time, and new ones work"):
    val ((first, firstAt), again, counts) = in(over(slow).copy(faults = List(at(500, Fault.Reset)))): world =>
      for
        _      <- world.serve(Flow[ByteString])
        broken <- world.ended(world.talk())
        again  <- world.ask(ByteString("again"))
      yield (broken, again, world.network.counts("controller", "simulator"))
    assertEquals(first, Failure(TransportError.Lost(simulator, "the link broke")))
    assertEquals(firstAt, 500.0)
    assertEquals(again, ByteString("again"))
    assertEquals(counts.connections, 2L)
    assertEquals(counts.disconnects, 1L)

  test("a lost host leaves connections half-open, does not answer, and on its return resets what was open"):
    val silence = NetworkFault(
      Where.Host("simulator"),
      TimedFault(Span.ofMillis(500), Fault.Silence(Span.ofSeconds(20)))
    )
    val ((first, firstAt), attempt, again) = in(over(slow).copy(faults = List(silence))): world =>
      val talking = world.talk()
      for
        _       <- world.serve(Flow[ByteString])
        _       <- Source.tick(1.second, 1.second, ()).take(1).runWith(Sink.ignore)
        attempt <- world.ended(world.ask(ByteString("x")))
        broken  <- world.ended(talking)
        again   <- world.ask(ByteString("again"))
      yield (broken, attempt, again)
    assertEquals(attempt, (Failure(TransportError.NoAnswer(simulator, Span.ofSeconds(5))), 6000.0))
    assertEquals(first, Failure(TransportError.Lost(simulator, "the link broke")))
    assertEquals(firstAt, 20_500.0)
    assertEquals(again, ByteString("again"))

  test("a fault on one link does not affect others"):
    val fault = NetworkFault(
      Where.Link("elsewhere", "simulator"),
      TimedFault(Span.ofMillis(10), Fault.Silence(Span.ofSeconds(9)))
    )
    val answer = in(over(slow).copy(faults = List(fault))): world =>
      world.serve(Flow[ByteString]).flatMap(_ => world.ask(ByteString("x")))
    assertEquals(answer, ByteString("x"))

  test("a client that cancels while it connects leaves no connection behind"):
    val serverSide = in(over(slow)): world =>
      val ended = Promise[Done]()
      for
        _ <- world.serve(Flow[ByteString].watchTermination()((_, done) => ended.completeWith(done)))
        _ = Source
          .empty[ByteString]
          .via(world.controller.connect(simulator))
          .takeWithin(20.millis)
          .runWith(Sink.ignore)
        outcome <- world.ended(ended.future)
      yield outcome
    assertEquals(serverSide._1, Success(Done))

  test("segments are cut anywhere, and no byte is lost or reordered"):
    val cutting       = slow.copy(cutsSegments = true)
    val (back, sizes) = in(over(cutting)): world =>
      val text = ByteString((1 to 500).map(i => s"$i;").mkString)
      for
        _        <- world.serve(Flow[ByteString])
        segments <- Source(text.grouped(100).toVector)
          .throttle(1, 10.millis)
          .via(world.controller.connect(simulator))
          .runWith(Sink.seq)
      yield (segments.reduce(_ ++ _) == text, segments.map(_.size))
    assert(back)
    assert(sizes.distinct.sizeIs > 5, sizes)

  test("a limited bandwidth delays large data"):
    val narrow = LinkProfile.symmetric(
      LatencyProfile.Limited("narrow", slow.toServer, Bandwidth.ofBitsPerSecond(80_000))
    )
    val at = in(over(narrow)): world =>
      for
        _      <- world.serve(Flow[ByteString].fold(0)(_ + _.size).map(size => ByteString(s"$size")))
        answer <- world.ask(ByteString(Array.fill[Byte](5_000)(0)))
      yield (answer.utf8String, world.ms())
    assertEquals(at, ("5000", 100 + 50 + 500 + 50 + 0.4))

  test("each lost packet of TCP is counted, and is sent again until it has arrived"):
    val lossy =
      LatencyProfile.parse("loss:20%,constant:100ms", Left(_)).fold(wrong => fail(wrong.message), identity)
    val sent           = ByteString(Array.fill[Byte](100_000)(7))
    val (came, counts) = in(over(LinkProfile.symmetric(lossy))): world =>
      for
        _    <- world.serve(Flow[ByteString])
        came <- world.ask(sent)
      yield (came, world.network.counts("controller", "simulator"))
    assertEquals(came, sent)
    assert(clue(counts.packetsLost) > 10 && counts.packetsLost == counts.packetsSentAgain, counts)
    assertEquals((counts.bytesToServer, counts.bytesToClient, counts.bytesLost), (100_000L, 100_000L, 0L))
    assertEquals((counts.connections, counts.disconnects, counts.duplicates), (1L, 0L, 0L))

  test("equal seeds give equal traffic to the nanosecond, different seeds different traffic"):
    val shaky = LinkProfile.symmetric(LatencyProfile.vpn).copy(
      faults = Faults(
        stallEvery = Some(Span.ofSeconds(2)),
        stallLasts = Span.ofMillis(300),
        resetEvery = Some(Span.ofSeconds(5))
      ),
      cutsSegments = true
    )
    def traffic(seed: Long) = in(over(shaky), seed): world =>
      def attempt(): Source[(String, Double), Any] = Source
        .tick(0.millis, 20.millis, ByteString("position"))
        .via(world.controller.connect(simulator))
        .map(bytes => bytes.utf8String -> world.ms())
        .recover(failure => failure.getMessage -> world.ms())
      world.serve(Flow[ByteString]).flatMap: _ =>
        Source.fromIterator(() => Iterator.fill(5)(())).flatMapConcat(_ => attempt()).runWith(Sink.seq)
    val first = traffic(1)
    assert(first.sizeIs > 300, first.size)
    assertEquals(traffic(1), first)
    assertNotEquals(traffic(2), first)

  test("connections that have ended in any way leave no stream running"):
    val (busy, left) = in(over(slow).copy(faults =
      List(at(5_000, Fault.Reset), at(10_000, Fault.Silence(Span.ofSeconds(9))))
    )): world =>
      val crash     = Flow[ByteString].map(_ => throw RuntimeException("crash"))
      def snapshots = MaterializerState.streamSnapshots(summon[ActorSystem])
      val elsewhere = Address("simulator", 1)
      for
        listening <- world.serve(Flow[ByteString])
        crashing  <- world.serve(crash, elsewhere)
        _         <- Future.traverse(1 to 5)(_ => world.ask(ByteString("ended by both")))
        _         <- Future.traverse(1 to 5)(_ => world.ask(ByteString("crashed"), elsewhere).failed)
        talking = Future.traverse(1 to 5)(_ => world.talk().failed)
        busy <- after(1.second, summon[ActorSystem].scheduler)(snapshots)
        _    <- talking
        _    <- Future.traverse(1 to 5): _ =>
          ticks.take(100).via(world.controller.connect(simulator)).take(3).runWith(Sink.ignore)
        _       <- Future.traverse(1 to 5)(_ => world.talk().failed)
        _       <- listening.close()
        _       <- crashing.close()
        _       <- after(1.second, summon[ActorSystem].scheduler)(Future.unit)
        streams <- snapshots
      yield (busy.size, streams)
    assert(busy > 10, busy)
    assertEquals(left, Seq())
