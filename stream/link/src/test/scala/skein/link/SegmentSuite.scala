package skein.link

import org.apache.pekko.util.ByteString
import skein.signal.{LatencyProfile, PacketLoss}
import skein.units.*

class SegmentSuite extends munit.FunSuite:
  private def ms(value: Double) = Span.ofMillis(value)

  /** First time-out of 200 ms; a packet may be overtaken for 50 ms. */
  private val tcp: Packets.Tcp =
    new Packets.Tcp(PacketLoss(LatencyProfile.none, 1, 2), timeout = ms(200), overtaken = ms(50))

  private def lost(): Segment =
    val segment = Segment(ByteString("x"), Segment.Never)
    segment.lost(ms(100), tcp)
    segment

  test("a lost packet is sent again after the timeout, and each further timeout is twice as long"):
    val segment = lost()
    assertEquals((segment.isLost, segment.againAt), (true, ms(300)))
    segment.lostAgain(ms(300))
    assertEquals(segment.againAt, ms(700))
    segment.lostAgain(ms(700))
    assertEquals(segment.againAt, ms(1500))

  test(
    "the acknowledgement of a packet sent no earlier reveals a loss once overtaking is ruled out"
  ):
    for (acknowledged, again) <- Seq(120.0 -> 150.0, 150.0 -> 150.0, 180.0 -> 180.0, 400.0 -> 300.0) do
      for sent <- Seq(100.0, 110.0) do
        val segment = lost()
        segment.missed(ms(sent), ms(acknowledged), tcp)
        assertEquals(segment.againAt, ms(again), s"sent $sent, acknowledged $acknowledged")
    val segment = lost()
    segment.missed(ms(99), ms(120), tcp)
    assertEquals(segment.againAt, ms(300), "one that was sent before it reveals nothing")

  test("the timeout does not grow by a loss that another packet revealed"):
    val segment = lost()
    segment.missed(ms(110), ms(180), tcp)
    segment.lostAgain(ms(180))
    assertEquals(segment.againAt, ms(380))
    segment.missed(ms(190), ms(240), tcp)
    assertEquals(segment.againAt, ms(240))

  test("after a timeout, and after it is sent again, no other packet reveals a loss"):
    val segment = lost()
    segment.lostAgain(ms(300))
    segment.missed(ms(310), ms(320), tcp)
    assertEquals(segment.againAt, ms(700))
    val travels = lost()
    travels.due = ms(400)
    travels.missed(ms(110), ms(120), tcp)
    assertEquals((travels.isLost, travels.againAt), (false, ms(300)))
