package skein.rpc

import scala.collection.mutable
import skein.link.Address
import skein.units.*
import upack.{Int32, Msg, Null, Str}

class ChannelStateSuite extends munit.FunSuite:

  private val address = Address("sim", 41451)

  /** A channel that only records sends, ends and reconnects; time is in milliseconds. */
  private final class Channel(settings: RpcSettings) extends ChannelEffects:
    val counters   = RpcCounters()
    val sent       = mutable.Buffer.empty[Call]
    val usedInTurn = mutable.Buffer.empty[Int]
    val ends       = mutable.Map.empty[String, Either[RpcError, Msg | Received]]
    val times      = mutable.Map.empty[String, (Instant, Instant)]
    val reconnects = mutable.Buffer.empty[(Int, Span)]
    val events     = mutable.Buffer.empty[RpcEvent]
    val state      = ChannelState(skein.rpc.Channel.Control, address, settings, counters, () => 0.0, this)

    def send(call: Call): Unit =
      call.written = true
      call.sends += 1
      sent += call
      usedInTurn += call.connection
    def end(call: Call, outcome: Either[RpcError, TimedReply[Msg | Received]]): Unit =
      assert(!ends.contains(call.method), s"${call.method} ended twice")
      ends(call.method) = outcome.map(_.value)
      for reply <- outcome do times(call.method) = (reply.sentAt, reply.receivedAt)
    def reconnect(connection: Int, after: Span): Unit = reconnects += connection -> after
    def observe(event: RpcEvent): Unit                = events += event

    def submit(name: String, options: CallOptions = CallOptions(), at: Double = 0): Unit =
      state.submit(Call(name, Seq.empty, options, ms(at)), ms(at))
    def open(connections: Int*): Unit                                 = connections.foreach(state.opened)
    def reply(name: String, result: Msg = Null, at: Double = 0): Unit =
      val call = sent.findLast(_.method == name).get
      state.replied(call.connection, RpcMessage.Reply(call.id, Null, result), ms(at)): Unit
    def sentNames: Seq[String]          = sent.map(_.method).toSeq
    def connectionOf(name: String): Int = sent.findLast(_.method == name).get.connection
    def error(name: String): RpcError   = ends(name).left.toOption.get

  private def ms(millis: Double): Instant = Instant.Epoch + Span.ofMillis(millis)

  private def channel(
      connections: Int = 2,
      perConnection: Int = 2,
      inAll: Int = 3,
      queue: Int = 2,
      resends: Int = 1,
      remembered: Int = 2
  ): Channel = Channel(
    RpcSettings(
      controlConnections = connections,
      windowPerConnection = perConnection,
      windowInAll = inAll,
      queue = queue,
      resends = resends,
      rememberedIds = remembered
    )
  )

  private val wait       = CallOptions(whenFull = WhenFull.Wait)
  private val idempotent = CallOptions(idempotent = true)

  test("calls made before a connection is open wait for it and go out in order"):
    val l = channel()
    l.submit("a")
    l.submit("b")
    assertEquals(l.sentNames, Seq.empty)
    l.open(1)
    assertEquals(l.sentNames, Seq("a", "b"))

  test("an answer has the times at which its request was sent and the answer was received"):
    val l = channel()
    l.open(1)
    l.submit("a")
    l.sent.head.sentAt = ms(3)
    l.reply("a", at = 8)
    assertEquals(l.times("a"), (ms(3), ms(8)))

  test("a call without a key goes to the connection with the fewest in flight, in rotation among equals"):
    val l = channel(connections = 3, inAll = 9)
    l.open(0, 1, 2)
    Seq("a", "b", "c", "d").foreach(l.submit(_))
    assertEquals(l.sent.map(_.connection).toSeq, Seq(0, 1, 2, 0))
    l.reply("b")
    l.submit("e")
    assertEquals(l.connectionOf("e"), 1)

  test("replies reach their own calls in any order"):
    val l = channel()
    l.open(0, 1)
    Seq("a", "b", "c").foreach(l.submit(_))
    l.reply("c", Int32(3))
    l.reply("a", Int32(1))
    l.reply("b", Int32(2))
    assertEquals(l.ends.toMap, Map("a" -> Right(Int32(1)), "b" -> Right(Int32(2)), "c" -> Right(Int32(3))))

  test("each connection numbers its calls from 0"):
    val l = channel(connections = 1, perConnection = 9, inAll = 9)
    l.open(0)
    Seq("a", "b", "c").foreach(l.submit(_))
    assertEquals(l.sent.map(_.id).toSeq, Seq(0L, 1L, 2L))

  test("a full window of all connections refuses calls or lets them wait, until an answer makes room"):
    val l = channel(perConnection = 9)
    l.open(0, 1)
    Seq("a", "b", "c").foreach(l.submit(_))
    l.submit("refused")
    assertEquals(l.error("refused"), RpcError.Overloaded("refused", "3 calls are in flight already"))
    l.submit("d", wait)
    l.submit("e", wait)
    l.submit("f", wait)
    assertEquals(l.error("f"), RpcError.Overloaded("f", "2 calls wait already"))
    assertEquals(l.sentNames, Seq("a", "b", "c"))
    l.reply("b")
    assertEquals(l.sentNames, Seq("a", "b", "c", "d"))

  test("a full window of one connection delays the calls of its keys, but not those of other keys"):
    val l = channel(perConnection = 1, inAll = 9)
    l.open(0, 1)
    l.submit("a", wait.copy(key = Some(0)))
    l.submit("b", wait.copy(key = Some(0)))
    l.submit("c", wait.copy(key = Some(1)))
    assertEquals(l.sentNames, Seq("a", "c"))
    l.submit("d", CallOptions(key = Some(2)))
    assertEquals(
      l.error("d"),
      RpcError.Overloaded("d", "1 calls are in flight already on each connection")
    )
    l.reply("a")
    assertEquals(l.sentNames, Seq("a", "c", "b"))

  test("a key's calls keep their order even when there is room again while others wait"):
    val l = channel(perConnection = 1, inAll = 1, queue = 9)
    l.open(0, 1)
    l.submit("a", wait)
    l.submit("b", wait.copy(key = Some(1)))
    l.submit("c", wait.copy(key = Some(1)))
    l.submit("d", wait)
    for name <- Seq("a", "b", "c") do l.reply(name)
    assertEquals(l.sentNames, Seq("a", "b", "c", "d"))
    assertEquals(Seq("b", "c").map(l.connectionOf), Seq(1, 1))

  test("a call times out at its deadline and makes room, and its late reply is reported and dropped"):
    val l = channel(connections = 1, perConnection = 1)
    l.open(0)
    l.submit("a", CallOptions(timeout = Span.ofMillis(500)))
    l.submit("b", wait)
    assertEquals(l.state.nextDeadline, Some(ms(500)))
    l.state.expire(ms(499.999))
    assertEquals(l.ends.size, 0)
    l.state.expire(ms(500))
    assertEquals(l.error("a"), RpcError.Timeout("a", Span.ofMillis(500)))
    assertEquals(l.sentNames, Seq("a", "b"))
    l.reply("a", at = 700)
    assertEquals(l.counters.snapshot.late, 1L)
    assertEquals(l.events.last, RpcEvent.LateReply("a", skein.rpc.Channel.Control, 0, Span.ofMillis(700)))
    l.reply("a", at = 701)
    assertEquals(l.counters.snapshot.unexpected, 1L)
    l.reply("b", Str("b"))
    assertEquals(l.ends("b"), Right(Str("b")))

  test("time spent waiting counts towards the timeout"):
    val l = channel()
    l.submit("a", CallOptions(timeout = Span.ofMillis(10)))
    l.state.expire(ms(10))
    assertEquals(l.error("a"), RpcError.Timeout("a", Span.ofMillis(10)))
    l.open(0)
    assertEquals(l.sentNames, Seq.empty)

  test("a bounded number of timed-out calls is remembered"):
    val l = channel(connections = 1, perConnection = 9, inAll = 9, remembered = 2)
    l.open(0)
    for name <- Seq("a", "b", "c") do l.submit(name)
    l.state.expire(ms(5000))
    for name <- Seq("a", "b", "c") do l.reply(name)
    assertEquals(l.counters.snapshot.late, 2L)
    assertEquals(l.counters.snapshot.unexpected, 1L)

  test("after the loss of a connection its calls may have run, and only idempotent ones are sent again"):
    val l = channel(inAll = 9)
    l.open(0, 1)
    l.submit("move", CallOptions(key = Some(0)))
    l.submit("read", idempotent.copy(key = Some(0)))
    l.submit("other", CallOptions(key = Some(1)))
    l.state.lost(0, "reset", malformed = false)
    assertEquals(l.error("move"), RpcError.ConnectionLost(address, mayHaveRun = true, "reset"))
    assertEquals(l.ends.keySet, Set("move"))
    l.open(0)
    assertEquals(l.sentNames, Seq("move", "read", "other", "read"))
    l.reply("read", Int32(4))
    assertEquals(l.ends("read"), Right(Int32(4)))

  test("an idempotent call is sent again a bounded number of times"):
    val l = channel(connections = 1, resends = 2)
    l.open(0)
    l.submit("read", idempotent)
    for _ <- 1 to 2 do
      l.state.lost(0, "reset", malformed = false)
      l.open(0)
    assertEquals(l.sent.length, 3)
    l.state.lost(0, "reset", malformed = false)
    assertEquals(l.error("read"), RpcError.ConnectionLost(address, mayHaveRun = true, "reset"))

  test("an idempotent call without a key moves to another connection immediately"):
    val l = channel()
    l.open(0, 1)
    l.submit("read", idempotent)
    l.state.lost(l.connectionOf("read"), "reset", malformed = false)
    assertEquals(l.usedInTurn.toSeq, Seq(0, 1))

  test("calls on a connection that is closed for malformed bytes fail with that reason"):
    val l = channel()
    l.open(0)
    l.submit("a")
    l.state.lost(0, "byte 0xc1", malformed = true)
    assertEquals(l.error("a"), RpcError.Malformed("a", "byte 0xc1"))

  test("while no connection opens, waiting and later calls fail immediately"):
    val l = channel()
    l.submit("waiting")
    l.submit("keyed", CallOptions(key = Some(0)))
    l.state.openFailed(0, "refused")
    assertEquals(l.ends.keySet, Set("keyed"))
    l.state.openFailed(1, "refused")
    l.submit("later")
    for name <- Seq("waiting", "keyed", "later") do
      assertEquals(l.error(name), RpcError.Unreachable(address, "refused"))
    l.open(1)
    l.submit("after")
    assertEquals(l.sentNames, Seq("after"))
    // Failed calls wait no longer: the queue has room for two others.
    l.submit("second")
    for name <- Seq("third", "fourth", "fifth") do l.submit(name, CallOptions(whenFull = WhenFull.Wait))
    assertEquals(l.sentNames, Seq("after", "second"))
    assertEquals(l.ends.keySet, Set("waiting", "keyed", "later", "fifth"))

  test("pauses between attempts to connect double up to the longest, and start again after an answer"):
    val l = channel(connections = 1)
    for _ <- 1 to 8 do l.state.openFailed(0, "refused")
    l.open(0)
    l.state.lost(0, "accepted, then closed", malformed = false)
    assertEquals(
      l.reconnects.map(_._2.toMillis).toSeq,
      Seq(50.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 2000.0, 2000.0, 2000.0)
    )
    l.open(0)
    l.submit("a")
    l.reply("a")
    l.state.lost(0, "reset", malformed = false)
    assertEquals(l.reconnects.last, 0 -> Span.ofMillis(50))

  test("the pause is shortened at random by at most the jitter"):
    val backOff = BackOff(Span.ofMillis(100), Span.ofMillis(300), jitter = 0.25)
    assertEquals(backOff.pause(2, 0.0), Span.ofMillis(200))
    assertEquals(backOff.pause(2, 1.0), Span.ofMillis(150))
    assertEquals(backOff.pause(1000, 0.0), Span.ofMillis(300))

  test("closing ends every call once, waiting or in flight"):
    val l = channel(perConnection = 1, inAll = 1)
    l.open(0)
    l.submit("flying")
    l.submit("waiting", wait)
    l.state.close()
    assertEquals(l.error("flying"), RpcError.Cancelled("flying"))
    assertEquals(l.error("waiting"), RpcError.Cancelled("waiting"))

  test("a refusal contains the peer's text, and a reply to no call changes nothing"):
    val l = channel()
    l.open(0)
    l.submit("a")
    l.state.replied(0, RpcMessage.Reply(99, Null, Null), ms(1))
    l.state.replied(0, RpcMessage.Reply(0, Str("std::bad_cast"), Null), ms(1))
    assertEquals(l.error("a"), RpcError.Refused("a", "std::bad_cast"))
    assertEquals(l.counters.snapshot.unexpected, 1L)

  test("under random faults every call ends exactly once and the counts add up"):
    for seed <- 1 to 200 do
      val random = scala.util.Random(seed)
      val l      = channel(connections = 3, perConnection = 4, inAll = 8, queue = 5)
      val up     = Array.fill(3)(false)
      var calls  = 0
      for step <- 0 until 400 do
        val connection = random.nextInt(3)
        random.nextInt(10) match
          case 0 if !up(connection)     => l.state.openFailed(connection, "refused")
          case 1 | 2 if !up(connection) =>
            up(connection) = true
            l.open(connection)
          case 3 if up(connection) && random.nextInt(4) == 0 =>
            up(connection) = false
            l.state.lost(connection, "reset", random.nextBoolean())
          case 4 | 5 | 6 =>
            calls += 1
            l.counters.called.increment()
            l.submit(
              s"call $calls",
              CallOptions(
                timeout = Span.ofMillis(1 + random.nextInt(60)),
                idempotent = random.nextBoolean(),
                key = Option.when(random.nextBoolean())(random.nextInt(5)),
                whenFull = if random.nextBoolean() then WhenFull.Wait else WhenFull.Refuse
              ),
              step
            )
          case 7 | 8 if up(connection) =>
            l.state.replied(connection, RpcMessage.Reply(random.nextInt(40), Null, Int32(step)), ms(step))
          case _ => l.state.expire(ms(step))
        assertEquals(l.counters.snapshot.pending, calls - l.ends.size.toLong, s"seed $seed, step $step")
        assert(l.counters.snapshot.pending <= 8 + 5 + 8, s"seed $seed, step $step: unbounded")
      l.state.close()
      assertEquals(l.ends.size, calls, s"seed $seed")
      assertEquals(l.counters.snapshot.pending, 0L, s"seed $seed")

  test("a withdrawn call ends with a timeout, and its late reply is recognised"):
    val channel = this.channel(connections = 1, perConnection = 1)
    channel.open(0)
    channel.submit("first", at = 0)
    channel.submit("second", CallOptions(whenFull = WhenFull.Wait), at = 1)
    val first = channel.sent.find(_.method == "first").get
    channel.state.withdraw(first, ms(700))
    assertEquals(channel.error("first"), RpcError.Timeout("first", Span.ofMillis(700)))
    assertEquals(channel.sentNames, Seq("first", "second"))
    channel.state.replied(0, RpcMessage.Reply(first.id, Null, Null), ms(800))
    assertEquals(channel.counters.snapshot.late, 1L)

  test("a call can also be withdrawn while it waits, or after it has ended"):
    val channel = this.channel(connections = 1, perConnection = 1)
    channel.open(0)
    channel.submit("first", at = 0)
    channel.submit("waiting", CallOptions(whenFull = WhenFull.Wait), at = 1)
    val first = channel.sent.head
    channel.reply("first", Int32(1), at = 20)
    channel.state.withdraw(first, ms(30))
    assertEquals(channel.ends("first"), Right(Int32(1)))
