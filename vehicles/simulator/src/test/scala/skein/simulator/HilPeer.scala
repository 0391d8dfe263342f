package skein.simulator

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Source}
import org.apache.pekko.util.ByteString
import scala.concurrent.Future
import skein.hil.SmallAutopilot
import skein.link.{Address, Transport}

/** A small autopilot at the far end of a connection. */
private[simulator] object HilPeer:
  /** Lets the autopilot fly until it has received the sensors of this time, µs, and then closes the
    * connection.
    *
    * @param on called with every received piece, before it is answered
    */
  def fly(autopilot: SmallAutopilot, untilUsec: Long, to: Address, transport: Transport)(
      on: Array[Byte] => Unit = _ => ()
  )(using ActorSystem): Future[Done] =
    val answering = Flow[ByteString]
      .map: bytes =>
        on(bytes.toArray)
        ByteString.fromArray(autopilot.hear(bytes.toArray))
      .takeWhile(_ => autopilot.heard.lastOption.forall(_ < untilUsec))
      .prepend(Source.single(ByteString.fromArray(autopilot.greeting)))
      .watchTermination()(Keep.right)
    transport.connect(to).joinMat(answering)(Keep.right).run()
