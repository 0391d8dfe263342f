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

  test("a link that alternates is busy for its share of the time, at any time"):
    for at <- Seq(0, 60, 300) do
      val busy = (0 until 4000).count(key => busyAt(key, at to at).head) / 4000.0
      assertEqualsDouble(busy, 40.0 / 95, 0.025)

  test("its stretches last as long as they should, on average"):
    val changes =
      (0 until 200).map(key => busyAt(key, 0 until 950).sliding(2).count(pair => pair(0) != pair(1))).sum
    // Two changes in 95 s; those less than a second apart are not seen.
    assertEqualsDouble(changes / 200.0, 20, 1.0)

  test("within a stretch delays are those of the busy or of the quiet link"):
    for key <- 0 until 50 do
      val world = WorldRandom.key(3, 0, key)
      val link  = if mixed.isBusy(world, 7 * second) then DelayTable.vpn else DelayTable.direct
      for line <- 0 until 12 do
        assertEquals(
          mixed.delayNs(world, line, 70, 70, 7 * second),
          link.delayNs(world, line, 70, 70, 7 * second)
        )

  test(
    "a recorded flight's delays come back by vehicle, kind and number; what is not on record never arrives"
  ):
    val delays = RecordedDelays(Vector(
      Vector(Array(1L, 2L), Array(3L), Array(4L), Array(5L)),
      Vector(Array(6L), Array(7L), Array(8L), Array(9L, 10L))
    ))
    assertEquals(delays.delayNs(0, Delays.question(1, 0), 0, 1, 0), 2L)
    assertEquals(delays.delayNs(0, Delays.answer(0, 1), 0, 0, 0), 7L)
    assertEquals(delays.delayNs(0, Delays.command(0), 9, 0, 0), 4L)
    assertEquals(delays.delayNs(0, Delays.acknowledgement(1), 9, 1, 0), 10L)
    assertEquals(delays.delayNs(0, Delays.command(1), 9, 5, 0), RecordedDelays.Lost)
