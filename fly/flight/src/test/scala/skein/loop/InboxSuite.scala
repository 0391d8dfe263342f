package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.Sink
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vtime.VirtualTime

class InboxSuite extends munit.FunSuite:

  private def message(number: Long) =
    val state = Kinematics(Vector3.Zero, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    val at    = Instant.ofNanos(number)
    Reading(1, number, Stamped(state, at, at, at))

  test("a graph that starts late begins with the newest message so far"):
    val inbox = Inbox((one, other) => one.validAt > other.validAt, _ => fail("a message was dropped"))
    for number <- Seq(1L, 3L, 2L) do inbox.put(message(number))
    val received = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        val taken         = inbox.messages.take(2).map(_.sequence).runWith(Sink.seq)
        inbox.put(message(4))
        taken
      .value
    assertEquals(received, Seq(3L, 4L))
