package skein.forward

import skein.signal.LatencyProfile
import skein.simd.WorldRandom

class DelaysSuite extends munit.FunSuite:
  private val mixed = LinkDelays.of(LatencyProfile.vpnMixed) match
    case alternating: AlternatingDelays => alternating
    case other                          => fail(other.toString)

  private val second = 1_000_000_000L

  private def busyAt(key: Int, seconds: Range): Seq[Boolean] =
    seconds.map(s => mixed.isBusy(WorldRandom.key(3, 0, key), s * second))

  test("an alternating link is busy for its share of the time, at every moment"):
    for at <- Seq(0, 60, 300) do
      val busy = (0 until 4000).count(key => busyAt(key, at to at).head) / 4000.0
      assertEqualsDouble(busy, 40.0 / 95, 0.025)

  test("the stretches of an alternating link have the stated mean duration"):
    val changes =
      (0 until 200).map(key => busyAt(key, 0 until 950).sliding(2).count(pair => pair(0) != pair(1))).sum
    // Two changes in 95 s; those less than a second apart are not seen.
    assertEqualsDouble(changes / 200.0, 20, 1.0)

  test("within a stretch, delays are those of the busy or of the quiet link"):
    for key <- 0 until 50 do
      val world = WorldRandom.key(3, 0, key)
      val link  = if mixed.isBusy(world, 7 * second) then DelayTable.vpn else DelayTable.direct
      for line <- 0 until 12 do
        assertEquals(
          mixed.delayNs(world, line, 70, 70, 7 * second),
          link.delayNs(world, line, 70, 70, 7 * second)
        )

  private def checked(text: String, timing: LoopTiming = LoopTiming.Stream()) = LinkDelays.checked(
    LatencyProfile.parse(text, Left(_)).fold(error => fail(error.message), identity),
    timing,
    vehicles = 2
  )

  private def lossy(text: String) = checked(text) match
    case Right(lossy: LossyDelays) => lossy
    case other                     => fail(other.toString)

  /** Additional delays of a line's messages due to losses, over many worlds and steps, ns. */
  private def waits(text: String, line: Int, worlds: Int = 400, steps: Int = 300): Seq[Seq[Long]] =
    val delays = lossy(text)
    for world <- 0 until worlds yield
      val key = WorldRandom.key(5, 0, world)
      for step <- 0 until steps yield
        val at = step * second / 10
        delays.delayNs(key, line, step, step, at) - DelayTable.vpn.delayNs(key, line, step, step, at)

  for (text, after) <- Seq("loss:5%,vpn" -> 0.05, "loss:5%/4,vpn" -> 0.05) do
    test(s"$text: of all messages 5 % are sent again after the time-out of TCP, and 5 % of these once more"):
      val all = waits(text, Delays.command(0)).flatten.map(ns => (ns * 1e-6).round)
      assertEqualsDouble(all.count(_ > 0) / all.size.toDouble, after, 0.004)
      assertEquals(all.distinct.sorted.take(3), Seq(0L, 303L, 909L))
      assertEqualsDouble(all.count(_ > 303).toDouble / all.count(_ > 0), after, 0.02)

  test(
    "with bursts of four packets, a line's next message is lost as often as on a link with forty packets " +
      "a second"
  ):
    // From packet to packet the chain keeps a share of 1 − 1/4 / 0.95; messages of a line are four apart.
    val keeps              = math.pow(1 - 0.25 / 0.95, 4)
    def next(text: String) =
      val lost = waits(text, Delays.command(1)).map(_.map(_ > 0))
      val both = lost.flatMap(_.sliding(2)).filter(_.head)
      both.count(_.last).toDouble / both.size
    assertEqualsDouble(next("loss:5%/4,vpn"), 0.05 + 0.95 * keeps, 0.03)
    assertEqualsDouble(next("loss:5%,vpn"), 0.05, 0.01)

  test("bursts last for as many packets as the loop sends"):
    def each(timing: LoopTiming, vehicles: Int, roundTripS: Double) =
      LinkDelays.packetsPerS(timing, vehicles, roundTripS)
    for timing <- Seq(LoopTiming.Stream(), LoopTiming.Predictive()) do
      assertEqualsDouble(each(timing, 2, 0.2), 40, 1e-9)
    // In a period of 0.1 s and two round trips, two requests and two commands.
    assertEqualsDouble(each(LoopTiming.Sequential(), 2, 0.2), 8, 1e-9)
    // Each of two tasks a period reads two vehicles and commands one; of eight vehicles, four tasks overlap.
    assertEqualsDouble(each(LoopTiming.Futures(), 2, 0.2), 60, 1e-9)
    assertEqualsDouble(each(LoopTiming.Futures(), 8, 0.2), 8 * 9 * 4 / 1.6, 1e-9)

  test("a message is sent again until only 1 in 50,000 would have to be once more"):
    // Bursts of `sequential` last for 264 ms on average: 0.05 e^(−2.12 / 0.264) of the messages.
    val longestS = checked("loss:5%/4,vpn", LoopTiming.Sequential()).map { case delays: TabledDelays =>
      delays.maxS.toDouble
    }
    assertEqualsDouble(longestS.fold(fail(_), identity), 2.12 + 0.1035, 0.01)

  test("bursts are independent in the two directions, outages are not"):
    def together(text: String) =
      val (there, back) =
        (waits(text, Delays.command(0)).flatten, waits(text, Delays.acknowledgement(0)).flatten)
      there.zip(back).count((a, b) => a > 0 && b > 0) / there.count(_ > 0).toDouble
    assertEqualsDouble(together("loss:5%/4,vpn"), 0.05, 0.02)
    assertEquals(together("outage:1s/10s,vpn"), 1.0)

  test("all messages of an outage arrive after it, at one of the tries"):
    val each = waits("outage:1s/10s,vpn", Delays.command(0)).map(_.map(ns => (ns * 1e-6).round))
    val all  = each.flatten
    // The later in an outage a message is sent, the sooner it passes; few outages follow another directly.
    val pairs = each.flatMap(_.sliding(2)).filter(!_.contains(0L))
    assert(pairs.count(pair => pair(0) < pair(1)) < 0.05 * pairs.count(pair => pair(0) > pair(1)))
    assertEqualsDouble(all.count(_ > 0) / all.size.toDouble, 0.1, 0.01)
    // Tries 303, 909 and 2,120 ms later.
    assertEquals(all.distinct.sorted, Seq(0L, 303L, 909L, 2120L))
    assertEqualsDouble(lossy("outage:1s/10s,vpn").maxS, 2.12 + 0.1035, 0.01)

  test("the message about an unsupported link states the link; a loss of 0 changes nothing"):
    for text <- Seq("rate:1mbit,loss:5%,vpn", "loss:5%,correlated:1s,vpn") do
      assertEquals(
        checked(text),
        Left(
          s"expected a link without rate, correlation and reordering, which forward simulation does not have, got $text"
        )
      )
    assert(checked("loss:0%,vpn").exists(_.isInstanceOf[DelayTable]))

  test("recorded delays are found by vehicle, kind and number; a message without a record never arrives"):
    val delays = RecordedDelays(Vector(
      Vector(Array(1L, 2L), Array(3L), Array(4L), Array(5L)),
      Vector(Array(6L), Array(7L), Array(8L), Array(9L, 10L))
    ))
    assertEquals(delays.delayNs(0, Delays.question(1, 0), 0, 1, 0), 2L)
    assertEquals(delays.delayNs(0, Delays.answer(0, 1), 0, 0, 0), 7L)
    assertEquals(delays.delayNs(0, Delays.command(0), 9, 0, 0), 4L)
    assertEquals(delays.delayNs(0, Delays.acknowledgement(1), 9, 1, 0), 10L)
    assertEquals(delays.delayNs(0, Delays.command(1), 9, 5, 0), RecordedDelays.Lost)
